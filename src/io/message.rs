//! Messages on standard error.
//!
//! Closed or full output must not stop a run: nothing here fails, and a lint forbids `println!` and
//! `eprintln!`.

use anstream::{AutoStream, ColorChoice};
use anstyle::{AnsiColor, Style};
use std::borrow::Cow;
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

/// Prints a warning.
pub fn warn(warning: &str) {
    headed("warning:", AnsiColor::Yellow.on_default().bold(), warning);
}

/// Prints a note.
pub fn note(fact: &str) {
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

/// Longest number in plain digits; f64 need 17 and leading zeros.
const DIGITS: usize = 24;

/// Numbers of more digits in exponent form: the digits of 1e300 fill lines.
fn short_numbers(text: &str) -> Cow<'_, str> {
    let of_number = |c: char| c.is_ascii_digit() || c == '.';
    let mut out = String::new();
    let mut rest = text;
    let mut before = ' ';
    while let Some(start) = rest.find(of_number) {
        let (head, tail) = rest.split_at(start);
        let end = tail.find(|c| !of_number(c)).unwrap_or(tail.len());
        let (word, after) = tail.split_at(end);
        let number = word.trim_end_matches('.');
        before = head.chars().next_back().unwrap_or(before);
        let of_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '/' | '\\');
        let alone = !of_word(before) && !after.starts_with(of_word);
        out.push_str(head);
        match number.parse::<f64>() {
            Ok(value) if number.len() > DIGITS && alone => {
                out.push_str(&format!("{value:e}{}", &word[number.len()..]));
            }
            _ => out.push_str(word),
        }
        before = '0';
        rest = after;
    }
    if out.is_empty() { Cow::Borrowed(text) } else { Cow::Owned(out + rest) }
}

/// Escapes control characters and shortens.
pub fn shown(text: &str, longest: usize) -> String {
    let text = short_numbers(text);
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
        let long = format!("found -{:.0}, {:.0}.", 1e300, 2e30);
        assert_eq!(shown(&long, 40), "found -1e300, 2e30.");
        assert_eq!(shown(&format!("found {}", 1e-300), 40), "found 1e-300");
        for text in
            ["packing_0000000000000000000000000000000001.csv", "0.00012345678901234567", "3f1e", "…1.5…"]
        {
            assert_eq!(shown(text, 60), text);
        }
    }
}
