//! Column of the bed: a full-height sample of grains settles between smooth planes, to find settling time,
//! step size and cost.

use super::clock::Clock;
use crate::bed::rms_speed;
use std::error::Error;
use std::time::{Duration, Instant};
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_dem::bond::BondInput;
use trackbed_dem::{BackEnd, BodyInput, ModelInput, Plane, Shape, Vec3};
use trackbed_input::model::grains::{DepositionPlan, GrainsPart};

const SPHERES: usize = 2000;
/// Small beds mix large and small grains, and are used as a whole.
const WHOLE: usize = 6000;
/// A polyhedron costs several hundred spheres, but a column needs as many neighbours as the bed.
const POLYHEDRON: usize = 20;
const LOOK: f64 = 1e-3;
/// Before low speed means rest [s].
const START: f64 = 0.05;
/// With main-stage contacts [s].
const AT_REST: f64 = 0.1;
const STRIDE: u32 = 50;

/// Results of a column.
#[derive(Clone, Debug)]
pub struct Column {
    /// Ratio of scene spheres to column spheres.
    pub share: f64,
    /// Contacts per grain, column over bed.
    pub full: f64,
    /// Settling time [s], or simulated time at the end of the budget.
    pub rest: f64,
    /// Whether it came to rest.
    pub rested: bool,
    /// Elapsed seconds on one thread.
    pub seconds: f64,
    /// Seconds per simulated second at the end of settling, one thread.
    pub late: f64,
    /// Seconds per simulated second at rest with main-stage contacts, one thread.
    pub pace: f64,
    /// The same including the initial short steps.
    pub first: f64,
    course: Vec<[f64; 2]>,
}

impl Column {
    /// Settles a column, if the bed is deposited, within about `budget`.
    ///
    /// # Errors
    /// No stable time step.
    pub fn settle(
        grains: &GrainsPart,
        plan: Option<&DepositionPlan>,
        surface: Option<&SolidSurface>,
        budget: Duration,
    ) -> Result<Column, Box<dyn Error>> {
        let bodies = || grains.groups.bodies.clone();
        let mut input = plan.map_or_else(|| grains.input(bodies()), |plan| grains.deposition_input(plan));
        let spheres = |bodies: &[BodyInput]| -> usize {
            bodies.iter().filter(|b| !b.absent).map(|b| members(&grains.groups.shapes[b.shape])).sum()
        };
        let all = spheres(&input.bodies);
        let (numbers, planes, full) = cut(&input, all);
        let numbers = unbroken(numbers, &input.bonds, input.bodies.len());
        let bodies: Vec<BodyInput> = numbers.iter().map(|&b| input.bodies[b].clone()).collect();
        if bodies.is_empty() {
            return Err("the bonded bed cannot be divided into columns".into());
        }
        let bonded = !input.bonds.is_empty();
        let share = all as f64 / spheres(&bodies).max(1) as f64;
        input.bonds = among(&numbers, &input.bonds, input.bodies.len());
        input.bodies.clone_from(&bodies);
        input.planes.extend(planes.iter().copied());
        smooth(&mut input, planes.len());
        let model = dem::Model::new(input.clone())?;
        let (mut state, begun, clock) = (dem::State::new(&model), Instant::now(), Clock::start(1));
        let mut work = dem::Work::new(&model, &state);
        let (mut rested, mut course) = (false, vec![[0.0, 0.0]]);
        let mut looked = 0.0;
        let longest = plan.map_or(0.0, |plan| plan.max_time);
        while !rested && state.time < longest && begun.elapsed() < budget {
            step(&model, &mut state, &mut work, surface)?;
            if state.time >= looked + LOOK {
                looked = state.time;
                course.push([looked, clock.seconds()]);
                let settled = |plan: &DepositionPlan| plan.settled(rms_speed(&model, &state), &model, &state);
                rested = state.time > START && plan.is_some_and(settled);
            }
        }
        let (seconds, rest) = (clock.seconds(), state.time);
        rested |= rest >= longest;
        let place = |(b, input): (usize, BodyInput)| BodyInput {
            position: state.position(b),
            orientation: state.orientation(&model, b),
            ..input
        };
        let level = plan.and_then(|plan| plan.level).unwrap_or(f64::INFINITY);
        let bodies: Vec<BodyInput> = bodies.into_iter().enumerate().map(place).collect();
        let below = (0..bodies.len()).filter(|&b| bodies[b].position.z <= level).collect();
        let below = unbroken(below, &input.bonds, bodies.len());
        let bonds = std::mem::take(&mut input.bonds);
        let left = below.iter().map(|&b| bodies[b].clone()).collect();
        // Bonds refer to bodies of the whole bed.
        let proper = match bonded {
            false => grains.input(left),
            true => ModelInput { bodies: left, ..grains.input(grains.groups.bodies.clone()) },
        };
        let mut input = ModelInput { body_forces: Vec::new(), other_surface: None, ..proper };
        input.bonds = among(&below, &bonds, bodies.len());
        input.planes.extend(planes.iter().copied());
        smooth(&mut input, planes.len());
        // Otherwise the bed may overlap main-stage walls; assume its earlier cost.
        let late = late(&course).unwrap_or(seconds / rest.max(f64::MIN_POSITIVE));
        let paces =
            if rested || plan.is_none() { paces(input, surface, budget / 3) } else { Ok((late, late)) };
        let (pace, first) = match paces {
            Err(_) if plan.is_some() => (late, late),
            paces => paces?,
        };
        Ok(Column { share, full, rest, rested, seconds, late, pace, first, course })
    }

