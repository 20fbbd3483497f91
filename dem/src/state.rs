//! What changes during a run, and all of it: a checkpoint of the state continues bit for bit.
//!
//! Bodies live in blocks of neighbours (`order.rs`), so that most contacts stay within a block and memory is read
//! in runs. Their numbers towards the user are those of the input; [`State::position`] and its like translate.
//!
//! Positions are those of `time`; velocities and spins those half a step earlier (leapfrog). Contact memory lies
//! beside the pairs of the near list, which is therefore part of the state.

use crate::Vec3;
use crate::bond::{self, BondList, BondState};
use crate::contact::groups::Groups;
use crate::law::History;
use crate::ledger::Ledger;
use crate::model::Model;
use crate::order::{self, Turnover};
use crate::wall::state::{WallMotion, WallState};
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};

/// Four numbers loaded as one; aligned, so that none lies across two lines of the cache.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
#[repr(C, align(32))]
pub(crate) struct Lanes(pub [f64; 4]);

impl std::ops::Deref for Lanes {
    type Target = [f64; 4];
    #[inline(always)]
    fn deref(&self) -> &[f64; 4] {
        &self.0
    }
}

impl std::ops::DerefMut for Lanes {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64; 4] {
        &mut self.0
    }
}

/// Orientation and angular momentum of a body that is not a sphere.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Rotation {
    /// Body frame to world.
    pub orientation: UnitQuaternion<f64>,
    /// Angular momentum about the centre, world axes, half a step ago [kg m²/s].
    pub momentum: Vec3,
}

/// Contacts of a block's spheres with bodies of other blocks.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Cross {
    /// Sphere of this block, other block, sphere there.
    pub spheres: Groups<3>,
    /// Sphere of this block, block of the box, its place there.
    pub boxes: Groups<3>,
    /// Sphere of this block and the image of one of any block across a periodic border.
    #[serde(default)]
    pub images: Vec<ImagePair>,
}

/// Sphere of a block, other block, sphere there, and how many box lengths the image is away from that sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct ImageName {
    pub i: u32,
    pub block: u32,
    pub j: u32,
    pub shift: [i32; 3],
}

/// Two spheres that touch across a periodic border or nearly do.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct ImagePair {
    pub name: ImageName,
    pub history: History,
}

impl ImagePair {
    /// A pair that has not touched.
    pub fn new(name: ImageName) -> ImagePair {
        ImagePair { name, history: History::NONE }
    }
}

/// A sphere that touches a patch of a surface or nearly does.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct PatchPair {
    pub i: u32,
    pub patch: u32,
    pub local: [f64; 2],
    /// Way that sphere and patch can come together before they may touch, counted from when the near list was made
    /// [m]; negative in touch.
    pub spare: f64,
}

/// A sphere in touch with a patch, and what is remembered of the last step.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct PatchContact {
    pub i: u32,
    pub patch: u32,
    /// Where the patch was touched, the normal, the patch's velocity and the overlap there.
    pub point: Vec3,
    pub normal: Vec3,
    pub velocity: Vec3,
    pub overlap: f64,
    /// Cosine between the contact's and the patch's own normal: its sign tells the side.
    pub side: f64,
    pub history: History,
}

/// Spheres near the patches of a surface, and those in touch; both in order of sphere and patch.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct PatchList {
    pub pairs: Vec<PatchPair>,
    pub live: Vec<PatchContact>,
}

impl PatchList {
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty() && self.live.is_empty()
    }
}

/// A block of neighbouring bodies with the contacts that only it sees.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Block {
    /// Number of each body in the input.
    pub bodies: Vec<u32>,
    /// Position and radius (of a sphere; bounding otherwise).
    pub centre: Vec<Lanes>,
    /// Velocity and inverse mass.
    pub velocity: Vec<Lanes>,
    /// Spin and material index.
    pub spin: Vec<Lanes>,
    /// Empty in scenes of single spheres only.
    pub rotation: Vec<Rotation>,
    /// Two spheres of the block that touch or nearly do.
    pub pairs: Groups<2>,
    /// A sphere, or a corner of a box, and a plane.
    pub planes: Groups<2>,
    pub walls: PatchList,
    pub surface: PatchList,
    /// Bonds between two of these bodies.
    pub bonds: BondList,
}

impl Block {
    /// An empty block; `turning`: contacts remember rolling and twisting.
    pub fn new(turning: bool) -> Block {
        Block { pairs: Groups::new(turning), planes: Groups::new(turning), ..Block::default() }
    }

