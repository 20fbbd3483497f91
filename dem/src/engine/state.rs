//! State of a run; checkpoints resume bitwise identically.
//!
//! Bodies are stored in spatial blocks (`reordering.rs`); public methods use input indices. Positions are at
//! `time`, velocities half a step earlier (leapfrog).

use crate::base::Vec3;
use crate::base::balance_terms::BalanceTerms;
use crate::base::force_tracking::AppliedLoad;
use crate::bodies::block::{Block, spin_of};
use crate::bodies::table::BodyKind;
use crate::bond::{BondList, BondState};
use crate::engine::model::Model;
use crate::integrate::step_size::StepSize;
use crate::lanes::vec4::{set_xyz, xyz};
use crate::law::scarring::Scar;
use crate::pairs::cross::Cross;
use crate::pairs::groups::Groups;
use crate::pairs::patches::PatchList;
use crate::shape::plane::PlaneMotion;
use crate::wall::hull::WaterLoad;
use crate::wall::state::WallState;
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct BlockLists {
    pub pairs: Groups<2>,
    /// Sphere or box corner, and plane.
    pub planes: Groups<2>,
    pub walls: PatchList,
    pub surface: PatchList,
    pub bonds: BondList,
}

/// State of a model ([`State::new`]).
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct State {
    /// Time [s].
    pub time: f64,
    /// Steps, including those before [`State::reset_time`].
    pub steps: u64,
    pub(crate) before: u64,
    /// Work, dissipation and impulse.
    pub balance: BalanceTerms,
    pub(crate) places: Vec<[u32; 2]>,
    pub(crate) blocks: Vec<Block>,
    pub(crate) lists: Vec<BlockLists>,
    /// By block of the first sphere.
    pub(crate) cross: Vec<Cross>,
    pub(crate) step_size: StepSize,
    pub(crate) bonds: BondState,
    pub(crate) planes: Vec<PlaneMotion>,
    pub(crate) walls: Vec<WallState>,
    /// Largest speed of prescribed and servo-controlled walls [m/s].
    pub(crate) driven_speed: f64,
    /// Position and velocity of external surface nodes in the last step, for bodies with faces.
    pub(crate) sheet: Vec<[Vec3; 2]>,
    /// By body index; empty without scarred ground.
    pub(crate) scars: Vec<Scar>,
    /// Cut-off beyond contact [m], displacement used, age in steps.
    pub(crate) near: f64,
    pub(crate) max_travel: f64,
    pub(crate) wall_travel: f64,
    pub(crate) steps_since_search: u32,
    pub(crate) stale: bool,
}

pub(crate) const ABSENT: [u32; 2] = [u32::MAX, 0];

impl State {
    /// Steps since the start or [`State::reset_time`].
    pub fn steps_done(&self) -> u64 {
        self.steps - self.before
    }

    /// Next time step [s]; initially [`Model::dt`].
    pub fn dt(&self) -> f64 {
        self.step_size.dt
    }

    /// Last time step [s].
    pub fn last_dt(&self) -> f64 {
        self.step_size.last
    }

    /// Velocity increment time [s]: mean of next and last step.
    pub fn kick(&self) -> f64 {
        self.step_size.kick()
    }

    /// Last critical time step [s] ([`crate::stability`]).
    pub fn measured_limit(&self) -> Option<f64> {
        (self.step_size.limit > 0.0).then_some(self.step_size.limit)
    }

    /// Sets the time step [s].
    pub fn set_dt(&mut self, dt: f64) {
        self.step_size.dt = dt;
    }

    /// Returns true if the body is present; absent bodies have no position.
    pub fn present(&self, body: usize) -> bool {
        self.places[body] != ABSENT
    }

    /// Number of bodies present.
    pub fn present_count(&self) -> usize {
        self.blocks.iter().map(|b| b.bodies.len()).sum()
    }

