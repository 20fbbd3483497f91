use super::tables::{corners, rows};
use super::*;

/// Reference table checked by hulls (2e-6) and quasi Monte Carlo; one body is 2 km from the origin.
#[test]
fn moments_are_those_of_the_table() {
    let shapes = rows(include_str!("../../../tests/data/shapes/geometry_corners.csv"));
    let table = rows(include_str!("../../../tests/data/shapes/dilated_polyhedra.csv"));
    assert!(table.len() > 20, "{}", table.len());
    for (name, row) in &table {
        let core = Core::new(&corners(&shapes, name)).unwrap_or_else(|e| panic!("{name}: {e}"));
        let m = Dilated::moments_of(&core, row[0]);
        let size = libm::cbrt(m.volume);
        let near = |found: f64, exact: f64, unit: f64, tolerance: f64| {
            assert!((found - exact).abs() <= tolerance * unit, "{name}: {found} for {exact}");
        };
        near(m.volume, row[4], m.volume, 1e-12);
        near(m.area, row[5], m.area, 1e-12);
        for d in 0..3 {
            near(m.centre[d], row[6 + d], size.max(1e-4 * row[6 + d].abs()), 1e-11);
        }
        let largest = m.inertia.abs().max();
        for (k, (i, j)) in [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)].into_iter().enumerate() {
            near(m.inertia[(i, j)], row[9 + k], largest, 1e-10);
        }
        if row[0] == 0.0 {
            continue;
        }
        // Principal frame.
        let (own, centre, turn) = Dilated::new(&corners(&shapes, name), row[0]).unwrap();
        let back = Dilated::moments_of(&own.core, own.radius);
        assert!(back.centre.norm() < 1e-10 * size && (centre - m.centre).norm() == 0.0, "{name}");
        let axes = turn.to_rotation_matrix();
        let turned = axes.matrix().transpose() * m.inertia * axes.matrix();
        assert!(
            (turned - Matrix3::from_diagonal(&Vec3::from(own.inertia))).abs().max() < 1e-10 * largest,
            "{name}"
        );
        assert!((back.inertia - turned).abs().max() < 1e-10 * largest, "{name}");
    }
}

#[test]
fn a_cube_has_six_faces() {
    let points: Vec<Vec3> = (0..8).map(|k| crate::shape::cuboid::corner(&Vec3::repeat(0.5), k)).collect();
    let core = Core::new(&points).unwrap();
    assert_eq!([core.faces.len(), core.edges.len(), core.corners.len()], [6, 12, 8]);
    assert!((core.circumference() - 4.0).abs() < 1e-12);
    for e in &core.edges {
        let [n1, n2] = e.faces.map(|f| core.faces[f as usize].normal);
        assert!((e.sides[0].0 - n2).norm() < 1e-12 && (e.sides[1].0 - n1).norm() < 1e-12);
    }
    assert!(core.spokes.iter().all(|s| s.len() == 3));
}

#[test]
fn outlines_are_closed() {
    let shapes = rows(include_str!("../../../tests/data/shapes/geometry_corners.csv"));
    for name in ["cube", "tetrahedron", "icosahedron", "wedge"] {
        let (body, _, _) = Dilated::new(&corners(&shapes, name), 0.1).unwrap();
        let (points, polygons) = body.outline();
        let mut sides = std::collections::BTreeMap::new();
        let mut volume = 0.0;
        for p in &polygons {
            for k in 0..p.len() {
                let (a, b) = (p[k], p[(k + 1) % p.len()]);
                *sides.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
            }
            for k in 1..p.len() - 1 {
                let [a, b, c] = [p[0], p[k], p[k + 1]].map(|n| points[n as usize]);
                volume += a.dot(&b.cross(&c)) / 6.0;
            }
        }
        assert!(sides.values().all(|n| *n == 0), "{name}: {sides:?}");
        let share = volume / body.volume;
        assert!((0.9..1.0).contains(&share), "{name}: {share}");
    }
}

#[test]
fn bodies_that_are_none() {
    let cube: Vec<Vec3> = (0..8).map(|k| crate::shape::cuboid::corner(&Vec3::repeat(0.5), k)).collect();
    let refused = |points: &[Vec3]| Core::new(points).unwrap_err();
    assert_eq!(refused(&cube[..3]), DilatedError::Count(3));
    assert_eq!(refused(&cube[..4]), DilatedError::Flat);
    let with = |p: Vec3| [&cube[..], &[p]].concat();
    assert_eq!(refused(&with(Vec3::new(0.1, 0.2, 0.0))), DilatedError::NotConvex(8));
    assert_eq!(refused(&with(Vec3::new(0.1, 0.2, 0.5))), DilatedError::NotConvex(8));
    assert_eq!(refused(&with(Vec3::new(0.1, 0.5, 0.5))), DilatedError::NotConvex(8));
    assert_eq!(refused(&with(Vec3::new(0.5, f64::NAN, 0.0))), DilatedError::NotFinite);
    assert_eq!(refused(&[&cube[..], &cube[..1]].concat()), DilatedError::NotConvex(8));
    let mut bent = cube.clone();
    bent.push(Vec3::new(0.0, 0.5 + 1e-7, 0.6));
    assert_eq!(Core::new(&bent).map(|c| c.corners.len()), Ok(9));
    assert_eq!(Dilated::new(&cube, 0.0).unwrap_err(), DilatedError::Radius(0.0));
    assert_eq!(Dilated::new(&cube, f64::INFINITY).unwrap_err(), DilatedError::NotFinite);
}
