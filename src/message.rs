//! What is said beside results, on standard error.
//!
//! Nobody may listen: the terminal is gone, the pipe closed, the disk full. That ends no run, so nothing here fails;
//! `println!` and `eprintln!`, which panic then, are refused by a lint in this crate.

use anstream::{AutoStream, ColorChoice};
use anstyle::{AnsiColor, Style};
use std::io::Write;

/// Longest message [characters].
const LONGEST: usize = 8000;

/// Says one line.
pub fn say(line: &str) {
    write(&format!("{}\n", shown(line, LONGEST)));
}

/// Says what is wrong.
pub fn error(sentence: &str) {
    headed("error:", AnsiColor::Red.on_default().bold(), sentence);
}

/// Prints a warning.
pub(crate) fn warn(warning: &str) {
    headed("warning:", AnsiColor::Yellow.on_default().bold(), warning);
}

/// Prints a note: nothing is wrong.
pub(crate) fn note(fact: &str) {
    headed("note:", AnsiColor::Cyan.on_default().bold(), fact);
}

/// Says a line whose head is coloured on a terminal that shows colours, unless `NO_COLOR` is set.
fn headed(head: &str, style: Style, line: &str) {
    let colours = AutoStream::choice(&std::io::stderr()) != ColorChoice::Never;
    let style = if colours { style } else { Style::new() };
    write(&format!("{style}{head}{style:#} {}\n", shown(line, LONGEST)));
}

fn write(text: &str) {
    // In one piece, so that lines of several processes do not mix; what cannot be said is dropped.
    let _ = std::io::stderr().write_all(text.as_bytes());
}

/// A text of others, such as a token of a file, as it can be shown in one line: control characters escaped, and of more than
/// `longest` characters the first ones with the number of all.
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
    fn what_others_wrote_is_shown_without_control_characters_and_in_short() {
        assert_eq!(shown("a b\nc", 10), "a b\\nc");
        assert_eq!(shown("a\u{1b}[31m\u{7}\0é", 40), "a\\u{1b}[31m\\u{7}\\u{0}é");
        assert_eq!(shown(&"x".repeat(200_000), 5), "xxxxx… (200000 characters)");
        assert_eq!(shown("ééé", 3), "ééé");
    }
}
