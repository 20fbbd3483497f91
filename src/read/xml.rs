//! The tags of an XML file that may have binary data behind them.

/// An opening or closing tag.
pub(super) struct Tag<'a> {
    /// Its name, with a slash in front when it closes.
    pub name: &'a str,
    attributes: &'a str,
    /// Whether it closes itself.
    closed: bool,
    /// Place of the byte behind it.
    pub end: usize,
}

impl<'a> Tag<'a> {
    /// The value of an attribute.
    pub fn attribute(&self, name: &str) -> Option<String> {
        let mut rest = self.attributes;
        loop {
            let (key, after) = rest.split_once('=')?;
            let after = after.trim_start();
            let quote = after.chars().next().filter(|c| matches!(c, '"' | '\''))?;
            let (value, left) = after[1..].split_once(quote)?;
            if key.trim() == name {
                let entities =
                    [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&apos;", "'"), ("&amp;", "&")];
                return Some(entities.iter().fold(value.to_string(), |v, (from, to)| v.replace(from, to)));
            }
            rest = left;
        }
    }

    /// The bytes between the tag and the next one.
    pub fn text_after<'b>(&self, bytes: &'b [u8]) -> &'b [u8] {
        if self.closed {
            return &[];
        }
        let rest = &bytes[self.end..];
        &rest[..rest.iter().position(|b| *b == b'<').unwrap_or(rest.len())]
    }
}

/// The tags of a file in order, without comments and declarations. Stops at the first that is damaged.
pub(super) fn tags(bytes: &[u8]) -> impl Iterator<Item = Tag<'_>> {
    let mut at = 0;
    std::iter::from_fn(move || {
        loop {
            at += bytes[at..].iter().position(|b| *b == b'<')?;
            if bytes[at..].starts_with(b"<!--") {
                at += 4 + bytes[at + 4..].windows(3).position(|w| w == b"-->")? + 3;
                continue;
            }
            let mut quote = None;
            let end = bytes[at..].iter().position(|b| {
                match quote {
                    Some(q) if q == *b => quote = None,
                    None if matches!(b, b'"' | b'\'') => quote = Some(*b),
                    _ => {}
                }
                quote.is_none() && *b == b'>'
            })?;
            let inner = &bytes[at + 1..at + end];
            at += end + 1;
            if inner.starts_with(b"?") || inner.starts_with(b"!") {
                continue;
            }
            let inner = std::str::from_utf8(inner).ok()?;
            let (inner, closed) = match inner.strip_suffix('/') {
                Some(open) => (open, true),
                None => (inner, false),
            };
            let split = inner.find(char::is_whitespace).unwrap_or(inner.len());
            return Some(Tag { name: &inner[..split], attributes: &inner[split..], closed, end: at });
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_with_attributes_comments_and_quotes() {
        let text = b"<?xml version=\"1.0\"?><!-- <a> --><A b=\"1 > 0\" c = 'x&amp;y'>text</A><B/>";
        let found: Vec<Tag> = tags(text).collect();
        assert_eq!(found.iter().map(|t| t.name).collect::<Vec<_>>(), ["A", "/A", "B"]);
        assert_eq!(found[0].attribute("b").unwrap(), "1 > 0");
        assert_eq!(found[0].attribute("c").unwrap(), "x&y");
        assert_eq!(found[0].attribute("d"), None);
        assert_eq!(found[0].text_after(text), b"text");
        assert_eq!(found[2].text_after(text), b"");
    }
}
