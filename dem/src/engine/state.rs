//! What changes during a run, and all of it: a checkpoint of the state continues bit for bit.
//!
//! Bodies live in blocks of neighbours (`order.rs`), so that most contacts stay within a block and memory is read
//! in runs. Their numbers towards the user are those of the input; [`State::position`] and its like translate.
//!
//! Positions are those of `time`; velocities and spins those half a step earlier (leapfrog). Contact memory lies
//! beside the pairs of the near list, which is therefore part of the state.

use crate::base::Vec3;
use crate::base::ledger::Ledger;
use crate::bodies::block::{Block, spin_of};
use crate::bodies::table::Kind;
use crate::bond::{BondList, BondState};
use crate::engine::model::Model;
use crate::integrate::pace::Pace;
use crate::lanes::record::{set_xyz, xyz};
use crate::law::scarring::Scar;
use crate::pairs::cross::Cross;
use crate::pairs::groups::Groups;
use crate::pairs::patches::PatchList;
use crate::shape::plane::PlaneMotion;
use crate::wall::state::WallState;
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};

/// Contacts and bonds that only one block sees.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct BlockLists {
    /// Two spheres of the block that touch or nearly do.
    pub pairs: Groups<2>,
    /// A sphere, or a corner of a box, and a plane.
    pub planes: Groups<2>,
    pub walls: PatchList,
    pub surface: PatchList,
    /// Bonds between two of these bodies.
    pub bonds: BondList,
}

/// The state. Build it with [`State::new`].
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct State {
    /// Time of the positions [s].
    pub time: f64,
    /// Steps done, those before [`State::begin_anew`] included.
    pub steps: u64,
    /// Steps done before it.
    pub(crate) before: u64,
    /// Sums of work, dissipation and impulse since the start.
    pub ledger: Ledger,
    /// Block and place of each body.
    pub(crate) places: Vec<[u32; 2]>,
    pub(crate) blocks: Vec<Block>,
    /// Contacts and bonds within each block.
    pub(crate) lists: Vec<BlockLists>,
    /// Contacts between blocks, by the block of their first sphere.
    pub(crate) cross: Vec<Cross>,
    pub(crate) pace: Pace,
    pub(crate) bonds: BondState,
    pub(crate) planes: Vec<PlaneMotion>,
    pub(crate) walls: Vec<WallState>,
    /// Largest speed that walls with prescribed motion and driven walls have had [m/s].
    pub(crate) driven_speed: f64,
    /// Place and velocity of each corner of the external surface in the last step, where bodies with faces may touch it.
    pub(crate) sheet: Vec<[Vec3; 2]>,
    /// What each body does to ground that is scarred, by number; empty where no ground is.
    pub(crate) scars: Vec<Scar>,
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

impl State {
    /// Steps done since the start, or since [`State::begin_anew`].
    pub fn steps_done(&self) -> u64 {
        self.steps - self.before
    }

    /// Length of the next step [s]; [`Model::dt`] until another is set.
    pub fn dt(&self) -> f64 {
        self.pace.dt
    }

    /// Length of the last step [s]: velocities are those of half of it before `time`.
    pub fn last_dt(&self) -> f64 {
        self.pace.last
    }

    /// Time by which velocities advance in the next step [s]: the mean of that step and the last.
    pub fn kick(&self) -> f64 {
        self.pace.kick()
    }

    /// The largest stable step found last [s], where steps follow the contacts ([`crate::stability`]).
    pub fn measured_limit(&self) -> Option<f64> {
        (self.pace.limit > 0.0).then_some(self.pace.limit)
    }

    /// Sets the length of the steps from now on [s].
    pub fn set_dt(&mut self, dt: f64) {
        self.pace.dt = dt;
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
        // What comes in again has not been in the ground.
        let absent = self.scars.iter_mut().zip(&self.places).filter(|(_, place)| **place == NOWHERE);
        absent.for_each(|(scar, _)| *scar = Scar::default());
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
            && constants.kind != Kind::Sphere
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

    /// Acceleration of the centre of a rigid body that a wall is, in the last step [m/s²]; zero of other walls.
    pub fn wall_acceleration(&self, wall: usize) -> Vec3 {
        self.walls[wall].acceleration
    }

    /// Force of grains and other walls on a wall in the last step [N] and its moment about the wall's centre where it was then [N m].
    pub fn wall_force(&self, wall: usize) -> (Vec3, Vec3) {
        (self.walls[wall].force, self.walls[wall].moment)
    }

    /// Number of contacts of spheres with walls in the last step.
    pub fn wall_contact_count(&self) -> usize {
        self.lists.iter().map(|b| b.walls.live.len()).sum()
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

    /// Lets time, the count of steps and accounts begin anew where everything is. Offsets of walls go on from where they started.
    pub fn begin_anew(&mut self) {
        self.time = 0.0;
        // Steps are counted on: every so many the bodies are put in order, and that decides the last bits of sums.
        self.before = self.steps;
        self.ledger = Ledger::default();
        self.driven_speed = 0.0;
        self.bonds.breaks.clear();
    }

    /// Has the neighbours searched anew before the next step: call it when the external surface has moved
    /// otherwise than its [`max_speed`](crate::spatial::surface::Surface::max_speed) tells.
    pub fn forget_neighbours(&mut self) {
        self.stale = true;
    }

    /// Allows for a way [m] that the external surface may have made between two steps, beyond what its
    /// [`max_speed`](crate::spatial::surface::Surface::max_speed) stated: neighbours stay known that much longer.
    pub fn allow_for_jump(&mut self, way: f64) {
        self.wall_drift += way;
    }
}