    /// Gives up memory that the bodies do not need.
    pub fn fit(&mut self) {
        self.bodies.shrink_to_fit();
        self.centre.shrink_to_fit();
        self.velocity.shrink_to_fit();
        self.spin.shrink_to_fit();
        self.rotation.shrink_to_fit();
    }
}

impl Cross {
    /// No contacts; `turning` as in [`Block::new`].
    pub fn new(turning: bool) -> Cross {
        Cross { spheres: Groups::new(turning), boxes: Groups::new(turning), images: Vec::new() }
    }

    /// No partner lies in a later block than this.
    pub fn last_block(&self) -> usize {
        let images = self.images.iter().map(|p| p.name.block).max().unwrap_or(0);
        self.spheres.most()[1].max(self.boxes.most()[1]).max(images) as usize
    }
}

/// The state. Build it with [`State::new`].
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct State {
    /// Time of the positions [s].
    pub time: f64,
    /// Steps done.
    pub steps: u64,
    /// Sums of work, dissipation and impulse since the start.
    pub ledger: Ledger,
    /// Block and place of each body.
    pub(crate) places: Vec<[u32; 2]>,
    pub(crate) blocks: Vec<Block>,
    /// Contacts between blocks, by the block of their first sphere.
    pub(crate) cross: Vec<Cross>,
    pub(crate) bonds: BondState,
    pub(crate) planes: Vec<WallMotion>,
    pub(crate) walls: Vec<WallState>,
    /// Reach of the near list beyond touch [m], how much of it motion has used up, and the steps it has lasted.
    pub(crate) near: f64,
    pub(crate) drift: f64,
    pub(crate) wall_drift: f64,
    pub(crate) lasted: u32,
    /// Whether the near list must be made anew.
    pub(crate) stale: bool,
}

/// Place of a body that is absent: in no block.
pub(crate) const NOWHERE: [u32; 2] = [u32::MAX, 0];

#[inline(always)]
pub(crate) fn xyz(lanes: &Lanes) -> Vec3 {
    Vec3::new(lanes[0], lanes[1], lanes[2])
}

#[inline(always)]
pub(crate) fn set_xyz(lanes: &mut Lanes, v: &Vec3) {
    lanes[0] = v.x;
    lanes[1] = v.y;
    lanes[2] = v.z;
}

/// World angular velocity from the angular momentum.
#[inline(always)]
pub(crate) fn spin_of(rotation: &Rotation, inertia: &Vec3) -> Vec3 {
    rotation.orientation
        * rotation.orientation.inverse_transform_vector(&rotation.momentum).component_div(inertia)
}

/// The leapfrog's velocity half a step before a moment at which the body moves at `velocity` [m/s], free to fall.
pub(crate) fn half_a_step_ago(model: &Model, body: usize, velocity: &Vec3) -> Vec3 {
    let fixed = model.body(body).fixed;
    let kick = Vec3::from_fn(|d, _| if fixed >> d & 1 == 1 { 0.0 } else { model.gravity[d] });
    velocity - kick * (0.5 * model.dt())
}

impl State {
    /// The start: positions and velocities as given, at time 0.
    ///
    /// The leapfrog's velocities at −dt/2 are the given ones less half a step of gravity. A contact or applied
    /// force already there at time 0 acts with its first full kick, a shift of half a step in time.
    pub fn new(model: &Model) -> State {
        let mut state = State {
            time: 0.0,
            steps: 0,
            ledger: Ledger::default(),
            places: Vec::new(),
            blocks: Vec::new(),
            cross: Vec::new(),
            bonds: BondState::default(),
            planes: model
                .planes
                .iter()
                .map(|p| WallMotion { offset: Vec3::zeros(), velocity: p.velocity, open: false })
                .collect(),
            walls: model.walls.start(&model.gravity, model.dt()),
            near: 0.1 * model.skin,
            drift: 0.0,
            wall_drift: 0.0,
            lasted: 0,
            stale: true,
        };
        let positions = model.bodies.positions().expect("a model that has not given its start up");
        for members in order::blocks(model, positions, |b| !model.bodies.absent(b)) {
            let mut block = Block::new(model.laws.rolls());
            for &body in &members {
                let b = model.body(body as usize);
                let c = positions[body as usize];
                block.centre.push(Lanes([c.x, c.y, c.z, b.radius]));
                block.velocity.push(Lanes([0.0, 0.0, 0.0, b.inverse_mass]));
                block.spin.push(Lanes([0.0, 0.0, 0.0, f64::from(b.material)]));
                if model.rigid {
                    block.rotation.push(Rotation {
                        orientation: model.bodies.orientation(body as usize),
                        momentum: Vec3::zeros(),
                    });
                }
            }
            block.bodies = members;
            block.fit();
            state.blocks.push(block);
        }
        state.cross.resize_with(state.blocks.len(), || Cross::new(model.laws.rolls()));
        state.number(model);
        bond::store::start(model, &mut state);
        for k in (0..model.bodies.len()).filter(|&k| !model.bodies.absent(k)) {
            let velocity = half_a_step_ago(model, k, &model.bodies.velocity(k));
            state.set_velocity(model, k, velocity, model.bodies.spin(k));
        }
        state
    }

