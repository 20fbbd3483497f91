//! Plane sections of a mesh.

use trackbed_fem::ElementKind;
use trackbed_fem::mesh::Mesh;

use super::solid::triangles;

/// Position [m] and value.
pub type Point = [f64; 4];

fn tetrahedra(kind: ElementKind) -> &'static [[usize; 4]] {
    match kind.corner_count() {
        8 => &[[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]],
        6 => &[[0, 1, 2, 5], [0, 1, 5, 4], [0, 4, 5, 3]],
        5 => &[[0, 1, 2, 4], [0, 2, 3, 4]],
        _ => &[[0, 1, 2, 3]],
    }
}

/// Eight sub-tetrahedra from corners and edge midpoints.
fn eight([a, b, c, d]: [[f64; 3]; 4]) -> [[[f64; 3]; 4]; 8] {
    let mid = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|k| 0.5 * (p[k] + q[k]));
    let (ab, ac, ad) = (mid(a, b), mid(a, c), mid(a, d));
    let (bc, bd, cd) = (mid(b, c), mid(b, d), mid(c, d));
    [
        [a, ab, ac, ad],
        [ab, b, bc, bd],
        [ac, bc, c, cd],
        [ad, bd, cd, d],
        [ab, ac, ad, bd],
        [ab, ac, bc, bd],
        [ac, ad, bd, cd],
        [ac, bc, bd, cd],
    ]
}

/// Returns the triangles of the section normal · x = offset. `nodes` has position and value per node;
/// `elements` overrides values.
pub fn section(
    mesh: &Mesh,
    nodes: &[Point],
    elements: Option<&[f64]>,
    normal: [f64; 3],
    offset: f64,
) -> Vec<[Point; 3]> {
    let side = |p: &Point| normal[0] * p[0] + normal[1] * p[1] + normal[2] * p[2] - offset;
    let mut out = Vec::new();
    for (element, own) in mesh.connectivity.iter().enumerate() {
        if !crossed(own, nodes, side) {
            continue;
        }
        let kind = mesh.connectivity.kind(element);
        let at = |xi: [f64; 3]| {
            let shape = kind.shape_functions(xi);
            let mut p = [0.0; 4];
            for (n, weight) in own.iter().zip(&shape) {
                (0..4).for_each(|k| p[k] += weight * nodes[*n as usize][k]);
            }
            if let Some(values) = elements {
                p[3] = values[element];
            }
            p
        };
        for tetrahedron in tetrahedra(kind) {
            let corners = tetrahedron.map(|c| kind.natural()[c]);
            if own.len() > kind.corner_count() {
                eight(corners).iter().for_each(|t| cut(t.map(at), side, &mut out));
            } else {
                cut(corners.map(at), side, &mut out);
            }
        }
    }
    out
}

fn crossed(own: &[u32], nodes: &[Point], side: impl Fn(&Point) -> f64) -> bool {
    let above = own.iter().filter(|n| side(&nodes[**n as usize]) > 0.0).count();
    above > 0 && above < own.len()
}

/// Returns the lines where the plane cuts element faces: both ends [m].
pub fn outlines(mesh: &Mesh, nodes: &[Point], normal: [f64; 3], offset: f64) -> Vec<[[f64; 3]; 2]> {
    let side = |p: &Point| normal[0] * p[0] + normal[1] * p[1] + normal[2] * p[2] - offset;
    let mut out = Vec::new();
    for (element, own) in mesh.connectivity.iter().enumerate() {
        if !crossed(own, nodes, side) {
            continue;
        }
        for face in mesh.connectivity.kind(element).faces() {
            for triangle in triangles(face.len()) {
                let p = triangle.map(|k| nodes[own[face[k]] as usize]);
                let s = p.map(|p| side(&p));
                let crossed =
                    (0..3).map(|k| (k, (k + 1) % 3)).filter(|(a, b)| (s[*a] > 0.0) != (s[*b] > 0.0));
                let ends: Vec<[f64; 3]> = crossed
                    .map(|(a, b)| {
                        let t = s[a] / (s[a] - s[b]);
                        [0, 1, 2].map(|k| p[a][k] + t * (p[b][k] - p[a][k]))
                    })
                    .collect();
                if let [a, b] = ends[..] {
                    out.push([a, b]);
                }
            }
        }
    }
    out
}

fn cut(corners: [Point; 4], side: impl Fn(&Point) -> f64, out: &mut Vec<[Point; 3]>) {
    let s = corners.map(|c| side(&c));
    let (above, below): (Vec<usize>, Vec<usize>) = (0..4).partition(|k| s[*k] > 0.0);
    let between = |a: usize, b: usize| {
        let t = s[a] / (s[a] - s[b]);
        [0, 1, 2, 3].map(|k| corners[a][k] + t * (corners[b][k] - corners[a][k]))
    };
    match (&above[..], &below[..]) {
        ([a], [p, q, r]) | ([p, q, r], [a]) => out.push([between(*a, *p), between(*a, *q), between(*a, *r)]),
        ([a, b], [p, q]) => {
            let [ap, aq, bp, bq] = [between(*a, *p), between(*a, *q), between(*b, *p), between(*b, *q)];
            out.extend([[ap, aq, bq], [ap, bq, bp]]);
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cube_section_integrates_linear_values() {
        for kind in [ElementKind::Hex8, ElementKind::Hex20] {
            let mut mesh = Mesh::default();
            let natural = kind.natural();
            mesh.coordinates = natural.iter().map(|x| x.map(|v| 0.5 + 0.5 * v)).collect();
            mesh.node_ids = (1..=natural.len() as u32).collect();
            let own: Vec<u32> = (0..natural.len() as u32).collect();
            mesh.push_element(1, 1, kind, &own);
            let nodes: Vec<Point> =
                mesh.coordinates.iter().map(|x| [x[0], x[1], x[2], 3.0 * x[0] + x[1] - x[2]]).collect();
            let triangles = section(&mesh, &nodes, None, [0.0, 0.0, 1.0], 0.3);
            let (mut area, mut sum) = (0.0, 0.0);
            for [a, b, c] in &triangles {
                assert!([a, b, c].iter().all(|p| (p[2] - 0.3).abs() < 1e-12));
                let size = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
                area += size;
                sum += size * (a[3] + b[3] + c[3]) / 3.0;
            }
            assert!((area - 1.0).abs() < 1e-12, "{kind:?}: {area}");
            assert!((sum - 1.7).abs() < 1e-12, "{kind:?}: {sum}");
            let of_elements = section(&mesh, &nodes, Some(&[7.0]), [0.0, 0.0, 1.0], 0.3);
            assert!(of_elements.iter().flatten().all(|p| p[3] == 7.0));
            assert!(section(&mesh, &nodes, None, [0.0, 0.0, 1.0], 1.3).is_empty());
            let around = outlines(&mesh, &nodes, [0.0, 0.0, 1.0], 0.3);
            let length: f64 = around.iter().map(|[a, b]| (a[0] - b[0]).hypot(a[1] - b[1])).sum();
            assert!((length - 4.0).abs() < 1e-12, "{kind:?}: {length}");
        }
    }
}
