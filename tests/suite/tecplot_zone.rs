//! Reader of a Tecplot zone, written for tests from the keywords of the Data Format Guide.

use std::collections::HashMap;

/// FEBRICK zone in blocks.
pub struct Zone {
    /// Lines before the numbers, without comments.
    pub header: Vec<String>,
    /// Nodal values by name.
    pub points: HashMap<String, Vec<f64>>,
    /// Values of bricks by name.
    pub cells: HashMap<String, Vec<f64>>,
    /// Points of each brick, from 0.
    pub bricks: Vec<[usize; 8]>,
}

/// Reads the only zone of a file.
pub fn read(text: &str) -> Zone {
    let lines: Vec<&str> = text.lines().filter(|l| !l.starts_with('#')).collect();
    let start = lines.iter().position(|l| l.starts_with(|c: char| c.is_ascii_digit() || c == '-')).unwrap();
    let header: Vec<String> = lines[..start].iter().map(|l| l.to_string()).collect();
    let names = header.iter().find_map(|l| l.strip_prefix("VARIABLES = ")).unwrap();
    let names = names.split('"').filter(|n| !n.trim().is_empty());
    let names: Vec<String> = names.map(String::from).collect();
    let keys = header[2..].join(" ");
    let number = |key: &str| -> usize {
        let after = &keys[keys.find(&format!(" {key}=")).unwrap() + key.len() + 2..];
        after.split([',', ' ']).next().unwrap().parse().unwrap()
    };
    let (points, bricks) = (number("N"), number("E"));
    assert!(keys.contains("DATAPACKING=BLOCK") && keys.contains("ZONETYPE=FEBRICK"));
    let range = keys.split("VARLOCATION=([").nth(1).unwrap().split(']').next().unwrap();
    let (first, last) = range.split_once('-').unwrap();
    let centred = first.parse::<usize>().unwrap()..=last.parse::<usize>().unwrap();
    let mut numbers = lines[start..].iter().flat_map(|l| l.split(' ')).map(|v| v.parse::<f64>().unwrap());
    let mut zone = Zone { header, points: HashMap::new(), cells: HashMap::new(), bricks: Vec::new() };
    for (k, name) in names.iter().enumerate() {
        let (of, count) = match centred.contains(&(k + 1)) {
            true => (&mut zone.cells, bricks),
            false => (&mut zone.points, points),
        };
        of.insert(name.clone(), numbers.by_ref().take(count).collect());
    }
    zone.bricks =
        (0..bricks).map(|_| std::array::from_fn(|_| numbers.next().unwrap() as usize - 1)).collect();
    assert_eq!(numbers.next(), None);
    zone
}
