//! Device back end: transfers of state, and the sequence of kernels of a step.

use super::arrays::{DeviceHistory, Lists};
use super::block_totals;
use super::bodies::{Constants, Motion, Spheres};
use super::cpu_forces::CpuForces;
use super::layout::{Count, Features, HELD_WIDTH, List, Number, Slot};
use super::machine::{Call, Machine};
use super::supported::{self, Unsupported};
use super::text;
use super::walls::{Triangles, placed};
use crate::base::error::StepError;
use crate::bodies::table::BodyKind;
use crate::contact::planes;
use crate::engine::back_end::BackEnd;
use crate::engine::broad_phase::Listed;
use crate::engine::input::AppliedForce;
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::engine::work::Work;
use crate::engine::{bonds, cpu_part, neighbour_list, reordering, step};
use crate::spatial::surface::{Surface, SurfaceContact};

/// Returns the source of the kernels for a model, valid as C and CUDA.
///
/// # Errors
/// [`Unsupported`] for the first unsupported feature.
pub fn source(model: &Model) -> Result<String, Unsupported> {
    supported::check(model)?;
    Ok(text::text(&model.laws, &text::features(model)))
}

/// Steps on a device. A state stepped on it is complete only after [`BackEnd::download`].
pub struct Device<M> {
    pub(super) machine: M,
    /// For the CPU's search and its own steps.
    pub(super) work: Work,
    pub(super) call: Call,
    pub(super) features: Features,
    pub(super) spheres: Spheres,
    books: Vec<f64>,
    mass: Vec<f64>,
    planes: Vec<[f64; 4]>,
    walls: Vec<f64>,
    /// Whether the device state is newer than the host state.
    pub(super) ahead: bool,
    /// Neighbours found on the device, not in state or `work`.
    pub(super) found: bool,
    /// Contacts, sphere and plane contacts (first), sphere–triangle pairs, bonds.
    pub(super) contacts: usize,
    pub(super) among_spheres: usize,
    pub(super) pairs: usize,
    bonds: usize,
    pub(super) held_since: Option<u64>,
    /// Whether the engine must make the next step.
    pub(super) overflowed: bool,
    pub(super) handed: CpuForces,
}

const PAIRS: [(Slot, Slot); 11] = [
    (Slot::OldX, Slot::NewX),
    (Slot::OldV, Slot::NewV),
    (Slot::OldW, Slot::NewW),
    (Slot::OldMemory, Slot::NewMemory),
    (Slot::OldTurn, Slot::NewTurn),
    (Slot::OldBonds, Slot::NewBonds),
    (Slot::OldSpheres, Slot::NewSpheres),
    (Slot::OldOrientation, Slot::NewOrientation),
    (Slot::OldMomentum, Slot::NewMomentum),
    (Slot::OldSpare, Slot::NewSpare),
    (Slot::OldTouch, Slot::NewTouch),
];

impl<M: Machine> Device<M> {
    /// Uploads a state. `machine` holds the kernels of the model's [`source`].
    ///
    /// # Errors
    /// Device out of memory or not responding.
    pub fn new(machine: M, model: &Model, state: &State) -> Result<Device<M>, StepError> {
        let work = Work::new(model, state);
        let mut call = Call::new();
        let materials = model.laws.materials();
        let g = model.gravity;
        call.number(Number::GravityX, g.x);
        call.number(Number::GravityY, g.y);
        call.number(Number::GravityZ, g.z);
        call.number(Number::Damping, model.damping);
        call.count(Count::Materials, materials as usize);
        let features = text::features(model);
        let mut device = Device {
            machine,
            work,
            call,
            features,
            spheres: Spheres::default(),
            books: Vec::new(),
            mass: Vec::new(),
            planes: Vec::new(),
            walls: Vec::new(),
            ahead: false,
            found: false,
            contacts: 0,
            among_spheres: 0,
            held_since: None,
            pairs: 0,
            bonds: 0,
            overflowed: false,
            // Bond breakage and too many triangle contacts repeat a step on the CPU.
            handed: CpuForces::new(features.bonds || features.walls > 0),
        };
        let law = text::law_constants(&model.laws, materials);
        let Triangles { shapes, names } =
            if device.features.walls > 0 { Triangles::of(model) } else { Triangles::default() };
        let constants = device
            .put(Slot::Law, &law)
            .and_then(|()| device.put(Slot::Shapes, shapes.as_flattened()))
            .and_then(|()| device.put_counts(Slot::Patches, names.as_flattened()));
        constants.map_err(|e| failed(state, e))?;
        device.take_over(model, state).map_err(|e| failed(state, e))?;
        Ok(device)
    }

