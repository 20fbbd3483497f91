//! `sources.bib`: literature sources of a run as BibTeX entries.

use std::path::Path;
use trackbed_io::failure::Failure;
use trackbed_io::write::{WriteError, atomic};

/// File name.
const FILE: &str = "sources.bib";
/// Title and author of the program, as in CITATION.cff.
const TITLE: &str = "trackbed: coupled DEM–FEM solver for ballasted railway track";
const AUTHOR: &str = "The trackbed developers";
/// Lower-case words of family names.
const PARTICLES: [&str; 8] = ["da", "de", "del", "der", "di", "la", "van", "von"];
/// Most words of a name; longer ones are titles.
const NAME_WORDS: usize = 3;

/// Reference.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Reference {
    authors: Vec<String>,
    published: String,
    year: Option<String>,
    topics: Vec<String>,
}

/// Writes `sources.bib` in `dir`.
///
/// # Errors
/// I/O errors.
pub fn write(dir: &Path, sources: &[&str]) -> Result<(), Failure> {
    let file = dir.join(FILE);
    let text = bibliography(sources);
    atomic::write(&file, |out| out.write_all(text.as_bytes()).map_err(WriteError::io(&file)))?;
    Ok(())
}

/// Entries of the program and of each distinct reference.
fn bibliography(sources: &[&str]) -> String {
    let program = [
        ("author", format!("{{{AUTHOR}}}")),
        ("title", escaped(TITLE)),
        ("version", env!("CARGO_PKG_VERSION").to_string()),
    ];
    let mut text = entry("software", "trackbed", &program);
    let all = distinct(sources);
    for (reference, key) in all.iter().zip(keys(&all)) {
        let authors: Vec<String> = reference.authors.iter().map(|name| escaped(name)).collect();
        let fields = [
            ("author", authors.join(" and ")),
            ("howpublished", escaped(&reference.published)),
            ("year", reference.year.clone().unwrap_or_default()),
            ("note", escaped(&reference.topics.join("; "))),
        ];
        text += &format!("\n{}", entry("misc", &key, &fields));
    }
    text
}

/// Entry without its empty fields.
fn entry(kind: &str, key: &str, fields: &[(&str, String)]) -> String {
    let fields = fields.iter().filter(|(_, value)| !value.is_empty());
    let lines: String = fields.map(|(name, value)| format!("  {name} = {{{value}}},\n")).collect();
    format!("@{kind}{{{key},\n{lines}}}\n")
}

fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        if "&%_#$".contains(c) {
            out.push('\\');
        }
        out.push(c);
    }
    out
}

/// References in order of appearance; equal ones are merged.
fn distinct(sources: &[&str]) -> Vec<Reference> {
    let mut all: Vec<Reference> = Vec::new();
    for new in sources.iter().flat_map(|source| references(source)) {
        let equal = |old: &&mut Reference| {
            (&old.authors, &old.published, &old.year) == (&new.authors, &new.published, &new.year)
        };
        match all.iter_mut().find(equal) {
            None => all.push(new),
            Some(old) => {
                for topic in new.topics {
                    if !old.topics.contains(&topic) {
                        old.topics.push(topic);
                    }
                }
            }
        }
    }
    all
}

/// References of a source, `topic: reference; topic: reference; reference`.
fn references(source: &str) -> Vec<Reference> {
    let mut topic = "";
    let mut all = Vec::new();
    for part in source.split("; ") {
        let text = match part.split_once(": ") {
            Some((own, text)) => {
                topic = own;
                text
            }
            None => part,
        };
        let found = of_part(text).into_iter();
        all.extend(found.map(|reference| Reference { topics: vec![topic.to_string()], ..reference }));
    }
    all
}

/// References in brackets, `method (Name & Name 1983)`, else those after a description.
fn of_part(text: &str) -> Vec<Reference> {
    let brackets = text.split('(').skip(1).filter_map(|rest| rest.split_once(')'));
    let inner = brackets.filter_map(|(inner, _)| reference(&inner.split(", ").collect::<Vec<_>>()));
    let bracketed: Vec<Reference> = inner.filter(|found| found.year.is_some()).collect();
    if !bracketed.is_empty() {
        return bracketed;
    }
    let pieces: Vec<&str> = text.split(", ").collect();
    // `…, 2016, and Name & Name, …`: another reference.
    let starts = |piece: &&str| piece.strip_prefix("and ").is_some_and(|rest| names(rest).is_some());
    let mut all = Vec::new();
    let mut rest = &pieces[..];
    while !rest.is_empty() {
        let end = rest.iter().skip(1).position(starts).map_or(rest.len(), |next| next + 1);
        all.extend(reference(&rest[..end]));
        rest = &rest[end..];
    }
    all
}

