//! Bond measures.

use crate::base::Vec3;
use crate::bodies::block::Block;
use crate::bond::debonded;
use crate::bond::kernel::{self, Motion, half_step_energy, respond, update_frame};
use crate::bond::store::Entry;
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::lanes::V3;
use crate::lanes::vec4::Vec4;

/// Bond, with the forces of the next step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BondRecord {
    /// Index in the model.
    pub bond: usize,
    /// First body.
    pub a: usize,
    /// Second body.
    pub b: usize,
    /// Point of force [m].
    pub point: Vec3,
    /// Unit vector from b to a.
    pub normal: Vec3,
    /// Tensile force without dashpot [N].
    pub tension: f64,
    /// Elastic shear force on a [N].
    pub shear: Vec3,
    /// Bending moment [N m].
    pub bending: f64,
    /// Twisting moment about the normal [N m].
    pub twisting: f64,
    /// Total force on a, dashpots included [N].
    pub force: Vec3,
    /// Mobilised fraction of strength [-].
    pub share: f64,
}

fn motion(block: &Block, k: usize) -> Motion<f64> {
    let vector = |v: &Vec4| V3::new(v[0], v[1], v[2]);
    Motion { x: vector(&block.centre[k]), v: vector(&block.velocity[k]), w: vector(&block.spin[k]) }
}

fn ends(state: &State, b: u32, e: &Entry) -> (Motion<f64>, Motion<f64>) {
    (motion(&state.blocks[b as usize], e.i as usize), motion(&state.blocks[e.block as usize], e.j as usize))
}

/// At the last half step [J].
pub(crate) fn elastic(model: &Model, state: &State) -> f64 {
    let dt = state.step_size.last;
    let since = if state.bonds.fresh { -0.5 * dt } else { 0.5 * dt };
    let mut sum = 0.0;
    state.each_bond(|number, (b, e)| {
        let (p, q) = ends(state, b, &e);
        sum += half_step_energy(&model.bonds[number as usize].values, &p, &q, &e.memory, dt, since);
    });
    sum
}

/// Returns all unbroken bonds, block by block.
pub fn records(model: &Model, state: &State) -> Vec<BondRecord> {
    let dt = if state.bonds.fresh { 0.0 } else { state.step_size.last };
    let mut out = Vec::with_capacity(state.bond_count());
    state.each_bond(|number, (b, mut e)| {
        let bond = &model.bonds[number as usize];
        let k = &bond.values;
        let (p, q) = ends(state, b, &e);
        let frame = update_frame(k[kernel::OFFSET], &p, &q, &mut e.memory, dt);
        let r = respond(k, &p, &q, &frame, &e.memory);
        let n = frame.normal;
        let twist = e.memory.turn.dot(n);
        let bend = (e.memory.turn - n * twist).norm2().sqrt();
        out.push(BondRecord {
            bond: number as usize,
            a: bond.ends[0] as usize,
            b: bond.ends[1] as usize,
            point: (p.x - n * (0.5 * (frame.length + k[kernel::OFFSET]))).to_vec(),
            normal: n.to_vec(),
            tension: k[kernel::STIFFNESS] * (frame.length - k[kernel::LENGTH]),
            shear: (-(e.memory.shear * k[kernel::STIFFNESS + 1])).to_vec(),
            bending: k[kernel::STIFFNESS + 2] * bend,
            twisting: k[kernel::STIFFNESS + 3] * twist.abs(),
            force: r.force.to_vec(),
            share: r.share.max(0.0),
        });
    });
    out
}

/// Rotation of a bond: relative, or of its centre line by shear.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BondRotation {
    /// Index in the model.
    pub bond: usize,
    /// Angle [rad].
    pub angle: f64,
}

/// Returns the largest rotation resisted by an unbroken bond, if any.
pub fn largest_rotation(model: &Model, state: &State) -> Option<BondRotation> {
    let mut largest: Option<BondRotation> = None;
    state.each_bond(|number, (_, e)| {
        let k = &model.bonds[number as usize].values;
        let resisted = |at: usize, size: f64| if k[kernel::STIFFNESS + at] > 0.0 { size } else { 0.0 };
        let turn = resisted(2, e.memory.turn.norm2().sqrt());
        let shear = resisted(1, e.memory.shear.norm2().sqrt() / k[kernel::LENGTH]);
        let angle = turn.max(shear);
        let bends = k[kernel::STIFFNESS + 1] > 0.0 || k[kernel::STIFFNESS + 2] > 0.0;
        if bends && largest.is_none_or(|l| angle > l.angle) {
            largest = Some(BondRotation { bond: number as usize, angle });
        }
    });
    largest
}

/// Debonded pairs, their blocks, and contact geometry beyond the initial overlap.
pub(crate) fn each_touch(
    blocks: &[Block],
    state: &State,
    mut f: impl FnMut(&Block, &Block, &debonded::DebondedPair, &crate::law::ContactGeometry),
) {
    state.each_debonded(|b, r| {
        let (p, q) = (&blocks[b as usize], &blocks[r.block as usize]);
        let (g, _) = debonded::geometry(p, r.i as usize, q, r.j as usize, r.reference);
        if g.overlap > 0.0 {
            f(p, q, r, &g);
        }
    });
}
