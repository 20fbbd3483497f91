//! All walls of a model as one surface of numbered patches.

use super::body::Body;
use super::input::{Motion, WallInput};
use super::servo::Servo;
use super::state::WallState;
use super::triangulated::{self, SLACK, Triangle};
use crate::base::Vec3;
use crate::base::error::{ModelError, Partner};
use crate::body_force::{BodyForce, Water};
use crate::integrate::rotation;
use crate::law::scarring::Scarring;
use crate::shape::triangle::Region;
use crate::spatial::bvh::Bvh;
use crate::spatial::facet;
use crate::spatial::patchwork::{Form, Patch, WallView};
use crate::spatial::round::{Part, Round};
use crate::spatial::surface::{Feature, PatchPoint, Surface};
use nalgebra::UnitQuaternion;
use std::collections::HashMap;

/// Position of unreachable patches [m].
const FAR: f64 = 1e30;

#[derive(Clone, Copy, Debug)]
enum Kind {
    Triangle(u32),
    Round(u32),
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    wall: u32,
    kind: Kind,
    /// Shared by coplanar patches.
    flat: u32,
}

#[derive(Clone, Debug)]
pub(crate) struct Wall {
    tree: Bvh,
    first: u32,
    pub material: u32,
    pub motion: Motion,
    /// Initial reference point of moments and rotation [m].
    pub centre: Vec3,
    pub servo: Option<Servo>,
    pub scarring: Option<Scarring>,
    /// Largest damping ratio of grain contacts.
    pub damping: f64,
    pub body: Option<Body>,
    /// Largest point distance from the centre [m]; zero if invariant under rotation.
    pub reach: f64,
}

/// All walls of a model.
#[derive(Clone, Debug, Default)]
pub struct Walls {
    entries: Vec<Entry>,
    triangles: Vec<Triangle>,
    rounds: Vec<Round>,
    of_triangles: Vec<u32>,
    pub(crate) walls: Vec<Wall>,
    /// Number of plain triangle surfaces.
    plain: usize,
}

impl Walls {
    /// Messages name the first `plain` walls triangle surfaces.
    ///
    /// # Errors
    /// Invalid shapes, bodies without volume.
    pub fn new(input: &[WallInput], plain: usize) -> Result<Walls, ModelError> {
        let mut walls = Walls { plain, ..Walls::default() };
        for (index, wall) in input.iter().enumerate() {
            walls.add(index, wall)?;
        }
        Ok(walls)
    }

    fn add(&mut self, index: usize, wall: &WallInput) -> Result<(), ModelError> {
        let name = self.name(index);
        let first = self.entries.len();
        match wall.shape.triangulated() {
            Some((vertices, triangles)) => {
                let mut flats = HashMap::new();
                for t in triangulated::triangles(vertices, triangles, &name)? {
                    let own = self.entries.len() as u32;
                    let flat = *flats.entry(t.plane_bits()).or_insert(own);
                    let kind = Kind::Triangle(self.triangles.len() as u32);
                    self.entries.push(Entry { wall: index as u32, kind, flat });
                    self.triangles.push(t);
                    self.of_triangles.push(index as u32);
                }
            }
            None => {
                for round in wall.shape.rounds() {
                    let (flat, kind) = (self.entries.len() as u32, Kind::Round(self.rounds.len() as u32));
                    self.entries.push(Entry { wall: index as u32, kind, flat });
                    self.rounds.push(round);
                }
            }
        }
        let boxes: Vec<_> = self.entries[first..]
            .iter()
            .map(|e| match e.kind {
                Kind::Triangle(t) => self.triangles[t as usize].bounds(),
                Kind::Round(r) => self.rounds[r as usize].bounds(),
            })
            .collect();
        let corners = |(lo, hi): &([f64; 3], [f64; 3])| {
            let (lo, hi) = (Vec3::from(*lo), Vec3::from(*hi));
            (0..8).map(move |k| Vec3::from_fn(|d, _| if k >> d & 1 == 1 { hi[d] } else { lo[d] }))
        };
        let body = match &wall.body {
            Some(b) => Some(Body::new(b, &wall.shape, boxes.iter().flat_map(corners).collect(), &name)?),
            None => None,
        };
        let centre = match &body {
            Some(b) => b.centre,
            None => wall.motion.centre.unwrap_or_else(|| wall.shape.own_centre()),
        };
        let far = |bounds: &([f64; 3], [f64; 3])| {
            corners(bounds).map(|corner| (corner - centre).norm()).fold(0.0, f64::max)
        };
        let spin = &wall.motion.angular_velocity;
        let unmoved = body.is_none()
            && self.entries[first..].iter().all(|e| match e.kind {
                Kind::Triangle(_) => spin.norm() == 0.0,
                Kind::Round(r) => self.rounds[r as usize].unmoved_by(&centre, spin),
            });
        let reach = match &body {
            Some(b) => b.reach,
            None if unmoved => 0.0,
            None => boxes.iter().map(far).fold(0.0, f64::max),
        };
        self.walls.push(Wall {
            tree: Bvh::new(&boxes),
            first: first as u32,
            material: wall.material as u32,
            motion: wall.motion,
            centre,
            scarring: wall.scarring,
            servo: wall.servo.clone().map(|s| Servo { direction: s.direction.normalize(), ..s }),
            damping: 0.0,
            body,
            reach,
        });
        Ok(())
    }

