//! Tables of tests.

use crate::base::Vec3;

pub fn rows(text: &str) -> Vec<(String, Vec<f64>)> {
    let lines = text.lines().filter(|l| !l.starts_with('#')).skip(1);
    let row = |line: &str| {
        let mut words = line.split(',');
        let name = words.next().unwrap().to_string();
        (name, words.map(|w| w.parse().unwrap_or(f64::NAN)).collect())
    };
    lines.map(row).collect()
}

pub fn corners(table: &[(String, Vec<f64>)], name: &str) -> Vec<Vec3> {
    table.iter().filter(|r| r.0 == name).map(|r| Vec3::new(r.1[0], r.1[1], r.1[2])).collect()
}