    /// Whether a body is there. Those that are not have no position, velocity or orientation, and take part in nothing.
    pub fn present(&self, body: usize) -> bool {
        self.places[body] != NOWHERE
    }

    /// Number of bodies that are there.
    pub fn present_count(&self) -> usize {
        self.blocks.iter().map(|b| b.bodies.len()).sum()
    }

    /// Writes down where each body is.
    pub(crate) fn number(&mut self, model: &Model) {
        self.places.clear();
        self.places.resize(model.bodies.len(), NOWHERE);
        for (b, block) in self.blocks.iter().enumerate() {
            for (k, &body) in block.bodies.iter().enumerate() {
                self.places[body as usize] = [b as u32, k as u32];
            }
        }
    }

    fn place(&self, body: usize) -> (&Block, usize) {
        let [b, k] = self.places[body];
        (&self.blocks[b as usize], k as usize)
    }

    /// Centre of mass of a body [m]. Along periodic axes it may have run on beyond the borders: see [`Model::wrap`].
    pub fn position(&self, body: usize) -> Vec3 {
        let (block, k) = self.place(body);
        xyz(&block.centre[k])
    }

    /// Velocity of a body's centre half a step before `time` [m/s].
    pub fn velocity(&self, body: usize) -> Vec3 {
        let (block, k) = self.place(body);
        xyz(&block.velocity[k])
    }

    /// Angular velocity of a body in world axes, half a step before `time` [rad/s].
    pub fn spin(&self, body: usize) -> Vec3 {
        let (block, k) = self.place(body);
        xyz(&block.spin[k])
    }

    /// Orientation of a body (body frame to world). Single spheres do not track theirs: the starting one.
    pub fn orientation(&self, model: &Model, body: usize) -> UnitQuaternion<f64> {
        let (block, k) = self.place(body);
        block.rotation.get(k).map_or_else(|| model.bodies.orientation(body), |r| r.orientation)
    }

    /// Sets a body's velocity [m/s] and spin [rad/s] as of half a step before `time`. Fixed rotations of clumps
    /// and boxes keep the spin of the input. The change is not in the ledger.
    pub fn set_velocity(&mut self, model: &Model, body: usize, velocity: Vec3, spin: Vec3) {
        let [b, k] = self.places[body];
        let block = &mut self.blocks[b as usize];
        let k = k as usize;
        set_xyz(&mut block.velocity[k], &velocity);
        set_xyz(&mut block.spin[k], &spin);
        if let Some(r) = block.rotation.get_mut(k) {
            let local = r.orientation.inverse_transform_vector(&spin);
            r.momentum = r.orientation * local.component_mul(&model.body(body).inertia);
        }
    }

    /// Sets a body elsewhere: shifts its centre [m] and turns it by a rotation in world axes. Velocity, angular momentum and
    /// contact memory stay as they are; fixed motions are left out (all rotations where one is fixed), and single spheres
    /// do not turn. The change of momentum about the origin goes to the ledger, that of energy does not. Call
    /// [`State::forget_neighbours`] afterwards.
    pub fn shift(&mut self, model: &Model, body: usize, shift: &Vec3, turn: &UnitQuaternion<f64>) {
        let [b, k] = self.places[body];
        let (block, k) = (&mut self.blocks[b as usize], k as usize);
        let constants = model.body(body);
        let fixed = |d: usize| constants.fixed >> d & 1 == 1;
        let shift = Vec3::from_fn(|d, _| if fixed(d) { 0.0 } else { shift[d] });
        let place = xyz(&block.centre[k]) + shift;
        set_xyz(&mut block.centre[k], &place);
        if let Some(r) = block.rotation.get_mut(k)
            && constants.kind != crate::model::Kind::Sphere
            && !(3..6).any(fixed)
        {
            r.orientation = turn * r.orientation;
            let spin = spin_of(r, &constants.inertia);
            set_xyz(&mut block.spin[k], &spin);
        }
        let momentum = xyz(&block.velocity[k]) * constants.mass;
        self.ledger.jumps.angular += shift.cross(&momentum);
    }