    /// As [`Walls::new`], with bodies that float in the water.
    ///
    /// # Errors
    /// Also open surfaces, too many vertices.
    pub(crate) fn afloat(
        input: &[WallInput],
        plain: usize,
        forces: &[BodyForce],
        gravity: &Vec3,
    ) -> Result<Walls, ModelError> {
        let mut walls = Walls::new(input, plain)?;
        if let Some(water) = forces.iter().find_map(BodyForce::water) {
            walls.float(input, water, gravity)?;
        }
        Ok(walls)
    }

    fn float(&mut self, input: &[WallInput], water: &Water, gravity: &Vec3) -> Result<(), ModelError> {
        for (index, given) in input.iter().enumerate() {
            if let (Some(rigid), Some(surface)) = (&given.body, given.shape.triangulated())
                && let Some(body) = &mut self.walls[index].body
            {
                let floats = body.float(rigid, surface, water, gravity);
                floats.map_err(|problem| ModelError::Wall { wall: self.name(index), problem })?;
            }
        }
        Ok(())
    }

    /// Shortest time per radian of bodies in the water [s].
    pub(crate) fn water_time(&self) -> f64 {
        let bodies = self.walls.iter().filter_map(|w| w.body.as_ref());
        bodies.map(Body::water_time).fold(f64::INFINITY, f64::min)
    }

    pub(crate) fn name(&self, wall: usize) -> String {
        match wall.checked_sub(self.plain) {
            None => format!("surface {wall}"),
            Some(k) => format!("wall {k}"),
        }
    }

    pub(crate) fn start(&self, gravity: &Vec3, dt: f64) -> Vec<WallState> {
        self.walls
            .iter()
            .map(|w| {
                let swing = w.motion.oscillation.map_or(Vec3::zeros(), |o| (o.at(0.0) - o.at(-dt)) / dt);
                let mut state = WallState {
                    offset: Vec3::zeros(),
                    steady: Vec3::zeros(),
                    orientation: UnitQuaternion::identity(),
                    turned: false,
                    velocity: w.motion.velocity + swing,
                    drive: w.motion.velocity,
                    spin: w.motion.angular_velocity,
                    open: false,
                    force: Vec3::zeros(),
                    moment: Vec3::zeros(),
                    frame: UnitQuaternion::identity(),
                    momentum: Vec3::zeros(),
                    acceleration: Vec3::zeros(),
                    change: Vec3::zeros(),
                    integral: 0.0,
                    origin: Vec3::zeros(),
                    tracking: Default::default(),
                    feet: Vec::new(),
                    meets: Vec::new(),
                };
                if let Some(body) = &w.body {
                    body.start(&mut state, gravity, dt);
                }
                state
            })
            .collect()
    }

    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    pub(crate) fn triangulated(&self) -> bool {
        self.rounds.is_empty()
    }

    /// Triangles with wall and a number shared by coplanar ones.
    pub(crate) fn triangles(&self) -> impl Iterator<Item = (u32, u32, &Triangle)> {
        self.entries.iter().filter_map(|entry| match entry.kind {
            Kind::Triangle(t) => Some((entry.wall, entry.flat, &self.triangles[t as usize])),
            Kind::Round(_) => None,
        })
    }

    #[inline]
    pub(crate) fn wall_of(&self, patch: u32) -> usize {
        self.entries[patch as usize].wall as usize
    }

