//! The force on a group of bodies, and loads on structures.

use super::bonds::records;
use super::contacts::{contacts, force_of};
use crate::base::Vec3;
use crate::base::error::Partner;
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::engine::wall_contacts;

/// Sum of the forces of bonds and contacts on the bodies that `of` picks, from bodies, walls and surfaces that are not
/// among them [N]: on bodies of prescribed motion, what holds them is its opposite (gravity apart).
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

/// Calls `f` with place [m] and force [N] of each contact on a structure: bodies and walls that `body` and `wall` pick. Of bodies that touch
/// an image across a periodic border the place is on the structure itself.
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
