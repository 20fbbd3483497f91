//! Initial overlaps by true shapes, and the speeds at which they throw grains.

use super::bonds::wide_gap;
use super::part::GrainsPart;
use crate::scene::{Document, SceneError};
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_dem::measure::ContactRecord;
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{Model, ModelInput, Partner, State, Vec3};

/// Largest overlap over smaller radius, beyond which grains are ejected.
pub const LARGEST_OVERLAP: f64 = 0.1;
const ROUNDING: f64 = 1e-9;
/// Plausible rise of a grain thrown by a start contact over its radius.
const RISE: f64 = 5.0;
/// Plausible speed of a thrown grain without gravity [m/s].
const SPEED: f64 = 1.0;

/// Deepest contact.
#[derive(Clone, Copy, Debug)]
pub struct Deepest {
    /// Overlap over the smaller radius.
    pub share: f64,
    /// The contact.
    pub contact: ContactRecord,
}

/// Grain thrown by its start contacts.
#[derive(Clone, Debug)]
pub struct Thrown {
    /// Group index.
    pub part: u32,
    /// Grain with its deepest contact.
    pub found: String,
    /// Speed [m/s].
    pub speed: f64,
    /// Plausible speed [m/s].
    pub usual: f64,
}

/// Returns the initial model of the first stage with gravity.
pub(super) fn first_input(grains: &GrainsPart) -> ModelInput {
    let mut input = grains.input(grains.groups.bodies.clone());
    if grains.packing.deposition.is_some() {
        input.walls.retain(|w| w.servo.is_none() && w.body.is_none());
    }
    input
}

/// Rejects overlaps of `state` above a tenth of the smaller radius, unless a group has `accept_overlap`;
/// `imported`: number of grains of an earlier run, whose contacts with each other and impacts are accepted.
///
/// # Errors
/// Deepest overlap.
pub fn check_overlaps(
    document: &Document,
    grains: &GrainsPart,
    (model, state): (&Model, State),
    ground: Option<&SolidSurface>,
    imported: usize,
) -> Result<(), SceneError> {
    let exempt = Exemptions { grains, model };
    let Some((state, all)) = contacts(model, state, ground) else { return Ok(()) };
    let impacts = (imported > 0).then(|| Impacts::of(model, &state, imported));
    let known = |c: &ContactRecord| impacts.as_ref().is_some_and(|i| i.explain(model, c));
    let found = deepest(model, &all, |c| exempt.counts(c) && !exempt.grows(c) && !known(c));
    let Some(Deepest { share, contact }) = found.filter(|d| d.share > LARGEST_OVERLAP + ROUNDING) else {
        return Ok(());
    };
    let found = format!(
        "{} and {} with an overlap of {:.3e} m, {:.0} % of the smaller radius",
        exempt.name(contact.a),
        exempt.partner(&contact.b),
        contact.overlap,
        100.0 * share
    );
    let expected = format!(
        "at most {:.0} % at the start. Move them apart, or set `accept_overlap = true` for the group",
        100.0 * LARGEST_OVERLAP
    );
    Err(document.error(&format!("grains.{}", exempt.group(&contact)), found, expected))
}

/// Contacts of imported grains in motion.
struct Impacts {
    imported: usize,
    /// Largest speed [m/s].
    fastest: f64,
    /// Mass bonded to each body [kg].
    masses: Vec<f64>,
}

impl Impacts {
    fn of(model: &Model, state: &State, imported: usize) -> Impacts {
        let fragments = dem::measure::fragments(model, state);
        let mut whole = vec![0.0; fragments.sizes.len()];
        fragments.of.iter().enumerate().for_each(|(b, &k)| whole[k as usize] += model.mass(b));
        let present = (0..imported).filter(|&b| state.present(b));
        Impacts {
            imported,
            fastest: present.map(|b| state.velocity(b).norm()).fold(0.0, f64::max),
            masses: fragments.of.iter().map(|&k| whole[k as usize]).collect(),
        }
    }

