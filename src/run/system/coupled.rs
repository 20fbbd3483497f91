//! Grains on a solid.

use super::{Applied, GrainsView, SolidView, System};
use crate::checkpoint::Body;
use crate::device::{Steps, failed};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::io;
use trackbed_coupling as coupling;
use trackbed_coupling::energy_balance::{StoredEnergy, WorkAndDissipation};
use trackbed_dem as dem;
use trackbed_dem::BackEnd;
use trackbed_fem as fem;
use trackbed_input::model::solid::SleeperBodies;
use trackbed_io::failure::Failure;
use trackbed_track::{CyclicLoad, MeshedSleeper, TrackSystem};

/// Meshed sleepers in a running system.
pub struct Meshed<'a> {
    /// Sleeper nodes.
    pub bodies: &'a SleeperBodies,
    /// Base heights when set down [m].
    pub bases: Vec<f64>,
    /// Seat load.
    pub load: Option<&'a CyclicLoad>,
    /// First sleeper face in the surface.
    pub first_face: usize,
    /// Seat load work [J].
    pub work: f64,
}

impl Meshed<'_> {
    fn add_load(&self, t: f64, load: &mut [f64]) {
        let Some(cycles) = self.load else { return };
        (0..self.bodies.count()).for_each(|k| self.bodies.add_load(k, cycles.on(k, t), load));
    }

    /// Work of seat forces at time `t` [J].
    fn work_at(&self, t: f64, u: &[f64]) -> f64 {
        let on = |k: usize| self.load.map_or(0.0, |l| l.on(k, t));
        (0..self.bodies.count()).map(|k| -on(k) * self.bodies.rise_of_seats(k, u)).sum()
    }
}

/// Grains on a solid.
pub struct CoupledSystem<'a> {
    /// Coupled model.
    pub model: coupling::step::Model<'a>,
    /// Coupled state.
    pub state: coupling::step::State,
    /// Scratch memory and factors.
    pub work: coupling::step::Work<Steps>,
    /// Whether grains must be uploaded to a device.
    pub changed: bool,
    /// Last window division [s], the period of contact impulses.
    pub last_window: f64,
    /// Whether windows may be divided.
    pub automatic: bool,
    /// Loads on the solid.
    pub loads: &'a [trackbed_input::model::solid::NodalLoad],
    /// Ground faces.
    pub ground_faces: usize,
    /// Meshed sleepers.
    pub seats: Option<Meshed<'a>>,
}

impl CoupledSystem<'_> {
    fn part_of_window(&mut self, applied: Applied<'_>) -> Result<(), Failure> {
        let (loads, seats) = (self.loads, self.seats.as_ref());
        let solid_load = |t: f64, load: &mut [f64]| {
            loads.iter().for_each(|l| l.add(t, load));
            seats.iter().for_each(|s| s.add_load(t, load));
        };
        // Loads are evaluated at mid-window.
        let middle = self.state.solid.time + 0.5 * self.model.window();
        let before = seats.map_or(0.0, |s| s.work_at(middle, &self.state.solid.u));
        let model = &self.model;
        let apply = |t: f64, s: &dem::State, out: &mut Vec<dem::AppliedForce>| {
            applied(t, &model.grains, s, out);
        };
        coupling::step::step(model, &mut self.state, &mut self.work, apply, solid_load)
            .map_err(|e| Failure::Numerical(model.grains.name_objects(&e)))?;
        if let Some(seats) = &mut self.seats {
            seats.work += seats.work_at(middle, &self.state.solid.u) - before;
        }
        Ok(())
    }

    fn put(
        &self,
        memory: Option<fem::nonlinear::SolverState>,
        seat_work: f64,
        body: &mut Body<'_>,
    ) -> io::Result<()> {
        let reference = Cow::Borrowed(&self.model.reference[..]);
        let state = if self.work.reduction().is_some() {
            let mut whole = self.state.clone();
            self.work.recover(&mut whole.solid);
            Cow::Owned(whole)
        } else {
            Cow::Borrowed(&self.state)
        };
        body.put(&SavedCoupling { reference, memory, state, seat_work })
    }
}

