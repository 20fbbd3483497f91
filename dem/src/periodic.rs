//! Periodic axes: what leaves a box on one side is back on the other.
//!
//! Positions run on unbounded between two sortings (`order.rs`), which put every centre back into the box. A pair that
//! meets across a border is an image pair: sphere i touches sphere j where j stands moved by whole box lengths. Image
//! pairs have a list of their own; all others, far more, are those of a scene without borders. Which image j shows is
//! found from positions put back into the box, so it does not matter how far bodies have run on.
//!
//! Source: Allen & Tildesley, Computer Simulation of Liquids (2017), sec. 1.6.2: periodic boundary conditions and the
//! nearest image.
//! Limits: spheres and clumps, between planes along the periodic axes; no bonds, no other walls.

use crate::Vec3;
use crate::bodies::Bodies;
use crate::contact::pass::motion;
use crate::detect;
use crate::error::{ModelError, Partner};
use crate::input::ModelInput;
use crate::law::{ContactLaw, PairTable};
use crate::model::Model;
use crate::search::candidates::spheres;
use crate::search::cells::Cells;
use crate::shape::Shape;
use crate::state::{Block, Cross, ImageName, ImagePair, Lanes, State, set_xyz, xyz};
use crate::threads::Part;
use crate::work::{BlockWork, CrossWork, Failure};

/// Whole box lengths along x, y and z.
pub(crate) type Turns = [i32; 3];

const NONE: Turns = [0; 3];

/// The box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Periodic {
    low: Vec3,
    /// Zero along axes without borders.
    length: Vec3,
}

impl Periodic {
    /// `None` without periodic axes.
    pub fn new(input: &ModelInput) -> Option<Periodic> {
        if input.periodic.iter().all(Option::is_none) {
            return None;
        }
        let side = |d: usize| input.periodic[d].unwrap_or_default();
        let low = Vec3::from_fn(|d, _| side(d)[0]);
        Some(Periodic { low, length: Vec3::from_fn(|d, _| side(d)[1] - side(d)[0]) })
    }

    /// How many box lengths a point lies from the box.
    fn turns(&self, x: &Vec3) -> Turns {
        std::array::from_fn(|d| {
            if self.length[d] > 0.0 { ((x[d] - self.low[d]) / self.length[d]).floor() as i32 } else { 0 }
        })
    }

    /// The way of so many box lengths [m].
    #[inline(always)]
    pub fn way(&self, turns: &Turns) -> Vec3 {
        Vec3::from_fn(|d, _| f64::from(turns[d]) * self.length[d])
    }

    /// A point put back into the box.
    pub fn wrap(&self, x: &Vec3) -> Vec3 {
        let x = x - self.way(&self.turns(x));
        // Just below the lower border, the rounded sum is the upper one.
        Vec3::from_fn(|d, _| {
            let past = self.length[d] > 0.0 && x[d] >= self.low[d] + self.length[d];
            if past { self.low[d] } else { x[d] }
        })
    }
}

/// Refuses what cannot be combined with periodic axes, and boxes so short that a body may meet itself or another twice.
pub(crate) fn check(input: &ModelInput, bodies: &Bodies, skin: f64) -> Result<(), ModelError> {
    let error = |problem: String| Err(ModelError::Periodic { problem });
    if input.periodic.iter().all(Option::is_none) {
        return Ok(());
    }
    for (what, there) in [
        ("triangle surfaces", !input.triangles.is_empty()),
        ("walls other than planes", !input.walls.is_empty()),
        ("an external surface", input.surface_material.is_some()),
        ("bonds", !input.bonds.is_empty()),
    ] {
        if there {
            return error(format!("{what} cannot be combined with them"));
        }
    }
    if let Some(k) = input.bodies.iter().position(|b| matches!(input.shapes[b.shape], Shape::Box { .. })) {
        return error(format!("body {k} is a box; only spheres and clumps can cross a border"));
    }
    let largest = bodies.iter().map(|b| b.radius).fold(0.0, f64::max);
    let least = 3.0 * (2.0 * largest + skin);
    for (axis, side) in ["x", "y", "z"].iter().zip(&input.periodic) {
        let Some([low, high]) = *side else { continue };
        let length = high - low;
        if !(low.is_finite() && high.is_finite() && length > 0.0) {
            return error(format!(
                "{axis} runs from {low} to {high}; both must be finite, the second the larger"
            ));
        }
        if length < least * (1.0 - 1e-9) {
            return error(format!(
                "{axis} is {length} m long; at least {least:.3e} m (three diameters of the largest body and three times the \
                 search skin) are needed"
            ));
        }
    }
    for (k, plane) in input.planes.iter().enumerate() {
        let n = plane.normal.normalize();
        if let Some(d) = (0..3).find(|&d| input.periodic[d].is_some() && n[d].abs() > 1e-12) {
            return error(format!(
                "the normal of plane {k} has a part along {}, which is periodic",
                ["x", "y", "z"][d]
            ));
        }
    }
    Ok(())
}

