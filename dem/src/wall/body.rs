//! Rigid-body walls: mass properties, motion (as clumps, `integrate/leapfrog.rs`, `integrate/rotation.rs`),
//! mount, vertex–plane contacts.
//!
//! Not supported: round bodies on infinite planes, or in contact with each other (error on overlapping
//! bounds).

use super::enclosed::{Enclosed, enclosed};
use super::hull::{Hull, WaterLoad};
use super::input::{Mount, RigidBody};
use super::mount;
use super::shape::WallShape;
use super::state::{VertexContact, WallState};
use crate::base::Vec3;
use crate::base::balance_terms::{BalanceTerms, Impulse};
use crate::base::error::ModelError;
use crate::bodies::block::Rotation;
use crate::body_force::Water;
use crate::contact::scalar;
use crate::integrate::step_size::StepSize;
use crate::law::{ContactGeometry, History, Laws};
use crate::shape::cuboid;
use crate::shape::plane::{Plane, PlaneMotion};
use crate::spatial::detect;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

#[derive(Clone, Debug)]
pub(crate) struct Body {
    pub mass: f64,
    /// Zero without free translation.
    pub inverse_mass: f64,
    pub centre: Vec3,
    /// Principal moments [kg m²], initial principal frame.
    pub inertia: Vec3,
    pub axes: UnitQuaternion<f64>,
    pub velocity: Vec3,
    pub spin: Vec3,
    /// Bits 0–2 translation, 3–5 rotation.
    pub fixed: u8,
    /// Largest vertex distance from the centre, half bounds in the initial frame [m].
    pub reach: f64,
    pub half: Vec3,
    /// Triangle vertices, or bounding box corners of a round shape [m].
    pub vertices: Vec<Vec3>,
    /// Whether vertices contact planes.
    stands: bool,
    mount: Option<Mount>,
    /// Water on it, if it floats.
    hull: Option<Box<Hull>>,
}

impl Body {
    /// `bounds`: bounding box corners of its patches [m].
    ///
    /// # Errors
    /// Planes, open surfaces without centre and inertia, free rotation of a round body without inertia,
    /// invalid inertia.
    pub fn new(
        input: &RigidBody,
        shape: &WallShape,
        bounds: Vec<Vec3>,
        name: &str,
    ) -> Result<Body, ModelError> {
        let error = |problem| ModelError::Wall { wall: name.to_string(), problem };
        let mut bits = input.fixed.iter().enumerate().map(|(k, &f)| u8::from(f) << k).sum::<u8>();
        let stands = shape.triangulated().is_some();
        let (centre, tensor, vertices) = if let Some((vertices, triangles)) = shape.triangulated() {
            let (centre, tensor) = of_triangles(input, vertices, triangles).map_err(error)?;
            let mut used = vec![false; vertices.len()];
            triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
            let vertices = vertices.iter().zip(used).filter_map(|(v, used)| used.then_some(*v));
            (centre, tensor, vertices.collect())
        } else if shape.plane().is_some() {
            return Err(error("an infinite plane cannot be a rigid body"));
        } else {
            let centre = input.centre.unwrap_or_else(|| shape.middle());
            let tensor = match input.inertia {
                Some(given) => of_six(given),
                None if input.spin != Vec3::zeros() => {
                    return Err(error("a round body rotates only if its inertia is given"));
                }
                // Arbitrary: no rotation.
                None => {
                    bits |= 0b11_1000;
                    Matrix3::identity() * input.mass
                }
            };
            (centre, tensor, bounds)
        };
        let (inertia, axes) = principal(&tensor);
        let sum = inertia.sum();
        if !(inertia.min() > 0.0 && sum.is_finite() && 2.0 * inertia.max() <= sum * (1.0 + 1e-9)) {
            return Err(error("its moments of inertia are not those of a rigid body"));
        }
        let half = vertices.iter().fold(Vec3::zeros(), |h, v| h.sup(&(v - centre).abs()));
        Ok(Body {
            mass: input.mass,
            inverse_mass: if bits & 7 == 7 { 0.0 } else { 1.0 / input.mass },
            centre,
            inertia,
            axes,
            velocity: input.velocity,
            spin: input.spin,
            fixed: bits,
            reach: vertices.iter().map(|v| (v - centre).norm()).fold(0.0, f64::max),
            half,
            vertices,
            stands,
            mount: input.mount.filter(|m| m.stiffness != Vec3::zeros() || m.damping != Vec3::zeros()),
            hull: None,
        })
    }