    /// Machine that runs the kernels.
    pub fn machine(&self) -> &M {
        &self.machine
    }

    /// Returns the numbers of searches and of neighbour-list rebuilds.
    pub fn rebuilds(&self) -> (u64, u64) {
        self.work.rebuilds()
    }

    pub(super) fn buffer(&self, slot: Slot) -> usize {
        self.call.buffer(slot)
    }

    pub(super) fn put(&mut self, slot: Slot, numbers: &[f64]) -> Result<(), String> {
        self.machine.put(self.call.buffers[slot as usize], numbers)
    }

    pub(super) fn put_counts(&mut self, slot: Slot, counts: &[u32]) -> Result<(), String> {
        self.machine.put_counts(self.call.buffers[slot as usize], counts)
    }

    pub(super) fn get(&mut self, slot: Slot, from: usize, numbers: &mut [f64]) -> Result<(), String> {
        self.machine.get(self.call.buffers[slot as usize], from, numbers)
    }

    pub(super) fn get_kept(&mut self, memory: &mut DeviceHistory) -> Result<(), String> {
        let kept = &mut memory.kept;
        self.get(Slot::OldSpare, 0, &mut kept.spare)?;
        self.get(Slot::OldTouch, 0, kept.touch.as_flattened_mut().as_flattened_mut())
    }

    pub(super) fn reserve(&mut self, slot: Slot, numbers: usize) -> Result<(), String> {
        self.machine.reserve(self.call.buffers[slot as usize], numbers)
    }

    fn take_over(&mut self, model: &Model, state: &State) -> Result<(), String> {
        let motion = Motion::of(state, self.features.clumps);
        let n = motion.x.len();
        self.call.count(Count::Bodies, n);
        self.call.count(Count::Blocks, state.blocks.len());
        for (slot, list) in [(Slot::OldX, &motion.x), (Slot::OldV, &motion.v), (Slot::OldW, &motion.w)] {
            self.put(slot, list.as_flattened())?;
        }
        for slot in [Slot::NewX, Slot::NewV, Slot::NewW] {
            self.reserve(slot, 4 * n)?;
        }
        self.reserve(Slot::Speed2, n)?;
        let booked = self.features.quantities() * state.blocks.len() + 1;
        self.reserve(Slot::Books, booked)?;
        self.books.resize(booked, 0.0);
        self.mass = self.work.members.iter().map(|m| m.mass_sum).collect();
        self.reserve(Slot::HeldBy, if self.features.held { HELD_WIDTH * n } else { 0 })?;
        self.put_counts(Slot::Flags, &[0])?;
        let constants = Constants::of(model, state, &self.work);
        self.put_counts(Slot::Single, &constants.how)?;
        self.put_counts(Slot::FirstSingle, &constants.first_single)?;
        self.put(Slot::Constants, constants.inertia.as_flattened())?;
        self.put(Slot::Mass, &constants.mass)?;
        self.spheres = Spheres::of(model, state, &self.work);
        if self.features.clumps {
            self.take_clumps(&motion, &constants)?;
        }
        let blocks = state.blocks.iter().enumerate();
        let blocks: Vec<u32> =
            blocks.flat_map(|(b, block)| block.bodies.iter().map(move |_| b as u32)).collect();
        self.put_counts(Slot::Block, &blocks)?;
        self.take_lists(model, state)?;
        (self.ahead, self.found, self.held_since) = (false, false, None);
        Ok(())
    }