    /// Whether an earlier run may have had the contact: among imported grains, or within v √(m/K) beyond the
    /// limit, K the secant stiffness.
    fn explain(&self, model: &Model, c: &ContactRecord) -> bool {
        if c.a < self.imported && matches!(c.b, Partner::Body(b) if b < self.imported) {
            return true;
        }
        let stiffness = c.normal_force / c.overlap;
        let impact = if stiffness > 0.0 { self.fastest * (self.masses[c.a] / stiffness).sqrt() } else { 0.0 };
        c.overlap <= LARGEST_OVERLAP * radius(model, c.a) + impact
    }
}

/// Returns the deepest contact of the initial grains with each other and with walls, its names, and the energy
/// of all contact springs [J]; accepted groups left out.
pub fn deepest_overlap(grains: &GrainsPart) -> Option<(Deepest, String, f64)> {
    let model = Model::new(first_input(grains)).ok()?;
    let exempt = Exemptions { grains, model: &model };
    let (state, all) = contacts(&model, State::new(&model), None)?;
    let found = deepest(&model, &all, |c| exempt.counts(c))?;
    let names = format!("{} and {}", exempt.name(found.contact.a), exempt.partner(&found.contact.b));
    Some((found, names, dem::measure::energies(&model, &state).elastic_normal))
}

/// Returns the grain thrown farthest beyond plausible speeds by its start contacts: v = √(|F| δ/m),
/// resultant F of contacts and weight, largest overlap δ.
pub fn thrown(grains: &GrainsPart, ground: Option<&SolidSurface>) -> Option<Thrown> {
    // Rejected later; the bonds of all pairs would fill the memory.
    if wide_gap(&grains.bonds, &grains.groups.bodies, &grains.groups.shapes).is_some() {
        return None;
    }
    let model = Model::new(first_input(grains)).ok()?;
    let exempt = Exemptions { grains, model: &model };
    let (state, all) = contacts(&model, State::new(&model), ground)?;
    let mut deepest = vec![None::<&ContactRecord>; model.body_count()];
    for c in all.iter().filter(|c| exempt.counts(c) && !exempt.grows(c)) {
        let other = if let Partner::Body(b) = c.b { Some(b) } else { None };
        for b in [Some(c.a), other].into_iter().flatten() {
            if deepest[b].is_none_or(|d| d.overlap < c.overlap) {
                deepest[b] = Some(c);
            }
        }
    }
    let forces = dem::measure::contact_forces_of(&model, &state, &all);
    let gravity = model.gravity();
    let thrown = |b: usize| {
        let contact = deepest[b].filter(|_| !exempt.is_moved(b))?;
        let force = forces[b] + gravity * model.mass(b);
        let speed = release_speed(&force, contact.overlap, model.mass(b));
        let usual = usual_speed(&gravity, model.radius(b));
        (speed > usual).then_some((b, contact, speed, usual))
    };
    let all = (0..model.body_count()).filter_map(thrown);
    let (b, contact, speed, usual) = all.max_by(|x, y| (x.2 / x.3).total_cmp(&(y.2 / y.3)))?;
    let other = match contact.b {
        Partner::Body(other) if other == b => exempt.name(contact.a),
        partner => exempt.partner(&partner),
    };
    let found = format!(
        "{} with an overlap of {:.3e} m with {other} at the start, which throws it at {speed:.2} m/s",
        exempt.name(b),
        contact.overlap
    );
    Some(Thrown { part: model.part(b), found, speed, usual })
}

fn release_speed(force: &Vec3, overlap: f64, mass: f64) -> f64 {
    (force.norm() * overlap / mass).sqrt()
}

/// Speed that raises a grain by [`RISE`] radii [m/s].
fn usual_speed(gravity: &Vec3, radius: f64) -> f64 {
    let g = gravity.norm();
    if g > 0.0 { (2.0 * g * RISE * radius).sqrt() } else { SPEED }
}

