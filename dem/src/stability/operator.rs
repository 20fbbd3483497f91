//! Operator M^(−½) (dt² K + 2 dt C) M^(−½) of current contacts and bonds.

use crate::base::Vec3;
use crate::base::error::Partner;
use crate::bodies::table::BodyKind;
use crate::bond::kernel;
use crate::contact::narrow_phase::ContactView;
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::engine::wall_contacts;
use crate::law::half_step_damping;
use crate::measure;
use nalgebra::{Matrix3, UnitQuaternion};

#[derive(Clone, Copy, Default)]
struct Pair {
    along: f64,
    across: f64,
}

impl Pair {
    fn apply(&self, n: &Vec3, v: &Vec3) -> Vec3 {
        v * self.across + n * ((self.along - self.across) * n.dot(v))
    }
}

/// Contact or bond of two bodies, or of body and fixed partner.
struct Link {
    /// Bodies; [`NOTHING`] for a fixed partner.
    ends: [u32; 2],
    arms: [Vec3; 2],
    normal: Vec3,
    /// Translational, rotational.
    stiffness: [Pair; 2],
    damping: [Pair; 2],
    /// C/2m* of a law's dashpot [1/s] for its half-step correction (`law/composed.rs`), else zero.
    lag: f64,
    now: [Pair; 2],
}

const NOTHING: u32 = u32::MAX;

impl Link {
    fn of(model: &Model, c: &ContactView<'_>, ends: [u32; 2], arms: [Vec3; 2]) -> Link {
        let g = &c.geometry;
        let law = model.laws.linearised(c.materials, 1.0 / c.inverse_mass, g.radius, g.overlap, c.history);
        let pair = |along: f64, across: f64| Pair { along: along * c.weight, across: across * c.weight };
        Link {
            ends,
            arms,
            normal: g.normal,
            stiffness: [pair(law.normal, law.tangential), pair(law.twisting, law.rolling)],
            damping: [pair(law.damping, law.tangential_damping), Pair::default()],
            lag: 0.5 * law.damping * c.inverse_mass,
            now: [Pair::default(); 2],
        }
    }

    /// ¼ k δ² [J] with the tangent stiffness: 0.94 of the energy of a Hertz contact.
    fn spring_energy(&self, overlap: f64) -> f64 {
        0.25 * self.stiffness[0].along * overlap * overlap
    }
}

pub(super) struct Operator {
    links: Vec<Link>,
    /// Square roots of inverse mass by axis and of inverse inertia tensor: bodies, then rigid walls.
    bodies: Vec<([f64; 3], Matrix3<f64>)>,
    /// Index in `bodies`, or [`NOTHING`].
    walls: Vec<u32>,
    /// Bodies with mount, stiffness by axis. Its dashpot has no delay: no reduction of the step.
    mounts: Vec<(u32, Vec3)>,
    /// Estimated energy of the contacts [J].
    energy: f64,
    /// Current step squared [s²].
    square: f64,
    motion: Vec<[Vec3; 2]>,
    force: Vec<[Vec3; 2]>,
}

impl Operator {
    pub fn new(model: &Model, state: &State) -> Operator {
        let mut bodies: Vec<_> = (0..model.body_count()).map(|b| mobility(model, state, b)).collect();
        let (mut walls, mut mounts) = (Vec::new(), Vec::new());
        for (wall, own) in model.walls.walls.iter().zip(&state.walls) {
            let Some(body) = &wall.body else {
                walls.push(NOTHING);
                continue;
            };
            let number = bodies.len() as u32;
            walls.push(number);
            mounts.extend(body.mount_stiffness().map(|k| (number, k)));
            bodies.push(moved(body.fixed, body.mass, &body.inertia, Some(own.frame)));
        }
        let still = vec![[Vec3::zeros(); 2]; bodies.len()];
        let (motion, force) = (still.clone(), still);
        let mut operator =
            Operator { links: Vec::new(), bodies, walls, mounts, energy: 0.0, square: 0.0, motion, force };
        operator.add_contacts(model, state);
        operator.add_wall_contacts(model, state);
        operator.add_bonds(model, state);
        operator
    }

    pub fn links(&self) -> usize {
        self.links.len()
    }

    /// Estimated energy of the contacts [J].
    pub fn spring_energy(&self) -> f64 {
        self.energy
    }

    pub fn len(&self) -> usize {
        6 * self.bodies.len()
    }

    fn add_contacts(&mut self, model: &Model, state: &State) {
        let (links, energy, walls) = (&mut self.links, &mut self.energy, &self.walls);
        let moving = |partner: Partner| match partner {
            Partner::Body(b) => Some((b as u32, state.position(b))),
            other => {
                let wall = model.walls.wall_of_partner(other)?;
                let number = *walls.get(wall).filter(|n| **n != NOTHING)?;
                Some((number, model.walls.walls[wall].centre + state.walls[wall].offset))
            }
        };
        measure::visit(model, state, 0.0, |c| {
            // Both fixed.
            if c.contact.inverse_mass == 0.0 {
                return;
            }
            let (g, other) = (&c.contact.geometry, moving(c.partner));
            let ends = [c.body, other.map_or(NOTHING, |(number, _)| number)];
            let arms = [
                g.point - state.position(c.body as usize),
                other.map_or_else(Vec3::zeros, |(_, centre)| g.point - c.shift - centre),
            ];
            let link = Link::of(model, &c.contact, ends, arms);
            *energy += link.spring_energy(g.overlap);
            links.push(link);
        });
    }

