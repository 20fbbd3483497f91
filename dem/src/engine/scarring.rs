//! Scarring of the ground by bodies (`law/scarring.rs`).
//!
//! The drag area is cut by the plane of the triangle beneath the centre.

use super::block_work::Ground;
use super::broad_phase;
use super::model::Model;
use super::state::State;
use super::work::Work;
use crate::base::Vec3;
use crate::bodies::block::Block;
use crate::bodies::block_bodies::BlockBodies;
use crate::contact::narrow_phase::{KINDS, OnGround};
use crate::lanes::vec4::xyz;
use crate::law::scarring::{Scar, Scarring};
use crate::spatial::facet::Facet;
use crate::spatial::patchwork::Form;

/// Travel below which the friction increase is reset [m].
const FORGOTTEN: f64 = 1e-12;

pub(crate) fn update(model: &Model, state: &mut State, work: &mut Work) {
    let down = model.gravity.normalize();
    let mut heights = std::mem::take(&mut work.heights);
    for b in 0..state.blocks.len() {
        let mut ground = std::mem::take(&mut work.ground);
        ground.clear();
        ground.resize(state.blocks[b].bodies.len(), Ground::default());
        let now = broad_phase::configuration(model, state, &work.members, (&work.walls, &work.sheet));
        for (kind, list) in KINDS.iter().zip(&state.cross[b].kinds) {
            kind.visit_scarred_ground(&now, b, list, &mut |on: &OnGround| {
                let patch = &model.patches[on.patch as usize];
                if let Form::Facet(facet) = &patch.form {
                    let centre = xyz(&state.blocks[b].centre[on.place]);
                    ground[on.place].see(on, facet, patch.wall as usize, &centre, &down);
                }
            });
        }
        let State { blocks, scars, stale, step_size, .. } = &mut *state;
        for (k, own) in ground.iter().enumerate() {
            let scar = &mut scars[blocks[b].bodies[k] as usize];
            let body = Body { model, block: &blocks[b], members: &work.members[b], k, down: &down };
            let before = scar.inside;
            body.follow(scar, own, step_size.kick(), &mut heights);
            *stale |= scar.inside != before;
        }
        work.ground = ground;
    }
    work.heights = heights;
}

impl Ground {
    fn see(&mut self, on: &OnGround, facet: &Facet, wall: usize, centre: &Vec3, down: &Vec3) {
        self.touches |= on.touches;
        self.cuts |= on.cuts;
        let normal = if facet.normal.dot(down) > 0.0 { -facet.normal } else { facet.normal };
        let height = normal.dot(&(centre - facet.corners[0]));
        let beneath = beneath(facet, centre, down);
        let nearer = self.plane.is_none_or(|(_, known)| height.abs() < known.abs());
        if beneath && !self.beneath || beneath == self.beneath && nearer && (beneath || on.cuts) {
            (self.plane, self.beneath, self.wall) = (Some((normal, height)), beneath, wall);
        }
    }
}

/// Returns true if a vertical line through `x` crosses the triangle.
fn beneath(facet: &Facet, x: &Vec3, down: &Vec3) -> bool {
    let slope = facet.normal.dot(down);
    if slope == 0.0 {
        return false;
    }
    let foot = x + down * (facet.normal.dot(&(facet.corners[0] - x)) / slope);
    facet.edges.iter().zip(&facet.corners).all(|(edge, corner)| edge.side.dot(&(foot - corner)) <= 0.0)
}

struct Body<'a> {
    model: &'a Model,
    block: &'a Block,
    members: &'a BlockBodies,
    k: usize,
    down: &'a Vec3,
}

impl Body<'_> {
    /// `dt` [s].
    fn follow(&self, scar: &mut Scar, ground: &Ground, dt: f64, heights: &mut Vec<f64>) {
        let law = self.model.walls.walls[ground.wall].scarring;
        let Some((law, (normal, height))) = law.zip(ground.plane).filter(|_| self.inside(scar, ground))
        else {
            let law = self.model.walls.walls.iter().find_map(|w| w.scarring);
            let way = law.map_or(0.0, |law| law.update_path(scar.way, false, 0.0, dt));
            let way = if way > FORGOTTEN { way } else { 0.0 };
            let friction = law.map_or(0.0, |law| law.friction(way));
            *scar = Scar { way, friction, ..Scar::default() };
            return;
        };
        let velocity = xyz(&self.block.velocity[self.k]);
        let speed = velocity.norm();
        if !scar.inside {
            let mass = self.model.mass(self.block.bodies[self.k] as usize);
            scar.inside = true;
            scar.sunk = self.down * law.depth(mass, velocity.dot(self.down));
        }
        scar.way = law.update_path(scar.way, ground.touches, speed, dt);
        scar.friction = law.friction(scar.way);
        scar.resistance = if speed > 0.0 {
            self.resistance(&law, (&normal, height), &(velocity / speed), heights)
        } else {
            0.0
        };
    }

    fn inside(&self, scar: &Scar, ground: &Ground) -> bool {
        let sunk = ground.beneath && ground.plane.is_some_and(|(_, height)| height < 0.0);
        ground.cuts || scar.inside && sunk
    }

    /// Drag over squared speed, from the projected immersed area [kg/m].
    fn resistance(
        &self,
        law: &Scarring,
        (normal, height): (&Vec3, f64),
        along: &Vec3,
        heights: &mut Vec<f64>,
    ) -> f64 {
        let (shape, scale) = self.members.solids[self.k];
        let turn = &self.block.rotation[self.k].orientation;
        let [up, along] = [normal, along].map(|x| turn.inverse_transform_vector(x));
        let below = self.model.skins[shape as usize].below(&up, -height / scale, &along, heights);
        law.resistance(below.seen * scale * scale)
    }
}
