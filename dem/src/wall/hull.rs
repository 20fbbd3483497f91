//! Floating rigid bodies: closed triangles in water, with thrust and rudder.
//!
//! Pressure is hydrostatic, plus the undisturbed wave's (Froude–Krylov). The surface is the mean plane of
//! the wave over the bounds of the body. Rudder: Fujii & Tuda, J. Soc. Nav. Archit. Japan 110, 1961; race of the
//! propeller: momentum theory (Rankine 1865).
//!
//! Limits: no radiation memory, diffraction, lift of the hull or Munk moment.
//!
//! Theory manual: equations (6.31a) to (6.31c) of `docs/theory/track.md`.

use super::body::Body;
use super::enclosed::enclosed;
use super::input::{BodyWater, Propulsion, RigidBody, Rudder};
use super::servo::interpolated;
use super::state::WallState;
use crate::base::Vec3;
use crate::body_force::{Skin, Water};
use crate::integrate::rotation;
use nalgebra::{Matrix3, UnitQuaternion};
use std::f64::consts::PI;

/// Angle and share of the height by which hydrostatic stiffness is measured.
const TILT: f64 = 1e-4;

/// Halvings of the height by which the draught is found.
const HALVED: usize = 50;

/// Load of the water and of the propulsion on a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WaterLoad {
    /// Force of the water without thrust, rudder and added mass [N].
    pub force: Vec3,
    /// Its moment about the centre of mass [N m].
    pub moment: Vec3,
    /// Requested and applied thrust [N]; none is applied above water.
    pub thrust: [f64; 2],
    /// Force on the rudder [N].
    pub rudder: Vec3,
    /// Rudder angle, positive to port [rad].
    pub angle: f64,
    /// Force and moment of thrust and rudder.
    driven: [Vec3; 2],
    /// Added mass by axis of the body [kg].
    added: Vec3,
}

/// Water plane and motion over the body.
struct Field {
    /// Unit normal, and its distance from the centre of mass [m].
    up: Vec3,
    level: f64,
    velocity: Vec3,
    acceleration: Vec3,
    /// Angular velocity of the plane [rad/s].
    spin: Vec3,
}

