//! Consistent nodal forces: `F_a = ∫ N_a t dA` on faces, `F_a = N_a(xi) F` at points.
//!
//! Source: Zienkiewicz and Taylor (2000), vol. 1, section 2.3. All functions add to `load`, shape
//! `[3 * nodes]` [N]. Limits: no follower loads.

use crate::mesh::{Face, Mesh};

/// Adds a uniform pressure [Pa], positive in compression.
pub fn face_pressure(mesh: &Mesh, face: &Face, pressure: f64, load: &mut [f64]) {
    integrate(mesh, face, load, |area, _| area.map(|a| -pressure * a));
}

/// Adds a uniform traction [Pa] in fixed axes x, y, z.
pub fn face_traction(mesh: &Mesh, face: &Face, traction: [f64; 3], load: &mut [f64]) {
    integrate(mesh, face, load, |_, size| traction.map(|t| t * size));
}

/// Adds a force [N] at the natural point `xi` of an element (index).
pub fn point_load(mesh: &Mesh, element: usize, xi: [f64; 3], force: [f64; 3], load: &mut [f64]) {
    let kind = mesh.connectivity.kind(element);
    add(&mesh.connectivity[element], &kind.shape_functions(xi), force, load);
}

/// Adds a force [N] at the natural point `xi` of a face.
pub fn face_point_load(face: &Face, xi: [f64; 2], force: [f64; 3], load: &mut [f64]) {
    add(face.nodes(), &face.shape.shape_functions(xi), force, load);
}

fn integrate(mesh: &Mesh, face: &Face, load: &mut [f64], force: impl Fn([f64; 3], f64) -> [f64; 3]) {
    for &(xi, weight) in face.shape.points() {
        let (_, area) = face.point_and_area(mesh, xi);
        let size = (area[0] * area[0] + area[1] * area[1] + area[2] * area[2]).sqrt();
        let force = force(area, size).map(|f| f * weight);
        add(face.nodes(), &face.shape.shape_functions(xi), force, load);
    }
}

fn add(nodes: &[u32], shape: &[f64], force: [f64; 3], load: &mut [f64]) {
    for (&node, n) in nodes.iter().zip(shape) {
        for k in 0..3 {
            load[3 * node as usize + k] += n * force[k];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::hex20;

    /// V0.7.
    #[test]
    fn pressure_matches_consistent_nodal_fractions() {
        let mesh = Mesh::block([1, 1, 1], [2.0, 3.0, 1.0]);
        let face = mesh.face(0, 5);
        let mut load = vec![0.0; 60];
        face_pressure(&mesh, &face, 500.0, &mut load);
        for (a, &node) in face.nodes.iter().enumerate() {
            let share = if a < 4 { -1.0 / 12.0 } else { 1.0 / 3.0 };
            let f = &load[3 * node as usize..][..3];
            assert!(f[0].abs() < 1e-12 && f[1].abs() < 1e-12);
            assert!((f[2] / (-500.0 * 6.0) - share).abs() < 1e-14, "{a}: {f:?}");
        }
    }

    #[test]
    fn loads_preserve_force_and_moment() {
        let mut mesh = Mesh::block([1, 1, 1], [1.0; 3]);
        for c in &mut mesh.coordinates {
            *c = [c[0] + 0.2 * c[1], c[1] - 0.1 * c[2] * c[0], c[2] + 0.3 * c[0]];
        }
        let force = [3.0, -7.0, 11.0];
        let moment = |x: [f64; 3], f: &[f64]| {
            [x[1] * f[2] - x[2] * f[1], x[2] * f[0] - x[0] * f[2], x[0] * f[1] - x[1] * f[0]]
        };
        let check = |load: &[f64], point: [f64; 3]| {
            let expected = moment(point, &force);
            for k in 0..3 {
                let sum: f64 = load.iter().skip(k).step_by(3).sum();
                let turn: f64 =
                    (0..20).map(|n| moment(mesh.coordinates[n], &load[3 * n..3 * n + 3])[k]).sum();
                assert!((sum - force[k]).abs() < 1e-13 && (turn - expected[k]).abs() < 1e-13);
            }
        };
        let mut load = vec![0.0; 60];
        let xi = [0.3, -0.6, 0.8];
        point_load(&mesh, 0, xi, force, &mut load);
        let n = hex20::shape_functions(xi);
        check(
            &load,
            std::array::from_fn(|k| (0..20).map(|a| n[a] * mesh.element_coordinates(0)[a][k]).sum()),
        );

        load.fill(0.0);
        let face = mesh.face(0, 2);
        face_point_load(&face, [0.4, -0.7], force, &mut load);
        check(&load, face.point_and_area(&mesh, [0.4, -0.7]).0);

        load.fill(0.0);
        face_traction(&Mesh::block([1, 1, 1], [2.0, 1.0, 1.0]), &face, force, &mut load);
        let total: f64 = load.iter().skip(1).step_by(3).sum();
        assert!((total + 7.0).abs() < 1e-13, "side 3 has 1 m²: {total}");
    }
}
