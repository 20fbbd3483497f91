//! Result files of known scenes, and bitmaps.

use crate::suite::support::Folder;
use std::fs;
use std::path::Path;

fn joined<T: ToString>(values: impl IntoIterator<Item = T>) -> String {
    values.into_iter().map(|v| v.to_string()).collect::<Vec<_>>().join(" ")
}

fn array(kind: &str, name: &str, components: usize, text: &str) -> String {
    format!(
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">{text}</DataArray>"
    )
}

fn file(folder: &Folder, name: &str, kind: &str, piece: &str, body: &str) {
    let text = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\
         <{kind}><Piece {piece}>{body}</Piece></{kind}></VTKFile>\n"
    );
    folder.write(&format!("frames/{name}"), &text);
}

/// Spheres (centre, radius) as single bodies, in groups.
pub fn grains(folder: &Folder, frame: usize, spheres: &[[f64; 4]], parts: &[u32]) {
    let points = joined(spheres.iter().flat_map(|s| &s[..3]));
    let data = array("Float64", "radius", 1, &joined(spheres.iter().map(|s| s[3])))
        + &array("UInt32", "id", 1, &joined(0..spheres.len()))
        + &array("UInt32", "part", 1, &joined(parts));
    let body =
        format!("<PointData>{data}</PointData><Points>{}</Points>", array("Float64", "Points", 3, &points));
    let piece = format!("NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\"", spheres.len());
    file(folder, &format!("grains_{frame}.vtp"), "PolyData", &piece, &body);
}

/// Force chains by end points.
pub fn chains(folder: &Folder, frame: usize, ends: &[[f64; 6]], forces: &[f64]) {
    let body = format!(
        "<CellData>{}</CellData><Points>{}</Points><Lines>{}{}</Lines>",
        array("Float64", "magnitude", 1, &joined(forces)),
        array("Float64", "Points", 3, &joined(ends.iter().flatten())),
        array("Int64", "connectivity", 1, &joined(0..2 * ends.len())),
        array("Int64", "offsets", 1, &joined((1..=ends.len()).map(|k| 2 * k))),
    );
    let piece = format!("NumberOfPoints=\"{}\" NumberOfLines=\"{}\"", 2 * ends.len(), ends.len());
    file(folder, &format!("chains_{frame}.vtp"), "PolyData", &piece, &body);
}

/// Unit cube element with nodal field `heat`.
pub fn solid(
    folder: &Folder,
    frame: usize,
    heat: impl Fn([f64; 3]) -> f64,
    moved: impl Fn([f64; 3]) -> [f64; 3],
) {
    let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
    let corners = corners.map(|c| c.map(f64::from));
    let body = format!(
        "<PointData>{}{}</PointData><Points>{}</Points><Cells>{}{}{}</Cells>",
        array("Float64", "heat", 1, &joined(corners.map(heat))),
        array("Float64", "displacement", 3, &joined(corners.iter().flat_map(|c| moved(*c)))),
        array("Float64", "Points", 3, &joined(corners.iter().flatten())),
        array("Int64", "connectivity", 1, &joined(0..8)),
        array("Int64", "offsets", 1, "8"),
        array("UInt8", "types", 1, "12"),
    );
    file(
        folder,
        &format!("solid_{frame}.vtu"),
        "UnstructuredGrid",
        "NumberOfPoints=\"8\" NumberOfCells=\"1\"",
        &body,
    );
}

/// Series of `count` frames, 1 s apart.
pub fn series(folder: &Folder, count: usize) {
    let mut text = String::from("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\"><Collection>\n");
    for frame in 0..count {
        for (part, name) in ["solid", "grains", "chains"].iter().enumerate() {
            let ending = if *name == "solid" { "vtu" } else { "vtp" };
            let file = format!("frames/{name}_{frame}.{ending}");
            if folder.join(&file).exists() {
                text += &format!("<DataSet timestep=\"{frame}\" part=\"{part}\" file=\"{file}\"/>\n");
            }
        }
    }
    folder.write("results.pvd", &(text + "</Collection></VTKFile>\n"));
}

/// Bitmap.
pub struct Pixels {
    width: usize,
    height: usize,
    rows: Vec<u8>,
}

impl Pixels {
    /// Reads a 24-bit bitmap, rows bottom-up.
    pub fn read(file: &Path) -> Pixels {
        let bytes = fs::read(file).unwrap();
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let (start, width, height) = (word(10), word(18), word(22));
        let row = (3 * width).next_multiple_of(4);
        assert_eq!((&bytes[..2], word(2), start + row * height), (&b"BM"[..], bytes.len(), bytes.len()));
        let line = |y: usize| &bytes[start + row * (height - 1 - y)..][..3 * width];
        let rows =
            (0..height).flat_map(|y| line(y).chunks_exact(3).flat_map(|p| [p[2], p[1], p[0]])).collect();
        Pixels { width, height, rows }
    }

    /// Pixel from the upper left.
    pub fn at(&self, x: usize, y: usize) -> [u8; 3] {
        self.rows[3 * (y * self.width + x)..][..3].try_into().unwrap()
    }

    /// All pixels.
    pub fn rows(self) -> Vec<u8> {
        self.rows
    }

    /// Count of non-white pixels.
    pub fn count(&self) -> usize {
        self.rows.chunks_exact(3).filter(|p| **p != [255; 3]).count()
    }

    /// Bounds of non-white pixels: x0, y0, x1, y1.
    pub fn covered(&self) -> Option<[usize; 4]> {
        let places = (0..self.width * self.height).map(|k| (k % self.width, k / self.width));
        places.filter(|(x, y)| self.at(*x, *y) != [255; 3]).fold(None, |ends: Option<[usize; 4]>, (x, y)| {
            let [x0, y0, x1, y1] = ends.unwrap_or([x, y, x, y]);
            Some([x0.min(x), y0.min(y), x1.max(x), y1.max(y)])
        })
    }

    /// Non-white runs of a column: middles and lengths.
    pub fn runs(&self, x: usize) -> Vec<(usize, usize)> {
        let mut runs: Vec<(usize, usize)> = Vec::new();
        let mut from = None;
        for y in 0..=self.height {
            let white = y == self.height || self.at(x, y) == [255; 3];
            match (from, white) {
                (None, false) => from = Some(y),
                (Some(first), true) => {
                    runs.push(((first + y) / 2, y - first));
                    from = None;
                }
                _ => {}
            }
        }
        runs
    }
}