    pub(crate) fn wall_of_partner(&self, partner: Partner) -> Option<usize> {
        match partner {
            Partner::Wall(wall) => Some(wall as usize),
            Partner::Triangle(t) => self.of_triangles.get(t as usize).map(|wall| *wall as usize),
            _ => None,
        }
    }

    #[inline]
    pub fn material(&self, patch: u32) -> u32 {
        self.walls[self.wall_of(patch)].material
    }

    pub(crate) fn partner(&self, patch: u32) -> Partner {
        match self.entries[patch as usize].kind {
            Kind::Triangle(t) => Partner::Triangle(t),
            Kind::Round(_) => Partner::Wall(self.wall_of(patch) as u32),
        }
    }

    /// `input`: original walls.
    pub(crate) fn patchwork(&self, input: &[WallInput]) -> Vec<Patch> {
        let mut out: Vec<Patch> = Vec::with_capacity(self.entries.len());
        for (k, wall) in input.iter().enumerate() {
            let first = out.len() as u32;
            let forms: Vec<Form> = match wall.shape.triangulated() {
                Some((vertices, triangles)) => {
                    let same = triangulated::welded(vertices);
                    let facets = facet::facets(vertices, triangles, &same);
                    facets.into_iter().map(|f| Form::Facet(Box::new(f))).collect()
                }
                None => wall.shape.rounds().into_iter().map(Form::Round).collect(),
            };
            let named = forms.into_iter().zip(first..);
            out.extend(named.map(|(form, patch)| Patch::new(k as u32, form, self.partner(patch))));
        }
        out
    }

    /// Wall poses `back` seconds ago.
    pub(crate) fn update_poses(&self, states: &[WallState], back: f64, out: &mut Vec<WallView>) {
        out.clear();
        out.extend(self.walls.iter().zip(states).map(|(wall, state)| {
            let mut state = state.clone();
            if back != 0.0 {
                state.offset -= state.velocity * back;
                state.orientation = rotation::by(&(state.spin * -back)) * state.orientation;
            }
            WallView {
                origin: state.to_world(&wall.centre, &Vec3::zeros()),
                orientation: state.orientation,
                centre: wall.centre + state.offset,
                velocity: state.velocity,
                spin: state.spin,
                material: wall.material,
                inverse_mass: wall.body.as_ref().map_or(0.0, |b| b.inverse_mass),
                open: state.open,
                driven: wall.servo.is_some(),
                scarred: wall.scarring.is_some(),
            }
        }));
    }

    pub(crate) fn placed<'a>(&'a self, states: &'a [WallState]) -> PlacedWalls<'a> {
        PlacedWalls { walls: self, states }
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedWalls<'a> {
    walls: &'a Walls,
    states: &'a [WallState],
}

impl PlacedWalls<'_> {
    #[inline(always)]
    fn parts(&self, patch: u32) -> (Kind, &Wall, &WallState) {
        let Entry { wall, kind, .. } = self.walls.entries[patch as usize];
        (kind, &self.walls.walls[wall as usize], &self.states[wall as usize])
    }
}