/// Reference in pieces between commas: description, authors, publication, year.
fn reference(pieces: &[&str]) -> Option<Reference> {
    let Some(start) = pieces.iter().position(|piece| names(piece).is_some()) else {
        let title = pieces.iter().rev().find(|piece| is_title(piece))?;
        return Some(Reference { published: title.to_string(), ..Reference::default() });
    };
    let mut authors = names(pieces[start])?;
    let mut end = start + 1;
    if authors.len() == 1 && split_year(pieces[start]).1.is_none() {
        // `Name, Name & Name`; a single author is followed by the publication.
        let others = pieces[end..].iter().map_while(|piece| names(piece));
        let list: Vec<Vec<&str>> = others.collect();
        if let Some(last) = list.iter().position(|names| names.len() > 1) {
            authors.extend(list[..=last].iter().flatten());
            end += last + 1;
        }
    }
    let words = pieces[start..].iter().flat_map(|piece| piece.split(|c: char| !c.is_ascii_digit()));
    let year = words.filter(|word| is_year(word)).reduce(|_, later| later);
    let text = pieces[end..].join(", ");
    let published = year.and_then(|year| text.strip_suffix(year)).unwrap_or(&text);
    Some(Reference {
        authors: authors.into_iter().map(String::from).collect(),
        published: published.trim_end_matches([',', ' ']).to_string(),
        year: year.map(String::from),
        topics: Vec::new(),
    })
}

/// Names of `Name & Name`, `Name and others`, `after Name`, `method of Name`, with or without a year.
fn names(piece: &str) -> Option<Vec<&str>> {
    let (mut text, _) = split_year(piece);
    for word in ["and ", "after "] {
        text = text.strip_prefix(word).unwrap_or(text);
    }
    let method = text.rsplit_once(" of ").filter(|(before, _)| before.starts_with(char::is_lowercase));
    let text = method.map_or(text, |(_, name)| name);
    let all: Vec<&str> = text.split(" & ").flat_map(|part| part.split(" and ")).collect();
    let (first, others) = all.split_first()?;
    let known = is_name(first) && others.iter().all(|name| *name == "others" || is_name(name));
    known.then_some(all)
}

fn is_name(text: &str) -> bool {
    let words: Vec<&str> = text.split(' ').collect();
    let letters = text.chars().all(|c| c.is_alphabetic() || matches!(c, ' ' | '-' | '\'' | '’'));
    let capital = |word: &&str| word.starts_with(char::is_uppercase);
    let Some((last, before)) = words.split_last() else { return false };
    letters
        && words.len() <= NAME_WORDS
        && capital(last)
        && before.iter().all(|word| capital(word) || PARTICLES.contains(word))
}

fn is_title(text: &str) -> bool {
    text.contains(' ') && text.split(' ').all(|word| word.starts_with(char::is_uppercase))
}

fn is_year(word: &str) -> bool {
    word.len() == 4 && word.parse().is_ok_and(|year: u32| (1600..2100).contains(&year))
}

/// Text before a year at the end, and the year.
fn split_year(text: &str) -> (&str, Option<&str>) {
    let (before, last) = text.rsplit_once(' ').unwrap_or(("", text));
    if is_year(last) { (before, Some(last)) } else { (text, None) }
}

/// Citation keys, such as `harkness2016`; equal ones are followed by a, b, ….
fn keys(all: &[Reference]) -> Vec<String> {
    let plain: Vec<String> = all.iter().map(key).collect();
    let unique = |(k, key): (usize, &String)| {
        let count = |keys: &[String]| keys.iter().filter(|other| *other == key).count();
        if count(&plain) == 1 { key.clone() } else { format!("{key}{}", letter(count(&plain[..k]))) }
    };
    plain.iter().enumerate().map(unique).collect()
}

fn letter(number: usize) -> String {
    u8::try_from(number)
        .ok()
        .filter(|n| *n < 26)
        .map_or_else(|| format!("-{number}"), |n| char::from(b'a' + n).to_string())
}

/// First name, or first word of the title, with the year.
fn key(reference: &Reference) -> String {
    let title = || reference.published.split(' ').next().unwrap_or_default();
    let name = reference.authors.first().map_or_else(title, String::as_str);
    let letters: String = name.chars().map(ascii).filter(char::is_ascii_alphanumeric).collect();
    letters + reference.year.as_deref().unwrap_or_default()
}