/// Spheres put back into the box, for the search.
pub(crate) struct Space {
    periodic: Periodic,
    pub points: Vec<Lanes>,
    turns: Vec<Turns>,
    largest: f64,
}

impl Space {
    pub fn new(periodic: Periodic, spheres: &[Lanes], largest: f64) -> Space {
        let turns: Vec<Turns> = spheres.iter().map(|p| periodic.turns(&xyz(p))).collect();
        let back = |(p, t): (&Lanes, &Turns)| {
            let x = xyz(p) - periodic.way(t);
            Lanes([x.x, x.y, x.z, p[3]])
        };
        let points = spheres.iter().zip(&turns).map(back).collect();
        Space { periodic, points, turns, largest }
    }

    /// Calls `f` with every later sphere of which an image lies within `skin` of touching sphere `i`, and with the
    /// box lengths that the image is away from the sphere itself.
    pub fn near(&self, cells: &Cells, i: u32, skin: f64, mut f: impl FnMut(u32, Turns)) {
        let (p, own) = (&self.points[i as usize], &self.turns[i as usize]);
        let reach = p[3] + self.largest + skin;
        // Images that may be within reach along each axis.
        let [x, y, z] = std::array::from_fn(|d| {
            let (from, length) = (p[d] - self.periodic.low[d], self.periodic.length[d]);
            let borders = length > 0.0;
            (-i32::from(borders && from < reach))..=i32::from(borders && from + reach > length)
        });
        for a in x {
            for b in y.clone() {
                for c in z.clone() {
                    let at = xyz(p) - self.periodic.way(&[a, b, c]);
                    cells.near(&Lanes([at.x, at.y, at.z, p[3]]), skin, |j| {
                        let q = &self.points[j as usize];
                        let reach = p[3] + q[3] + skin;
                        if j > i && (at - xyz(q)).norm_squared() < reach * reach {
                            let other = &self.turns[j as usize];
                            f(j, std::array::from_fn(|d| [a, b, c][d] + own[d] - other[d]));
                        }
                    });
                }
            }
        }
    }
}

/// Replaces a list of image pairs, keeping the memory of those that were there. Names ascend.
pub(crate) fn merge(list: &mut Vec<ImagePair>, names: impl Iterator<Item = ImageName>) {
    let mut old = std::mem::take(list).into_iter().peekable();
    for name in names {
        while old.next_if(|p| p.name < name).is_some() {}
        list.push(old.next_if(|p| p.name == name).unwrap_or(ImagePair::new(name)));
    }
}

/// Contacts of block `b`'s image pairs, one by one; their slots of `width` records follow those of the spheres and boxes.
pub(crate) fn contacts<L: ContactLaw, const RIGID: bool>(
    periodic: &Periodic,
    laws: &PairTable<L>,
    blocks: Part<'_, Block>,
    works: Part<'_, BlockWork>,
    b: usize,
    lists: &mut Cross,
    out: &mut CrossWork,
    width: usize,
    dt: f64,
) {
    let first = lists.spheres.len() + lists.boxes.len();
    let (mine, wa) = (&blocks[b], &works[b]);
    for (k, ImagePair { name, history }) in lists.images.iter_mut().enumerate() {
        let [i, block, j] = [name.i, name.block, name.j].map(|n| n as usize);
        let (other, wb) = (&blocks[block], &works[block]);
        let (a, c) = (wa.body(name.i) as usize, wb.body(name.j) as usize);
        let (p, q) = (&spheres(mine, wa, RIGID)[i], &spheres(other, wb, RIGID)[j]);
        let way = periodic.way(&name.shift);
        let law = laws.get(mine.spin[a][3] as u32, other.spin[c][3] as u32);
        let slot = &mut out.slots[(first + k) * width..][..width];
        let Some(g) = detect::sphere_sphere(&xyz(p), p[3], &(xyz(q) + way), q[3]) else {
            if !history.is_fresh() {
                out.friction += law.release(history);
            }
            slot.fill(Lanes::default());
            continue;
        };
        let (ma, mb) = (motion(mine, a, &g.point), motion(other, c, &(g.point - way)));
        let mass = 1.0 / (ma.velocity[3] + mb.velocity[3]);
        let (velocity, spin) = (ma.at_point() - mb.at_point(), ma.spin() - mb.spin());
        let f = law.evaluate_one(mass, &g, &velocity, &spin, history, dt);
        out.dashpot += f.dashpot;
        out.friction += f.friction;
        out.couple += way.cross(&f.force) * dt;
        let lanes = |v: Vec3, last: f64| Lanes([v.x, v.y, v.z, last]);
        if width == 3 {
            slot[0] = lanes(f.force, 0.0);
            slot[1] = lanes(ma.arm.cross(&f.force) + f.moment, 0.0);
            slot[2] = lanes(-(mb.arm.cross(&f.force) + f.moment), 0.0);
        } else {
            slot[0] = lanes(f.force, -ma.arm.dot(&g.normal));
            slot[1] = lanes(f.force.cross(&g.normal), mb.arm.dot(&g.normal));
        }
        let bound = p[3].min(q[3]);
        if g.overlap > bound && out.failure.is_none() {
            let partner = Partner::Body(other.bodies[c] as usize);
            out.failure = Some(Failure::Overlap { body: mine.bodies[a], partner, overlap: g.overlap, bound });
        }
    }
}