/// Checkpoint of the system.
#[derive(Serialize, Deserialize)]
pub struct SavedCoupling<'a> {
    /// Displacement from which strain energy counts [m]. Shape `[3·nodes]`.
    pub reference: Cow<'a, [f64]>,
    /// Of an elastoplastic solver; none at the end of a run.
    pub memory: Option<fem::nonlinear::SolverState>,
    /// Grains, solid and interface.
    pub state: Cow<'a, coupling::step::State>,
    /// Work of seat loads [J].
    pub seat_work: f64,
}

impl TrackSystem for CoupledSystem<'_> {
    fn window(&self) -> f64 {
        self.model.grains.dt() * f64::from(self.model.substeps)
    }

    fn grains(&self) -> Option<GrainsView<'_>> {
        Some(GrainsView { model: &self.model.grains, state: &self.state.grains })
    }

    fn meshed_sleeper(&self, k: usize) -> Option<MeshedSleeper> {
        let s = self.seats.as_ref()?;
        let (moved, [x, y, z]) = (s.bodies.moved(k, &self.state.solid.u), s.bodies.centre(k, s.bases[k]));
        let faces = s.bodies.face_count();
        let first = s.first_face + k * faces;
        Some(MeshedSleeper {
            place: [x + moved.translation[0], y + moved.translation[1], z + moved.translation[2]],
            height: z + moved.seats,
            moved,
            contact: self.work.contact_force_on(first..first + faces, self.last_window),
        })
    }

    fn relocate(&mut self, moves: &[(usize, dem::Vec3, nalgebra::UnitQuaternion<f64>)]) {
        let grains = &mut self.state.grains;
        moves.iter().for_each(|(body, shift, turn)| grains.shift(&self.model.grains, *body, shift, turn));
        grains.request_search();
        self.changed = true;
    }
}

impl System for CoupledSystem<'_> {
    fn steps_done(&self, windows: u64) -> (u64, u64) {
        (self.state.grains.steps_done(), windows)
    }

    fn advance(&mut self, applied: Applied<'_>) -> Result<(), Failure> {
        // CPU steps use the state directly.
        if std::mem::take(&mut self.changed) && self.work.grains.elsewhere() {
            self.work
                .grains
                .upload(&self.model.grains, &self.state.grains)
                .map_err(failed(&self.model.grains))?;
        }
        // Applies from the next window.
        self.last_window = self.model.window();
        for _ in 0..self.model.division {
            self.part_of_window(applied)?;
        }
        coupling::step::check_interface(&mut self.model, &mut self.state, &mut self.work, self.automatic)
            .map_err(|e| Failure::Numerical(format!("solid in subdivided coupling windows: {e}")))
    }

    fn save(&self, body: &mut Body<'_>) -> io::Result<()> {
        let seat_work = self.seats.as_ref().map_or(0.0, |s| s.work);
        self.put(self.work.solver_state(), seat_work, body)
    }

    fn save_end(&self, body: &mut Body<'_>) -> io::Result<()> {
        self.put(None, 0.0, body)
    }

    fn exchange(&mut self, leave: &[usize], arrive: &[dem::flow::Arrival]) -> Result<(), Failure> {
        coupling::step::exchange(&self.model, &mut self.state, &mut self.work, leave, arrive)
            .map_err(|e| Failure::Numerical(self.model.grains.name_objects(&e)))
    }

    fn surface(&self) -> &dyn dem::surface::Surface {
        &self.work.surface
    }

    fn stored(&self) -> StoredEnergy {
        self.work.stored_energy(&self.model, &self.state)
    }

    fn recover(&mut self) {
        self.work.recover(&mut self.state.solid);
    }

    fn examine(&mut self) -> Result<(), Failure> {
        self.work
            .find_reduction_error(&self.model, &mut self.state)
            .map_err(|e| Failure::Numerical(format!("error of the reduced solid: {e}")))
    }

    fn spent(&self) -> WorkAndDissipation {
        coupling::step::work_and_dissipation(&self.state)
    }

    fn solid(&self) -> Option<SolidView<'_>> {
        Some(SolidView { model: self.model.solid, state: &self.state.solid })
    }

    fn contact_force(&self) -> [f64; 3] {
        self.work.contact_force_on(0..self.ground_faces, self.last_window)
    }

    fn peak_pressure(&self) -> f64 {
        self.work.peak_pressure_on(0..self.ground_faces, self.last_window)
    }

    fn seat_work(&self) -> f64 {
        match &self.seats {
            Some(seats) => seats.work,
            None => self.state.grains.balance.work_applied,
        }
    }
}
