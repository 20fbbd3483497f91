//! Scratch of the step: never saved, made anew from a state at any time without changing a bit of what follows.

use crate::Vec3;
use crate::bond::pass::{BondWork, ListWork};
use crate::bond::{self, Held};
use crate::contact::hits::Hit;
use crate::contact::patches::Touch;
use crate::contact::planes::PlaneNow;
use crate::error::Partner;
use crate::lanes::Simd;
use crate::ledger::Ledger;
use crate::model::{Kind, Model, for_members};
use crate::search::near::Merging;
use crate::search::patches::Candidate;
use crate::state::{ImageName, Lanes, PatchContact, PatchPair, State, xyz};
use crate::surface::SurfaceContact;
use crate::wall::advance::WallSum;
use std::sync::Mutex;

/// Sum of the contact forces on a body, and of the torques about its centre; the fourth numbers are zero.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub(crate) struct Sums(pub [Lanes; 2]);

impl Sums {
    #[inline(always)]
    pub fn force(&self) -> &Lanes {
        &self.0[0]
    }

    #[inline(always)]
    pub fn torque(&self) -> &Lanes {
        &self.0[1]
    }

    #[inline(always)]
    pub fn both(&mut self) -> (&mut Lanes, &mut Lanes) {
        let [force, torque] = &mut self.0;
        (force, torque)
    }
}

/// One body's share in a slot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gather {
    pub place: u32,
    pub block: u32,
    /// Twice the slot's number, and one for the second partner.
    slot: u32,
}

impl Gather {
    pub fn new(place: u32, block: u32, slot: u32, first: bool) -> Gather {
        Gather { place, block, slot: 2 * slot + u32::from(!first) }
    }

    /// The slot, and whether the body is the first partner.
    #[inline(always)]
    pub fn slot(&self) -> (usize, bool) {
        ((self.slot >> 1) as usize, self.slot & 1 == 0)
    }
}

/// Where spheres were, to single precision from one of them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reference {
    origin: Vec3,
    offsets: Vec<[f32; 3]>,
    /// Bound on the error of an offset [m].
    error: f64,
}

impl Reference {
    pub fn start(&mut self, origin: Option<&Lanes>) {
        *self = Reference { origin: origin.map(xyz).unwrap_or_default(), ..Reference::default() };
    }

    pub fn push(&mut self, x: &Vec3) {
        let offset = x - self.origin;
        // Half a unit in the last place of each component, and room for the three together.
        self.error = self.error.max(1.1e-7 * offset.amax());
        self.offsets.push([offset.x as f32, offset.y as f32, offset.z as f32]);
    }

    pub fn len(&self) -> usize {
        self.offsets.len()
    }

    /// A bound from above on the square of the way from the k-th place.
    #[inline(always)]
    pub fn moved2(&self, k: usize, x: &Vec3) -> f64 {
        let [a, b, c] = self.offsets[k].map(f64::from);
        let way = (x - self.origin - Vec3::new(a, b, c)).norm() + self.error;
        way * way
    }
}

/// Buffers handed out to blocks in progress.
#[derive(Debug)]
pub(crate) struct Buffers<T>(Mutex<Vec<T>>);

impl<T> Default for Buffers<T> {
    fn default() -> Buffers<T> {
        Buffers(Mutex::new(Vec::new()))
    }
}

impl<T> Clone for Buffers<T> {
    fn clone(&self) -> Buffers<T> {
        Buffers::default()
    }
}

impl<T: Default> Buffers<T> {
    pub fn take(&self) -> T {
        self.0.lock().map(|mut b| b.pop()).ok().flatten().unwrap_or_default()
    }

    /// Frees them.
    pub fn clear(&self) {
        if let Ok(mut buffers) = self.0.lock() {
            *buffers = Vec::new();
        }
    }

    pub fn give_back(&self, buffer: T) {
        if let Ok(mut buffers) = self.0.lock() {
            buffers.push(buffer);
        }
    }
}

/// A failure that a block met; place is that of the body within the block.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Failure {
    Overlap { body: u32, partner: Partner, overlap: f64, bound: f64 },
    Speed { body: u32, speed: f64, bound: f64 },
    Wall { wall: u32, speed: f64, bound: f64 },
    Meeting { walls: [u32; 2] },
}

/// Contacts of a block with others: their forces, what they dissipated, and the first failure.
#[derive(Clone, Debug, Default)]
pub(crate) struct CrossWork {
    /// As many records per contact as [`Work::slot_width`] says: of the force on the first partner and the torques on
    /// both; or of single spheres the force and its lever on the first, the moment per lever and that on the second.
    pub slots: Vec<Lanes>,
    pub dashpot: f64,
    pub friction: f64,
    /// Angular impulse about the origin that contacts across periodic borders give in this step.
    pub couple: Vec3,
    pub failure: Option<Failure>,
}