    pub(crate) fn number(&mut self, model: &Model) {
        self.places.clear();
        self.places.resize(model.bodies.len(), ABSENT);
        for (b, block) in self.blocks.iter().enumerate() {
            for (k, &body) in block.bodies.iter().enumerate() {
                self.places[body as usize] = [b as u32, k as u32];
            }
        }
        // Re-inserted bodies start without a scar.
        let absent = self.scars.iter_mut().zip(&self.places).filter(|(_, place)| **place == ABSENT);
        absent.for_each(|(scar, _)| *scar = Scar::default());
    }

    fn locate(&self, body: usize) -> (&Block, usize) {
        let [b, k] = self.places[body];
        (&self.blocks[b as usize], k as usize)
    }

    /// Centre of mass [m], not wrapped ([`Model::wrap`]).
    pub fn position(&self, body: usize) -> Vec3 {
        let (block, k) = self.locate(body);
        xyz(&block.centre[k])
    }

    /// Velocity half a step before `time` [m/s].
    pub fn velocity(&self, body: usize) -> Vec3 {
        let (block, k) = self.locate(body);
        xyz(&block.velocity[k])
    }

    /// Angular velocity in world axes half a step before `time` [rad/s].
    pub fn spin(&self, body: usize) -> Vec3 {
        let (block, k) = self.locate(body);
        xyz(&block.spin[k])
    }

    /// Orientation (body frame to world); initial value for single spheres.
    pub fn orientation(&self, model: &Model, body: usize) -> UnitQuaternion<f64> {
        let (block, k) = self.locate(body);
        block.rotation.get(k).map_or_else(|| model.bodies.orientation(body), |r| r.orientation)
    }

    /// Sets velocity [m/s] and angular velocity [rad/s] half a step before `time`, without a balance entry.
    /// Fixed rotations are kept.
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

    /// Translates [m] and rotates a body about world axes; motion and contact history are kept. Fixed motions
    /// are skipped; single spheres do not rotate. Energy is not balanced. Call [`State::request_search`]
    /// afterwards.
    pub fn shift(&mut self, model: &Model, body: usize, shift: &Vec3, turn: &UnitQuaternion<f64>) {
        let [b, k] = self.places[body];
        let (block, k) = (&mut self.blocks[b as usize], k as usize);
        let constants = model.body(body);
        let fixed = |d: usize| constants.fixed >> d & 1 == 1;
        let shift = Vec3::from_fn(|d, _| if fixed(d) { 0.0 } else { shift[d] });
        let place = xyz(&block.centre[k]) + shift;
        set_xyz(&mut block.centre[k], &place);
        if let Some(r) = block.rotation.get_mut(k)
            && constants.kind != BodyKind::Sphere
            && !(3..6).any(fixed)
        {
            r.orientation = turn * r.orientation;
            let spin = spin_of(r, &constants.inertia);
            set_xyz(&mut block.spin[k], &spin);
        }
        let momentum = xyz(&block.velocity[k]) * constants.mass;
        self.balance.jumps.angular += shift.cross(&momentum);
    }

    /// Spheres in the world: centre [m], radius [m]; empty for a box.
    pub fn spheres(&self, model: &Model, body: usize) -> Vec<(Vec3, f64)> {
        let (x, q) = (self.position(body), self.orientation(model, body));
        model.members(body).into_iter().map(|(c, r)| (x + q * c, r)).collect()
    }

    /// Current point of a plane [m].
    pub fn plane_point(&self, model: &Model, plane: usize) -> Vec3 {
        model.planes[plane].point + self.planes[plane].offset
    }

    /// Sets a plane's velocity [m/s].
    pub fn set_plane_velocity(&mut self, plane: usize, velocity: Vec3) {
        self.planes[plane].velocity = velocity;
    }

    /// Opens or closes a plane.
    pub fn open_plane(&mut self, plane: usize, open: bool) {
        self.planes[plane].open = open;
        self.stale = true;
    }

    /// Displacement of a wall's centre [m]. Indices: [`ModelInput::triangles`](crate::ModelInput::triangles),
    /// then [`ModelInput::walls`](crate::ModelInput::walls).
    pub fn wall_offset(&self, wall: usize) -> Vec3 {
        self.walls[wall].offset
    }

