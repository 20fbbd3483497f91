use super::*;

#[test]
fn coplanar_triangles_share_their_plane() {
    let turn = nalgebra::UnitQuaternion::from_euler_angles(0.3, -0.7, 1.1);
    let n = 12;
    let at = |i: usize, j: usize| {
        // Nearly coincident rows make slivers.
        let y = if j.is_multiple_of(2) { j as f64 } else { j as f64 - 1.0 + 1e-6 };
        turn * Vec3::new(i as f64 * 0.1, y * 0.1, 0.0) + Vec3::new(5.0, -3.0, 2.0)
    };
    let (mut vertices, mut list) = (Vec::new(), Vec::new());
    let mut push = |corners: [Vec3; 3]| {
        let first = vertices.len() as u32;
        vertices.extend(corners);
        list.push([first, first + 2, first + 1]);
    };
    for j in 0..n {
        for i in 0..n {
            push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    push([at(0, 0), at(1, 0), at(0, 0) + turn * Vec3::new(0.0, -0.1, 0.02)]);
    let patches = triangles(&vertices, &list, "a floor").unwrap();
    let (floor, roof) = patches.split_at(patches.len() - 1);
    assert!(floor.iter().all(|t| t.plane.map(f64::to_bits) == floor[0].plane.map(f64::to_bits)));
    assert!((floor[0].normal().dot(&(turn * Vec3::z())).abs() - 1.0).abs() < 1e-14);
    assert!(roof[0].normal().dot(&floor[0].normal()).abs() < 0.999);
}

#[test]
fn rejection_is_safe_and_sharp() {
    use rand_core::Rng;
    let mut rng = rand_pcg::Pcg64Mcg::new(5);
    let mut unit = || (rng.next_u64() >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0;
    let (mut missed, mut far) = (0, 0);
    for _ in 0..5000 {
        let vertices: Vec<Vec3> = (0..3).map(|_| Vec3::new(unit(), unit(), unit())).collect();
        let Ok(patches) = triangles(&vertices, &[[0, 1, 2]], "one") else { continue };
        let x = Vec3::new(unit(), unit(), unit()) * 2.0;
        let distance = (patches[0].closest(&x).0 - x).norm();
        assert!(patches[0].clearance(&x) <= distance);
        far += 1;
        missed += usize::from(patches[0].clearance(&x) < 0.8 * distance);
    }
    assert!(missed * 10 < far, "{missed} of {far}");
}

#[test]
fn welding_finds_equal_places() {
    let v = [Vec3::x(), Vec3::zeros(), Vec3::x(), Vec3::new(-0.0, 0.0, -0.0), Vec3::y()];
    assert_eq!(welded(&v), [0, 1, 0, 1, 4]);
}
