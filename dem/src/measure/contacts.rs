//! Present contacts, for force chains and coordination.

use crate::base::Vec3;
use crate::base::error::Partner;
use crate::bodies::block::Block;
use crate::contact::narrow_phase::{
    BodyAccess, ContactView, KINDS, PlaneView, PosedBody, SheetView, Visited,
};
use crate::contact::scalar;
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::lanes::vec4::{Vec4, xyz};
use crate::law::scarring::Scar;
use crate::law::{ContactForce, ContactGeometry, History};
use crate::pairs::cross::{Cross, ImagePair};
use crate::pairs::patches::PatchContact;
use crate::shape::plane::PlaneMotion;
use crate::spatial::detect;
use crate::spatial::patchwork::{WallView, Walls};
use crate::spatial::periodic::Periodic;
use crate::spatial::sheet::SheetFacet;
use std::borrow::Cow;

/// Contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactRecord {
    /// Body on which the force acts.
    pub a: usize,
    /// Contact partner.
    pub b: Partner,
    /// Contact point [m].
    pub point: Vec3,
    /// Unit normal, from b to a.
    pub normal: Vec3,
    /// Overlap [m].
    pub overlap: f64,
    /// Reduced radius r₁r₂/(r₁ + r₂), or the radius against a flat partner [m].
    pub radius: f64,
    /// Normal force, positive in compression [N].
    pub normal_force: f64,
    /// Total force on a [N].
    pub force: Vec3,
    /// Vector from b to its periodic image in contact [m]; b itself is in contact at `point` − `shift`.
    pub shift: Vec3,
}

/// Bodies `back` seconds ago.
struct Snapshot<'a> {
    model: &'a Model,
    planes: &'a [PlaneMotion],
    walls: Vec<WallView>,
    sheet: Vec<SheetFacet>,
    blocks: Cow<'a, [Block]>,
    /// Member spheres and their bodies; empty for single spheres.
    spheres: Vec<Vec<Vec4>>,
    owners: Vec<Vec<u32>>,
    back: f64,
    /// Last time step [s].
    last: f64,
    scars: &'a [Scar],
}

impl<'a> Snapshot<'a> {
    fn new(model: &'a Model, state: &'a State, back: f64) -> Snapshot<'a> {
        let mut blocks = Cow::Borrowed(&state.blocks[..]);
        if back != 0.0 {
            blocks.to_mut().iter_mut().for_each(|block| move_back(block, back));
        }
        let (spheres, owners) = blocks.iter().map(|block| members(model, block)).unzip();
        let mut walls = Vec::new();
        if !model.patches.is_empty() {
            model.walls.update_poses(&state.walls, back, &mut walls);
        }
        let mut sheet = Vec::new();
        if !model.sheet.is_empty() {
            model.sheet.update_poses(&state.sheet, back, &mut sheet);
        }
        let (planes, last) = (&state.planes[..], state.step_size.last);
        Snapshot { model, planes, walls, sheet, blocks, spheres, owners, back, last, scars: &state.scars }
    }
}

impl BodyAccess for Snapshot<'_> {
    fn block(&self, b: usize) -> &Block {
        &self.blocks[b]
    }

    fn sphere(&self, b: usize, i: u32) -> &Vec4 {
        self.spheres[b].get(i as usize).unwrap_or_else(|| &self.blocks[b].centre[i as usize])
    }

    fn owner(&self, b: usize, i: u32) -> usize {
        self.owners[b].get(i as usize).map_or(i as usize, |k| *k as usize)
    }

    fn placed(&self, b: usize, k: usize) -> PosedBody<'_> {
        let block = &self.blocks[b];
        let body = self.model.body(block.bodies[k] as usize);
        PosedBody {
            centre: xyz(&block.centre[k]),
            orientation: block.rotation[k].orientation,
            shape: &self.model.shapes[body.shape],
            scale: body.scale,
            core: &self.model.cores[body.shape],
            radius: self.model.shapes[body.shape].rounding(body.scale),
        }
    }

    fn plane(&self, k: usize) -> PlaneView {
        let (plane, motion) = (&self.model.planes[k], &self.planes[k]);
        PlaneView {
            origin: plane.point + motion.offset - motion.velocity * self.back,
            normal: plane.normal,
            velocity: motion.velocity,
            material: plane.material as u32,
            open: motion.open,
        }
    }

    fn walls(&self) -> Walls<'_> {
        Walls { patches: &self.model.patches, walls: &self.walls }
    }

    fn sheet(&self) -> SheetView<'_> {
        self.model.sheet_at(&self.sheet)
    }

    fn borders(&self) -> Option<&Periodic> {
        self.model.periodic.as_ref()
    }

    fn scars(&self) -> &[Scar] {
        self.scars
    }
}

fn move_back(block: &mut Block, back: f64) {
    for k in 0..block.bodies.len() {
        let x = xyz(&block.centre[k]) - xyz(&block.velocity[k]) * back;
        block.centre[k] = Vec4::of(&x, block.centre[k][3]);
        if let Some(r) = block.rotation.get_mut(k) {
            let spin = xyz(&block.spin[k]);
            r.orientation = crate::integrate::rotation::steady(&r.orientation, &spin, -back);
        }
    }
}