impl Field {
    fn still(level: f64, velocity: Vec3) -> Field {
        Field { up: Vec3::z(), level, velocity, acceleration: Vec3::zeros(), spin: Vec3::zeros() }
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Hull {
    water: Water,
    gravity: Vec3,
    given: BodyWater,
    propulsion: Option<Propulsion>,
    skin: Skin,
    /// Bounds in the body frame, about the centre of mass: middle and half lengths [m].
    middle: Vec3,
    half: Vec3,
    /// Levers of the moments against rotation, cubed [m³].
    levers: Vec3,
    /// Displaced mass of the floating body [kg].
    displaced: f64,
    /// Linear damping in heave [N s/m], roll, pitch [N m s].
    damping: Vec3,
    /// Inertia, and that without added inertia over inertia with it, in the body frame.
    inertia: Matrix3<f64>,
    torque: Matrix3<f64>,
}

impl Hull {
    /// # Errors
    /// Open surfaces, too many vertices.
    pub fn new(
        body: &Body,
        input: &RigidBody,
        (vertices, triangles): (&[Vec3], &[[u32; 3]]),
        water: &Water,
        gravity: &Vec3,
    ) -> Result<Option<Hull>, &'static str> {
        let Some(given) = input.water else { return Ok(None) };
        let solid = enclosed(vertices, triangles).ok_or("its surface must be closed to float")?;
        let skin = Skin::of_surface(vertices, &solid.faces, &body.centre)
            .ok_or("a floating surface has at most 65,536 vertices")?;
        let frame = body.axes.to_rotation_matrix();
        let inertia = frame * Matrix3::from_diagonal(&body.inertia) * frame.inverse();
        let added = Matrix3::from_diagonal(&given.added_inertia.component_mul(&inertia.diagonal()));
        let torque = (inertia + added).try_inverse().map_or(Matrix3::identity(), |inverse| inertia * inverse);
        let ends = body.vertices.iter().map(|v| v - body.centre);
        let (low, high) = ends.fold((Vec3::repeat(f64::MAX), Vec3::repeat(f64::MIN)), |(low, high), v| {
            (low.inf(&v), high.sup(&v))
        });
        let half = (high - low) * 0.5;
        let lever = |i: usize, j: usize| libm::hypot(half[i], half[j]).powi(3);
        let mut hull = Hull {
            water: *water,
            gravity: *gravity,
            given,
            propulsion: input.propulsion.clone(),
            skin,
            middle: (high + low) * 0.5,
            half,
            levers: Vec3::new(lever(1, 2), lever(0, 2), lever(0, 1)),
            displaced: 0.0,
            damping: Vec3::zeros(),
            inertia,
            torque,
        };
        hull.measure(body.mass);
        Ok(Some(hull))
    }

    /// Damping at the draught in still water, upright.
    fn measure(&mut self, mass: f64) {
        let (density, g) = (self.water.density, self.gravity.norm());
        let below = |turn: &Vec3, level: f64| {
            let turn = rotation::by(turn);
            let wet = self.skin.surface_below(&turn.inverse_transform_vector(&Vec3::z()), level, &Vec3::x());
            (density * wet.volume, turn * wet.arm)
        };
        let (mut level, mut step) = (self.middle.z, self.half.z);
        for _ in 0..HALVED {
            step *= 0.5;
            level += if below(&Vec3::zeros(), level).0 < mass { step } else { -step };
        }
        let displaced = below(&Vec3::zeros(), level).0;
        let rise = TILT * self.half.z;
        let heave = g * (below(&Vec3::zeros(), level + rise).0 - below(&Vec3::zeros(), level - rise).0)
            / (2.0 * rise);
        let righting = |axis: usize| {
            let moment = |angle: f64| {
                let (mass, arm) = below(&Vec3::ith(axis, angle), level);
                arm.cross(&(Vec3::z() * (mass * g)))[axis]
            };
            (moment(-TILT) - moment(TILT)) / (2.0 * TILT)
        };
        let stiffness = Vec3::new(heave, righting(0), righting(1));
        let moving = Vec3::new(
            mass + self.given.added_mass.z * displaced,
            self.inertia[(0, 0)] * (1.0 + self.given.added_inertia.x),
            self.inertia[(1, 1)] * (1.0 + self.given.added_inertia.y),
        );
        let critical = stiffness.zip_map(&moving, |k, m| 2.0 * (k.max(0.0) * m).sqrt());
        self.damping = self.given.damping_ratio.component_mul(&critical);
        self.displaced = displaced;
    }

    /// Shortest time per radian in heave, roll, pitch [s], from the bounds.
    pub fn time_constant(&self, mass: f64) -> f64 {
        let heave = 4.0 * self.water.density * self.gravity.norm() * self.half.x * self.half.y;
        let turn = |k: usize, lever: f64| self.inertia[(k, k)] / (heave * lever * lever / 3.0);
        (mass / heave).min(turn(0, self.half.y)).min(turn(1, self.half.x)).sqrt()
    }

    /// Mean plane and motion of the water over the bounds, by two Gauss points along either horizontal axis.
    fn field(&self, centre: &Vec3, turn: &UnitQuaternion<f64>, time: f64) -> Field {
        let water = &self.water;
        let still = water.level - centre.z;
        let current = Vec3::new(water.current[0], water.current[1], 0.0);
        let Some(wave) = &water.wave else {
            return Field::still(still, current);
        };
        let lowest = self.skin.points().iter().map(|p| (turn * p).z).fold(f64::INFINITY, f64::min);
        let depth = 0.5 * (lowest - still);
        let ahead = turn * Vec3::x();
        let flat = libm::hypot(ahead.x, ahead.y);
        let ahead = if flat > 0.0 { Vec3::new(ahead.x, ahead.y, 0.0) / flat } else { Vec3::x() };
        let abeam = Vec3::z().cross(&ahead);
        let middle = turn * self.middle;
        let far = self.half / 3.0_f64.sqrt();
        let mut field = Field::still(0.0, current);
        for (i, j) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let at = centre + middle + ahead * (i * far.x) + abeam * (j * far.y);
            let orbit = wave.at(at.x, at.y, depth, time);
            let lever = ahead * (0.25 * i / far.x) + abeam * (0.25 * j / far.y);
            field.level += 0.25 * orbit.elevation;
            field.up -= lever * orbit.elevation;
            field.spin += lever.cross(&Vec3::z()) * orbit.velocity.z;
            field.velocity += orbit.velocity * 0.25;
            field.acceleration += orbit.acceleration * 0.25;
        }
        field.up.normalize_mut();
        field.level = field.up.dot(&Vec3::new(middle.x, middle.y, still + field.level));
        field
    }

    /// Load at a time [s]; `late`: time since the velocity of the state [s].
    pub fn load(&self, body: &Body, state: &WallState, time: f64, late: f64) -> WaterLoad {
        let turn = &state.orientation;
        let back = |v: &Vec3| turn.inverse_transform_vector(v);
        let centre = body.centre + state.offset;
        let field = self.field(&centre, turn, time);
        let velocity = state.velocity + state.acceleration * late;
        let flow = field.velocity - velocity;
        let (flow_body, spin) = (back(&flow), back(&(state.spin - field.spin)));
        let speed = flow.norm();
        let along = if speed > 0.0 { flow_body / speed } else { Vec3::x() };
        let wet = self.skin.surface_below(&back(&field.up), field.level, &along);
        let density = self.water.density;
        let displaced = density * wet.volume;
        let dynamic = 0.5 * density;
        let form = self.given.drag.component_mul(&flow_body) * wet.seen;
        let mut drag = turn * ((form + flow_body * (self.given.skin_drag * wet.area)) * (dynamic * speed));
        // Less linear damping as the body leaves the water.
        let fraction = if self.displaced > 0.0 { (displaced / self.displaced).min(1.0) } else { 0.0 };
        drag.z += self.damping.x * fraction * flow.z;
        let linear = Vec3::new(self.damping.y, self.damping.z, 0.0) * fraction;
        let brake = Vec3::from_fn(|d, _| {
            let quadratic = dynamic * self.given.drag_moment[d] * self.levers[d] * wet.area * spin[d].abs();
            -(quadratic + linear[d]) * spin[d]
        });
        let force = (field.acceleration - self.gravity) * displaced + drag;
        let added = self.given.added_mass * displaced;
        let carried = turn * added.component_mul(&back(&field.acceleration));
        let moment = (turn * wet.arm).cross(&force) + turn * brake;
        let mut load = WaterLoad { force: force + carried, moment, added, ..WaterLoad::default() };
        if let Some(propulsion) = &self.propulsion {
            self.drive(propulsion, body, (state, &velocity, &field), time, &mut load);
        }
        load
    }

