//! Tags of an XML file with appended binary data.

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

pub(crate) struct Tag<'a> {
    pub name: String,
    start: Option<BytesStart<'a>>,
    closed: bool,
    pub end: usize,
}

impl Tag<'_> {
    pub fn attribute(&self, name: &str) -> Option<String> {
        let attribute = self.start.as_ref()?.try_get_attribute(name).ok()??;
        Some(attribute.unescape_value().ok()?.into_owned())
    }

    pub fn text_after<'b>(&self, bytes: &'b [u8]) -> &'b [u8] {
        if self.closed {
            return &[];
        }
        let rest = &bytes[self.end..];
        &rest[..rest.iter().position(|b| *b == b'<').unwrap_or(rest.len())]
    }
}

/// Tags in order, without comments and declarations, up to the first damaged tag.
pub(crate) fn tags(bytes: &[u8]) -> impl Iterator<Item = Tag<'_>> {
    // The reader counts positions behind a byte order mark.
    let mark = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    let mut reader = Reader::from_reader(&bytes[mark..]);
    // Pairing is not checked: appended binary data can break it.
    reader.config_mut().check_end_names = false;
    reader.config_mut().allow_unmatched_ends = true;
    std::iter::from_fn(move || {
        loop {
            let (name, start, closed) = match reader.read_event().ok()? {
                Event::Start(start) => (text(start.name().as_ref())?, Some(start), false),
                Event::Empty(start) => (text(start.name().as_ref())?, Some(start), true),
                Event::End(end) => (format!("/{}", text(end.name().as_ref())?), None, false),
                Event::Eof => return None,
                _ => continue,
            };
            return Some(Tag { name, start, closed, end: mark + reader.buffer_position() as usize });
        }
    })
}

fn text(name: &[u8]) -> Option<String> {
    std::str::from_utf8(name).ok().map(String::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_with_attributes_comments_and_quotes() {
        let text = b"<?xml version=\"1.0\"?><!-- <a> --><A b=\"1 > 0\" c = 'x&amp;y'>text</A><B/>";
        let found: Vec<Tag> = tags(text).collect();
        assert_eq!(found.iter().map(|t| t.name.as_str()).collect::<Vec<_>>(), ["A", "/A", "B"]);
        assert_eq!(found[0].attribute("b").unwrap(), "1 > 0");
        assert_eq!(found[0].attribute("c").unwrap(), "x&y");
        assert_eq!(found[0].attribute("d"), None);
        assert_eq!(found[0].text_after(text), b"text");
        assert_eq!(found[2].text_after(text), b"");
        let marked = [b"\xef\xbb\xbf".as_slice(), text].concat();
        let tag = tags(&marked).next().unwrap();
        assert_eq!((tag.end, tag.text_after(&marked)), (found[0].end + 3, b"text".as_slice()));
    }

    #[test]
    fn stops_at_damaged_tag() {
        for text in ["<A><B c=", "<A><B", "<A><!-- no end", "<A>\u{0}\u{1}"] {
            assert_eq!(tags(text.as_bytes()).map(|t| t.name).collect::<Vec<_>>(), ["A"], "{text}");
        }
    }
}
