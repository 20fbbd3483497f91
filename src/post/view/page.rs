//! HTML page with style, modules and, if exported, data.
//!
//! An import map resolves bare module names to `data:` addresses: browsers load no second file from disk.

use base64::prelude::{BASE64_STANDARD, Engine};
use maud::{DOCTYPE, Markup, PreEscaped, Render, html};
use serde_json::{Value, json};
use trackbed_io::write::{BODY_FIELDS, FrameField, MADE_FIELDS, SOLID_FIELDS, SOLID_PARTS};

/// Modules by import name. The first two are three.js (licence: `web/three.LICENSE.txt`).
const MODULES: [(&str, &str); 31] = [
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
    ("water", include_str!("web/water.js")),
    ("model", include_str!("web/model.js")),
    ("outline", include_str!("web/outline.js")),
    ("stage", include_str!("web/stage.js")),
    ("pick", include_str!("web/pick.js")),
    ("plots", include_str!("web/plots.js")),
    ("legend", include_str!("web/legend.js")),
    ("cards", include_str!("web/cards.js")),
    ("save", include_str!("web/save.js")),
    ("panel", include_str!("web/panel.js")),
    ("presets", include_str!("web/presets.js")),
    ("theme", include_str!("web/theme.js")),
    ("dialogs", include_str!("web/dialogs.js")),
    ("state", include_str!("web/state.js")),
    ("player", include_str!("web/player.js")),
    ("history", include_str!("web/history.js")),
    ("parts", include_str!("web/parts.js")),
    ("app", include_str!("web/app.js")),
    ("main", include_str!("web/main.js")),
];

const BODY: &str = include_str!("web/body.html");
const STYLE: &str = include_str!("web/style.css");

/// Content policy: no external resources.
pub const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' data:; style-src 'unsafe-inline'; \
                          connect-src 'self'; img-src data: blob:; media-src blob:; base-uri 'none'; form-action 'none'";

/// JSON within a `script` element, where only `<` needs escaping.
struct ScriptJson<'a>(&'a Value);

impl Render for ScriptJson<'_> {
    fn render_to(&self, buffer: &mut String) {
        buffer.push_str(&self.0.to_string().replace('<', "\\u003c"));
    }
}

pub fn pieces(title: &str, settings: &Value) -> (Markup, Markup) {
    let head = html! {
        (DOCTYPE) "\n"
        (PreEscaped("<html lang=\"en\">\n"))
        head {
            "\n"
            meta charset="utf-8"; "\n"
            meta name="viewport" content="width=device-width, initial-scale=1"; "\n"
            meta http-equiv="Content-Security-Policy" content=(POLICY); "\n"
            link rel="icon" href="data:,"; "\n"
            title { (title) " \u{2013} trackbed" } "\n"
            // Style sheets have no character references.
            style { (PreEscaped(STYLE)) } "\n"
        }
        "\n"
        (PreEscaped("<body>\n"))
        (PreEscaped(BODY))
        (about())
        script id="settings" type="application/json" { (ScriptJson(settings)) } "\n"
        script type="importmap" { (ScriptJson(&imports())) } "\n"
    };
    let tail = html! {
        // Trusted text; an escaped `'` would be invalid JavaScript.
        script type="module" { (PreEscaped("import 'main';")) } "\n"
        (PreEscaped("</body>\n</html>\n"))
    };
    (head, tail)
}

fn about() -> Markup {
    html! {
        dialog id="about" {
            "\n" h2 { "trackbed " (env!("CARGO_PKG_VERSION")) } "\n"
            p { "Coupled discrete-element and finite-element solver for ballasted railway track; viewer of its results." } "\n"
            p { "Licence: MIT or Apache-2.0. Drawn with three.js, © 2010–2024 three.js authors, MIT licence." } "\n"
            button class="close" { "Close" } "\n"
        }
        "\n"
    }
}

fn labels(fields: impl Iterator<Item = &'static FrameField>) -> Value {
    let label =
        |field: &FrameField| (field.name.to_string(), json!({ "label": field.label, "unit": field.unit }));
    Value::Object(fields.map(label).collect())
}

fn imports() -> Value {
    let fields = format!(
        "export const FIELDS = {};\nexport const SOLID_FIELDS = {};",
        labels(BODY_FIELDS.iter().chain(&MADE_FIELDS)),
        labels(SOLID_FIELDS.iter().chain(&SOLID_PARTS))
    );
    let address = |text: &str| json!(format!("data:text/javascript;base64,{}", BASE64_STANDARD.encode(text)));
    let modules = MODULES.iter().map(|(name, text)| (name.to_string(), address(text)));
    let addresses: serde_json::Map<String, Value> =
        modules.chain([("fields".to_string(), address(&fields))]).collect();
    json!({ "imports": addresses })
}

pub fn embedded(name: &str, deflated: &[u8]) -> Markup {
    html! { script type="text/plain" data-block=(name) { (BASE64_STANDARD.encode(deflated)) } "\n" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hostile_titles_stay_text() {
        let evil = "</title><script>alert(1)</script>\"'&";
        let (head, tail) = pieces(evil, &json!({ "title": evil }));
        let page = head.0 + &tail.0;
        assert!(!page.contains("<script>alert"), "the title is escaped");
        assert!(page.contains("&lt;/title&gt;&lt;script&gt;"), "the title is there");
        assert!(embedded("grains/0/\"><b>", b"x").0.contains("data-block=\"grains/0/&quot;&gt;&lt;b&gt;\""));
    }

    #[test]
    fn script_content_has_no_element() {
        let evil = json!({ "</script><!--": "</script><script>alert(1)</script>", "quote": "\"&'" });
        let text = html! { script { (ScriptJson(&evil)) } }.0;
        let content = text.strip_prefix("<script>").unwrap().strip_suffix("</script>").unwrap();
        assert!(!content.contains('<'), "{content}");
        assert_eq!(serde_json::from_str::<Value>(content).unwrap(), evil);
    }

    #[test]
    fn title_named_like_place_stays_text() {
        let settings = json!({ "served": true });
        let plain = pieces("bed", &settings);
        for title in
            ["{{DATA}}", "{{TITLE}}", "{{STYLE}}", "{{SETTINGS}}{{IMPORTS}}", "}}{{", "{{", "{{{{DATA}}}}"]
        {
            let (head, tail) = pieces(title, &settings);
            assert!(head.0.contains(&format!("<title>{title} ")), "{title}");
            assert_eq!(head.0.len() - title.len(), plain.0.0.len() - "bed".len(), "{title}");
            assert_eq!(tail.0, plain.1.0, "{title}");
        }
    }
}
