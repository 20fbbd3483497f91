//! Energies and momentum.

use super::contacts::visit;
use crate::base::balance_terms::Impulse;
use crate::base::error::Partner;
use crate::bodies::table::BodyKind;
use crate::contact::narrow_phase::{ContactView, Visited};
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::lanes::vec4::xyz;
use crate::wall;

/// Energies of all bodies and contacts [J].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// ½ m v².
    pub kinetic_translation: f64,
    /// ½ ω·I ω.
    pub kinetic_rotation: f64,
    /// Normal springs.
    pub elastic_normal: f64,
    /// Tangential springs, and sliding work not yet recorded as dissipated.
    pub elastic_tangential: f64,
    /// Bonds: tension, shear, bending, twisting.
    pub elastic_bonds: f64,
    /// Springs of rigid-body supports.
    pub elastic_mounts: f64,
    /// −m g·x, zero at the origin.
    pub gravity: f64,
}

impl Energies {
    /// Kinetic energy [J].
    pub fn kinetic(&self) -> f64 {
        self.kinetic_translation + self.kinetic_rotation
    }

    /// Elastic energy [J].
    pub fn elastic(&self) -> f64 {
        self.elastic_normal + self.elastic_tangential + self.elastic_bonds + self.elastic_mounts
    }

    /// Total energy [J]. Minus [`BalanceTerms::work`](crate::base::balance_terms::BalanceTerms::work) plus
    /// [`BalanceTerms::dissipated`](crate::base::balance_terms::BalanceTerms::dissipated) it is
    /// constant to second order in dt.
    pub fn total(&self) -> f64 {
        self.kinetic() + self.elastic() + self.gravity
    }
}

/// Returns the energies at the last half step, with fixed bodies in prescribed motion.
pub fn energies(model: &Model, state: &State) -> Energies {
    let mut e = Energies::default();
    bodies(model, state, |_| true, &mut e);
    let ground = crate::engine::walls::ground(model, &state.planes, state.step_size.last);
    for (wall, own) in model.walls.walls.iter().zip(&state.walls) {
        let Some(body) = &wall.body else { continue };
        let [translation, rotation, gravity, mount] =
            body.energies(own, &model.gravity, 0.5 * state.step_size.last);
        let [normal, tangential] = wall::body::stored(&ground, body, wall.material, own);
        e.kinetic_translation += translation;
        e.kinetic_rotation += rotation;
        e.gravity += gravity;
        e.elastic_mounts += mount;
        e.elastic_normal += normal;
        e.elastic_tangential += tangential;
    }
    contacts(model, state, |_| true, &mut e);
    let back = 0.5 * state.step_size.last;
    crate::engine::wall_contacts::visit(model, state, back, |_, c| springs(model, c, back, &mut e));
    e.elastic_bonds = super::bonds::elastic(model, state);
    e
}

/// Selected bodies and all their contacts.
pub(crate) fn energies_of(model: &Model, state: &State, counted: impl Fn(usize) -> bool) -> Energies {
    let mut e = Energies::default();
    bodies(model, state, &counted, &mut e);
    let touches =
        |c: &Visited<'_>| counted(c.body as usize) || matches!(c.partner, Partner::Body(b) if counted(b));
    contacts(model, state, touches, &mut e);
    e
}

fn bodies(model: &Model, state: &State, counted: impl Fn(usize) -> bool, e: &mut Energies) {
    let back = 0.5 * state.step_size.last;
    for block in &state.blocks {
        for (k, &body) in block.bodies.iter().enumerate().filter(|(_, b)| counted(**b as usize)) {
            let b = model.body(body as usize);
            let (v, w) = (xyz(&block.velocity[k]), xyz(&block.spin[k]));
            e.kinetic_translation += 0.5 * b.mass * v.norm_squared();
            e.kinetic_rotation += match block.rotation.get(k) {
                Some(r) if b.kind != BodyKind::Sphere => 0.5 * w.dot(&r.momentum),
                _ => 0.5 * b.inertia.x * w.norm_squared(),
            };
            e.gravity -= b.mass * model.gravity.dot(&(xyz(&block.centre[k]) - v * back));
        }
    }
}