impl Surface for PlacedWalls<'_> {
    fn candidates(&self, lo: [f64; 3], hi: [f64; 3], out: &mut Vec<u32>) {
        let (middle, half) =
            ((Vec3::from(lo) + Vec3::from(hi)) * 0.5, (Vec3::from(hi) - Vec3::from(lo)) * 0.5);
        for (wall, state) in self.walls.walls.iter().zip(self.states) {
            if state.open {
                continue;
            }
            let (lo, hi) = if state.turned {
                let turn = state.orientation.inverse().to_rotation_matrix().matrix().abs();
                let (c, h) = (state.to_local(&wall.centre, &middle), turn * half);
                (c - h, c + h)
            } else {
                (Vec3::from(lo) - state.offset, Vec3::from(hi) - state.offset)
            };
            let first = out.len();
            wall.tree.query(lo.into(), hi.into(), out);
            out[first..].iter_mut().for_each(|p| *p += wall.first);
        }
    }

    #[inline]
    fn closest_point(&self, patch: u32, centre: [f64; 3], _: [f64; 2]) -> PatchPoint {
        let (kind, wall, state) = self.parts(patch);
        let x = state.to_local(&wall.centre, &Vec3::from(centre));
        let (point, normal, feature) = match kind {
            Kind::Triangle(t) => {
                let t = &self.walls.triangles[t as usize];
                let (point, region) = t.closest(&x);
                let feature = match region {
                    Region::Face => Feature::Face,
                    Region::Edge(k) => Feature::Edge(t.edges[k]),
                    Region::Vertex(k) => Feature::Vertex(t.vertices[k]),
                };
                (point, t.normal(), feature)
            }
            Kind::Round(r) => {
                let (point, normal, part) = self.walls.rounds[r as usize].closest(&x);
                match part {
                    Part::Inside => (point, normal, Feature::Face),
                    Part::Rim(k) => (point, normal, Feature::Edge(k as u32)),
                    Part::Apex => (point, normal, Feature::Vertex(0)),
                    Part::Hidden => (Vec3::repeat(FAR), normal, Feature::Face),
                }
            }
        };
        let point = if state.open { Vec3::repeat(FAR) } else { state.to_world(&wall.centre, &point) };
        PatchPoint {
            point: point.into(),
            normal: state.turn(&normal).into(),
            velocity: state.velocity_at(&wall.centre, &point).into(),
            local: [0.0; 2],
            feature,
        }
    }

    #[inline(always)]
    fn clearance(&self, patch: u32, centre: [f64; 3]) -> f64 {
        let (kind, wall, state) = self.parts(patch);
        if state.open {
            return FAR;
        }
        let x = state.to_local(&wall.centre, &Vec3::from(centre));
        match kind {
            Kind::Triangle(t) => self.walls.triangles[t as usize].clearance(&x),
            Kind::Round(r) => {
                let round = &self.walls.rounds[r as usize];
                let (point, normal, _) = round.closest(&x);
                let away = x - point;
                if round.one_sided() && away.dot(&normal) < 0.0 { 0.0 } else { away.norm() * (1.0 - SLACK) }
            }
        }
    }

    #[inline(always)]
    fn fetch(&self, patch: u32) {
        if let Kind::Triangle(t) = self.walls.entries[patch as usize].kind {
            self.walls.triangles[t as usize].fetch();
        }
    }

    fn max_speed(&self) -> f64 {
        let speed = |(w, s): (&Wall, &WallState)| s.velocity.norm() + s.spin.norm() * w.reach;
        self.walls.walls.iter().zip(self.states).map(speed).fold(0.0, f64::max)
    }

    fn one_sided(&self) -> bool {
        false
    }

    fn one_sided_patch(&self, patch: u32) -> bool {
        match self.walls.entries[patch as usize].kind {
            Kind::Triangle(_) => false,
            Kind::Round(r) => self.walls.rounds[r as usize].one_sided(),
        }
    }

    fn sharp(&self) -> bool {
        true
    }

    #[inline(always)]
    fn level(&self, a: u32, b: u32) -> bool {
        self.walls.entries[a as usize].flat == self.walls.entries[b as usize].flat
    }

    #[inline(always)]
    fn foot(&self, patch: u32, centre: [f64; 3]) -> Option<[Vec3; 3]> {
        let (kind, wall, state) = self.parts(patch);
        let Kind::Triangle(t) = kind else { return None };
        if state.open {
            return None;
        }
        let t = &self.walls.triangles[t as usize];
        let foot = t.foot(&state.to_local(&wall.centre, &Vec3::from(centre)))?;
        let point = state.to_world(&wall.centre, &foot);
        Some([point, state.turn(&t.normal()), state.velocity_at(&wall.centre, &point)])
    }

    fn group(&self, patch: u32) -> usize {
        self.walls.wall_of(patch)
    }

    fn groups(&self) -> usize {
        self.states.len()
    }

    fn driven(&self, group: usize) -> bool {
        self.walls.walls[group].servo.is_some()
    }

    fn moment_centre(&self, patch: u32) -> [f64; 3] {
        let (_, wall, state) = self.parts(patch);
        (wall.centre + state.offset).into()
    }

    fn spin(&self, patch: u32) -> Vec3 {
        self.states[self.walls.wall_of(patch)].spin
    }

    fn inverse_mass(&self, patch: u32) -> f64 {
        let (_, wall, _) = self.parts(patch);
        wall.body.as_ref().map_or(0.0, |b| b.inverse_mass)
    }

    fn is_empty(&self) -> bool {
        self.walls.is_empty()
    }
}
