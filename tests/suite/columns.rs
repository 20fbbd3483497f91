//! Result columns: files match `src/io/columns.rs` and its documentation.

use super::support::{Folder, Table, repository, run, trackbed};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use trackbed::columns::{Definition, Kind, TABLES, Table as Defined, cycles, history};

fn is_defined(table: &Defined, head: &str) -> bool {
    let (name, unit) = head.strip_suffix(']').and_then(|h| h.split_once(" [")).unwrap_or((head, ""));
    table.columns.iter().filter(|column| column.unit == unit).any(|column| match column.kind {
        Kind::Scalar => column.of("").item_in(name).is_some(),
        Kind::Vector => (0..3).any(|axis| column.at(axis).item_in(name).is_some()),
        Kind::Tensor => (0..6).any(|part| column.at(part).item_in(name).is_some()),
        Kind::List => column.of("").item_in(name.trim_end_matches(|c: char| c.is_ascii_digit())).is_some(),
    })
}

/// Rejects undefined columns of a table.
pub fn expect_defined(file: &Path, header: &str) {
    let Some(table) = TABLES.iter().find(|table| file.ends_with(table.file)) else { return };
    for head in header.split(',') {
        assert!(is_defined(table, head), "{}: {head} is not defined in src/io/columns.rs", file.display());
    }
}

#[test]
fn columns_of_runs_are_defined() {
    let folder = Folder::new("columns");
    for (scene, set) in [
        ("verify/bounce", "output.frames=1"),
        ("verify/bonded_beam", "time.end=0.002"),
        ("solid/embankment", "output.tables=true"),
    ] {
        let out = folder.join(scene);
        run(&repository().join(format!("inputs/{scene}.toml")), &out, &[set]).good();
        let files = TABLES.iter().map(|table| out.join(table.file)).filter(|file| file.exists());
        let tables: Vec<Table> = files.map(|file| Table::read(&file)).collect();
        assert!(!tables.is_empty(), "{scene}");
    }
    let undefined = ["time [ms]", "work_x [J]", "loads [N]", "load_a [N]", "pile_sector [m]"];
    assert!(undefined.iter().all(|head| !is_defined(history::TABLE, head)));
}

#[test]
fn names_of_columns_are_read_back() {
    let names = [
        (history::LOAD.of("_2"), "load_2", "_2"),
        (history::SLEEPER.of("").at(2), "sleeper_z", ""),
        (history::WALL_FORCE.of("plate").at(0), "plate_force_x", "plate"),
        (history::PROBE_STRESS.of("crest").at(5), "crest_stress_zx", "crest"),
        (cycles::STRESS_PEAK.of("crest_stress_zz"), "crest_stress_zz_peak", "crest_stress_zz"),
        (history::STRUCTURE_SECTOR.of("pile").at(3), "pile_sector3", "pile"),
        (history::ENERGY_ERROR.into(), "energy_error", ""),
    ];
    for (name, text, item) in names {
        assert_eq!(name.to_string(), text);
        assert_eq!(name.item_in(text), Some(item));
    }
    assert_eq!(history::LOAD.of("").item_in("load_force_x"), None);
    assert_eq!(history::WALL_FORCE.at(0).item_in("plate_force_y"), None);
}

#[test]
fn meanings_are_short_and_listed() {
    let list = trackbed(["schema", "--columns"]).good().stdout;
    for table in TABLES {
        let names: BTreeSet<_> = table.columns.iter().map(|column| column.name).collect();
        assert_eq!(names.len(), table.columns.len(), "{}: a name twice", table.file);
        for Definition { name, meaning, .. } in table.columns {
            assert!((1..=12).contains(&meaning.split_whitespace().count()), "{name}: {meaning}");
            let listed =
                |line: &str| line.starts_with(table.file) && line.contains(name) && line.ends_with(meaning);
            assert!(list.lines().any(listed), "{name}:\n{list}");
        }
    }
}

fn quoted(page: &str) -> (BTreeSet<&str>, Vec<(&str, &str)>) {
    let spans = page.split('`').skip(1).step_by(2).flat_map(|span| span.split([',', ' ']));
    let sides: Vec<&str> = page.split("` … `").collect();
    let pairs = sides.windows(2).filter_map(|w| Some((w[0].rsplit('`').next()?, w[1].split('`').next()?)));
    (spans.filter(|text| !text.is_empty()).collect(), pairs.collect())
}

/// Short forms: `_bend` for `sleeper_bend`, `runout_…`, `sleeper_x…z`, `grains_kinetic` … `solid_gravity`.
#[test]
fn results_page_names_each_column() {
    let page = fs::read_to_string(repository().join("docs/guide/results.md")).unwrap();
    let (texts, ranges) = quoted(&page);
    let shortened = |text: &str, name: &str| match text.split_once('…') {
        Some((start, _)) if start.starts_with('_') => start.len() > 1 && name.contains(start),
        Some((start, _)) => !start.is_empty() && name.starts_with(start),
        None => text == name || text.starts_with('_') && name.ends_with(text),
    };
    let mut missing = Vec::new();
    // Documented with slopes and element tests.
    let elsewhere = ["outline.csv", "fragments.csv", "origins.csv", "passage.csv", "element tests"];
    for table in TABLES.iter().filter(|table| !elsewhere.contains(&table.file)) {
        let place = |name: &str| table.columns.iter().position(|column| column.name == name);
        for (k, column) in table.columns.iter().enumerate() {
            let ends: &[&str] = match column.kind {
                Kind::Scalar => &[""],
                Kind::Vector => &["_x", "_y", "_z"],
                Kind::Tensor => &["_xx", "_yy", "_zz", "_xy", "_yz", "_zx"],
                Kind::List => &["0"],
            };
            let name = column.name.replace("<_n>", "");
            let named = |end: &&str| texts.iter().any(|text| shortened(text, &format!("{name}{end}")));
            let between = |(from, to): &(&str, &str)| {
                place(from).zip(place(to)).is_some_and(|(a, b)| (a..=b).contains(&k))
            };
            if !ends.iter().any(named) && !ranges.iter().any(between) {
                missing.push(format!("{}: {name}", table.file));
            }
        }
    }
    assert!(missing.is_empty(), "not in docs/guide/results.md:\n{}", missing.join("\n"));
}
