use super::*;
use crate::write::sample::folder;

fn columns() -> Vec<Column> {
    vec![Column::new("time", "s"), Column::new("settlement", "m"), Column::new("a, b", "")]
}

#[test]
fn rows_read_back_exactly() {
    let dir = folder("csv");
    let file = dir.join("history.csv");
    let mut history = History::create(&file, columns()).unwrap();
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "time [s],settlement [m],\"a, b\"\n");
    let values = [0.1 + 0.2, -1.0e-300, f64::MAX, 1.0 / 3.0, 5.0e-324, -0.0, 12345678.9, 1e15, 2.5e-7];
    for row in values.chunks(3) {
        history.row(row).unwrap();
    }
    let text = std::fs::read_to_string(&file).unwrap();
    let back: Vec<u64> = text
        .lines()
        .skip(1)
        .flat_map(|row| row.split(','))
        .map(|v| v.parse::<f64>().unwrap().to_bits())
        .collect();
    assert_eq!(back, values.map(f64::to_bits));
    assert!(text.lines().all(|row| row.len() < 90), "no number takes 300 digits: {text}");
    std::fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn rejects_row_with_nan() {
    let dir = folder("csv_nan");
    let file = dir.join("history.csv");
    let mut history = History::create(&file, columns()).unwrap();
    history.row(&[0.0, 1.0, 2.0]).unwrap();
    let error = history.row(&[0.5, f64::NAN, 2.0]).unwrap_err();
    assert_eq!(error.to_string(), format!("{}: settlement at index 1 is NaN: not written", file.display()));
    assert!(history.row(&[0.5, 1.0]).unwrap_err().to_string().contains("row 1 has 2 values, expected 3"));
    assert_eq!(std::fs::read_to_string(&file).unwrap().lines().count(), 2);
    std::fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn resumed_history_equals_uninterrupted() {
    let dir = folder("csv_resume");
    let file = dir.join("history.csv");
    let row = |i: u32| [0.1 * f64::from(i), f64::from(i), 0.25];
    let mut whole = History::create(&file, columns()).unwrap();
    let start = whole.mark().unwrap();
    (0..3).for_each(|i| whole.row(&row(i)).unwrap());
    let mark = whole.mark().unwrap();
    (3..6).for_each(|i| whole.row(&row(i)).unwrap());
    let expected = std::fs::read_to_string(&file).unwrap();
    // Later rows, the last truncated; nothing after the mark; nothing at all.
    for (left, mark, first) in [(expected.len() - 4, mark, 3), (mark.bytes as usize, mark, 3), (40, start, 0)]
    {
        std::fs::write(&file, &expected[..left]).unwrap();
        let mut second = History::resume(&file, columns(), mark).unwrap();
        (first..6).for_each(|i| second.row(&row(i)).unwrap());
        assert_eq!(std::fs::read_to_string(&file).unwrap(), expected);
        assert_eq!(second.mark().unwrap(), Mark { rows: 6, bytes: expected.len() as u64 });
    }

    let error = History::resume(&file, columns()[..2].to_vec(), mark).unwrap_err();
    assert!(error.to_string().contains("has other columns"), "{error}");
    for wrong in [&expected[..mark.bytes as usize - 1], &expected.replace("0.1,", "0.123,")] {
        std::fs::write(&file, wrong).unwrap();
        let error = History::resume(&file, columns(), mark).unwrap_err();
        assert!(error.to_string().contains("is not the history"), "{error}");
    }
    std::fs::remove_dir_all(&dir).unwrap();
}
