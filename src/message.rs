//! Messages on standard error.
//!
//! Closed or full output must not stop a run: nothing here fails, and a lint forbids `println!` and
//! `eprintln!`.

use anstream::{AutoStream, ColorChoice};
use anstyle::{AnsiColor, Style};
use std::io::Write;

const LONGEST: usize = 8000;

/// Prints a line.
pub fn say(line: &str) {
    write(&format!("{}\n", shown(line, LONGEST)));
}

/// Prints an error.
pub fn error(sentence: &str) {
    headed("error:", AnsiColor::Red.on_default().bold(), sentence);
}

pub(crate) fn warn(warning: &str) {
    headed("warning:", AnsiColor::Yellow.on_default().bold(), warning);
}

pub(crate) fn note(fact: &str) {
    headed("note:", AnsiColor::Cyan.on_default().bold(), fact);
}

/// Coloured on capable terminals, unless `NO_COLOR` is set.
fn headed(head: &str, style: Style, line: &str) {
    let colours = AutoStream::choice(&std::io::stderr()) != ColorChoice::Never;
    let style = if colours { style } else { Style::new() };
    write(&format!("{style}{head}{style:#} {}\n", shown(line, LONGEST)));
}

fn write(text: &str) {
    // One call, so that lines do not mix.
    let _ = std::io::stderr().write_all(text.as_bytes());
}

/// Escapes control characters and shortens to `longest`, with the total length.
pub(crate) fn shown(text: &str, longest: usize) -> String {
    if text.len() <= longest && !text.contains(char::is_control) {
        return text.to_string();
    }
    let mut out = String::new();
    for (k, c) in text.chars().enumerate() {
        if k == longest {
            out += &format!("… ({} characters)", text.chars().count());
            break;
        }
        match c.is_control() {
            false => out.push(c),
            true => out.extend(c.escape_default()),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn foreign_text_is_escaped_and_shortened() {
        assert_eq!(shown("a b\nc", 10), "a b\\nc");
        assert_eq!(shown("a\u{1b}[31m\u{7}\0é", 40), "a\\u{1b}[31m\\u{7}\\u{0}é");
        assert_eq!(shown(&"x".repeat(200_000), 5), "xxxxx… (200000 characters)");
        assert_eq!(shown("ééé", 3), "ééé");
    }
}
