//! Colour maps and palettes, as in the viewer.

use super::draw::Colour;

/// The first two maps suit colour-blind readers.
const MAPS: [(&str, &str); 4] = [
    ("viridis", "440154 482475 414487 355f8d 2a788e 21918c 22a884 44bf70 7ad151 bddf26 fde725"),
    ("cividis", "00224e 123570 3b496c 575d6d 707173 8a8678 a59c74 c3b369 e1cc55 fee838"),
    ("blue-red", "0000ff 0080ff 00ffff 00ff80 00ff00 80ff00 ffff00 ff8000 ff0000"),
    ("diverging", "3b4cc0 6788ee 9abbff c9d7f0 edd1c2 f7a889 e26952 b40426"),
];

/// Group colours that also differ in lightness (Okabe and Ito 2008, and lighter variants).
const GROUPS: &str = "e69f00 56b4e9 009e73 f0e442 0072b2 d55e00 cc79a7 999999 ffd37a a8dcf8 7fd6bd 7fb3dd";

const TABLE: usize = 256;

pub fn maps() -> impl Iterator<Item = &'static str> {
    MAPS.iter().map(|(name, _)| *name)
}

/// Parses `#rrggbb` or `rrggbb`.
pub fn parse(text: &str) -> Option<Colour> {
    let digits = text.strip_prefix('#').unwrap_or(text);
    if digits.len() != 6 || !digits.bytes().all(|b| b.is_ascii_hexdigit()) {
        return None;
    }
    let n = u32::from_str_radix(digits, 16).ok()?;
    Some([16, 8, 0].map(|k| ((n >> k) & 255) as f32 / 255.0))
}

pub fn table(name: &str) -> Option<Vec<Colour>> {
    let (_, stops) = MAPS.iter().find(|(n, _)| *n == name)?;
    let stops: Vec<Colour> = stops.split(' ').filter_map(parse).collect();
    let colour = |k: usize| {
        let at = k as f32 / (TABLE - 1) as f32 * (stops.len() - 1) as f32;
        let below = (at as usize).min(stops.len() - 2);
        [0, 1, 2].map(|c| stops[below][c] + (stops[below + 1][c] - stops[below][c]) * (at - below as f32))
    };
    Some((0..TABLE).map(colour).collect())
}

pub fn group(number: usize) -> Colour {
    let known = GROUPS.split(' ').count();
    GROUPS.split(' ').nth(number % known).and_then(parse).unwrap_or_default()
}

/// Colour of a piece by rank.
pub fn piece(place: usize) -> Colour {
    let share = |k: usize, n: usize| ((place * k) % n) as f32 / n as f32;
    match place {
        0 => [0.86, 0.1, 0.1],
        _ => [0.05 + 0.25 * share(5, 7), 0.5 + 0.38 * share(3, 8), 0.12 + 0.2 * share(2, 5)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_include_end_colours() {
        let table = table("viridis").unwrap();
        assert_eq!((table[0], table[255]), (parse("440154").unwrap(), parse("#fde725").unwrap()));
        assert_eq!(table.len(), 256);
        assert!(super::table("jet").is_none() && parse("#12345").is_none() && parse("zzzzzz").is_none());
    }
}
