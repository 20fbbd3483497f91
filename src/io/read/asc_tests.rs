use super::*;

const HEAD: &str = "ncols 3\nNROWS 2\nxllcorner 100\nyllcorner 200\ncellsize 10\nNODATA_value -9999\n";

fn read(text: &str) -> Result<Surface, String> {
    parse(Path::new("a.asc"), text).map_err(|e| e.to_string())
}

#[test]
fn samples_lie_at_cell_centres() {
    let surface = read(&format!("{HEAD}1 2 3\n4 5 6\n")).unwrap();
    let vertices = [
        [105.0, 215.0, 1.0],
        [115.0, 215.0, 2.0],
        [125.0, 215.0, 3.0],
        [105.0, 205.0, 4.0],
        [115.0, 205.0, 5.0],
        [125.0, 205.0, 6.0],
    ];
    assert_eq!(surface.vertices, vertices);
    assert_eq!(surface.triangles.len(), 4);
    for t in &surface.triangles {
        let [a, b, c] = t.map(|v| surface.vertices[v as usize]);
        let up = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        assert_eq!(up, 100.0, "{t:?}");
    }
}

#[test]
fn other_heads_and_holes() {
    let centres = HEAD.replace("corner", "center");
    let surface = read(&format!("{centres}1 2\n3 4 5\n6")).unwrap();
    assert_eq!(surface.vertices[0], [100.0, 210.0, 1.0]);
    let unlike = HEAD.replace("cellsize 10", "dx 10\ndy 20");
    assert_eq!(read(&format!("{unlike}1 2 3 4 5 6")).unwrap().vertices[0], [105.0, 230.0, 1.0]);
    let hole = read(&format!("{HEAD}-9999 2 3\n4 5 6")).unwrap();
    assert_eq!((hole.vertices.len(), hole.triangles.len()), (5, 3));
    let none = read(&format!("{HEAD}nan 2 NaN\n4 nan 6")).unwrap_err();
    let expected = "a.asc: heights: found 3 samples, none of which has neighbours on two sides, expected heights that make a surface";
    assert_eq!(none, expected);
}

#[test]
fn every_fault_has_its_sentence() {
    let cases = [
        (String::new(), "a.asc: ncols: found nothing, expected a line with its value"),
        (HEAD.to_string(), "a.asc: heights: found 0, expected 3 times 2, as in ncols and nrows"),
        (
            format!("{HEAD}1 2 3 4 5 6 7"),
            "a.asc:7: height: found \"7\", expected the end after 3 times 2 heights",
        ),
        (format!("{HEAD}1 2 3 4 5x 6"), "a.asc:7: height: found \"5x\", expected a number"),
        (format!("{HEAD}1 2 3 4 1e999 6"), "a.asc:7: height: found \"1e999\", expected a finite number"),
        (
            HEAD.replace("ncols 3", "ncols 3.5"),
            "a.asc:1: ncols: found 3.5, expected a whole number from 2 to 100000000",
        ),
        (
            HEAD.replace("ncols 3", "ncols 1e99"),
            "a.asc:1: ncols: found 1e99, expected a whole number from 2 to 100000000",
        ),
        (
            HEAD.replace("ncols 3", "ncols 90000000").replace("NROWS 2", "NROWS 90000000"),
            "a.asc: ncols and nrows: found 90000000 times 90000000 heights, expected at most 100000000 in all",
        ),
        (HEAD.replace("cellsize 10", "cellsize 0"), "a.asc:5: cellsize: found 0, expected a length above 0"),
        (
            HEAD.replace("cellsize 10", "cellsize"),
            "a.asc:5: cellsize: found \"\", expected one finite number",
        ),
        (format!("ncols 3\n{HEAD}"), "a.asc:2: ncols: found it again, expected each name once"),
        (
            format!("xllcenter 3\n{HEAD}"),
            "a.asc:1: xllcenter: found together with xllcorner, expected only one of them",
        ),
        (
            "north 3\n".to_string(),
            "a.asc:1: head: found \"north\", expected ncols, nrows, xllcorner, yllcorner, xllcenter, yllcenter, cellsize, dx, dy, nodata_value",
        ),
    ];
    for (text, sentence) in cases {
        assert_eq!(read(&text).unwrap_err(), sentence);
    }
}
