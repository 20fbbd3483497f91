//! Tests of boundary layers: closed-form matrices, rejected input, rigid-body check.

use super::*;
use crate::mesh::Constraint;
use crate::supports::Supports;

fn faces(mesh: &Mesh, side: u8) -> Vec<Face> {
    mesh.boundary_faces().into_iter().filter(|f| f.side == side).collect()
}

#[test]
fn rigid_face_motions_match_area_moments() {
    let mesh = Mesh::block([2, 3, 1], [2.0, 3.0, 1.0]);
    let layer = BoundaryLayer { spring_normal: 7.0, spring_tangential: 5.0, ..Default::default() };
    let layer = BoundaryLayer { faces: faces(&mesh, 5), ..layer };
    let springs = FaceMatrix::springs(&mesh, std::slice::from_ref(&layer));
    assert!(FaceMatrix::dashpots(&mesh, &[layer]).is_empty());
    let form = |motion: &dyn Fn([f64; 3]) -> [f64; 3]| {
        let x: Vec<f64> = mesh.coordinates.iter().flat_map(|c| motion(*c)).collect();
        let mut product = vec![0.0; x.len()];
        springs.add_times(&x, &mut product);
        let dot: f64 = x.iter().zip(&product).map(|(a, b)| a * b).sum();
        assert!((dot - springs.form(&x)).abs() < 1e-12 * dot);
        dot
    };
    assert!((form(&|_| [0.0, 0.0, 1.0]) - 7.0 * 6.0).abs() < 1e-12);
    assert!((form(&|_| [0.6, 0.8, 0.0]) - 5.0 * 6.0).abs() < 1e-12);
    // ∫ x² + y² over 2 × 3 = 2³·3/3 + 2·3³/3.
    assert!((form(&|x| [-x[1], x[0], 0.0]) - 5.0 * 26.0).abs() < 1e-11);
    // Rotation about y: ∫ x².
    assert!((form(&|x| [0.0, 0.0, x[0]]) - 7.0 * 8.0).abs() < 1e-11);
}

#[test]
fn springs_constrain_but_dashpots_do_not() {
    let mesh = Mesh::block([2, 1, 1], [2.0, 1.0, 1.0]);
    let free = |constraints: &[Constraint], layers: &[BoundaryLayer]| {
        let supports = Supports::new(&mesh, constraints).unwrap();
        supports.rigid_body_motion_on_springs(&mesh, &spring_points(&mesh, layers))
    };
    let base = faces(&mesh, 0);
    assert_eq!(free(&[], &[BoundaryLayer::springs(base.clone(), 1.0, 1e-3)]), None);
    assert!(free(&[], &[BoundaryLayer::springs(base.clone(), 1.0, 0.0)]).is_some());
    let wall = |side| BoundaryLayer::springs(faces(&mesh, side), 1.0, 0.0);
    assert_eq!(free(&[], &[wall(0), wall(4)]).unwrap().1, 1);
    assert_eq!(free(&[], &[wall(0), wall(4), wall(1)]), None);
    let soil = Elastic { young: 1e7, poisson: 0.3, density: 2000.0 };
    assert!(free(&[], &[BoundaryLayer::absorbing(base, &soil)]).is_some());
}

#[test]
fn bad_layers_are_named() {
    let mesh = Mesh::block([2, 1, 1], [2.0, 1.0, 1.0]);
    let base = faces(&mesh, 0);
    let refused = |layer: BoundaryLayer| check(&mesh, &[BoundaryLayer::default(), layer]).unwrap_err();
    let e = refused(BoundaryLayer::springs(base.clone(), -1.0, 0.0));
    assert!(matches!(e, ModelError::BoundaryConstant { index: 1, name: "spring_normal", .. }), "{e}");
    let e = refused(BoundaryLayer { dashpot_tangential: f64::NAN, ..Default::default() });
    assert!(e.to_string().contains("dashpot_tangential is NaN"), "{e}");
    let e = refused(BoundaryLayer::springs(vec![base[0], base[1], base[0]], 1.0, 0.0));
    assert!(e.to_string().ends_with("face 1 of element 1 is named twice"), "{e}");
    let e = refused(BoundaryLayer::springs(vec![mesh.face(0, 2)], 1.0, 0.0));
    assert!(e.to_string().ends_with("face 3 of element 1 is not on the boundary of the mesh"), "{e}");
    let far = Face { element: 17, ..base[0] };
    assert!(matches!(
        refused(BoundaryLayer::springs(vec![far], 1.0, 0.0)),
        ModelError::BoundaryFace { element: 17, .. }
    ));
    assert!(check(&mesh, &[BoundaryLayer::springs(base, 1.0, 1.0)]).is_ok());
}

#[test]
fn absorbing_constants_are_wave_impedances() {
    let soil = Elastic { young: 20e6, poisson: 0.3, density: 2000.0 };
    let layer = BoundaryLayer::viscous_spring(Vec::new(), &soil, 4.0, SpringFactors::SPATIAL);
    assert!((layer.dashpot_normal / (2000.0 * soil.compression_wave_speed()) - 1.0).abs() < 1e-14);
    let shear: f64 = 20e6 / 2.6;
    assert!((layer.dashpot_tangential / (2000.0 * (shear / 2000.0).sqrt()) - 1.0).abs() < 1e-14);
    assert!((layer.spring_normal / (shear / 3.0) - 1.0).abs() < 1e-14);
    assert!((layer.spring_tangential / (shear / 6.0) - 1.0).abs() < 1e-14);
}