    fn drive(
        &self,
        propulsion: &Propulsion,
        body: &Body,
        (state, velocity, field): (&WallState, &Vec3, &Field),
        time: f64,
        load: &mut WaterLoad,
    ) {
        let turn = &state.orientation;
        let arm = |point: &Vec3| turn * (point - body.centre);
        let wet = |arm: &Vec3| field.up.dot(arm) < field.level;
        let inflow = |arm: &Vec3| field.velocity - velocity - state.spin.cross(arm);
        let ahead = turn * propulsion.direction;
        let requested = interpolated(&propulsion.thrust, time);
        let propeller = arm(&propulsion.point);
        let thrust = if wet(&propeller) { requested } else { 0.0 };
        load.thrust = [requested, thrust];
        let mut driven = [ahead * thrust, propeller.cross(&(ahead * thrust))];
        if let Some(rudder) = &propulsion.rudder {
            load.angle = interpolated(&rudder.angle, time);
            let at = arm(&rudder.point);
            if wet(&at) {
                let race = self.race(propulsion, thrust, -inflow(&propeller).dot(&ahead));
                let inflow = inflow(&at) - ahead * race;
                load.rudder = self.steer(rudder, load.angle, &ahead, &(turn * Vec3::z()), &inflow);
                driven[0] += load.rudder;
                driven[1] += at.cross(&load.rudder);
            }
        }
        load.driven = driven;
    }

    /// Speed that the propeller adds to the water [m/s], at a speed of advance.
    fn race(&self, propulsion: &Propulsion, thrust: f64, advance: f64) -> f64 {
        let disc = 0.25 * PI * propulsion.diameter * propulsion.diameter;
        if disc <= 0.0 || thrust <= 0.0 {
            return 0.0;
        }
        let advance = advance.max(0.0);
        (advance * advance + 2.0 * thrust / (self.water.density * disc)).sqrt() - advance
    }

    /// Normal force of a rudder in an inflow.
    fn steer(&self, rudder: &Rudder, angle: f64, ahead: &Vec3, stock: &Vec3, inflow: &Vec3) -> Vec3 {
        let port = stock.cross(ahead).normalize();
        let flow = inflow - stock * stock.dot(inflow);
        let (sin, cos) = libm::sincos(angle);
        let normal = port * cos + port.cross(stock) * sin;
        let slope = 6.13 * rudder.aspect_ratio / (rudder.aspect_ratio + 2.25);
        normal * (0.5 * self.water.density * rudder.area * slope * flow.norm() * flow.dot(&normal))
    }

    /// Force and torque of water and propulsion, with the reaction of the added masses to all `others` (force
    /// with gravity and supports, torque).
    pub fn act(
        &self,
        body: &Body,
        state: &WallState,
        load: &WaterLoad,
        (others, twist): (&Vec3, &Vec3),
    ) -> (Vec3, Vec3) {
        let (force, torque) = (load.force + load.driven[0], load.moment + load.driven[1]);
        let all = others + force;
        let turn = state.orientation.to_rotation_matrix();
        let back = |m: Matrix3<f64>| turn * m * turn.inverse();
        let reaction = if load.added == Vec3::zeros() {
            Vec3::zeros()
        } else {
            let mut mass = back(Matrix3::from_diagonal(&load.added)) + Matrix3::identity() * body.mass;
            let mut free = all;
            for d in (0..3).filter(|d| body.fixed >> d & 1 == 1) {
                mass.row_mut(d).fill(0.0);
                mass.column_mut(d).fill(0.0);
                (mass[(d, d)], free[d]) = (1.0, 0.0);
            }
            let acceleration = mass.try_inverse().map_or(free / body.mass, |inverse| inverse * free);
            acceleration * body.mass - free
        };
        let about = torque + twist;
        let spun = if self.given.added_inertia == Vec3::zeros() {
            Vec3::zeros()
        } else {
            back(self.torque) * about - about
        };
        (force + reaction, torque + spun)
    }
}