    fn add_wall_contacts(&mut self, model: &Model, state: &State) {
        wall_contacts::visit(model, state, 0.0, |walls, c| {
            let [a, b] = walls.map(|w| w as usize);
            let arm = |w: usize| c.geometry.point - model.walls.walls[w].centre - state.walls[w].offset;
            // A wall with prescribed motion comes second.
            let [first, second] = if self.walls[a] == NOTHING { [b, a] } else { [a, b] };
            let ends = [self.walls[first], self.walls[second]];
            let link = Link::of(model, c, ends, [arm(first), arm(second)]);
            self.energy += link.spring_energy(c.geometry.overlap);
            self.links.push(link);
        });
    }

    fn add_bonds(&mut self, model: &Model, state: &State) {
        state.each_bond(|number, _| {
            let bond = &model.bonds[number as usize];
            let [a, b] = bond.ends.map(|e| state.position(e as usize));
            let (k, length) = (&bond.values, (a - b).norm());
            let normal = (a - b) / length;
            let arm = |sign: f64| 0.5 * (length + sign * k[kernel::OFFSET]);
            let values = |first: usize| {
                let pair =
                    |along: usize, across: usize| Pair { along: k[first + along], across: k[first + across] };
                [pair(0, 1), pair(3, 2)]
            };
            self.links.push(Link {
                ends: bond.ends,
                arms: [normal * -arm(1.0), normal * arm(-1.0)],
                normal,
                stiffness: values(kernel::STIFFNESS),
                damping: values(kernel::DAMPING),
                lag: 0.0,
                now: [Pair::default(); 2],
            });
        });
    }

    pub fn at(&mut self, dt: f64) -> &mut Operator {
        self.square = dt * dt;
        for link in &mut self.links {
            let (numerator, denominator) = half_step_damping::share(link.lag * dt);
            let share = numerator / denominator;
            link.now = std::array::from_fn(|m| {
                let (k, c) = (&link.stiffness[m], &link.damping[m]);
                let at = |k: f64, c: f64| dt * dt * k + 2.0 * dt * c * share;
                Pair { along: at(k.along, c.along), across: at(k.across, c.across) }
            });
        }
        self
    }

    /// `out` = operator × `v`; per body displacement and rotation.
    pub fn apply(&mut self, v: &[f64], out: &mut [f64]) {
        let six = |v: &[f64]| [Vec3::new(v[0], v[1], v[2]), Vec3::new(v[3], v[4], v[5])];
        let scaled = |(root, turn): &([f64; 3], Matrix3<f64>), [x, w]: [Vec3; 2]| {
            [Vec3::from_fn(|d, _| root[d] * x[d]), turn * w]
        };
        for ((motion, force), (body, v)) in
            self.motion.iter_mut().zip(&mut self.force).zip(self.bodies.iter().zip(v.chunks_exact(6)))
        {
            *motion = scaled(body, six(v));
            *force = [Vec3::zeros(); 2];
        }
        for link in &self.links {
            let [a, b] = link.ends.map(|e| e as usize);
            let at = |[v, w]: &[Vec3; 2], arm: &Vec3| v + w.cross(arm);
            let mut slip = at(&self.motion[a], &link.arms[0]);
            let mut turn = self.motion[a][1];
            if link.ends[1] != NOTHING {
                slip -= at(&self.motion[b], &link.arms[1]);
                turn -= self.motion[b][1];
            }
            let (pull, couple) =
                (link.now[0].apply(&link.normal, &slip), link.now[1].apply(&link.normal, &turn));
            self.force[a][0] += pull;
            self.force[a][1] += link.arms[0].cross(&pull) + couple;
            if link.ends[1] != NOTHING {
                self.force[b][0] -= pull;
                self.force[b][1] -= link.arms[1].cross(&pull) + couple;
            }
        }
        for (body, stiffness) in &self.mounts {
            let v = self.motion[*body as usize][0];
            self.force[*body as usize][0] += stiffness.component_mul(&v) * self.square;
        }
        for ((force, body), out) in self.force.iter().zip(&self.bodies).zip(out.chunks_exact_mut(6)) {
            let [x, w] = scaled(body, *force);
            out[..3].copy_from_slice(x.as_slice());
            out[3..].copy_from_slice(w.as_slice());
        }
    }
}

/// Square roots of inverse mass by axis and of inverse inertia tensor, world axes; zero if fixed.
fn mobility(model: &Model, state: &State, body: usize) -> ([f64; 3], Matrix3<f64>) {
    let b = model.body(body);
    if !state.present(body) {
        return ([0.0; 3], Matrix3::zeros());
    }
    let frame = (b.kind != BodyKind::Sphere).then(|| state.orientation(model, body));
    moved(b.fixed, b.mass, &b.inertia, frame)
}

/// Bits of `fixed`: translation, then rotation.
fn moved(
    fixed: u8,
    mass: f64,
    inertia: &Vec3,
    frame: Option<UnitQuaternion<f64>>,
) -> ([f64; 3], Matrix3<f64>) {
    let free = |d: usize| if fixed >> d & 1 == 1 { 0.0 } else { 1.0 };
    let root = std::array::from_fn(|d| free(d) / mass.sqrt());
    let local = Matrix3::from_diagonal(&inertia.map(|i| 1.0 / i.sqrt()));
    let turned = match frame.map(|q| q.to_rotation_matrix()) {
        None => local,
        Some(turn) => turn.matrix() * local * turn.matrix().transpose(),
    };
    (root, Matrix3::from_fn(|i, j| turned[(i, j)] * free(3 + i) * free(3 + j)))
}
