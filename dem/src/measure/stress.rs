//! Mean stress of bodies from contact and bond forces (Love 1927; Weber 1966). Tension is positive.
//!
//! Limit: regions need many bodies across.
//!
//! Theory manual: equation (3.14) of `docs/theory/motion.md`.

use super::BoxRegion;
use super::contacts::{ContactRecord, contacts};
use crate::base::Vec3;
use crate::base::error::Partner;
use crate::engine::model::Model;
use crate::engine::state::State;

/// Mean stress of each body [Pa], as xx, yy, zz, xy, yz, zx. Shape `[bodies][6]`.
pub fn mean_stress(model: &Model, state: &State) -> Vec<[f64; 6]> {
    mean_stress_of(model, state, &contacts(model, state))
}

/// As [`mean_stress`], from given contacts.
pub fn mean_stress_of(model: &Model, state: &State, contacts: &[ContactRecord]) -> Vec<[f64; 6]> {
    let mut stress = vec![[0.0; 6]; model.body_count()];
    let bonds = super::bonds::records(model, state);
    let bonds = bonds.iter().map(|b| (b.a, Partner::Body(b.b), b.point, b.force, Vec3::zeros()));
    let touches = contacts.iter().map(|c| (c.a, c.b, c.point, c.force, c.shift));
    for (a, b, point, force, shift) in touches.chain(bonds) {
        let mut add = |body: usize, point: Vec3, force: Vec3| {
            let r = point - state.position(body);
            let s = &mut stress[body];
            for (k, (i, j)) in [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)].into_iter().enumerate() {
                s[k] += 0.5 * (r[i] * force[j] + r[j] * force[i]);
            }
        };
        add(a, point, force);
        if let Partner::Body(b) = b {
            add(b, point - shift, -force);
        }
    }
    for (body, s) in stress.iter_mut().enumerate() {
        let volume = model.volume(body);
        s.iter_mut().for_each(|x| *x /= volume);
    }
    stress
}

/// Mean stress of a region, with voids [Pa], as xx, yy, zz, xy, yz, zx.
pub fn region_stress(model: &Model, state: &State, bodies: &[[f64; 6]], region: &BoxRegion) -> [f64; 6] {
    let mut sum = [0.0; 6];
    for (body, stress) in bodies.iter().enumerate() {
        if state.present(body) && region.holds(&model.wrap(&state.position(body))) {
            let volume = model.volume(body);
            sum.iter_mut().zip(stress).for_each(|(s, x)| *s += volume * x);
        }
    }
    sum.map(|s| s / region.volume())
}
