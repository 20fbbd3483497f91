//! Mean stress of each body from its contact and bond forces (Love 1927; Weber 1966):
//! σ = (1/V) Σ ½ (r ⊗ F + F ⊗ r), r from the body's centre to the contact point, F the force on the body.
//! With this sign pressure is negative: tension positive, as in the solid. The symmetric part is taken: the rest
//! is the unbalanced torque.

use super::contacts::contacts;
use crate::error::Partner;
use crate::model::Model;
use crate::state::State;

/// Mean stress of each body [Pa] in the order xx, yy, zz, xy, yz, zx. Shape `[bodies][6]`.
pub fn mean_stress(model: &Model, state: &State) -> Vec<[f64; 6]> {
    let mut stress = vec![[0.0; 6]; model.body_count()];
    let bonds = crate::bond::records(model, state);
    let bonds = bonds.iter().map(|b| (b.a, Partner::Body(b.b), b.point, b.force));
    for (a, b, point, force) in
        contacts(model, state).iter().map(|c| (c.a, c.b, c.point, c.force)).chain(bonds)
    {
        let mut add = |body: usize, force: crate::Vec3| {
            let r = point - state.position(body);
            let s = &mut stress[body];
            for (k, (i, j)) in [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)].into_iter().enumerate() {
                s[k] += 0.5 * (r[i] * force[j] + r[j] * force[i]);
            }
        };
        add(a, force);
        if let Partner::Body(b) = b {
            add(b, -force);
        }
    }
    for (body, s) in stress.iter_mut().enumerate() {
        let volume = model.volume(body);
        s.iter_mut().for_each(|x| *x /= volume);
    }
    stress
}