    /// Displacement of a wall's centre since time zero [m].
    pub fn wall_travel(&self, wall: usize) -> Vec3 {
        self.walls[wall].offset - self.walls[wall].origin
    }

    /// Rotation of a wall.
    pub fn wall_orientation(&self, wall: usize) -> UnitQuaternion<f64> {
        self.walls[wall].orientation
    }

    /// Roll, pitch and heading of a wall since the start, about x, y, z in this order [rad].
    pub fn wall_angles(&self, wall: usize) -> Vec3 {
        let q = self.walls[wall].orientation;
        let sine = (2.0 * (q.w * q.j - q.k * q.i)).clamp(-1.0, 1.0);
        Vec3::new(
            libm::atan2(2.0 * (q.w * q.i + q.j * q.k), 1.0 - 2.0 * (q.i * q.i + q.j * q.j)),
            libm::asin(sine),
            libm::atan2(2.0 * (q.w * q.k + q.i * q.j), 1.0 - 2.0 * (q.j * q.j + q.k * q.k)),
        )
    }

    /// Current position of a wall point, initially `x` [m].
    pub fn wall_point(&self, model: &Model, wall: usize, x: &Vec3) -> Vec3 {
        self.walls[wall].to_world(&model.walls.walls[wall].centre, x)
    }

    /// Velocity [m/s] and angular velocity [rad/s] of a wall half a step before `time`.
    pub fn wall_velocity(&self, wall: usize) -> (Vec3, Vec3) {
        (self.walls[wall].velocity, self.walls[wall].spin)
    }

    /// Acceleration of a rigid-body wall [m/s²]; else zero.
    pub fn wall_acceleration(&self, wall: usize) -> Vec3 {
        self.walls[wall].acceleration
    }

    /// Contact force on a wall [N] and moment about its centre [N m] in the last step.
    pub fn wall_force(&self, wall: usize) -> (Vec3, Vec3) {
        (self.walls[wall].force, self.walls[wall].moment)
    }

    /// Load of water and propulsion on a rigid-body wall at `time`; none if it does not float.
    pub fn water_load(&self, model: &Model, wall: usize) -> Option<WaterLoad> {
        let body = model.walls.walls[wall].body.as_ref()?;
        body.water_load(&self.walls[wall], self.time, 0.5 * self.step_size.last)
    }

    /// Force of a servo-controlled wall compared with its target; none for other walls.
    pub fn wall_load(&self, wall: usize) -> Option<AppliedLoad> {
        self.walls[wall].tracking.result()
    }

    /// Sphere–wall contacts in the last step.
    pub fn wall_contact_count(&self) -> usize {
        self.lists.iter().map(|b| b.walls.live.len()).sum()
    }

    /// Sets a wall's steady velocity [m/s]; no effect if servo-controlled or rigid body.
    pub fn set_wall_velocity(&mut self, wall: usize, velocity: Vec3) {
        let own = &mut self.walls[wall];
        own.velocity += velocity - own.drive;
        own.drive = velocity;
    }

    /// Opens or closes a wall.
    pub fn open_wall(&mut self, wall: usize, open: bool) {
        self.walls[wall].open = open;
        self.stale = true;
    }

    /// Resets time, steps and balances; wall offsets are kept.
    pub fn reset_time(&mut self) {
        self.time = 0.0;
        // The total count fixes sorting steps, hence rounding.
        self.before = self.steps;
        self.balance = BalanceTerms::default();
        (self.step_size.before, self.step_size.expected) = ([0.0; 2], 0.0);
        self.driven_speed = 0.0;
        self.bonds.breaks.clear();
        for wall in &mut self.walls {
            (wall.origin, wall.tracking) = (wall.offset, Default::default());
        }
    }

    /// Requests a neighbour search, if the external surface exceeded its
    /// [`max_speed`](crate::spatial::surface::Surface::max_speed).
    pub fn request_search(&mut self) {
        self.stale = true;
    }

    /// Adds surface displacement [m] beyond its [`max_speed`](crate::spatial::surface::Surface::max_speed),
    /// without a new search.
    pub fn add_surface_travel(&mut self, way: f64) {
        self.wall_travel += way;
    }
}