fn contacts(model: &Model, state: &State, counted: impl Fn(&Visited<'_>) -> bool, e: &mut Energies) {
    let back = 0.5 * state.step_size.last;
    visit(model, state, back, |c| {
        if counted(c) {
            springs(model, &c.contact, back, e);
        }
    });
}

fn springs(model: &Model, c: &ContactView<'_>, back: f64, e: &mut Energies) {
    // Sliding advances the spring by half a step; beyond the friction limit it is dissipation, not yet
    // recorded.
    let n = &c.geometry.normal;
    let slip = c.velocity - n * c.velocity.dot(n);
    let mut history = *c.history;
    if !history.is_new() {
        let before = history.spring.norm();
        history.spring += slip * back;
        let length = history.spring.norm();
        if length > before {
            let (overlap, radius) = (c.geometry.overlap, c.geometry.radius);
            let (force, stiffness) =
                model.laws.friction_limit(c.materials, c.friction, overlap, radius, &history);
            let most = if stiffness > 0.0 { before.max(force / stiffness) } else { 0.0 };
            if length > most {
                history.spring *= most / length;
                e.elastic_tangential += stiffness * most * (length - most) * c.weight;
            }
        }
        if model.laws.rolls() {
            let about = c.spin.dot(n);
            let roll = (c.spin - n * about) * (c.geometry.radius * back);
            let forward = [roll.x, roll.y, roll.z, about * c.geometry.radius * back];
            history.turn.iter_mut().zip(forward).for_each(|(x, d)| *x += d);
        }
    }
    let [a, b] = c.materials;
    let (normal, tangential) = model.laws.stored(a, b, c.geometry.overlap, c.geometry.radius, &history);
    e.elastic_normal += normal * c.weight;
    e.elastic_tangential += tangential * c.weight;
}

/// Momentum [kg m/s], and angular momentum about the origin [kg m²/s], at the last half step. Balanced by
/// [`BalanceTerms::impulse`](crate::base::balance_terms::BalanceTerms::impulse) to rounding.
pub fn momentum(model: &Model, state: &State) -> Impulse {
    let mut sum = momentum_of(model, state, |_| true);
    for (wall, own) in model.walls.walls.iter().zip(&state.walls) {
        if let Some(body) = &wall.body {
            body.momentum(own, &mut sum);
        }
    }
    sum
}

/// Selected bodies.
pub(crate) fn momentum_of(model: &Model, state: &State, counted: impl Fn(usize) -> bool) -> Impulse {
    let mut sum = Impulse::default();
    for block in &state.blocks {
        for (k, &body) in block.bodies.iter().enumerate().filter(|(_, b)| counted(**b as usize)) {
            let b = model.body(body as usize);
            sum.add(&xyz(&block.centre[k]), &(xyz(&block.velocity[k]) * b.mass));
            sum.angular += match block.rotation.get(k) {
                Some(r) if b.kind != BodyKind::Sphere => r.momentum,
                _ => xyz(&block.spin[k]) * b.inertia.x,
            };
        }
    }
    sum
}

/// Reference of energy errors [J]: all bodies at the largest prescribed speed, and at the rounding speed of
/// positions.
pub fn reference_energy(model: &Model, state: &State) -> f64 {
    let (mut mass, mut speed, mut far) = (0.0, state.driven_speed, 0.0_f64);
    for block in &state.blocks {
        for (k, &body) in block.bodies.iter().enumerate() {
            let body = model.body(body as usize);
            far = far.max(xyz(&block.centre[k]).amax());
            if body.inverse_mass > 0.0 {
                mass += body.mass;
            } else {
                speed = speed.max(xyz(&block.velocity[k]).norm());
            }
        }
    }
    for (wall, now) in model.walls.walls.iter().zip(&state.walls) {
        far = far.max((wall.centre + now.offset).amax() + wall.reach);
        mass += wall.body.as_ref().map_or(0.0, |b| b.mass);
    }
    far = model.planes.iter().fold(far, |far, plane| far.max(plane.point.amax()));
    speed = speed.max(ROUNDING * f64::EPSILON * far / state.step_size.dt);
    0.5 * mass * speed * speed
}

/// Accumulated rounding of distances, relative to positions.
const ROUNDING: f64 = 64.0;
