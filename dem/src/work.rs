//! Scratch of the step: never saved, made anew from a state at any time without changing a bit of what follows.

use crate::Vec3;
use crate::bond::pass::{BondWork, ListWork};
use crate::bond::{self, Held};
use crate::contact::patches::Touch;
use crate::contact::planes::PlaneNow;
use crate::error::Partner;
use crate::lanes::Simd;
use crate::ledger::Ledger;
use crate::model::{Kind, Model, for_members};
use crate::search::cells::Cells;
use crate::state::{ImageName, Lanes, PatchContact, PatchPair, State, xyz};
use crate::surface::SurfaceContact;
use crate::wall::advance::WallSum;

/// A contact between blocks: force on the first partner, torque on the first, torque on the second.
pub(crate) type Slot = [Lanes; 3];

/// Sum of the contact forces on a body, and of the torques about its centre; the fourth numbers are zero.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub(crate) struct Sums {
    pub force: Lanes,
    pub torque: Lanes,
}

impl Sums {
    #[inline(always)]
    pub fn both(&mut self) -> (&mut Lanes, &mut Lanes) {
        (&mut self.force, &mut self.torque)
    }
}

/// One body's share in a slot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gather {
    pub place: u32,
    pub block: u32,
    pub slot: u32,
    /// Whether the body is the first partner.
    pub first: bool,
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
    pub slots: Vec<Slot>,
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
    /// Whether no motion is fixed and no body is a box.
    pub free: bool,
    pub mass_sum: f64,
    pub kind: Vec<Kind>,
    pub mass: Vec<f64>,
    pub inertia: Vec<Vec3>,
    pub inverse_inertia: Vec<f64>,
    pub reach: Vec<f64>,
    pub fixed: Vec<u8>,
    /// Half sides of boxes; empty in scenes without.
    pub half: Vec<Vec3>,
    /// First sphere of each body, and one past the last.
    pub first: Vec<u32>,

    // Spheres: place of the body, centre in the body frame and radius, and the same in the world.
    pub owner: Vec<u32>,
    pub local: Vec<Lanes>,
    pub spheres: Vec<Lanes>,

    // Candidates, valid while no sphere has moved further than the skin allows.
    pub reference: Vec<Vec3>,
    pub candidates: Vec<[u32; 2]>,
    pub cross: Vec<[u32; 3]>,
    pub boxed: Vec<[u32; 3]>,
    pub images: Vec<ImageName>,
    pub planes: Vec<[u32; 2]>,
    pub walls: Vec<[u32; 2]>,
    pub surface: Vec<[u32; 2]>,

    // The step.
    pub gather: Vec<Gather>,
    pub sums: Vec<Sums>,
    pub contacts: Vec<SurfaceContact>,
    pub ledger: Ledger,
    pub fastest: f64,
    pub failure: Option<Failure>,
    pub row: Vec<u32>,
    pub patches: Vec<PatchPair>,
    pub touches: Vec<Touch>,
    pub live: Vec<PatchContact>,
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
    pub(crate) bonds: BondWork,
    /// Pairs that are not for the ordinary contacts.
    pub(crate) held: Held,
    pub(crate) applied: Vec<Applied>,
    pub(crate) surface_contacts: Vec<SurfaceContact>,
    pub(crate) cells: Cells,
    pub(crate) points: Vec<Lanes>,
    pub(crate) names: Vec<[u32; 2]>,
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
    /// Whether blocks are shared among threads.
    pub(crate) parallel: bool,
}

/// Spheres below which sharing the work costs more than it saves. Both ways give the same bits.
const PARALLEL: usize = 2500;

impl Work {
    /// Scratch for a state.
    pub fn new(model: &Model, state: &State) -> Work {
        let mut work = Work {
            blocks: Vec::new(),
            cross: Vec::new(),
            bonds: BondWork::default(),
            held: Held::default(),
            applied: Vec::new(),
            surface_contacts: Vec::new(),
            cells: Cells::default(),
            points: Vec::new(),
            names: Vec::new(),
            listed: false,
            wall_reference: Vec::new(),
            wall_places: Vec::new(),
            surface_drift: 0.0,
            searches: 0,
            refreshes: 0,
            simd: Simd::best(),
            planes: Vec::new(),
            parallel: model.sphere_count() >= PARALLEL,
        };
        work.arrange(model, state);
        work
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
        crate::search::near::link(state, self);
        bond::pass::arrange(model, state, self);
    }

    /// Contacts with the external surface in the last step, by block, then sphere, then patch.
    pub fn surface_contacts(&self) -> &[SurfaceContact] {
        &self.surface_contacts
    }

    /// Sum of the contact forces on a body in the last step [N].
    pub fn contact_force(&self, state: &State, body: usize) -> Vec3 {
        let [b, k] = state.places[body];
        self.blocks[b as usize].sums.get(k as usize).map(|s| xyz(&s.force)).unwrap_or_default()
    }

    /// Sum of the contact torques on a body about its centre in the last step [N m].
    pub fn contact_torque(&self, state: &State, body: usize) -> Vec3 {
        let [b, k] = state.places[body];
        self.blocks[b as usize].sums.get(k as usize).map(|s| xyz(&s.torque)).unwrap_or_default()
    }

    /// How often candidates were searched and how often the near list was made from them.
    pub fn rebuilds(&self) -> (u64, u64) {
        (self.searches, self.refreshes)
    }
}

impl BlockWork {
    fn arrange(&mut self, model: &Model, bodies: &[u32]) {
        self.kind.clear();
        self.mass.clear();
        self.inertia.clear();
        self.inverse_inertia.clear();
        self.reach.clear();
        self.fixed.clear();
        self.half.clear();
        self.first.clear();
        self.owner.clear();
        self.local.clear();
        for (k, &body) in bodies.iter().enumerate() {
            let b = &model.bodies[body as usize];
            self.kind.push(b.kind);
            self.mass.push(b.mass);
            self.inverse_inertia.push(1.0 / b.inertia.x);
            self.fixed.push(b.fixed);
            self.first.push(self.owner.len() as u32);
            if model.rigid {
                self.inertia.push(b.inertia);
                self.reach.push(if b.kind == Kind::Sphere { 0.0 } else { b.radius });
                self.half.push(model.half(body as usize));
            }
            for_members(&model.shapes[b.shape], b.scale, |c, r| {
                self.owner.push(k as u32);
                if model.rigid {
                    self.local.push(Lanes([c.x, c.y, c.z, r]));
                }
            });
        }
        self.first.push(self.owner.len() as u32);
        self.free = self.fixed.iter().all(|&f| f == 0) && self.kind.iter().all(|&k| k != Kind::Box);
        self.mass_sum = self.mass.iter().sum();
        self.sums.clear();
        self.sums.resize(bodies.len(), Sums::default());
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