/// Member spheres and their bodies; empty for single spheres.
fn members(model: &Model, block: &Block) -> (Vec<Vec4>, Vec<u32>) {
    let (mut own, mut owner) = (Vec::new(), Vec::new());
    for (k, (&body, r)) in block.bodies.iter().zip(&block.rotation).enumerate() {
        for (c, radius) in model.members(body as usize) {
            own.push(Vec4::of(&(xyz(&block.centre[k]) + r.orientation * c), radius));
            owner.push(k as u32);
        }
    }
    (own, owner)
}

/// Visits every contact `back` seconds ago, in neighbour-list order.
pub(crate) fn visit(model: &Model, state: &State, back: f64, mut f: impl FnMut(&Visited<'_>)) {
    let now = Snapshot::new(model, state, back);
    debonded(state, &now, &mut f);
    for b in 0..now.blocks.len() {
        let (block, lists) = (&now.blocks[b], &state.lists[b]);
        let mut pair = |i: u32, other: u32, j: u32, history: &History, shift: Vec3| {
            let second = &now.blocks[other as usize];
            let (p, a) = (now.sphere(b, i), now.owner(b, i));
            let (q, c) = (now.sphere(other as usize, j), now.owner(other as usize, j));
            if let Some(geometry) = detect::sphere_sphere(&xyz(p), p[3], &(xyz(q) + shift), q[3]) {
                let (ma, mb) =
                    (block.motion(a, &geometry.point), second.motion(c, &(geometry.point - shift)));
                f(&Visited {
                    body: block.bodies[a],
                    partner: Partner::Body(second.bodies[c] as usize),
                    shift,
                    contact: ContactView {
                        geometry,
                        weight: 1.0,
                        velocity: ma.at_point() - mb.at_point(),
                        inverse_mass: block.velocity[a][3] + second.velocity[c][3],
                        history,
                        spin: ma.spin() - mb.spin(),
                        materials: [block.spin[a][3] as u32, second.spin[c][3] as u32],
                        friction: None,
                    },
                });
            }
        };
        let here = Vec3::zeros();
        lists.pairs.iter().for_each(|([i, j], history)| pair(i, b as u32, j, &history, here));
        let Cross { spheres, kinds, images } = &state.cross[b];
        spheres.iter().for_each(|([i, other, j], history)| pair(i, other, j, &history, here));
        for ImagePair { name, history } in images {
            let shift = model.periodic.map_or(here, |p| p.image_offset(&name.shift));
            pair(name.i, name.block, name.j, history, shift);
        }
        KINDS.iter().zip(kinds).for_each(|(kind, list)| kind.visit(&model.laws, &now, b, list, &mut f));
        planes(state, &now, b, &mut f);
        for contact in &lists.walls.live {
            let (number, offset) = original(model, contact.patch);
            let k = model.walls.wall_of(number);
            let wall = &model.walls.walls[k];
            let partner = Partnership {
                material: wall.material,
                partner: model.walls.partner(number),
                velocity: state.walls[k].velocity_at(&wall.centre, &(contact.point - offset)),
                spin: state.walls[k].spin,
                inverse_mass: wall.body.as_ref().map_or(0.0, |b| b.inverse_mass),
            };
            patch(&now, b, contact, &partner, &mut f);
        }
        for contact in &lists.surface.live {
            let partner = Partnership {
                material: model.patch_material(original(model, contact.patch).0) as u32,
                partner: Partner::Patch(original(model, contact.patch).0),
                velocity: contact.velocity,
                spin: Vec3::zeros(),
                inverse_mass: 0.0,
            };
            patch(&now, b, contact, &partner, &mut f);
        }
    }
}

/// Patch of a contact, and the offset of its periodic image [m].
fn original(model: &Model, number: u32) -> (u32, Vec3) {
    model.images.as_ref().map_or((number, Vec3::zeros()), |images| images.original(number))
}

struct Partnership {
    material: u32,
    partner: Partner,
    /// At the contact point [m/s].
    velocity: Vec3,
    /// Angular velocity of its body [rad/s].
    spin: Vec3,
    /// Inverse mass of its body [1/kg].
    inverse_mass: f64,
}

fn debonded(state: &State, now: &Snapshot<'_>, f: &mut impl FnMut(&Visited<'_>)) {
    super::bonds::each_touch(&now.blocks, state, |p, q, r, geometry| {
        let (i, j) = (r.i as usize, r.j as usize);
        let (ma, mb) = (p.motion(i, &geometry.point), q.motion(j, &geometry.point));
        f(&Visited {
            body: p.bodies[i],
            partner: Partner::Body(q.bodies[j] as usize),
            shift: Vec3::zeros(),
            contact: ContactView {
                geometry: *geometry,
                weight: 1.0,
                velocity: ma.at_point() - mb.at_point(),
                inverse_mass: p.velocity[i][3] + q.velocity[j][3],
                history: &r.history,
                spin: xyz(&p.spin[i]) - xyz(&q.spin[j]),
                materials: [p.spin[i][3] as u32, q.spin[j][3] as u32],
                friction: None,
            },
        });
    });
}