    /// Lets water act on the body; `surface`: of the wall.
    ///
    /// # Errors
    /// As [`Hull::new`].
    pub fn float(
        &mut self,
        input: &RigidBody,
        surface: (&[Vec3], &[[u32; 3]]),
        water: &Water,
        gravity: &Vec3,
    ) -> Result<(), &'static str> {
        self.hull = Hull::new(self, input, surface, water, gravity)?.map(Box::new);
        Ok(())
    }

    /// Velocities half a step earlier.
    pub fn start(&self, state: &mut WallState, gravity: &Vec3, dt: f64) {
        let damping =
            self.mount.map_or(Vec3::zeros(), |m| m.damping.component_mul(&self.velocity) / self.mass);
        let mut kick =
            Vec3::from_fn(|d, _| if self.fixed >> d & 1 == 1 { 0.0 } else { gravity[d] - damping[d] });
        state.velocity = self.velocity;
        state.spin = self.spin;
        state.frame = self.axes;
        let local = self.axes.inverse_transform_vector(&self.spin);
        state.momentum = self.axes * local.component_mul(&self.inertia);
        if let Some((force, _)) = self.action(state, (&Vec3::zeros(), &Vec3::zeros()), gravity, (0.0, 0.0)) {
            for d in (0..3).filter(|d| self.fixed >> d & 1 == 0) {
                kick[d] += force[d] / self.mass;
            }
        }
        state.velocity = self.velocity - kick * (0.5 * dt);
    }

    /// Load of the water, if the body floats; `late`: time since the velocity of the state [s].
    pub fn water_load(&self, state: &WallState, time: f64, late: f64) -> Option<WaterLoad> {
        self.hull.as_ref().map(|hull| hull.load(self, state, time, late))
    }

    /// Force and torque of the water, if the body floats, under those of contacts.
    pub fn action(
        &self,
        state: &WallState,
        (force, torque): (&Vec3, &Vec3),
        gravity: &Vec3,
        (time, late): (f64, f64),
    ) -> Option<(Vec3, Vec3)> {
        let hull = self.hull.as_ref()?;
        let load = hull.load(self, state, time, late);
        let support = self.mount.map_or(Vec3::zeros(), |m| {
            -m.stiffness.component_mul(&state.offset) - m.damping.component_mul(&state.velocity)
        });
        let others = force + gravity * self.mass + support;
        Some(hull.act(self, state, &load, (&others, torque)))
    }

    /// Shortest time per radian of the body in the water [s].
    pub fn water_time(&self) -> f64 {
        self.hull.as_ref().map_or(f64::INFINITY, |hull| hull.time_constant(self.mass))
    }

    fn spin_of(&self, frame: &UnitQuaternion<f64>, momentum: &Vec3) -> Vec3 {
        frame * frame.inverse_transform_vector(momentum).component_div(&self.inertia)
    }

    /// Advances one step; `force` and `torque` about the centre, without gravity.
    pub fn advance(
        &self,
        state: &mut WallState,
        force: &Vec3,
        torque: &Vec3,
        gravity: &Vec3,
        step_size: &StepSize,
        balance: &mut BalanceTerms,
    ) {
        let (kick, dt) = (step_size.kick(), step_size.dt);
        let x = self.centre + state.offset;
        let (v0, w0) = (state.velocity, state.spin);
        let pull = gravity * self.mass;
        balance.gravity.add(&x, &(pull * kick));
        let whole = force + pull;
        let mut v1 = match &self.mount {
            None => v0 + whole * (kick / self.mass),
            Some(m) => mount::kick(m, self.mass, &v0, &whole, (&x, &state.offset), kick, balance),
        };
        for d in 0..3 {
            if self.fixed >> d & 1 == 1 {
                v1[d] = v0[d];
            }
        }
        if self.fixed & 7 != 0 {
            let held = |d: usize| self.fixed >> d & 1 == 1;
            let hold = Vec3::from_fn(|d, _| if held(d) { -whole[d] * kick } else { 0.0 });
            balance.constraints.add(&x, &hold);
            balance.work_constraints += hold.dot(&((v0 + v1) * 0.5));
        }
        state.velocity = v1;
        state.acceleration = (v1 - v0) / kick;
        state.offset += v1 * dt;

        let before = state.momentum;
        state.momentum += torque * kick;
        let kicked = self.spin_of(&state.frame, &state.momentum);
        if self.fixed >> 3 == 0 {
            state.frame =
                crate::integrate::rotation::free_one(&state.frame, &state.momentum, &self.inertia, dt);
            state.spin = self.spin_of(&state.frame, &state.momentum);
        } else {
            let rotation = Rotation { orientation: state.frame, momentum: state.momentum };
            let kicked = crate::integrate::leapfrog::hold(
                &rotation,
                &self.inertia,
                &kicked,
                &self.spin,
                self.fixed >> 3,
            );
            state.frame = crate::integrate::rotation::steady(&state.frame, &kicked, dt);
            let local = state.frame.inverse_transform_vector(&kicked);
            state.momentum = state.frame * local.component_mul(&self.inertia);
            state.spin = kicked;
            balance.constraints.angular += state.momentum - before - torque * kick;
            balance.work_constraints += 0.5 * (state.momentum.dot(&kicked) - before.dot(&w0))
                - torque.dot(&((w0 + kicked) * 0.5)) * kick;
        }
        state.orientation = state.frame * self.axes.inverse();
        state.turned = true;
    }

    pub fn rests_on_ground(&self) -> bool {
        self.stands
    }

    pub fn speed(&self, state: &WallState) -> f64 {
        state.velocity.norm() + state.spin.norm() * self.reach
    }

    /// Kinetic (translation, rotation), potential, mount energy at the last half step [J]. `back`: half of
    /// the last step [s].
    pub fn energies(&self, state: &WallState, gravity: &Vec3, back: f64) -> [f64; 4] {
        let offset = state.offset - state.velocity * back;
        let x = self.centre + offset;
        [
            0.5 * self.mass * state.velocity.norm_squared(),
            0.5 * state.spin.dot(&state.momentum),
            -self.mass * gravity.dot(&x),
            self.mount.as_ref().map_or(0.0, |m| mount::stored(m, &offset)),
        ]
    }

    /// Adds momentum as [`crate::measure::momentum`].
    pub fn momentum(&self, state: &WallState, sum: &mut Impulse) {
        sum.add(&(self.centre + state.offset), &(state.velocity * self.mass));
        sum.angular += state.momentum;
    }

    pub fn mount_stiffness(&self) -> Option<Vec3> {
        self.mount.map(|m| m.stiffness)
    }

    /// Square of the highest mount frequency [1/s²].
    pub fn mount_frequency(&self) -> f64 {
        self.mount.as_ref().map_or(0.0, |m| mount::highest(m, self.mass))
    }

    /// Time step limit for contact stiffness `k` [N/m] and damping ratio `zeta`: box of the body's bounds
    /// under grains of radius `r`, plus mount.
    pub fn step_limit(&self, k: f64, tangential: f64, zeta: f64, r: f64) -> f64 {
        let n = self.half.map(|h| h / r + 1.0);
        let sides = 4.0 * (n.x * n.y).max(n.y * n.z).max(n.z * n.x);
        let lever = || cuboid::levers2(&self.half).into_iter().fold(0.0, f64::max);
        let turn = if self.fixed >> 3 == 7 { 0.0 } else { lever() };
        let own = k.max(tangential) * (1.0 / self.mass + turn / self.inertia.min());
        let zeta = zeta * (0.5 * sides).sqrt();
        let mount = self.mount_frequency();
        if mount > 0.0 {
            // (λ + ω²) dt² + 4 ζ' √λ dt = 4.
            let (all, damping) = (sides * own + mount, 4.0 * zeta * (sides * own).sqrt());
            return ((damping * damping + 4.0 * all).sqrt() - damping) / all;
        }
        ((4.0 + 16.0 * zeta * zeta).sqrt() - 4.0 * zeta) / (sides * own).sqrt()
    }
}