    fn take_clumps(&mut self, motion: &Motion, constants: &Constants) -> Result<(), String> {
        let spheres = std::mem::take(&mut self.spheres);
        let numbers: [(Slot, &[[f64; 4]]); 6] = [
            (Slot::OldOrientation, &motion.orientation),
            (Slot::OldMomentum, &motion.momentum),
            (Slot::Moments, &constants.moments),
            (Slot::Target, &constants.target),
            (Slot::OldSpheres, &spheres.world),
            (Slot::Local, &spheres.local),
        ];
        for (slot, list) in numbers {
            self.put(slot, list.as_flattened())?;
        }
        self.put_counts(Slot::FirstSphere, &spheres.first)?;
        self.put_counts(Slot::Owner, &spheres.owner)?;
        let (bodies, count) = (motion.x.len(), spheres.world.len());
        // Sphere positions exist only on the device from here.
        self.spheres = Spheres { local: Vec::new(), world: Vec::new(), ..spheres };
        for (slot, count) in
            [(Slot::NewOrientation, bodies), (Slot::NewMomentum, bodies), (Slot::NewSpheres, count)]
        {
            self.reserve(slot, 4 * count)?;
        }
        Ok(())
    }

    fn take_lists(&mut self, model: &Model, state: &State) -> Result<(), String> {
        let lists = Lists::of(model, state, &self.work, &self.spheres, 0);
        let memory = DeviceHistory::of(model, state);
        let last = state.blocks.len();
        let bonds = lists.bond_ends.len();
        (self.bonds, self.overflowed) = (bonds, lists.pairs.overflowed);
        let planes = lists.from(List::Planes, 0);
        self.call.count(Count::FirstPlane, planes as usize);
        self.note_rest(&lists);
        let (count, pairs) = (self.contacts, self.pairs);
        let counts: [(Slot, &[u32]); 7] = [
            (Slot::Ends, lists.ends.as_flattened()),
            (Slot::Start, &lists.start),
            (Slot::Entries, lists.entries.as_flattened()),
            (Slot::Ranges, lists.ranges.as_flattened()),
            (Slot::BondEnds, lists.bond_ends.as_flattened()),
            (Slot::PatchPairs, lists.pairs.ends.as_flattened()),
            (Slot::Groups, &lists.pairs.groups),
        ];
        for (slot, list) in counts {
            self.put_counts(slot, list)?;
        }
        self.put_counts(Slot::Offsets, &lists.offsets(&self.work, &self.spheres))?;
        let numbers: [(Slot, &[f64]); 8] = [
            (Slot::OldMemory, memory.spring.as_flattened()),
            (Slot::OldTurn, if self.features.roll { memory.turn.as_flattened() } else { &[] }),
            (Slot::OldBonds, memory.bonds.as_flattened()),
            (Slot::BondConstants, lists.bond_constants.as_flattened()),
            (Slot::Reference, &lists.reference),
            (Slot::Ways, lists.ways.as_flattened()),
            (Slot::OldSpare, &memory.kept.spare),
            (Slot::OldTouch, memory.kept.touch.as_flattened().as_flattened()),
        ];
        for (slot, list) in numbers {
            self.put(slot, list)?;
        }
        let with_planes = (lists.from(List::Planes, last) - planes) as usize;
        let room = [
            (Slot::NewMemory, 4 * count),
            (Slot::NewTurn, if self.features.roll { 4 * count } else { 0 }),
            (Slot::NewBonds, 8 * bonds),
            (Slot::Spent, 2 * count),
            (Slot::Walls, 8 * with_planes),
            (Slot::Power, bonds),
            (Slot::Couples, 4 * lists.ways.len()),
        ];
        room.into_iter().try_for_each(|(slot, numbers)| self.reserve(slot, numbers))?;
        self.room_for_pairs(pairs)?;
        self.assign_cpu_forces(lists)
    }

