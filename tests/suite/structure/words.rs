//! Words replaced by the glossary.

use std::collections::{BTreeMap, BTreeSet};

/// Scope of a ban.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ban {
    /// Names in code.
    Names,
    /// Also comments, messages and pages.
    Anywhere,
}

/// Parses the table `| word | standard term | names, or anywhere |`.
pub fn replaced(page: &str) -> BTreeMap<String, Ban> {
    let table = page.split("## Replaced words").nth(1).expect("the page has a heading for replaced words");
    let rows = table.lines().skip_while(|l| !l.starts_with("|--")).skip(1).take_while(|l| l.starts_with('|'));
    let mut all = BTreeMap::new();
    for row in rows {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let ban = match cells[2] {
            "names" => Ban::Names,
            "anywhere" => Ban::Anywhere,
            other => panic!("{other:?}: expected names or anywhere in {row}"),
        };
        all.extend(cells[0].split(", ").map(|word| (word.to_string(), ban)));
    }
    assert!(!all.is_empty(), "the table of replaced words is empty");
    all
}

/// Splits `LoadCycle`, `load_cycle` or `LOAD_CYCLE` into words.
pub fn words_of(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut before_lower = false;
    for c in name.chars() {
        if !c.is_alphanumeric() || (c.is_uppercase() && before_lower) {
            words.push(String::new());
        }
        if c.is_alphanumeric() {
            words.last_mut().expect("it has a first").extend(c.to_lowercase());
        }
        before_lower = c.is_lowercase();
    }
    words.retain(|w| !w.is_empty());
    words
}

fn names(stream: proc_macro2::TokenStream, all: &mut Vec<(usize, String)>) {
    for token in stream {
        match token {
            proc_macro2::TokenTree::Ident(name) => all.push((name.span().start().line, name.to_string())),
            proc_macro2::TokenTree::Group(group) => names(group.stream(), all),
            _ => {}
        }
    }
}

/// Locations of replaced words.
pub fn uses(file: &str, text: &str, replaced: &BTreeMap<String, Ban>) -> BTreeMap<String, Vec<String>> {
    let mut found: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut add = |line: usize, word: String, from: &str| {
        if replaced.contains_key(&word) {
            found.entry(word).or_default().push(format!("{file}:{line} {from}"));
        }
    };
    let mut code = Vec::new();
    if file.ends_with(".rs") {
        names(text.parse().unwrap_or_else(|e| panic!("{file}: {e}")), &mut code);
    }
    for (line, name) in &code {
        words_of(name).into_iter().for_each(|w| add(*line, w, name));
    }
    let counted: BTreeSet<(usize, &str)> = code.iter().map(|(line, name)| (*line, name.as_str())).collect();
    for (number, line) in text.lines().enumerate() {
        for piece in line.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|p| !p.is_empty()) {
            let counted = counted.contains(&(number + 1, piece));
            for word in
                words_of(piece).into_iter().filter(|w| !counted && replaced.get(w) == Some(&Ban::Anywhere))
            {
                add(number + 1, word, line.trim());
            }
        }
    }
    found
}

/// Parses the table `| phrase | standard term | pages, or anywhere |`: each phrase with true if it is banned anywhere.
pub fn replaced_phrases(page: &str) -> Vec<(String, bool)> {
    let table =
        page.split("## Replaced phrases").nth(1).expect("the page has a heading for replaced phrases");
    let rows = table.lines().skip_while(|l| !l.starts_with("|--")).skip(1).take_while(|l| l.starts_with('|'));
    let mut all = Vec::new();
    for row in rows {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let anywhere = match cells[2] {
            "pages" => false,
            "anywhere" => true,
            other => panic!("{other:?}: expected pages or anywhere in {row}"),
        };
        all.extend(cells[0].split(", ").map(|phrase| (phrase.to_string(), anywhere)));
    }
    assert!(!all.is_empty(), "the table of replaced phrases is empty");
    all
}

/// Places of replaced phrases in a file.
pub fn phrases_in(file: &str, text: &str, phrases: &[(String, bool)]) -> Vec<String> {
    let mut words: Vec<(usize, String)> = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let line = line.trim_start().trim_start_matches(['/', '!', '#', '|', '>', '*']);
        for piece in line.split_inclusive([' ', '.', ',', ';', ':', '(', ')', '"', '`', '|']) {
            let word = piece.trim_end_matches([' ', '.', ',', ';', ':', '(', ')', '"', '`', '|']);
            if !word.is_empty() {
                words.push((number + 1, word.to_lowercase()));
            }
            if piece.trim_end_matches(' ').len() > word.len() {
                words.push((number + 1, String::new()));
            }
        }
    }
    let is_page = file.ends_with(".md");
    let mut found = Vec::new();
    for (phrase, _) in phrases.iter().filter(|(_, anywhere)| *anywhere || is_page) {
        let parts: Vec<&str> = phrase.split(' ').collect();
        let places = words.windows(parts.len()).filter(|w| w.iter().map(|(_, word)| word).eq(parts.iter()));
        found.extend(places.map(|w| format!("{file}:{}: {phrase}", w[0].0)));
    }
    found
}