/// Scratch of one block.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlockWork {
    // Constants of the bodies, in block order.
    /// Whether no body is a box.
    pub round: bool,
    pub mass_sum: f64,
    /// The material of all bodies, where there is only one.
    pub material: Option<u32>,
    /// Empty in scenes of single spheres only.
    pub kind: Vec<Kind>,
    pub inertia: Vec<Vec3>,
    pub reach: Vec<f64>,
    /// Empty where all motions are free.
    pub fixed: Vec<u8>,
    /// Half sides of boxes; empty in scenes without.
    pub half: Vec<Vec3>,
    /// First sphere of each body, and one past the last; empty in scenes of single spheres only.
    pub first: Vec<u32>,
    /// Number of spheres.
    pub count: usize,

    // Spheres (empty in scenes of single spheres only): place of the body, centre in the body frame and radius, and the same in the world.
    pub owner: Vec<u32>,
    pub local: Vec<Lanes>,
    pub spheres: Vec<Lanes>,

    // Candidates, valid while no sphere has moved further than the skin allows.
    pub reference: Reference,
    pub candidates: Vec<[u16; 2]>,
    pub cross: Vec<[u32; 3]>,
    pub boxed: Vec<[u32; 3]>,
    pub images: Vec<ImageName>,
    pub planes: Vec<[u32; 2]>,
    pub walls: Vec<Candidate>,
    pub surface: Vec<Candidate>,

    // The step.
    pub gather: Vec<Gather>,
    /// Empty between steps, unless they are to be kept.
    pub sums: Vec<Sums>,
    pub contacts: Vec<SurfaceContact>,
    pub ledger: Ledger,
    pub fastest: f64,
    pub failure: Option<Failure>,
    pub row: Vec<u32>,
    pub patches: Vec<PatchPair>,
    pub touches: Vec<Touch>,
    pub live: Vec<PatchContact>,
    pub hits: Vec<Hit>,
    /// What the block's spheres felt from each wall; empty in blocks near none.
    pub wall_sums: Vec<WallSum>,
    pub bonds: ListWork,
}

/// A force applied to a body in this step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Applied {
    pub block: u32,
    pub place: u32,
    pub force: Vec3,
    pub torque: Vec3,
}

/// The scratch. Build it with [`Work::new`] for one state; it follows that state from then on.
#[derive(Clone, Debug)]
pub struct Work {
    pub(crate) blocks: Vec<BlockWork>,
    pub(crate) cross: Vec<CrossWork>,
    /// Scratch of [`threads::through`](crate::threads::through).
    pub(crate) beyond: Vec<CrossWork>,
    pub(crate) bonds: BondWork,
    /// Pairs that are not for the ordinary contacts.
    pub(crate) held: Held,
    pub(crate) applied: Vec<Applied>,
    pub(crate) surface_contacts: Vec<SurfaceContact>,
    pub(crate) buffers: Buffers<Vec<Sums>>,
    pub(crate) merging: Buffers<Merging>,
    pub(crate) keep_forces: bool,
    pub(crate) slot_width: usize,
    /// Whether the candidates exist, and where walls were when they were found.
    pub(crate) listed: bool,
    pub(crate) wall_reference: Vec<Vec3>,
    pub(crate) wall_places: Vec<(Vec3, nalgebra::UnitQuaternion<f64>)>,
    pub(crate) surface_drift: f64,
    pub(crate) searches: u64,
    pub(crate) refreshes: u64,
    /// What the processor computes four lanes with.
    pub(crate) simd: Simd,
    pub(crate) planes: Vec<PlaneNow>,
    /// The material of all bodies and of all planes, where there is only one.
    pub(crate) material: Option<u32>,
    pub(crate) plane_material: Option<u32>,
    /// Whether blocks are shared among threads.
    pub(crate) parallel: bool,
}

/// What all are equal to, if they are.
fn common<T: Copy + PartialEq>(mut all: impl Iterator<Item = T>) -> Option<T> {
    let first = all.next()?;
    all.all(|x| x == first).then_some(first)
}

/// Spheres below which sharing the work costs more than it saves. Both ways give the same bits.
const PARALLEL: usize = 2500;

impl Work {
    /// Scratch for a state.
    pub fn new(model: &Model, state: &State) -> Work {
        let mut work = Work {
            blocks: Vec::new(),
            cross: Vec::new(),
            beyond: Vec::new(),
            bonds: BondWork::default(),
            held: Held::default(),
            applied: Vec::new(),
            surface_contacts: Vec::new(),
            buffers: Buffers::default(),
            merging: Buffers::default(),
            keep_forces: false,
            slot_width: if model.rigid || model.laws.rolls() { 3 } else { 2 },
            listed: false,
            wall_reference: Vec::new(),
            wall_places: Vec::new(),
            surface_drift: 0.0,
            searches: 0,
            refreshes: 0,
            simd: Simd::best(),
            planes: Vec::new(),
            material: None,
            plane_material: common(model.planes.iter().map(|p| p.material as u32)),
            parallel: model.sphere_count() >= PARALLEL,
        };
        work.arrange(model, state);
        work
    }

    /// Follows another state of the same model from now on, such as an earlier one that is taken up again. What comes
    /// then has the bits that new scratch gives.
    pub fn follow(&mut self, model: &Model, state: &State) {
        self.arrange(model, state);
    }