/// Lower-case letter without accent.
fn ascii(c: char) -> char {
    let lower = c.to_lowercase().next().unwrap_or(c);
    match lower {
        'à'..='å' | 'ā' | 'ă' | 'ą' => 'a',
        'ç' | 'ć' | 'č' => 'c',
        'è'..='ë' | 'ē' | 'ę' | 'ě' => 'e',
        'ì'..='ï' | 'ī' | 'ı' => 'i',
        'ł' => 'l',
        'ñ' | 'ń' | 'ň' => 'n',
        'ò'..='ö' | 'ø' | 'ō' | 'ő' => 'o',
        'ř' => 'r',
        'ś' | 'ş' | 'š' | 'ß' => 's',
        'ù'..='ü' | 'ū' | 'ů' | 'ű' => 'u',
        'ý' | 'ÿ' => 'y',
        'ź' | 'ż' | 'ž' => 'z',
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `authors | publication | year | topic`, per reference.
    fn read(source: &str) -> Vec<String> {
        let line = |r: &Reference| {
            let year = r.year.as_deref().unwrap_or("-");
            format!("{} | {} | {year} | {}", r.authors.join(", "), r.published, r.topics.join("; "))
        };
        references(source).iter().map(line).collect()
    }

    #[test]
    fn reads_journals_and_books() {
        let cases: [(&str, &[&str]); 8] = [
            (
                "contact: conical damage of elastic spheres, Harkness and others, Granular Matter 18:65, 2016; Suhr & Six, \
                 Granular Matter 19:64, 2017",
                &[
                    "Harkness, others | Granular Matter 18:65 | 2016 | contact",
                    "Suhr, Six | Granular Matter 19:64 | 2017 | contact",
                ],
            ),
            (
                "contact: elastic spheres, Hertz 1882; Johnson, Contact Mechanics, 1985; dashpot of Tsuji, \
                 Tanaka & Ishida, Powder Technology 71, 1992",
                &[
                    "Hertz |  | 1882 | contact",
                    "Johnson | Contact Mechanics | 1985 | contact",
                    "Tsuji, Tanaka, Ishida | Powder Technology 71 | 1992 | contact",
                ],
            ),
            (
                "contact, tangential: pressure-dependent friction, after Suhr & Six, Powder Technol. 294, 2016, \
                 and Barton & Kjaernsli, J. Geotech. Eng. Div. ASCE 107, 1981",
                &[
                    "Suhr, Six | Powder Technol. 294 | 2016 | contact, tangential",
                    "Barton, Kjaernsli | J. Geotech. Eng. Div. ASCE 107 | 1981 | contact, tangential",
                ],
            ),
            (
                "contact: linear loading, stiffer unloading, Walton & Braun, J. Rheol. 30, 949, 1986",
                &["Walton, Braun | J. Rheol. 30, 949 | 1986 | contact"],
            ),
            (
                "contact: linear spring-dashpot with Coulomb friction, Cundall & Strack, Geotechnique 29(1), 1979",
                &["Cundall, Strack | Geotechnique 29(1) | 1979 | contact"],
            ),
            (
                "integration: leapfrog (velocity Verlet), Verlet, Phys. Rev. 159, 1967",
                &["Verlet | Phys. Rev. 159 | 1967 | integration"],
            ),
            (
                "rail: Euler-Bernoulli beam of cubic elements, Przemieniecki, Theory of Matrix Structural Analysis, 1968",
                &["Przemieniecki | Theory of Matrix Structural Analysis | 1968 | rail"],
            ),
            ("contact: formulas of the scene", &[]),
        ];
        for (source, expected) in cases {
            assert_eq!(read(source), expected, "{source}");
        }
    }

    #[test]
    fn reads_years_behind_names() {
        let cases: [(&str, &[&str]); 8] = [
            (
                "elements: serendipity and linear kinds with mean dilatation, Zienkiewicz & Taylor, The Finite Element Method; Hughes \
                 1980",
                &[
                    "Zienkiewicz, Taylor | The Finite Element Method | - | elements",
                    "Hughes |  | 1980 | elements",
                ],
            ),
            (
                "plasticity: return maps in principal stresses, de Souza Neto, Peric & Owen 2008; Clausen, \
                 Damkilde & Andersen 2006",
                &[
                    "de Souza Neto, Peric, Owen |  | 2008 | plasticity",
                    "Clausen, Damkilde, Andersen |  | 2006 | plasticity",
                ],
            ),
            (
                "modified Cam clay: Roscoe & Burland 1968; implicit integration: Borja & Lee, Comput. Methods Appl. Mech. Eng. 78, 1990",
                &[
                    "Roscoe, Burland |  | 1968 | modified Cam clay",
                    "Borja, Lee | Comput. Methods Appl. Mech. Eng. 78 | 1990 | implicit integration",
                ],
            ),
            (
                "sparse factorization: multifrontal (Duff & Reid 1983) over dense kernels of the crate faer, nested dissection by \
                 coordinates (George 1973)",
                &["Duff, Reid |  | 1983 | sparse factorization", "George |  | 1973 | sparse factorization"],
            ),
            (
                "sparse factorization: the library MUMPS, Amestoy, Duff, L'Excellent & Koster, SIAM J. Matrix Anal. Appl. 23, 2001; \
                 nested dissection by coordinates (George 1973)",
                &[
                    "Amestoy, Duff, L'Excellent, Koster | SIAM J. Matrix Anal. Appl. 23 | 2001 | sparse factorization",
                    "George |  | 1973 | sparse factorization",
                ],
            ),
            (
                "static equations: conjugate gradients with smoothed aggregation, Vaněk, Mandel & Brezina 1996",
                &["Vaněk, Mandel, Brezina |  | 1996 | static equations"],
            ),
            (
                "linear elasticity: Timoshenko & Goodier, Theory of Elasticity 1970",
                &["Timoshenko, Goodier | Theory of Elasticity | 1970 | linear elasticity"],
            ),
            (
                "user material: interface UMAT, Abaqus User Subroutines Reference Guide",
                &[" | Abaqus User Subroutines Reference Guide | - | user material"],
            ),
        ];
        for (source, expected) in cases {
            assert_eq!(read(source), expected, "{source}");
        }
    }

    #[test]
    fn equal_references_are_one_entry() {
        let sources = [
            "time integration: Newmark, J. Eng. Mech. Div. ASCE 85(3), 1959",
            "rail in time: average acceleration, Newmark, J. Eng. Mech. Div. ASCE 85(3), 1959",
            "time integration: Newmark, J. Eng. Mech. Div. ASCE 85(3), 1959",
        ];
        let expected = "\n@misc{newmark1959,\n  author = {Newmark},\n  howpublished = {J. Eng. Mech. Div. ASCE 85(3)},\n  \
                        year = {1959},\n  note = {time integration; rail in time},\n}\n";
        let text = bibliography(&sources);
        assert!(text.ends_with(expected), "{text}");
        assert_eq!(text.matches('@').count(), 2);
    }

    #[test]
    fn keys_are_unique_and_ascii() {
        let sources = [
            "a: Suhr & Six, Powder Technol. 294, 2016",
            "b_1: Suhr & Six, Granular Matter & Dust 19 #64, 2016; Zienkiewicz & Taylor, The Finite Element Method",
            "c: Vaněk, Mandel & Brezina 1996; Lu and others, Landslides 16, 2019",
            "d: interface UMAT, Abaqus User Subroutines Reference Guide; de Souza Neto, Peric & Owen 2008",
        ];
        let text = bibliography(&sources);
        for part in [
            "@misc{suhr2016a,\n",
            "@misc{suhr2016b,\n  author = {Suhr and Six},\n  howpublished = {Granular Matter \\& Dust 19 \\#64},\n  \
             year = {2016},\n  note = {b\\_1},\n}\n",
            "@misc{zienkiewicz,\n  author = {Zienkiewicz and Taylor},\n  howpublished = {The Finite Element Method},\n  note = {",
            "@misc{vanek1996,\n  author = {Vaněk and Mandel and Brezina},\n  year = {1996},\n",
            "@misc{lu2019,\n  author = {Lu and others},\n",
            "@misc{abaqus,\n  howpublished = {Abaqus User Subroutines Reference Guide},\n",
            "@misc{desouzaneto2008,\n  author = {de Souza Neto and Peric and Owen},\n",
        ] {
            assert!(text.contains(part), "{part} is missing in {text}");
        }
    }

    #[test]
    fn program_is_cited_as_in_citation_file() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../CITATION.cff");
        let citation = std::fs::read_to_string(file).unwrap();
        assert!(
            citation.contains(&format!("title: \"{TITLE}\"\n")) && citation.contains(AUTHOR),
            "{citation}"
        );
        let text = bibliography(&[]);
        let version = env!("CARGO_PKG_VERSION");
        assert_eq!(
            text,
            format!(
                "@software{{trackbed,\n  author = {{{{{AUTHOR}}}}},\n  title = {{{TITLE}}},\n  version = {{{version}}},\n}}\n"
            )
        );
    }

    #[test]
    fn file_is_written() {
        let dir = trackbed_io::scratch::folder("bibtex");
        write(&dir, &["strength reduction: Griffiths & Lane, Geotechnique 49(3), 1999"]).unwrap();
        let text = std::fs::read_to_string(dir.join(FILE)).unwrap();
        assert!(text.contains("@misc{griffiths1999,\n  author = {Griffiths and Lane},\n"), "{text}");
        std::fs::remove_dir_all(&dir).unwrap();
    }
}
