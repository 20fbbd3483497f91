//! Inlets and outlets with balances.
//!
//! The inserted amount never exceeds rate × (t − start) and lags by less than one grain, unless no position
//! or queued grain is free. The backlog is inserted at twice the rate.

mod record;

pub use record::{Amount, FlowRecord, InletRecord, OutletRecord};

use super::checkpoint::{Body, Loaded};
use super::system::{GrainsView, System};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::io;
use trackbed_dem as dem;
use trackbed_dem::flow::Arrival;
use trackbed_dem::insert::free_space::{FreePositions, FreeSpace};
use trackbed_dem::measure::BoxRegion;
use trackbed_input::model::grains::{FlowPlan, GrainsPart, InletPlan, OutletPlan, OutletRegion};
use trackbed_io::failure::Failure;

/// Insertion rate over requested rate during a backlog.
const CATCH_UP: f64 = 2.0;
/// Rounding tolerance in grains.
const SLACK: f64 = 1e-9;

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Inlet {
    waiting: VecDeque<u32>,
    places: FreePositions,
    /// Requested and inserted amounts.
    allowed: f64,
    given: f64,
    amount: Amount,
    full: u64,
    empty: u64,
}

#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct Outlet {
    amount: Amount,
    missed: u64,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Course {
    start: Amount,
    inlets: Vec<Inlet>,
    outlets: Vec<Outlet>,
    /// Time, mass in, mass out at half time.
    half: Option<[f64; 3]>,
}

/// Inlets and outlets in progress.
pub struct Flow<'a> {
    plan: &'a FlowPlan,
    /// Other parts are sleepers.
    groups: u32,
    every: u64,
    window: f64,
    end: f64,
    /// Mean grain in units of the rate.
    usual: Vec<f64>,
    course: Course,
}

impl<'a> Flow<'a> {
    /// Creates inlets and outlets, if any, for a main stage of `end` [s].
    pub fn new(
        part: Option<&'a GrainsPart>,
        view: Option<GrainsView<'_>>,
        window: f64,
        end: f64,
    ) -> Option<Self> {
        let (part, view) = (part?, view?);
        let plan = part.flow.as_ref()?;
        let waiting = |inlet: &InletPlan| {
            let waits =
                |b: &u32| !view.state.present(*b as usize) && view.model.part(*b as usize) == inlet.part;
            Inlet {
                waiting: (0..view.model.body_count() as u32).filter(waits).collect(),
                places: FreePositions::new(inlet.seed),
                allowed: 0.0,
                given: 0.0,
                amount: Amount::default(),
                full: 0,
                empty: 0,
            }
        };
        let usual = |inlet: &InletPlan| {
            let own = (0..view.model.body_count()).filter(|&b| view.model.part(b) == inlet.part);
            let masses: Vec<f64> = own.map(|b| view.model.mass(b)).collect();
            inlet.rate.of(masses.iter().sum::<f64>() / masses.len().max(1) as f64)
        };
        let mut flow = Flow {
            plan,
            groups: part.groups.first_shape.len() as u32,
            every: ((plan.interval / window).round() as u64).max(1),
            window,
            end,
            usual: plan.inlets.iter().map(usual).collect(),
            course: Course {
                start: Amount::default(),
                inlets: plan.inlets.iter().map(waiting).collect(),
                outlets: vec![Outlet::default(); plan.outlets.len()],
                half: None,
            },
        };
        flow.course.start = flow.present(view);
        Some(flow)
    }

    /// Restores from a checkpoint.
    ///
    /// # Errors
    /// Checkpoint with other content.
    pub fn resume(self, loaded: &mut Loaded) -> Result<Self, Failure> {
        Ok(Flow { course: loaded.take()?, ..self })
    }

    /// Saves the state for [`Flow::resume`].
    ///
    /// # Errors
    /// I/O errors.
    pub fn save(&self, body: &mut Body<'_>) -> io::Result<()> {
        body.put(&self.course)
    }

    /// Returns the present grains.
    pub fn present(&self, view: GrainsView<'_>) -> Amount {
        let mut sum = Amount::default();
        let there = |b: &usize| view.state.present(*b) && view.model.part(*b) < self.groups;
        (0..view.model.body_count()).filter(there).for_each(|b| sum.add(view.model.mass(b)));
        sum
    }

    /// Inserts and removes grains after window `k` at `time` [s].
    ///
    /// # Errors
    /// Failed insertion or removal.
    pub fn follow<S: System>(&mut self, k: u64, time: f64, system: &mut S) -> Result<(), Failure> {
        if !k.is_multiple_of(self.every) {
            return Ok(());
        }
        let Some(view) = system.grains() else { return Ok(()) };
        let leave = self.leaving(view);
        let arrive = self.arriving(time, view, system.surface(), &leave);
        if !leave.is_empty() || !arrive.is_empty() {
            system.exchange(&leave, &arrive)?;
        }
        if self.course.half.is_none() && 2.0 * time >= self.end {
            let [come, gone] = self.sums();
            self.course.half = Some([time, come.mass, gone.mass]);
        }
        Ok(())
    }

    fn leaving(&mut self, view: GrainsView<'_>) -> Vec<usize> {
        let GrainsView { model, state } = view;
        let interval = self.every as f64 * self.window;
        let mut leave = Vec::new();
        for b in (0..model.body_count()).filter(|&b| state.present(b)) {
            let (part, x) = (model.part(b), model.wrap(&state.position(b)));
            for (plan, outlet) in self.plan.outlets.iter().zip(&mut self.course.outlets) {
                if !plan.parts.contains(&part) {
                    continue;
                }
                if plan.region.holds(&x) {
                    outlet.amount.add(model.mass(b));
                    leave.push(b);
                    if plan.recycle
                        && let Some(k) = self.plan.inlets.iter().position(|i| i.part == part)
                    {
                        self.course.inlets[k].waiting.push_back(b as u32);
                    }
                    break;
                }
                if let OutletRegion::Box(region) = &plan.region {
                    outlet.missed += u64::from(flown_through(region, &x, &(state.velocity(b) * interval)));
                }
            }
        }
        leave
    }