    /// Spheres of a body in the world: centre [m] and radius [m]. One for a sphere, none for a box.
    pub fn spheres(&self, model: &Model, body: usize) -> Vec<(Vec3, f64)> {
        let (x, q) = (self.position(body), self.orientation(model, body));
        model.members(body).into_iter().map(|(c, r)| (x + q * c, r)).collect()
    }

    /// Position of plane `plane`: the point given, moved along [m].
    pub fn plane_point(&self, model: &Model, plane: usize) -> Vec3 {
        model.planes[plane].point + self.planes[plane].offset
    }

    /// Gives a plane another velocity [m/s].
    pub fn set_plane_velocity(&mut self, plane: usize, velocity: Vec3) {
        self.planes[plane].velocity = velocity;
    }

    /// Opens a plane (grains pass) or closes it again.
    pub fn open_plane(&mut self, plane: usize, open: bool) {
        self.planes[plane].open = open;
        self.stale = true;
    }

    /// Displacement of a wall's centre since the start [m]. Walls are counted through: first
    /// [`ModelInput::triangles`](crate::ModelInput::triangles), then [`ModelInput::walls`](crate::ModelInput::walls).
    pub fn wall_offset(&self, wall: usize) -> Vec3 {
        self.walls[wall].offset
    }

    /// Turn of a wall since the start.
    pub fn wall_orientation(&self, wall: usize) -> UnitQuaternion<f64> {
        self.walls[wall].orientation
    }

    /// Where a point of a wall is now that was at `x` at the start [m].
    pub fn wall_point(&self, model: &Model, wall: usize, x: &Vec3) -> Vec3 {
        self.walls[wall].to_world(&model.walls.walls[wall].centre, x)
    }

    /// Velocity of a wall's centre [m/s] and angular velocity [rad/s], half a step before `time`.
    pub fn wall_velocity(&self, wall: usize) -> (Vec3, Vec3) {
        (self.walls[wall].velocity, self.walls[wall].spin)
    }

    /// Force of the grains on a wall in the last step [N] and its moment about the wall's centre where it was then [N m].
    pub fn wall_force(&self, wall: usize) -> (Vec3, Vec3) {
        (self.walls[wall].force, self.walls[wall].moment)
    }

    /// Number of contacts of spheres with walls in the last step.
    pub fn wall_contact_count(&self) -> usize {
        self.blocks.iter().map(|b| b.walls.live.len()).sum()
    }

    /// Gives a wall another steady velocity [m/s]. Driven walls and rigid bodies do not follow it.
    pub fn set_wall_velocity(&mut self, wall: usize, velocity: Vec3) {
        let own = &mut self.walls[wall];
        own.velocity += velocity - own.drive;
        own.drive = velocity;
    }

    /// Opens a wall (grains pass) or closes it again.
    pub fn open_wall(&mut self, wall: usize, open: bool) {
        self.walls[wall].open = open;
        self.stale = true;
    }

    /// Has the neighbours searched anew before the next step: call it when the external surface has moved
    /// otherwise than its [`max_speed`](crate::surface::Surface::max_speed) tells.
    pub fn forget_neighbours(&mut self) {
        self.stale = true;
    }

    /// Allows for a way [m] that the external surface may have made between two steps, beyond what its
    /// [`max_speed`](crate::surface::Surface::max_speed) told: neighbours stay known that much longer.
    pub fn allow_for_jump(&mut self, way: f64) {
        self.wall_drift += way;
    }

    /// Puts the bodies into blocks of present neighbours and carries the contacts along. Done every
    /// `order::EVERY` steps: by count, so that a restart does not change when.
    pub(crate) fn reorder(&mut self, model: &Model) {
        if let Some(periodic) = &model.periodic {
            crate::periodic::wrap(periodic, model, self);
        }
        let all = Turnover::none(self);
        let positions = all.positions(self);
        order::reorder(self, model, &positions, &all);
    }
}