/// Centre of mass [m], inertia tensor [kg m²].
fn of_triangles(
    input: &RigidBody,
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
) -> Result<(Vec3, Matrix3<f64>), &'static str> {
    if let (Some(centre), Some(given)) = (input.centre, input.inertia) {
        return Ok((centre, of_six(given)));
    }
    let missing = "its surface is not closed: give the centre and the inertia of the body";
    let Enclosed { volume, centre: own, inertia, .. } = enclosed(vertices, triangles).ok_or(missing)?;
    let centre = input.centre.unwrap_or(own);
    let d = centre - own;
    let steiner = Matrix3::identity() * d.norm_squared() - d * d.transpose();
    let own = inertia * (input.mass / volume) + steiner * input.mass;
    Ok((centre, input.inertia.map_or(own, of_six)))
}

fn of_six([xx, yy, zz, xy, yz, zx]: [f64; 6]) -> Matrix3<f64> {
    Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz)
}

/// Principal moments, right-handed axes (columns).
fn principal(tensor: &Matrix3<f64>) -> (Vec3, UnitQuaternion<f64>) {
    let noise = 1e-13 * tensor.trace().abs();
    let mut clean = *tensor;
    for (i, j) in [(0, 1), (1, 2), (0, 2)] {
        if clean[(i, j)].abs() <= noise {
            clean[(i, j)] = 0.0;
            clean[(j, i)] = 0.0;
        }
    }
    let diagonal = clean[(0, 1)] == 0.0 && clean[(1, 2)] == 0.0 && clean[(0, 2)] == 0.0;
    if diagonal {
        return (clean.diagonal(), UnitQuaternion::identity());
    }
    let eigen = clean.symmetric_eigen();
    let (x, y) = (eigen.eigenvectors.column(0).into_owned(), eigen.eigenvectors.column(1).into_owned());
    let axes = Matrix3::from_columns(&[x, y, x.cross(&y)]);
    (eigen.eigenvalues, UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes)))
}