    fn arriving(
        &mut self,
        time: f64,
        view: GrainsView<'_>,
        surface: &dyn dem::surface::Surface,
        leave: &[usize],
    ) -> Vec<Arrival> {
        let GrainsView { model, state } = view;
        let interval = self.every as f64 * self.window;
        let mut arrive: Vec<Arrival> = Vec::new();
        // Sorted, as found.
        let leaves = |b: usize| leave.binary_search(&b).is_ok();
        let inlets = self.plan.inlets.iter().zip(&mut self.course.inlets);
        for ((plan, inlet), &usual) in inlets.zip(&self.usual) {
            if time > plan.stop {
                continue;
            }
            let rate = plan.rate.value();
            let owed = rate * (time - plan.start).max(0.0);
            inlet.allowed = owed.min(inlet.allowed + CATCH_UP * rate * interval);
            let mut room = None;
            loop {
                let Some(&body) = inlet.waiting.front() else {
                    inlet.empty += u64::from(owed >= inlet.given + usual);
                    inlet.allowed = inlet.allowed.min(inlet.given + usual);
                    break;
                };
                let body = body as usize;
                let amount = plan.rate.of(model.mass(body));
                if inlet.given + (1.0 - SLACK) * amount > inlet.allowed {
                    break;
                }
                let room = room.get_or_insert_with(|| {
                    let largest = inlet.waiting.iter().map(|&b| model.radius(b as usize)).fold(0.0, f64::max);
                    let mut room = FreeSpace::new(model, state, surface, plan.region, largest, leaves);
                    arrive.iter().for_each(|a| room.fill(&a.position, model.radius(a.body)));
                    room
                });
                let Some((position, orientation)) = room.find_position(model.radius(body), &mut inlet.places)
                else {
                    inlet.full += 1;
                    // Without a free position, at most one grain is due.
                    inlet.allowed = inlet.allowed.min(inlet.given + amount);
                    break;
                };
                inlet.waiting.pop_front();
                inlet.given += amount;
                inlet.amount.add(model.mass(body));
                let (velocity, spin) = (plan.velocity, dem::Vec3::zeros());
                arrive.push(Arrival { body, position, orientation, velocity, spin });
            }
        }
        arrive
    }

    /// Returns total inflow and outflow.
    pub fn sums(&self) -> [Amount; 2] {
        let sum = |all: &mut dyn Iterator<Item = Amount>| {
            all.fold(Amount::default(), |s, a| Amount { grains: s.grains + a.grains, mass: s.mass + a.mass })
        };
        let course = &self.course;
        [sum(&mut course.inlets.iter().map(|i| i.amount)), sum(&mut course.outlets.iter().map(|o| o.amount))]
    }

    /// Returns results at `time` [s] and warnings.
    pub fn finish(&self, time: f64, view: GrainsView<'_>) -> (FlowRecord, Vec<String>) {
        let [come, gone] = self.sums();
        let over = |mass: f64, time: f64| if time > 0.0 { mass / time } else { 0.0 };
        let [half, half_in, half_out] = self.course.half.unwrap_or([time, come.mass, gone.mass]);
        let inlets: Vec<InletRecord> =
            self.plan.inlets.iter().zip(&self.course.inlets).map(|(p, i)| record(p, i, time)).collect();
        let outlets: Vec<OutletRecord> =
            self.plan.outlets.iter().zip(&self.course.outlets).map(outlet).collect();
        let interval = self.every as f64 * self.window;
        let remarks = outlets.iter().filter_map(|o| o.remark(interval));
        let warnings = inlets.iter().filter_map(InletRecord::remark).chain(remarks).collect();
        let record = FlowRecord {
            interval,
            at_start: self.course.start,
            at_end: self.present(view),
            inserted: come,
            removed: gone,
            energy_in: view.state.balance.work_flow,
            mean_rate_in: over(come.mass, time),
            mean_rate_out: over(gone.mass, time),
            later_rate_in: over(come.mass - half_in, time - half),
            later_rate_out: over(gone.mass - half_out, time - half),
            inlets,
            outlets,
        };
        (record, warnings)
    }
}

/// Whether displacement `way` crossed a box, if longer than its width.
fn flown_through(region: &BoxRegion, x: &dem::Vec3, way: &dem::Vec3) -> bool {
    if way.norm() < (region.high - region.low).min() {
        return false;
    }
    // Path fractions between each pair of sides.
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for d in 0..3 {
        let (a, b) = ((x[d] - region.low[d]) / way[d], (x[d] - region.high[d]) / way[d]);
        if way[d] == 0.0 {
            if x[d] < region.low[d] || x[d] > region.high[d] {
                return false;
            }
        } else {
            (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
        }
    }
    from < to
}

fn record(plan: &InletPlan, inlet: &Inlet, time: f64) -> InletRecord {
    let requested = plan.rate.value() * (time.min(plan.stop) - plan.start).max(0.0);
    InletRecord {
        group: plan.group.clone(),
        amount: inlet.amount,
        unit: plan.rate.unit(),
        requested,
        backlog: requested - inlet.given,
        queued: inlet.waiting.len(),
        without_free_position: inlet.full,
        without_grains: inlet.empty,
    }
}

fn outlet((plan, outlet): (&OutletPlan, &Outlet)) -> OutletRecord {
    OutletRecord { name: plan.name.clone(), amount: outlet.amount, missed: outlet.missed }
}