/// Puts all bodies back into the box. Pairs whose partners go different ways become image pairs, or cease to be.
pub(crate) fn wrap(periodic: &Periodic, model: &Model, state: &mut State) {
    let mut moved = false;
    let mut turns: Vec<Vec<Turns>> = Vec::with_capacity(state.blocks.len());
    for block in &mut state.blocks {
        let mut own = Vec::new();
        for (k, &body) in block.bodies.iter().enumerate() {
            let t = periodic.turns(&xyz(&block.centre[k]));
            own.extend((0..model.member_count(body as usize)).map(|_| t));
            if t == NONE {
                continue;
            }
            moved = true;
            let (way, mass) = (periodic.way(&t), model.mass(body as usize));
            let back = xyz(&block.centre[k]) - way;
            set_xyz(&mut block.centre[k], &back);
            state.ledger.periodic.angular -= way.cross(&(xyz(&block.velocity[k]) * mass));
            state.ledger.work_periodic += mass * model.gravity.dot(&way);
        }
        turns.push(own);
    }
    if !moved {
        return;
    }
    for b in 0..state.blocks.len() {
        let shift = |i: u32, block: u32, j: u32, before: &Turns| -> Turns {
            let (ti, tj) = (&turns[b][i as usize], &turns[block as usize][j as usize]);
            std::array::from_fn(|d| before[d] + tj[d] - ti[d])
        };
        let own = b as u32;
        let (pairs, cross) = (&mut state.blocks[b].pairs, &mut state.cross[b]);
        let mut all: Vec<ImagePair> = Vec::new();
        let mut add = |i, block, j, before: &Turns, history| {
            all.push(ImagePair {
                name: ImageName { i, block, j, shift: shift(i, block, j, before) },
                history,
            });
        };
        pairs.iter().for_each(|([i, j], history)| add(i, own, j, &NONE, history));
        cross.spheres.iter().for_each(|([i, block, j], history)| add(i, block, j, &NONE, history));
        cross.images.iter().for_each(|p| add(p.name.i, p.name.block, p.name.j, &p.name.shift, p.history));
        pairs.clear();
        cross.spheres.clear();
        cross.images.clear();
        all.sort_unstable_by_key(|p| p.name);
        for pair in all {
            let ImageName { i, block, j, shift } = pair.name;
            if shift != NONE {
                cross.images.push(pair);
            } else if block == own {
                pairs.push([i, j], &pair.history);
            } else {
                cross.spheres.push([i, block, j], &pair.history);
            }
        }
    }
}

impl Model {
    /// A point put back into the box along the periodic axes, lower borders included, upper ones not [m]; the point
    /// itself without. Positions of a [`State`] may have run on beyond the borders.
    pub fn wrap(&self, x: &Vec3) -> Vec3 {
        self.periodic.map_or(*x, |p| p.wrap(x))
    }

    /// Lower and upper border [m] of each axis that is periodic.
    pub fn periodic(&self) -> [Option<[f64; 2]>; 3] {
        std::array::from_fn(|d| {
            let p = self.periodic.filter(|p| p.length[d] > 0.0)?;
            Some([p.low[d], p.low[d] + p.length[d]])
        })
    }
}

#[cfg(test)]
#[path = "periodic_tests.rs"]
mod tests;
