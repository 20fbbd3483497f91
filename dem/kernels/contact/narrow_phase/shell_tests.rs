//! Contact names, overlap limits, penetration.

use super::*;
use crate::base::random::Random;
use nalgebra::UnitQuaternion;

fn cube() -> Shell {
    let corner = |k: u32| Vec3::from_fn(|d, _| if k >> d & 1 == 1 { 0.5 } else { -0.5 });
    let vertices: Vec<Vec3> = (0..8).map(corner).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces: Vec<[u32; 3]> = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
    let same: Vec<u32> = (0..8).collect();
    Shell::rounded(&vertices, &faces, &same, 0.05).expect("a small radius")
}

fn at(centre: Vec3, orientation: UnitQuaternion<f64>) -> Pose {
    Pose { centre, orientation, scale: 1.0 }
}

const STILL: UnitQuaternion<f64> =
    UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(1.0, 0.0, 0.0, 0.0));

fn pile() -> Vec<Round> {
    let (base, axis, radii) = (Vec3::new(0.0, 0.0, -0.3), Vec3::z(), [0.4; 2]);
    let side = |far| Round::Frustum { base, axis, height: 0.6, radii, far };
    let end = |z: f64| Round::Disc { centre: Vec3::z() * (0.3 * z), axis: axis * z, radius: 0.4 };
    vec![side(false), side(true), end(-1.0), end(1.0)]
}

/// History look-up requires unique ascending names.
#[test]
fn names_ascend() {
    let (shell, mut random, mut found, mut several) =
        (cube(), Random::new(3, 1), WallContactList::default(), 0);
    for k in 0..2000 {
        let pose =
            at(random.orientation() * Vec3::x() * (0.7 + 0.6 * random.uniform()), random.orientation());
        let moved = ShellPose { shell: &shell, pose };
        found.clear();
        if k % 2 == 0 {
            rounds(&moved, &Vec3::zeros(), &pile(), at(Vec3::zeros(), STILL), &mut found);
        } else {
            shells(&moved, &ShellPose { shell: &shell, pose: at(Vec3::zeros(), STILL) }, &mut found);
        }
        assert_eq!(found.names.len(), found.touches.len());
        assert!(found.names.is_sorted_by(|a, b| a < b), "{k}: {:?}", found.names);
        several += usize::from(found.names.len() > 3);
    }
    assert!(several > 300, "{several}");
}

fn lost_of(found: &WallContactList) -> bool {
    found.touches.iter().any(|t| t.weight > 0.0 && t.geometry.overlap > t.bound)
}

#[test]
fn what_has_come_too_deep() {
    let (shell, mut found) = (cube(), WallContactList::default());
    let ball = [Round::Sphere { centre: Vec3::zeros(), radius: 2.0 }];
    for (depth, deep) in [(0.04, false), (0.05, true)] {
        let moved = ShellPose { shell: &shell, pose: at(Vec3::z() * (2.5 - depth), STILL) };
        found.clear();
        rounds(&moved, &Vec3::zeros(), &ball, at(Vec3::zeros(), STILL), &mut found);
        assert!(!found.touches.is_empty() && lost_of(&found) == deep, "{depth}");
    }
    let turned = |axis: Vec3| UnitQuaternion::from_scaled_axis(axis * std::f64::consts::FRAC_PI_4);
    let edges = 2.0 * 2.0_f64.sqrt() * 0.45;
    let lying = vec![Round::Frustum {
        base: Vec3::x() * -2.0,
        axis: Vec3::x(),
        height: 4.0,
        radii: [0.4; 2],
        far: false,
    }];
    for (below, meet) in [(None, edges), (Some(lying), 0.5 * edges + 0.4)] {
        for (height, crossed) in [(meet + 0.049, false), (meet - 0.04, true), (meet - 0.2, true)] {
            let moved =
                ShellPose { shell: &shell, pose: at(Vec3::new(0.03, 0.02, height), turned(Vec3::y())) };
            found.clear();
            match &below {
                None => {
                    let other = ShellPose { shell: &shell, pose: at(Vec3::zeros(), turned(Vec3::x())) };
                    shells(&moved, &other, &mut found);
                }
                Some(forms) => rounds(&moved, &Vec3::zeros(), forms, at(Vec3::zeros(), STILL), &mut found),
            }
            assert!(!found.touches.is_empty() || below.is_some());
            let says =
                found.touches.iter().any(|t| t.geometry.overlap == t.bound / DEEPEST && t.weight > 0.0);
            assert!(says == crossed, "{height}: {:?}", found.touches);
        }
    }
}