    pub(super) fn note_rest(&mut self, lists: &Lists) {
        self.among_spheres = lists.from(List::CrossDebonded, 0) as usize;
        self.pairs = lists.pairs.ends.len();
        self.contacts = lists.next() as usize + self.pairs;
        self.call.count(Count::FirstDebonded, self.among_spheres);
        self.call.count(Count::FirstImage, lists.from(List::Images, 0) as usize);
        self.call.count(Count::FirstPatch, lists.next() as usize);
    }

    pub(super) fn room_for_pairs(&mut self, pairs: usize) -> Result<(), String> {
        let room = [
            (Slot::NewSpare, pairs),
            (Slot::NewTouch, 12 * pairs),
            (Slot::Ended, pairs),
            (Slot::Action, 8 * pairs),
        ];
        room.into_iter().try_for_each(|(slot, numbers)| self.reserve(slot, numbers))
    }

    pub(super) fn assign_cpu_forces(&mut self, lists: Lists) -> Result<(), String> {
        if self.features.beside {
            let width = self.features.picked_width();
            let there = (&mut self.machine, &mut self.call);
            self.handed.take_over(there, width, lists.handed, lists.watched)?;
        }
        Ok(())
    }

    fn fetch(&mut self, model: &Model, state: &mut State) -> Result<(), StepError> {
        if self.ahead {
            self.bring_back(model, state, Listed::All).map_err(|e| failed(state, e))?;
            self.ahead = false;
        }
        Ok(())
    }

    /// Downloads the parts of `listed`.
    pub(super) fn bring_back(
        &mut self,
        model: &Model,
        state: &mut State,
        listed: Listed,
    ) -> Result<(), String> {
        if self.found || listed == Listed::Rest {
            self.name_contacts(state)?;
        }
        let n = state.blocks.iter().map(|b| b.bodies.len()).sum();
        let mut motion = Motion::zeros(n, self.features.clumps);
        let mut memory = DeviceHistory::zeros(model, self.contacts, self.pairs, self.bonds);
        let lists = [
            (Slot::OldX, &mut motion.x),
            (Slot::OldV, &mut motion.v),
            (Slot::OldW, &mut motion.w),
            (Slot::OldMemory, &mut memory.spring),
            (Slot::OldTurn, &mut memory.turn),
            (Slot::OldBonds, &mut memory.bonds),
        ];
        for (slot, list) in lists {
            if slot == Slot::OldTurn && !self.features.roll {
                continue;
            }
            self.get(slot, 0, list.as_flattened_mut())?;
        }
        self.get_kept(&mut memory)?;
        if self.features.clumps {
            let lists =
                [(Slot::OldOrientation, &mut motion.orientation), (Slot::OldMomentum, &mut motion.momentum)];
            for (slot, list) in lists {
                self.get(slot, 0, list.as_flattened_mut())?;
            }
        }
        motion.put(state, &mut self.work);
        match listed {
            Listed::All => memory.put(state),
            Listed::Rest => _ = memory.put_contacts(state),
        }
        Ok(())
    }

