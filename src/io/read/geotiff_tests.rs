use super::*;
use tiff::encoder::colortype::{ColorType, Gray16, Gray32Float, Gray64Float, RGB8};
use tiff::encoder::{TiffEncoder, TiffValue};

struct Tags<'a> {
    scale: &'a [f64],
    tie: &'a [f64],
    matrix: &'a [f64],
    keys: &'a [u16],
    absent: &'a str,
}

const GOOD: Tags<'static> = Tags {
    scale: &[10.0, 20.0, 0.0],
    tie: &[0.0, 0.0, 0.0, 100.0, 240.0, 0.0],
    matrix: &[],
    keys: &[],
    absent: "",
};

fn file<C: ColorType>(tags: &Tags<'_>, size: [u32; 2], values: &[C::Inner]) -> Result<Surface, String>
where
    [C::Inner]: TiffValue,
{
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
    let mut image = encoder.new_image::<C>(size[0], size[1]).unwrap();
    let directory = image.encoder();
    for (tag, numbers) in [
        (Tag::ModelPixelScaleTag, tags.scale),
        (Tag::ModelTiepointTag, tags.tie),
        (Tag::ModelTransformationTag, tags.matrix),
    ] {
        if !numbers.is_empty() {
            directory.write_tag(tag, numbers).unwrap();
        }
    }
    if !tags.keys.is_empty() {
        directory.write_tag(Tag::GeoKeyDirectoryTag, tags.keys).unwrap();
    }
    if !tags.absent.is_empty() {
        directory.write_tag(Tag::GdalNodata, tags.absent).unwrap();
    }
    image.write_data(values).unwrap();
    read(&bytes.into_inner())
}

fn read(bytes: &[u8]) -> Result<Surface, String> {
    use std::sync::atomic::{AtomicU32, Ordering};
    static NUMBER: AtomicU32 = AtomicU32::new(0);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    let path = std::env::temp_dir().join(format!("trackbed-geotiff-{}-{number}.tif", std::process::id()));
    std::fs::write(&path, bytes).unwrap();
    let result = read_geotiff(&path).map_err(|e| e.to_string().replace(&path.display().to_string(), "a.tif"));
    std::fs::remove_file(path).unwrap();
    result
}

const SIX: [f32; 6] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];

#[test]
fn places_area_and_point_samples() {
    let surface = file::<Gray32Float>(&GOOD, [3, 2], &SIX).unwrap();
    assert_eq!((surface.vertices[0], surface.triangles.len()), ([105.0, 230.0, 1.0], 4));
    assert_eq!(surface.vertices[5], [125.0, 210.0, 6.0]);
    let points = Tags { keys: &[1, 1, 0, 1, 1025, 0, 1, 2], ..GOOD };
    let surface = file::<Gray16>(&points, [3, 2], &[1, 2, 3, 4, 5, 6]).unwrap();
    assert_eq!(surface.vertices[0], [100.0, 240.0, 1.0]);
    let matrix = [10.0, 0.0, 0.0, 100.0, 0.0, -20.0, 0.0, 240.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let turned = Tags { scale: &[], tie: &[], matrix: &matrix, ..GOOD };
    let same = file::<Gray64Float>(&turned, [3, 2], &SIX.map(f64::from)).unwrap();
    assert_eq!(same.vertices[0], [105.0, 230.0, 1.0]);
}

#[test]
fn values_without_data_leave_holes() {
    let tags = Tags { absent: "-9999", ..GOOD };
    let hole = file::<Gray32Float>(&tags, [3, 2], &[-9999.0, 2.0, f32::NAN, 4.0, 5.0, 6.0]).unwrap();
    assert_eq!((hole.vertices.len(), hole.triangles.len()), (4, 2));
}

#[test]
fn what_makes_no_terrain_is_refused() {
    let refused = |tags: &Tags<'_>| file::<Gray32Float>(tags, [3, 2], &SIX).unwrap_err();
    assert_eq!(
        refused(&Tags { scale: &[], ..GOOD }),
        "a.tif: place: found none, expected a pixel scale with a tie point, or a transformation"
    );
    assert_eq!(
        refused(&Tags { keys: &[1, 1, 0, 1, 1024, 0, 1, 2], ..GOOD }),
        "a.tif: coordinates: found degrees, expected metres on a plane: project it first, for example with gdalwarp -t_srs"
    );
    assert_eq!(
        refused(&Tags { scale: &[10.0, -1.0, 0.0], ..GOOD }),
        "a.tif: place: found steps (10, -1) from (100, 240), expected finite places, steps above 0, north up"
    );
    let colours = file::<RGB8>(&GOOD, [2, 2], &[0; 12]).unwrap_err();
    assert_eq!(colours, "a.tif: bands: found 12 values for 2 times 2 samples, expected one band");
    let row = file::<Gray32Float>(&GOOD, [3, 1], &SIX[..3]).unwrap_err();
    assert_eq!(
        row,
        "a.tif: size: found 3 times 1 samples, expected 2 or more each way, at most 100000000 in all"
    );
    for bytes in [&b""[..], b"II", b"II*\0\x08\0\0\0", b"ncols 3", &[0xff; 64]] {
        let sentence = read(bytes).unwrap_err();
        assert!(sentence.starts_with("a.tif: GeoTIFF: found "), "{sentence}");
    }
}