    /// Lays the constants out in the state's present order.
    pub(crate) fn arrange(&mut self, model: &Model, state: &State) {
        self.listed = false;
        self.blocks.resize_with(state.blocks.len(), BlockWork::default);
        self.cross.resize_with(state.blocks.len(), CrossWork::default);
        for (w, block) in self.blocks.iter_mut().zip(&state.blocks) {
            w.arrange(model, &block.bodies);
            if model.rigid {
                w.spheres.resize(w.local.len(), Lanes::default());
                for k in 0..block.bodies.len() {
                    w.place_spheres(k, &block.centre[k], &block.rotation[k].orientation);
                }
            }
        }
        // A block without a body or with several materials has none of its own.
        self.material = common(self.blocks.iter().map(|w| w.material)).flatten();
        crate::search::near::link(state, self);
        bond::pass::arrange(model, state, self);
    }

    /// Contacts with the external surface in the last step, by block, then sphere, then patch.
    pub fn surface_contacts(&self) -> &[SurfaceContact] {
        &self.surface_contacts
    }

    /// Whether [`Work::contact_force`] and [`Work::contact_torque`] shall know the forces after a step; they take 64
    /// bytes per body.
    pub fn keep_forces(&mut self, keep: bool) {
        self.keep_forces = keep;
    }

    /// Sum of the contact forces on a body in the last step, if kept; else zero [N].
    pub fn contact_force(&self, state: &State, body: usize) -> Vec3 {
        let [b, k] = state.places[body];
        self.blocks[b as usize].sums.get(k as usize).map(|s| xyz(s.force())).unwrap_or_default()
    }

    /// Sum of the contact torques on a body about its centre in the last step, if kept; else zero [N m].
    pub fn contact_torque(&self, state: &State, body: usize) -> Vec3 {
        let [b, k] = state.places[body];
        self.blocks[b as usize].sums.get(k as usize).map(|s| xyz(s.torque())).unwrap_or_default()
    }

    /// How often candidates were searched and how often the near list was made from them.
    pub fn rebuilds(&self) -> (u64, u64) {
        (self.searches, self.refreshes)
    }
}

impl BlockWork {
    fn arrange(&mut self, model: &Model, bodies: &[u32]) {
        self.kind.clear();
        self.inertia.clear();
        self.reach.clear();
        self.fixed.clear();
        self.half.clear();
        self.first.clear();
        self.owner.clear();
        self.local.clear();
        self.mass_sum = 0.0;
        self.fixed.reserve_exact(bodies.len());
        self.material = common(bodies.iter().map(|&b| model.body(b as usize).material));
        for (k, &body) in bodies.iter().enumerate() {
            let b = model.body(body as usize);
            self.fixed.push(b.fixed);
            self.mass_sum += b.mass;
            if model.rigid {
                self.first.push(self.owner.len() as u32);
                self.kind.push(b.kind);
                self.inertia.push(b.inertia);
                self.reach.push(if b.kind == Kind::Sphere { 0.0 } else { b.radius });
                self.half.push(model.half(body as usize));
                for_members(&model.shapes[b.shape], b.scale, |c, r| {
                    self.owner.push(k as u32);
                    self.local.push(Lanes([c.x, c.y, c.z, r]));
                });
            }
        }
        self.count = if model.rigid { self.owner.len() } else { bodies.len() };
        if model.rigid {
            self.first.push(self.owner.len() as u32);
        }
        let moving = self.fixed.iter().all(|&f| f == 0);
        self.round = self.kind.iter().all(|&k| k != Kind::Box);
        if moving {
            self.fixed = Vec::new();
        }
        self.sums = Vec::new();
    }

    /// Whether no body is a box or has a fixed motion.
    pub(crate) fn plain(&self) -> bool {
        self.round && self.fixed.is_empty()
    }

    /// Whether the bodies k to k + 3 are no boxes and have no fixed motion.
    #[inline(always)]
    pub(crate) fn all_free(&self, k: usize) -> bool {
        self.round && (self.fixed.is_empty() || self.fixed[k..k + 4] == [0; 4])
    }

    /// The body of a sphere.
    #[inline(always)]
    pub(crate) fn body(&self, sphere: u32) -> u32 {
        self.owner.get(sphere as usize).copied().unwrap_or(sphere)
    }

    /// Adds a force and a torque about the centre to a body's sums.
    #[inline(always)]
    pub(crate) fn push(&mut self, body: usize, force: &Vec3, torque: &Vec3) {
        let (f, t) = self.sums[body].both();
        for d in 0..3 {
            f[d] += force[d];
            t[d] += torque[d];
        }
    }

    /// Puts the spheres of a body where its centre and orientation say.
    #[inline(always)]
    pub(crate) fn place_spheres(
        &mut self,
        k: usize,
        centre: &Lanes,
        orientation: &nalgebra::UnitQuaternion<f64>,
    ) {
        let x = xyz(centre);
        let turn = orientation.to_rotation_matrix();
        for s in self.first[k] as usize..self.first[k + 1] as usize {
            let local = &self.local[s];
            let p = x + turn * xyz(local);
            self.spheres[s] = Lanes([p.x, p.y, p.z, local[3]]);
        }
    }
}