    /// Returns the seconds between two simulated times [s]; none if not reached.
    pub fn between(&self, [from, to]: [f64; 2]) -> Option<f64> {
        let at = |time: f64| {
            let k = self.course.partition_point(|c| c[0] < time);
            let [[t0, s0], [t1, s1]] = [*self.course.get(k.checked_sub(1)?)?, *self.course.get(k)?];
            Some(s0 + (s1 - s0) * (time - t0) / (t1 - t0))
        };
        Some(at(to)? - at(from)?).filter(|seconds| *seconds > 0.0)
    }
}

fn late(course: &[[f64; 2]]) -> Option<f64> {
    let ([t0, s0], [t1, s1]) = (course[3 * course.len() / 4], *course.last()?);
    (t1 > t0).then(|| (s1 - s0) / (t1 - t0))
}

/// Counts spheres, or equivalent cost.
fn members(shape: &Shape) -> usize {
    if shape.dilated() { POLYHEDRON } else { shape.query(|s| s.sphere_count()).max(1) }
}

fn unbroken(mut numbers: Vec<usize>, bonds: &[BondInput], count: usize) -> Vec<usize> {
    let mut kept = vec![false; count];
    numbers.iter().for_each(|&b| kept[b] = true);
    let mut changed = !bonds.is_empty();
    while changed {
        changed = false;
        for bond in bonds {
            if kept[bond.a] != kept[bond.b] {
                (kept[bond.a], kept[bond.b], changed) = (false, false, true);
            }
        }
    }
    numbers.retain(|&b| kept[b]);
    numbers
}

fn among(numbers: &[usize], bonds: &[BondInput], count: usize) -> Vec<BondInput> {
    let mut place = vec![None; count];
    numbers.iter().enumerate().for_each(|(at, &b)| place[b] = Some(at));
    let renamed = |bond: &BondInput| Some(BondInput { a: place[bond.a]?, b: place[bond.b]?, ..*bond });
    bonds.iter().filter_map(renamed).collect()
}

/// Grains in a central square, enclosing planes, and fraction of contacts kept.
fn cut(input: &ModelInput, all: usize) -> (Vec<usize>, Vec<Plane>, f64) {
    let numbers: Vec<usize> = (0..input.bodies.len()).filter(|&b| !input.bodies[b].absent).collect();
    if all <= WHOLE {
        return (numbers, Vec::new(), 1.0);
    }
    let there: Vec<&BodyInput> = numbers.iter().map(|&b| &input.bodies[b]).collect();
    let reach = |b: &BodyInput| b.scale * input.shapes[b.shape].query(|s| s.bounding_radius());
    let ends = |d: usize| {
        let x = there.iter().map(|b| b.position[d]);
        x.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    };
    let ends = [ends(0), ends(1)];
    let middle = ends.map(|[low, high]| 0.5 * (low + high));
    let sides = ends.map(|[low, high]| high - low);
    // A narrow bed keeps its width.
    let area = sides[0] * sides[1] * SPHERES as f64 / all as f64;
    let narrow = sides[0].min(sides[1]);
    let largest = there.iter().map(|b| reach(b)).fold(0.0, f64::max);
    let side = if narrow * narrow < area { area / narrow } else { area.sqrt() } + 2.0 * largest;
    let within = |b: &BodyInput| (0..2).all(|d| (b.position[d] - middle[d]).abs() + reach(b) <= 0.5 * side);
    let inside = numbers.iter().copied().filter(|&b| within(&input.bodies[b])).collect();
    let plane = |d: usize, sign: f64| {
        let (mut point, mut normal) = (Vec3::new(middle[0], middle[1], 0.0), Vec3::zeros());
        point[d] += sign * 0.5 * side;
        normal[d] = -sign;
        Plane { point, normal, material: 0, velocity: Vec3::zeros() }
    };
    let mean = there.iter().map(|b| 2.0 * reach(b)).sum::<f64>() / there.len() as f64;
    let full = 1.0 - 2.0 / 3.0 * (mean / side).min(1.0);
    (inside, [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)].map(|(d, sign)| plane(d, sign)).to_vec(), full)
}

fn smooth(input: &mut ModelInput, count: usize) {
    let of = input.bodies.first().map_or(0, |b| b.material);
    input.materials.push(input.materials[of].with_friction(0.0));
    let (material, first) = (input.materials.len() - 1, input.planes.len() - count);
    input.planes[first..].iter_mut().for_each(|plane| plane.material = material);
}

fn step(
    model: &dem::Model,
    state: &mut dem::State,
    work: &mut dem::Work,
    surface: Option<&SolidSurface>,
) -> Result<(), dem::StepError> {
    dem::stability::follow(model, state);
    match surface {
        Some(s) => work.step(model, state, s, &[]),
        None => work.step(model, state, &dem::surface::NoSurface, &[]),
    }
}

/// Seconds per simulated second at rest: final, and overall.
///
/// # Errors
/// No stable time step.
fn paces(
    input: ModelInput,
    surface: Option<&SolidSurface>,
    budget: Duration,
) -> Result<(f64, f64), Box<dyn Error>> {
    let model = dem::Model::new(input)?;
    let (mut state, begun, clock) = (dem::State::new(&model), Instant::now(), Clock::start(1));
    let mut work = dem::Work::new(&model, &state);
    let mut looks = vec![(0.0, 0.0)];
    // New friction and stiffness cause motion and short steps.
    while looks.len() < 2 || (state.time < AT_REST && begun.elapsed() < budget) {
        for _ in 0..STRIDE {
            step(&model, &mut state, &mut work, surface)?;
        }
        looks.push((state.time, clock.seconds()));
    }
    let (middle, end) = (looks[(looks.len() - 1) / 2], looks[looks.len() - 1]);
    Ok(((end.1 - middle.1) / (end.0 - middle.0), end.1 / end.0))
}
