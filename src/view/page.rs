//! The page: one HTML text with its style, its modules and, in an exported file, its data.
//!
//! Modules name each other by bare names, which an import map resolves to `data:` addresses: the same text works from a
//! server and from a disk, where a browser loads no second file.

use base64::prelude::{BASE64_STANDARD, Engine};
use serde_json::{Value, json};

/// Modules by the names that they import each other by. The first two are three.js (licence: `web/three.LICENSE.txt`).
const MODULES: [(&str, &str); 24] = [
    ("three", include_str!("web/three.module.min.js")),
    ("orbit", include_str!("web/OrbitControls.js")),
    ("chunk", include_str!("web/chunk.js")),
    ("source", include_str!("web/source.js")),
    ("local", include_str!("web/local.js")),
    ("colours", include_str!("web/colours.js")),
    ("shaders", include_str!("web/shaders.js")),
    ("spheres", include_str!("web/spheres.js")),
    ("grains", include_str!("web/grains.js")),
    ("chains", include_str!("web/chains.js")),
    ("walls", include_str!("web/walls.js")),
    ("solid", include_str!("web/solid.js")),
    ("stage", include_str!("web/stage.js")),
    ("pick", include_str!("web/pick.js")),
    ("plots", include_str!("web/plots.js")),
    ("legend", include_str!("web/legend.js")),
    ("save", include_str!("web/save.js")),
    ("panel", include_str!("web/panel.js")),
    ("dialogs", include_str!("web/dialogs.js")),
    ("state", include_str!("web/state.js")),
    ("player", include_str!("web/player.js")),
    ("history", include_str!("web/history.js")),
    ("app", include_str!("web/app.js")),
    ("main", include_str!("web/main.js")),
];

const FRAME: &str = include_str!("web/index.html");
const STYLE: &str = include_str!("web/style.css");

/// What a browser may load for the page: nothing from elsewhere.
pub const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' data:; style-src 'unsafe-inline'; \
                          connect-src 'self'; img-src data: blob:; media-src blob:; base-uri 'none'; form-action 'none'";

/// A text within a `script` element, which `</script>` would end.
fn quoted(value: &Value) -> String {
    value.to_string().replace('<', "\\u003c")
}

/// A text within HTML.
fn escaped(text: &str) -> String {
    quick_xml::escape::escape(text).into_owned()
}

/// The page in two pieces, between which the data of an exported file stand. `settings` are given to the page.
pub fn pieces(title: &str, settings: &Value) -> (String, String) {
    let imports: serde_json::Map<String, Value> = MODULES
        .iter()
        .map(|(name, text)| {
            let address = format!("data:text/javascript;base64,{}", BASE64_STANDARD.encode(text));
            (name.to_string(), json!(address))
        })
        .collect();
    let (head, tail) = FRAME.split_once("{{DATA}}").expect("the page has a place for data");
    let place = |name: &str| match name {
        "TITLE" => escaped(title),
        "POLICY" => escaped(POLICY),
        "VERSION" => escaped(env!("CARGO_PKG_VERSION")),
        "STYLE" => STYLE.to_string(),
        "SETTINGS" => quoted(settings),
        "IMPORTS" => quoted(&json!({ "imports": imports })),
        other => unreachable!("the frame of the page has no place {other}"),
    };
    (filled(head, place), filled(tail, place))
}

/// A frame with its places `{{NAME}}` filled. What is filled in is not searched for places: a folder may have the name of one.
fn filled(frame: &str, place: impl Fn(&str) -> String) -> String {
    let mut out = String::new();
    let mut rest = frame;
    while let Some((before, after)) = rest.split_once("{{") {
        let (name, after) = after.split_once("}}").expect("a place of the frame ends");
        out += before;
        out += &place(name);
        rest = after;
    }
    out + rest
}

/// A block within the page, deflated.
pub fn embedded(name: &str, deflated: &[u8]) -> String {
    format!(
        "<script type=\"text/plain\" data-block=\"{}\">{}</script>\n",
        escaped(name),
        BASE64_STANDARD.encode(deflated)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hostile_titles_stay_text() {
        let evil = "</title><script>alert(1)</script>\"'&";
        let (head, tail) = pieces(evil, &json!({ "title": evil }));
        let page = head + &tail;
        assert!(!page.contains("<script>alert"), "the title is escaped");
        assert!(page.contains("&lt;/title&gt;&lt;script&gt;"), "the title is there");
        assert!(embedded("grains/0/\"><b>", b"x").contains("data-block=\"grains/0/&quot;&gt;&lt;b&gt;\""));
    }

    #[test]
    fn title_named_like_place_stays_text() {
        let settings = json!({ "served": true });
        let plain = pieces("bed", &settings);
        for title in
            ["{{DATA}}", "{{TITLE}}", "{{STYLE}}", "{{SETTINGS}}{{IMPORTS}}", "}}{{", "{{", "{{{{DATA}}}}"]
        {
            let (head, tail) = pieces(title, &settings);
            assert!(head.contains(&format!("<title>{title} ")), "{title}");
            assert_eq!(head.len() - title.len(), plain.0.len() - "bed".len(), "{title}");
            assert_eq!(tail, plain.1, "{title}");
        }
    }
}
