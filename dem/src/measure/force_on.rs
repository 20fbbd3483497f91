//! Forces on bodies and structures.

use super::bonds::records;
use super::contacts::{contacts, force_of};
use crate::base::Vec3;
use crate::base::error::Partner;
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::engine::wall_contacts;

/// Returns the contact and bond force of others on selected bodies [N]; for prescribed motion, minus the
/// holding force (without gravity).
pub fn force_on(model: &Model, state: &State, of: impl Fn(usize) -> bool) -> Vec3 {
    let mut sum = Vec3::zeros();
    let mut add = |a: usize, b: Option<usize>, force: Vec3| {
        sum += force * (f64::from(of(a)) - f64::from(b.is_some_and(&of)));
    };
    records(model, state).iter().for_each(|r| add(r.a, Some(r.b), r.force));
    for c in contacts(model, state) {
        let b = match c.b {
            Partner::Body(b) => Some(b),
            _ => None,
        };
        add(c.a, b, c.force);
    }
    sum
}

/// Calls `f` with point [m] and force [N] of each contact on selected bodies and walls, at its periodic
/// original.
pub fn loads_on(
    model: &Model,
    state: &State,
    (body, wall): (impl Fn(usize) -> bool, impl Fn(usize) -> bool),
    mut f: impl FnMut(Vec3, Vec3),
) {
    for c in contacts(model, state) {
        let first = body(c.a);
        let second = match c.b {
            Partner::Body(b) => body(b),
            other => model.walls.wall_of_partner(other).is_some_and(&wall),
        };
        match (first, second) {
            (true, false) => f(c.point, c.force),
            (false, true) => f(c.point - c.shift, -c.force),
            _ => {}
        }
    }
    wall_contacts::visit(model, state, 0.0, |walls, c| match walls.map(|w| wall(w as usize)) {
        [true, false] => f(c.geometry.point, force_of(model, state, c).0),
        [false, true] => f(c.geometry.point, -force_of(model, state, c).0),
        _ => {}
    });
}