#[derive(Clone, Copy)]
pub(crate) struct Ground<'a> {
    pub laws: &'a Laws,
    pub planes: &'a [Plane],
    pub motions: &'a [PlaneMotion],
    /// Vertex radius for laws with curvature [m].
    pub tip_radius: f64,
    pub dt: f64,
}

impl Ground<'_> {
    /// Laws with curvature use the radius of the smallest grain.
    fn tip(&self, at: &Vec3, origin: &Vec3, normal: &Vec3) -> Option<ContactGeometry> {
        let g = detect::sphere_plane(at, 0.0, origin, normal)?;
        Some(ContactGeometry { radius: self.tip_radius, ..g })
    }
}

/// Vertex–plane contacts: returns force and torque about the centre, adds the planes' totals.
pub(crate) fn ground_reaction(
    ground: &Ground<'_>,
    body: &Body,
    material: u32,
    state: &mut WallState,
    balance: &mut BalanceTerms,
) -> (Vec3, Vec3) {
    let &Ground { laws, planes, motions, dt, .. } = ground;
    let (mut force, mut torque) = (Vec3::zeros(), Vec3::zeros());
    let mut old = std::mem::take(&mut state.feet);
    let x = body.centre + state.offset;
    for (p, (plane, wall)) in planes.iter().zip(motions).enumerate() {
        let origin = plane.point + wall.offset;
        if wall.open
            || !body.stands
            || body.inverse_mass == 0.0
            || (x - origin).dot(&plane.normal) > body.reach
        {
            continue;
        }
        let materials = [material, plane.material as u32];
        for (v, vertex) in body.vertices.iter().enumerate() {
            let at = state.to_world(&body.centre, vertex);
            let Some(g) = ground.tip(&at, &origin, &plane.normal) else { continue };
            let mut foot = VertexContact { plane: p as u32, vertex: v as u32, history: History::NONE };
            if let Some(known) = old.iter_mut().find(|f| (f.plane, f.vertex) == (foot.plane, foot.vertex)) {
                foot.history = std::mem::replace(&mut known.history, History::NONE);
            }
            let relative = state.velocity_at(&body.centre, &g.point) - wall.velocity;
            let f = scalar::evaluate(
                laws,
                materials,
                None,
                body.inverse_mass,
                &g,
                &relative,
                &state.spin,
                &mut foot.history,
                dt,
            );
            balance.dissipated_dashpot += f.dashpot;
            balance.dissipated_friction += f.friction;
            balance.work_walls += f.force.dot(&wall.velocity) * dt;
            balance.walls.add(&g.point, &(f.force * dt));
            force += f.force;
            balance.walls.angular += f.moment * dt;
            torque += (g.point - x).cross(&f.force) + f.moment;
            state.feet.push(foot);
        }
    }
    for foot in old.iter_mut().filter(|f| !f.history.is_new()) {
        let materials = [material, planes[foot.plane as usize].material as u32];
        balance.dissipated_friction += scalar::end(laws, materials, &mut foot.history);
    }
    (force, torque)
}

/// Vertex–plane spring energy at the last half step: normal, tangential [J].
pub(crate) fn stored(ground: &Ground<'_>, body: &Body, material: u32, state: &WallState) -> [f64; 2] {
    let &Ground { laws, planes, motions, dt, .. } = ground;
    let back = 0.5 * dt;
    let mut then = state.clone();
    then.offset -= state.velocity * back;
    then.orientation = crate::integrate::rotation::steady(&state.orientation, &state.spin, -back);
    let mut sum = [0.0; 2];
    for foot in &state.feet {
        let (plane, wall) = (&planes[foot.plane as usize], &motions[foot.plane as usize]);
        let at = then.to_world(&body.centre, &body.vertices[foot.vertex as usize]);
        let origin = plane.point + wall.offset - wall.velocity * back;
        let Some(ContactGeometry { point, normal, overlap, radius }) =
            ground.tip(&at, &origin, &plane.normal)
        else {
            continue;
        };
        let velocity = state.velocity_at(&body.centre, &point) - wall.velocity;
        let slip = velocity - normal * velocity.dot(&normal);
        let mut history = foot.history;
        history.spring += slip * back;
        let (n, t) = laws.stored(material, plane.material as u32, overlap, radius, &history);
        sum[0] += n;
        sum[1] += t;
    }
    sum
}

#[cfg(test)]
#[path = "body_tests.rs"]
mod tests;
