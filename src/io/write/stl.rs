//! Binary STL of a surface.
//!
//! Source: 3D Systems, StereoLithography Interface Specification, 1989. Coordinates are single precision.

use trackbed_dem::shape::polyhedron::Surface;

/// Returns a binary STL file, whose title must not begin with `solid`, a mark of text.
pub fn stl_bytes(surface: &Surface) -> Vec<u8> {
    let mut bytes = b"surface written by trackbed".to_vec();
    bytes.resize(80, 0);
    bytes.extend((surface.triangles.len() as u32).to_le_bytes());
    for t in 0..surface.triangles.len() {
        let [a, b, c] = surface.corners(t);
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default();
        for v in [normal, a, b, c] {
            v.iter().for_each(|x| bytes.extend((*x as f32).to_le_bytes()));
        }
        bytes.extend([0, 0]);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read::read_surface;
    use trackbed_dem::shape::polyhedron::{Polyhedron, convex_hull};

    #[test]
    fn stone_reads_back_with_volume() {
        let turn = |k: usize| 2.4 * k as f64;
        let point = |k: usize| [libm::cos(turn(k)), 0.7 * libm::sin(turn(k)), 0.05 * k as f64];
        let body = Polyhedron::new(&convex_hull(&(0..24).map(point).collect::<Vec<_>>()).unwrap()).unwrap();
        let file = std::env::temp_dir().join(format!("trackbed-{}-stone.stl", std::process::id()));
        std::fs::write(&file, stl_bytes(body.surface())).unwrap();
        let back = read_surface(&file).unwrap();
        std::fs::remove_file(file).unwrap();
        assert_eq!(back.triangles.len(), body.surface().triangles.len());
        assert_eq!(back.topology().unwrap().turned_edges, 0);
        let volume = Polyhedron::new(&back).unwrap().moments().volume;
        assert!((volume / body.moments().volume - 1.0).abs() < 1e-6);
    }
}
