use super::*;

fn read(text: &str, content: Content) -> Result<Vec<(usize, Vec<String>)>, String> {
    let table = Table::parse(Path::new("F.DAT"), content, text.to_string()).map_err(|e| e.to_string())?;
    Ok(table.rows.iter().map(|r| (r.line, table.fields(r).map(String::from).collect())).collect())
}

fn rows(text: &str) -> Result<Vec<(usize, Vec<String>)>, String> {
    read(text, Content::Nodes)
}

fn row(line: usize, fields: &[&str]) -> (usize, Vec<String>) {
    (line, fields.iter().map(|f| f.to_string()).collect())
}

#[test]
fn reads_all_separators_and_comments() {
    let text = "\u{feff}! c\r\n# c\r\n/PREP7\r\n*** c\r\n\r\n 1, 2.0 ,3\t4 \r\n5 6 ! rest\n7,8,\n\n9";
    let expected =
        vec![row(6, &["1", "2.0", "3", "4"]), row(7, &["5", "6"]), row(8, &["7", "8"]), row(10, &["9"])];
    assert_eq!(rows(text).unwrap(), expected);
}

#[test]
fn skips_repeated_headers() {
    let text = "LIST 3 NODES\nNODE X\n1 2\nNODE X\nLIST 3 NODES\n---\n3 4\n";
    assert_eq!(rows(text).unwrap(), vec![row(3, &["1", "2"]), row(7, &["3", "4"])]);
}

#[test]
fn a_damaged_row_is_no_header() {
    let error = rows("1 2\nO3 4\n").unwrap_err();
    assert!(error.starts_with("F.DAT:2: node list: found \"O3 4\", expected a row of numbers"), "{error}");
    // Neither above the first row, nor without a number.
    for text in ["O3 4\n1 2\n", "base ALL\n1 2\n", "1 2\nbase ALL\n"] {
        assert!(rows(text).unwrap_err().contains("expected a row of numbers, id x y z, a column heading"));
    }
}

#[test]
fn rejects_empty_field_between_commas() {
    let error = rows("1,2\n3,,4\n").unwrap_err();
    assert_eq!(error, "F.DAT:2: column 2: found nothing between two commas, expected a number");
}

/// Overflow marks in any list and column count; comments with stars stay comments.
#[test]
fn rejects_overflowed_numbers() {
    let stars = [
        "1 1 0.\n***** 1  0.00000E+00\n",
        "***** UX 0.0\n",
        "***** ALL\n",
        "** 3 1\n",
        "*****10001 4\n",
        "*****, 1, 0.5\n",
        "***** ***** *****\n",
        "1 2\n*****\n3 4\n",
        "##### 1 0.0\n",
        "5 1 #####\n",
    ];
    for text in stars {
        let error = read(text, Content::Constraints).unwrap_err();
        assert!(error.contains("expected a number: its field was too narrow"), "{text}: {error}");
    }
    let comments = "**********\n*** nodes 1 to 5 ***\n* 7 8\n** of the base\n### 3 of them\n1 2 # rest\n";
    assert_eq!(read(comments, Content::Constraints).unwrap(), [row(6, &["1", "2"])]);
}

#[test]
fn commands_are_no_headers() {
    for text in
        ["D,      1,UX  ,  0.0    ,  0.0\n", "D,ALL,ALL\n", "d,base,uz,0.5\n", "NSEL,S,LOC,Z,0\n1 1\n"]
    {
        let error = read(text, Content::Constraints).unwrap_err();
        assert!(error.contains("row: found the command \"") && error.contains("a .cdb file"), "{error}");
    }
    assert!(rows("N,1,0.0,0.0,0.0\n").unwrap_err().contains("command"));
    assert!(read("EN,1,1,2,3,4\n", Content::Elements).unwrap_err().contains("command"));
}

#[test]
fn decimal_commas_and_semicolons_are_named() {
    let decimal = "expected a decimal point";
    let error = rows("  1   0,0000000000000000e0   0,5  -2,0\n").unwrap_err();
    assert_eq!(error, format!("F.DAT:1: row: found \"0,0000000000000000e0\", {decimal}"));
    for text in ["5 1 0,5\n", "5\t1\t-0,5e-3\n", "1 2.5 0,5 3\n"] {
        assert!(rows(text).unwrap_err().contains(decimal), "{text}");
    }
    assert!(rows("1;-7;0\n").unwrap_err().contains("blanks, tabs or commas"));
    for text in ["1,2,3,4\n", "1, 2,3, 4\n", "1,1,1, 3,11\n", "1,0.5 0.25\n"] {
        assert!(rows(text).is_ok(), "{text}");
    }
}

const BANNER: &str = "\n *** MAPDL - ENGINEERING ANALYSIS SYSTEM  RELEASE 2021 R1          21.1     ***\n Ansys Mechanical \
                      Enterprise\n 00000000  VERSION=LINUX x64     10:11:12  MAY 05, 2021 CP=      1.234\n\n 2 m bank, \
                      stage 2\n\n\n";

#[test]
fn reads_pages_of_listing() {
    let heading = "    NODE  LABEL     REAL           IMAG\n";
    let first = " LIST CONSTRAINTS FOR SELECTED NODES         1 TO       32 BY        1\n CURRENTLY SELECTED DOF SET= UX\n";
    let page = |row: &str| format!("{BANNER}{heading}{row}\n");
    let text =
        format!("{first}{}{}", page("1  UX   0.0   0.0"), page("2  UX   0.0   0.0").replace("1.234", "9.9"));
    let found = read(&text, Content::Constraints).unwrap();
    let ids: Vec<&str> = found.iter().map(|(_, fields)| fields[0].as_str()).collect();
    assert_eq!(ids, ["1", "2"]);
    // Without its heading a page would hide rows.
    let rows: String = (1..20).map(|n| format!("{n} UX 0.0\n")).collect();
    for text in [format!("{BANNER}{rows}"), format!("1 UX 0.\n{BANNER}")] {
        let error = read(&text, Content::Constraints).unwrap_err();
        assert!(error.contains("page of a listing: found no column heading"), "{error}");
    }
}