fn planes(state: &State, now: &Snapshot<'_>, b: usize, f: &mut impl FnMut(&Visited<'_>)) {
    let block = &now.blocks[b];
    for (name, history) in state.lists[b].planes.iter() {
        let [i, k] = name;
        let (p, a, plane) = (now.sphere(b, i), now.owner(b, i), now.plane(k as usize));
        if let Some(geometry) = detect::sphere_plane(&xyz(p), p[3], &plane.origin, &plane.normal) {
            f(&Visited {
                body: block.bodies[a],
                partner: Partner::Plane(k as usize),
                shift: Vec3::zeros(),
                contact: ContactView {
                    geometry,
                    weight: 1.0,
                    velocity: block.motion(a, &geometry.point).at_point() - plane.velocity,
                    inverse_mass: block.velocity[a][3],
                    history: &history,
                    spin: xyz(&block.spin[a]),
                    materials: [block.spin[a][3] as u32, plane.material],
                    friction: None,
                },
            });
        }
    }
}

/// Geometry of the last step, overlap at the requested time.
fn patch(
    now: &Snapshot<'_>,
    b: usize,
    pair: &PatchContact,
    partner: &Partnership,
    f: &mut impl FnMut(&Visited<'_>),
) {
    if pair.history.is_new() {
        return;
    }
    let block = &now.blocks[b];
    let a = now.owner(b, pair.i);
    let velocity = block.motion(a, &pair.point).at_point() - partner.velocity;
    let overlap = pair.overlap - velocity.dot(&pair.normal) * (now.last - now.back);
    if overlap > 0.0 {
        let radius = now.sphere(b, pair.i)[3];
        f(&Visited {
            body: block.bodies[a],
            partner: partner.partner,
            shift: Vec3::zeros(),
            contact: ContactView {
                geometry: ContactGeometry { point: pair.point, normal: pair.normal, overlap, radius },
                weight: 1.0,
                velocity,
                inverse_mass: block.velocity[a][3] + partner.inverse_mass,
                history: &pair.history,
                spin: xyz(&block.spin[a]) - partner.spin,
                materials: [block.spin[a][3] as u32, partner.material],
                friction: None,
            },
        });
    }
}

/// Force of the next step, total and normal [N].
pub(super) fn force_of(model: &Model, state: &State, c: &ContactView<'_>) -> (Vec3, f64) {
    let mut history = *c.history;
    let ContactForce { force, normal, .. } = scalar::evaluate(
        &model.laws,
        c.materials,
        c.friction,
        c.inverse_mass,
        &c.geometry,
        &c.velocity,
        &c.spin,
        &mut history,
        state.step_size.kick(),
    );
    (force * c.weight, normal * c.weight)
}

/// Returns all contacts with the forces of the next step, in fixed order.
pub fn contacts(model: &Model, state: &State) -> Vec<ContactRecord> {
    let mut out = Vec::new();
    visit(model, state, 0.0, |c| {
        let (force, normal_force) = force_of(model, state, &c.contact);
        out.push(ContactRecord {
            a: c.body as usize,
            b: c.partner,
            point: c.contact.geometry.point,
            normal: c.contact.geometry.normal,
            overlap: c.contact.geometry.overlap,
            radius: c.contact.geometry.radius,
            normal_force,
            force,
            shift: c.shift,
        });
    });
    out
}

/// Coordination number [-]: loaded contacts per free body, two per contact between bodies. Zero without free
/// bodies.
pub fn coordination(model: &Model, state: &State) -> f64 {
    let free = |body: usize| model.body(body).inverse_mass > 0.0;
    let count: usize = contacts(model, state)
        .iter()
        .filter(|c| c.normal_force > 0.0)
        .map(|c| usize::from(free(c.a)) + usize::from(matches!(c.b, Partner::Body(b) if free(b))))
        .sum();
    let bodies = (0..model.body_count()).filter(|&b| state.present(b) && free(b)).count();
    if bodies == 0 { 0.0 } else { count as f64 / bodies as f64 }
}

/// Returns the sum of contact and bond forces on each body [N]. Shape `[bodies]`.
pub fn contact_forces(model: &Model, state: &State) -> Vec<Vec3> {
    contact_forces_of(model, state, &contacts(model, state))
}

/// As [`contact_forces`], from given contacts.
pub fn contact_forces_of(model: &Model, state: &State, contacts: &[ContactRecord]) -> Vec<Vec3> {
    let mut sum = vec![Vec3::zeros(); model.body_count()];
    for c in contacts {
        sum[c.a] += c.force;
        if let Partner::Body(b) = c.b {
            sum[b] -= c.force;
        }
    }
    for b in super::bonds::records(model, state) {
        sum[b.a] += b.force;
        sum[b.b] -= b.force;
    }
    sum
}