    /// Advances the state by one step; motion and contact history stay on the device.
    fn advance<S: Surface>(
        &mut self,
        model: &Model,
        state: &mut State,
        surface: &S,
        applied: &[AppliedForce],
    ) -> Result<(), StepError> {
        let new_order = state.steps > 0 && state.steps.is_multiple_of(reordering::EVERY);
        let solid = |k: usize| k < model.body_count() && model.body(k).kind == BodyKind::Solid;
        if new_order || !applied.iter().all(|a| solid(a.body)) {
            return self.by_processor(model, state, surface, applied);
        }
        let beside = self.features.beside;
        if beside || !surface.is_empty() {
            step::prepare(model, state, &mut self.work, surface, applied)?;
        }
        if neighbour_list::needs_rebuild(state) {
            self.overflowed |= self.list(model, state, surface).map_err(|e| failed(state, e))?;
        }
        if self.overflowed {
            return self.by_processor(model, state, surface, applied);
        }
        if beside {
            let there = (&mut self.machine, &self.call);
            let given = self.handed.hand_over(there, model, (state, &mut self.work), surface);
            given.map_err(|e| failed(state, e))?;
        }
        let failed_there = self.launch(model, state).map_err(|e| failed(state, e))?;
        if failed_there {
            // The device still has the previous step.
            self.ahead = true;
            let as_before = !beside || self.handed.restore(state);
            self.by_processor(model, state, surface, applied)?;
            let again = || failed(state, "a step failed on the GPU but not when repeated on the CPU".into());
            return if as_before { Ok(()) } else { Err(again()) };
        }
        self.exchange();
        self.ahead = true;
        if beside {
            cpu_part::motion(model, state, &mut self.work);
            let picked = self.handed.pick((&mut self.machine, &self.call), (state, &mut self.work));
            picked.map_err(|e| failed(state, e))?;
        }
        let all = block_totals::reduce_blocks(
            &self.books,
            &self.features,
            &self.mass,
            model,
            state,
            &mut self.work,
        );
        if bonds::checks_separation(state) {
            self.fetch(model, state)?;
        }
        step::finish_step(model, state, &mut self.work, all, surface.max_speed())
    }

    fn by_processor<S: Surface>(
        &mut self,
        model: &Model,
        state: &mut State,
        surface: &S,
        applied: &[AppliedForce],
    ) -> Result<(), StepError> {
        self.fetch(model, state)?;
        if self.found {
            self.work.follow(model, state);
        }
        step::step(model, state, &mut self.work, surface, applied)?;
        self.take_over(model, state).map_err(|e| failed(state, e))
    }

    /// Returns whether the step failed.
    fn launch(&mut self, model: &Model, state: &State) -> Result<bool, String> {
        planes::update_poses(&model.planes, &state.planes, &mut self.work.planes);
        let planes: Vec<[f64; 4]> = self.work.planes.iter().flat_map(|p| [p.face.0, p.motion.0]).collect();
        if planes != self.planes {
            self.put(Slot::Planes, planes.as_flattened())?;
            self.planes = planes;
        }
        if self.features.walls > 0 {
            let walls = placed(model, state).into_flattened();
            if walls != self.walls {
                self.put(Slot::WallNow, &walls)?;
                self.walls = walls;
            }
            self.call.number(Number::Gone, state.max_travel + state.wall_travel);
        }
        let step_size = state.step_size;
        self.call.number(Number::Step, step_size.kick());
        self.call.number(Number::Way, step_size.dt);
        let bonds = bonds::parts(model, step_size.last, state.bonds.fresh);
        self.call.number(Number::Last, bonds.dt);
        self.call.number(Number::Since, bonds.since());
        self.call.number(Number::Bound, 0.5 * model.radii.0 / step_size.dt);
        self.machine.launch("bodies", state.present_count(), &self.call)?;
        self.machine.launch("books", 4 * (self.books.len() - 1) + 1, &self.call)?;
        let books = self.buffer(Slot::Books);
        self.machine.get(books, 0, &mut self.books)?;
        Ok(self.books.last() != Some(&0.0))
    }

    fn exchange(&mut self) {
        for (old, new) in PAIRS {
            self.call.buffers.swap(old as usize, new as usize);
        }
    }
}

impl<M: Machine> BackEnd for Device<M> {
    fn upload(&mut self, model: &Model, state: &State) -> Result<(), StepError> {
        self.work.follow(model, state);
        self.take_over(model, state).map_err(|e| failed(state, e))
    }

    fn step<S: Surface>(
        &mut self,
        model: &Model,
        state: &mut State,
        surface: &S,
        applied: &[AppliedForce],
    ) -> Result<(), StepError> {
        self.advance(model, state, surface, applied)
    }

    fn download(&mut self, model: &Model, state: &mut State) -> Result<(), StepError> {
        self.fetch(model, state)
    }

    fn surface_contacts(&self) -> &[SurfaceContact] {
        self.work.surface_contacts()
    }
}

fn failed(state: &State, problem: String) -> StepError {
    StepError::Device { time: state.time, problem }
}