/// All contacts of a state, also deep ones; none if they cannot be found.
fn contacts(
    model: &Model,
    mut state: State,
    ground: Option<&SolidSurface>,
) -> Option<(State, Vec<ContactRecord>)> {
    let mut work = dem::Work::new(model, &state);
    match ground {
        Some(ground) => dem::find_deep_contacts(model, &mut state, &mut work, ground),
        None => dem::find_deep_contacts(model, &mut state, &mut work, &NoSurface),
    }
    .ok()?;
    let all = dem::measure::contacts(model, &state);
    Some((state, all))
}

fn deepest(
    model: &Model,
    contacts: &[ContactRecord],
    counts: impl Fn(&ContactRecord) -> bool,
) -> Option<Deepest> {
    let share = |c: &ContactRecord| {
        let smaller = match c.b {
            Partner::Body(b) => radius(model, c.a).min(radius(model, b)),
            _ => radius(model, c.a),
        };
        c.overlap / smaller
    };
    let all = contacts.iter().filter(|c| counts(c)).map(|c| Deepest { share: share(c), contact: *c });
    // The first of equal contacts.
    all.reduce(|most, other| if other.share > most.share { other } else { most })
}

/// Groups of bodies and their exemptions.
struct Exemptions<'a> {
    grains: &'a GrainsPart,
    model: &'a Model,
}

impl Exemptions<'_> {
    fn is_sleeper(&self, body: usize) -> bool {
        self.model.part(body) >= self.grains.stone_groups()
    }

    fn is_moved(&self, body: usize) -> bool {
        let part = self.model.part(body);
        self.grains.groups.moving.iter().any(|m| m.part == part)
    }

    /// Sleepers count against grains only.
    fn counts(&self, c: &ContactRecord) -> bool {
        let ends = ends(c);
        let accepted = |b: usize| self.grains.groups.overlapping.contains(&self.model.part(b));
        let ends = || ends.iter().copied();
        !ends().any(accepted) && !ends().all(|b| self.is_moved(b)) && !ends().all(|b| self.is_sleeper(b))
    }

    fn grows(&self, c: &ContactRecord) -> bool {
        let growths = &self.grains.groups.growths;
        ends(c).iter().any(|b| growths.iter().any(|g| g.bodies.contains(b)))
    }

    fn group(&self, c: &ContactRecord) -> u32 {
        let grain = ends(c).into_iter().find(|b| !self.is_sleeper(*b));
        grain.map_or(0, |b| self.model.part(b))
    }

    fn name(&self, body: usize) -> String {
        if self.is_sleeper(body) {
            return "a sleeper".into();
        }
        let name = &self.grains.groups.names[self.model.part(body) as usize];
        format!("grain {body} of \"{name}\"")
    }

    fn partner(&self, partner: &Partner) -> String {
        match partner {
            Partner::Body(b) => self.name(*b),
            other => self.model.name_objects(other),
        }
    }
}

fn ends(c: &ContactRecord) -> Vec<usize> {
    match c.b {
        Partner::Body(b) => vec![c.a, b],
        _ => vec![c.a],
    }
}

/// Reference radius [m]: smallest clump sphere, half the shortest box side, equal-volume sphere of a
/// polyhedron.
fn radius(model: &Model, body: usize) -> f64 {
    model.scale(body) * model.shape(body).query(|s| s.reference_radius())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn released_spring_gives_its_energy() {
        let (stiffness, overlap, mass) = (1e8_f64, 4e-4_f64, 0.0888_f64);
        let speed = release_speed(&Vec3::new(0.0, 0.0, stiffness * overlap), overlap, mass);
        let energy = 0.5 * stiffness * overlap * overlap;
        assert!((0.5 * mass * speed * speed / energy - 1.0).abs() < 1e-12, "{speed}");
        let usual = usual_speed(&Vec3::new(0.0, 0.0, -9.81), 0.02);
        assert!((usual * usual / (2.0 * 9.81) / 0.02 - 5.0).abs() < 1e-12, "{usual}");
        assert_eq!(usual_speed(&Vec3::zeros(), 0.02), 1.0);
        assert!(speed > usual);
    }
}
