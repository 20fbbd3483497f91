//! Contacts of spheres with patch surfaces, without double counting.
//!
//! Contacts are local minima of the distance to the *union* of patches: a closest point on an edge or vertex
//! counts only if no patch through it is closer. Shared points count once: face before edge before vertex,
//! then the lowest patch. Points are compared, so patches need not share vertices.
//!
//! A contact that changes patch keeps its history.
//!
//! At concave seams both patches count, unless their normals differ by less than ten degrees (smooth
//! surface): then the deepest counts, whose force has a potential. Descending overlap makes the result
//! independent of patch order.

use super::dispatch;
use super::patch_forces::PatchForce;
use super::scalar::{self, StepContext};
use crate::base::Vec3;
use crate::base::balance_terms::Impulse;
use crate::base::error::Partner;
use crate::base::failure::Failure;
use crate::bodies::block::Block;
use crate::bodies::block_bodies::BlockBodies;
use crate::bodies::sums::{BlockTotals, WallSum};
use crate::lanes::vec4::xyz;
use crate::lanes::{Real, V3};
use crate::law::{ContactGeometry, History};
use crate::pairs::patches::{PatchContact, PatchList, PatchPair};
use crate::spatial::surface::{Feature, PatchPoint, Surface, SurfaceContact};

/// Scratch and results of a block.
#[derive(Clone, Debug, Default)]
pub struct PatchWork {
    /// Whether contacts may resist rolling or twisting, or adhere.
    pub turning: bool,
    found: Vec<PatchTouch>,
    live: Vec<PatchContact>,
    forces: Vec<PatchForce>,
    /// Energy of ended springs [J].
    ended: f64,
    pub contacts: Vec<SurfaceContact>,
    /// Force sums by wall; empty without walls nearby.
    pub wall_sums: Vec<WallSum>,
    /// Wall contacts for another back end.
    pub aside: SavedForces,
}

#[derive(Clone, Debug, Default)]
pub struct SavedForces {
    /// In the order of spheres.
    pub forces: Vec<PatchForce>,
    pub dashpot: f64,
    pub friction: f64,
}

impl SavedForces {
    pub fn clear(&mut self) {
        self.forces.clear();
        (self.dashpot, self.friction) = (0.0, 0.0);
    }
}

impl PatchWork {
    /// Latest surface contacts, in the order of spheres.
    pub fn forces(&self) -> &[PatchForce] {
        &self.forces
    }

    /// Moves the latest contacts and their dissipation out of `totals`.
    pub fn set_aside(&mut self, totals: &mut BlockTotals) {
        let PatchWork { forces, aside, .. } = self;
        std::mem::swap(forces, &mut aside.forces);
        aside.dashpot = std::mem::take(&mut totals.balance.dissipated_dashpot);
        aside.friction = std::mem::take(&mut totals.balance.dissipated_friction);
    }
}

/// Coincidence tolerance over radius.
const SAME: f64 = 1e-6;
/// Smallest cosine between normals of a smooth surface: ten degrees.
const SMOOTH: f64 = 0.984_807_753_012_208;
/// Smallest cosine between normals for history transfer.
const SIMILAR: f64 = 0.9;

#[derive(Default)]
pub struct SurfaceExchange {
    pub work: f64,
    pub impulse: Impulse,
}

#[derive(Clone, Copy, Debug)]
pub struct PatchTouch {
    patch: u32,
    closest: PatchPoint,
    geometry: ContactGeometry,
    /// Centre behind a one-sided surface.
    behind: bool,
    pub counts: bool,
}

#[derive(Clone, Copy, Debug)]
pub struct Gap<R> {
    offset: V3<R>,
    along: R,
    pub distance: R,
}

impl<R: Real> Gap<R> {
    /// `straight`: interior point with exact normal.
    #[inline(always)]
    pub fn new(offset: V3<R>, outward: V3<R>, straight: R::Mask) -> Gap<R> {
        let along = offset.dot(outward);
        Gap { offset, along, distance: R::select(straight, along.abs(), offset.norm2().sqrt()) }
    }

    /// `r`: sphere radius.
    #[inline(always)]
    pub fn contact(&self, outward: V3<R>, r: R, straight: R::Mask, behind: R::Mask) -> (V3<R>, R) {
        let &Gap { offset, along, distance } = self;
        let apart = R::zero().lt(distance);
        let inward = along.lt(R::zero()) & !behind;
        let mut normal = V3::select(inward, -outward, outward);
        if R::any(!straight) {
            let away = V3::select(behind, -offset, offset);
            let away = V3::new(away.x / distance, away.y / distance, away.z / distance);
            normal = V3::select(straight, normal, away);
        }
        let overlap = R::select(behind, r + distance, r - distance);
        (V3::select(apart, normal, outward), R::select(apart, overlap, r))
    }
}

#[inline]
fn overlapping<S: Surface>(
    surface: &S,
    x: &Vec3,
    r: f64,
    travel_since_search: f64,
    pairs: &mut [PatchPair],
    out: &mut Vec<PatchTouch>,
) {
    let sharp = surface.sharp();
    let centre = [x.x, x.y, x.z];
    for pair in pairs {
        if pair.spare > travel_since_search {
            continue;
        }
        if sharp && pair.spare >= 0.0 {
            let clearance = surface.clearance(pair.patch, centre);
            if clearance > r {
                pair.spare = travel_since_search + clearance - r;
                continue;
            }
        }
        let closest = surface.closest_point(pair.patch, centre, pair.local);
        pair.local = closest.local;
        let (point, outward) = (Vec3::from(closest.point), Vec3::from(closest.normal));
        let offset = x - point;
        let along = offset.dot(&outward);
        let behind = along < 0.0 && surface.one_sided_patch(pair.patch);
        let straight = sharp && closest.feature == Feature::Face;
        let gap = Gap::new(V3::from_vec(&offset), V3::from_vec(&outward), straight);
        let distance = gap.distance;
        if distance >= r && !(behind && straight) {
            // Exact for a smooth patch; beyond a sharp edge, check again next step.
            pair.spare = if sharp { travel_since_search } else { travel_since_search + distance - r };
            continue;
        }
        pair.spare = -1.0;
        let (normal, overlap) = gap.contact(V3::from_vec(&outward), r, straight, behind);
        let normal = normal.to_vec();
        let geometry = ContactGeometry { point, normal, overlap, radius: r };
        out.push(PatchTouch { patch: pair.patch, closest, geometry, behind, counts: true });
    }
    if out.len() < 2 {
        for t in out.iter_mut() {
            t.counts = !(t.behind && t.closest.feature != Feature::Face);
        }
        return;
    }
    count_once(surface, r, out);
    keep_deepest(out);
}

/// Coincidence tolerance of contact points [m].
#[inline(always)]
pub fn tolerance<R: Real>(radius: R) -> R {
    R::splat(SAME) * radius
}

#[inline(always)]
pub fn one_point<R: Real>(a: V3<R>, b: V3<R>, radius: R) -> R::Mask {
    (a - b).norm2().sqrt().le(tolerance(radius))
}

#[inline(always)]
pub fn alike<R: Real>(a: V3<R>, b: V3<R>) -> R::Mask {
    a.dot(b).gt(R::splat(SMOOTH))
}

/// Whether a new contact may adopt an ending one's history, and their distance.
#[inline(always)]
pub fn may_follow<R: Real>(new: (V3<R>, V3<R>), old: (V3<R>, V3<R>), radius: R) -> (R::Mask, R) {
    let away = (old.1 - new.1).norm2().sqrt();
    (old.0.dot(new.0).gt(R::splat(SIMILAR)) & away.lt(R::splat(0.5) * radius), away)
}

/// Whether a sphere crossed a two-sided patch, which flips the normal. `old`: normal, side.
#[inline(always)]
pub fn passed<R: Real>(normal: V3<R>, side: R, old: (V3<R>, R)) -> R::Mask {
    old.0.dot(normal).lt(R::splat(-0.5)) & (old.1 * side).le(R::zero())
}

pub struct InteriorContact<R: Real> {
    pub normal: V3<R>,
    pub overlap: R,
    /// Cosine of contact and patch normal.
    pub side: R,
    /// Whether no other contact can count.
    pub stays: R::Mask,
}

/// Sphere on a patch interior.
#[inline(always)]
pub fn rest<R: Real>(offset: V3<R>, outward: V3<R>, r: R) -> InteriorContact<R> {
    let along = offset.dot(outward);
    let distance = along.abs();
    let normal = V3::select(along.lt(R::zero()), -outward, outward);
    let stays = distance.lt(r) & (R::splat(SMOOTH) * r).lt(distance);
    InteriorContact { normal, overlap: r - distance, side: normal.dot(outward), stays }
}

#[inline(always)]
fn count_once<S: Surface>(surface: &S, r: f64, out: &mut [PatchTouch]) {
    let same = |a: &Vec3, b: &Vec3| one_point(V3::from_vec(a), V3::from_vec(b), r);
    for k in 0..out.len() {
        let point = out[k].geometry.point;
        let rank = |k: usize, t: &PatchTouch| match t.closest.feature {
            Feature::Face => (0, k),
            Feature::Edge(_) => (1, k),
            Feature::Vertex(_) => (2, k),
        };
        let own = rank(k, &out[k]);
        let on_rim = own.0 > 0;
        let (mut shared, mut counts) = (false, true);
        for (m, other) in out.iter().enumerate() {
            if m == k {
                continue;
            }
            if same(&other.geometry.point, &point) {
                shared = true;
                counts &= own < rank(m, other);
            } else if on_rim && surface.clearance(other.patch, point.into()) <= tolerance(r) {
                let nearest = surface.closest_point(other.patch, point.into(), other.closest.local);
                counts &= !same(&Vec3::from(nearest.point), &point);
            }
        }
        // Outside the outer rim of a one-sided surface.
        out[k].counts = counts && !(on_rim && out[k].behind && !shared);
    }
}

/// Interior contact with only coplanar patches nearby; other contacts then differ by less than [`SMOOTH`].
#[inline(always)]
fn resting<S: Surface>(
    surface: &S,
    x: &Vec3,
    r: f64,
    pairs: &[PatchPair],
    before: &[PatchContact],
) -> Option<PatchContact> {
    let [old] = before else { return None };
    if !pairs.iter().all(|p| surface.level(p.patch, old.patch)) {
        return None;
    }
    let [point, outward, velocity] = surface.foot(old.patch, [x.x, x.y, x.z])?;
    let InteriorContact { normal, overlap, side, stays } =
        rest(V3::from_vec(&(x - point)), V3::from_vec(&outward), r);
    stays.then(|| PatchContact { point, normal: normal.to_vec(), velocity, overlap, side, ..*old })
}

/// Keeps the deepest among similar normals, the first of equals.
fn keep_deepest(found: &mut [PatchTouch]) {
    let mut last = (f64::INFINITY, 0);
    loop {
        let next = (0..found.len())
            .filter(|&k| found[k].counts && after(last, k, &found[k]))
            .max_by(|&a, &b| found[a].geometry.overlap.total_cmp(&found[b].geometry.overlap).then(b.cmp(&a)));
        let Some(k) = next else { return };
        last = (found[k].geometry.overlap, k);
        let normal = found[k].geometry.normal;
        for m in 0..found.len() {
            let other = V3::from_vec(&found[m].geometry.normal);
            if found[m].counts && after(last, m, &found[m]) && alike(V3::from_vec(&normal), other) {
                found[m].counts = false;
            }
        }
    }
}

/// Whether a contact follows `last` in descending overlap.
fn after(last: (f64, usize), k: usize, t: &PatchTouch) -> bool {
    t.geometry.overlap < last.0 || (t.geometry.overlap == last.0 && k > last.1)
}

pub struct ContactSurface<'a, S, M, P> {
    pub surface: &'a S,
    /// By patch: material (index), partner name.
    pub material: M,
    pub partner: P,
    /// Whether contacts go to another program part; else forces are summed by wall.
    pub external: bool,
    /// Motion bound since the neighbour list was built [m].
    pub travel_since_search: f64,
}

/// Contacts of a block with a surface: detection, law, application.
pub fn contacts<S: Surface>(
    setting: &StepContext<'_>,
    against: &ContactSurface<'_, S, impl Fn(u32) -> u32, impl Fn(u32) -> Partner>,
    list: &mut PatchList,
    (block, members): (&Block, &BlockBodies),
    totals: &mut BlockTotals,
    work: &mut PatchWork,
) -> SurfaceExchange {
    detect(setting, against, list, (block, members), totals, work);
    dispatch::patch_forces(setting, work.turning, block, &mut work.forces);
    let exchange = apply(setting, against, (block, members), totals, work);
    std::mem::swap(&mut list.live, &mut work.live);
    exchange
}

#[inline(always)]
fn detect<S: Surface>(
    setting: &StepContext<'_>,
    against: &ContactSurface<'_, S, impl Fn(u32) -> u32, impl Fn(u32) -> Partner>,
    list: &mut PatchList,
    (block, members): (&Block, &BlockBodies),
    totals: &mut BlockTotals,
    work: &mut PatchWork,
) {
    let ContactSurface { surface, material, travel_since_search, .. } = against;
    let (surface, travel_since_search) = (*surface, *travel_since_search);
    let PatchWork { found, live, forces, .. } = work;
    live.clear();
    forces.clear();
    let owner = |i: u32| members.body(i) as usize;
    let end = |c: &mut PatchContact| {
        scalar::end(setting.laws, [block.material(owner(c.i)), material(c.patch)], &mut c.history)
    };
    let input = |body: usize, c: &PatchContact, radius: f64, local: [f64; 2]| {
        let (mass, material) = (surface.inverse_mass(c.patch), material(c.patch));
        let (point, velocity) = ((&c.point, c.overlap), (&c.velocity, mass));
        let spin = (&surface.spin(c.patch), material);
        PatchForce::new(body as u32, point, (&c.normal, radius), velocity, spin, local, &c.history)
    };
    let mut friction = 0.0;
    let sharp = surface.sharp();
    let spheres = members.spheres(block);
    list.pairs.iter().filter(|p| p.spare <= travel_since_search).for_each(|p| surface.fetch(p.patch));
    let old = &mut list.live[..];
    let mut at = 0;
    for pairs in list.pairs.chunk_by_mut(|a, b| a.i == b.i) {
        let sphere = pairs[0].i;
        let p = spheres[sphere as usize];
        let (x, r) = (xyz(&p), p[3]);
        while at < old.len() && old[at].i < sphere {
            friction += end(&mut old[at]);
            at += 1;
        }
        let from = at;
        at += old[from..].iter().take_while(|c| c.i == sphere).count();
        let before = &mut old[from..at];
        let a = owner(sphere);
        if sharp && let Some(contact) = resting(surface, &x, r, pairs, before) {
            forces.push(input(a, &contact, r, [0.0; 2]));
            live.push(contact);
            continue;
        }
        found.clear();
        overlapping(surface, &x, r, travel_since_search, pairs, found);
        if found.is_empty() && before.is_empty() {
            continue;
        }
        let first = live.len();
        for t in found.iter().filter(|t| t.counts) {
            live.push(new_contact(t, sphere, before));
        }
        let now = &mut live[first..];
        if before.iter().any(|c| !c.history.is_new()) {
            transfer_history(now, before, r);
            before.iter_mut().for_each(|c| friction += end(c));
        }
        for (t, contact) in found.iter().filter(|t| t.counts).zip(now) {
            if let Some((overlap, bound)) = update_contact(surface, contact, t, r)
                && totals.failure.is_none()
            {
                let partner = (against.partner)(t.patch);
                totals.failure = Some(Failure::Overlap { body: block.bodies[a], partner, overlap, bound });
            }
            if let Some(way) = surface.correction(t.patch, t.closest.local) {
                contact.history.displace(&way.into(), &contact.normal);
            }
            forces.push(input(a, contact, t.geometry.radius, t.closest.local));
        }
    }
    old[at..].iter_mut().for_each(|c| friction += end(c));
    // Fixes the summation order.
    work.ended = friction;
}

/// Updates a contact; returns overlap and limit if too deep [m].
#[inline(always)]
fn update_contact<S: Surface>(
    surface: &S,
    contact: &mut PatchContact,
    t: &PatchTouch,
    r: f64,
) -> Option<(f64, f64)> {
    let g = &t.geometry;
    let side = g.normal.dot(&Vec3::from(t.closest.normal));
    let old = (V3::from_vec(&contact.normal), contact.side);
    let passed = !contact.history.is_new() && passed(V3::from_vec(&g.normal), side, old);
    let overlap = if passed { 2.0 * r - g.overlap } else { g.overlap };
    let bound = if surface.one_sided() { 2.0 * r } else { r };
    contact.point = g.point;
    contact.normal = g.normal;
    contact.velocity = t.closest.velocity.into();
    contact.overlap = g.overlap;
    contact.side = side;
    (passed || overlap > bound).then_some((overlap, bound))
}

#[inline(always)]
fn apply<S: Surface>(
    setting: &StepContext<'_>,
    against: &ContactSurface<'_, S, impl Fn(u32) -> u32, impl Fn(u32) -> Partner>,
    (block, members): (&Block, &BlockBodies),
    totals: &mut BlockTotals,
    work: &mut PatchWork,
) -> SurfaceExchange {
    let (ContactSurface { surface, material, external, .. }, dt) = (against, setting.dt);
    let PatchWork { live, forces, contacts, wall_sums, .. } = work;
    let (mut dashpot, mut friction) = (0.0, work.ended);
    let mut exchange = SurfaceExchange::default();
    for (result, contact) in forces.iter().zip(live) {
        let before = std::mem::replace(&mut contact.history, result.history());
        let (a, force, moment) = (result.body as usize, result.force(), result.moment());
        let dissipated = result.dissipated();
        dashpot += dissipated.0;
        friction += dissipated.1;
        totals.sums[a].push(&force, &result.torque());
        let materials = [block.material(a), material(contact.patch)];
        if *external {
            exchange.work += force.dot(&contact.velocity) * dt;
            exchange.impulse.add(&contact.point, &(force * dt));
            exchange.impulse.angular += moment * dt;
            // Dashpot part; a sliding spring holds the remaining limit.
            let (normal, tangential) =
                scalar::springs(setting.laws, materials, contact.overlap, result.radius(), &contact.history);
            let sprung = contact.normal * normal - contact.history.spring * tangential;
            contacts.push(SurfaceContact {
                dashpot: (sprung - force).into(),
                sphere: members.member(contact.i, a),
                body: block.bodies[a],
                patch: contact.patch,
                local: result.local,
                point: contact.point.into(),
                force: (-force).into(),
                couple: [0.0; 3],
                overlap: contact.overlap,
            });
        } else {
            let group = surface.group(contact.patch);
            let sum = &mut wall_sums[group];
            sum.force += force;
            sum.moment +=
                (contact.point - Vec3::from(surface.moment_centre(contact.patch))).cross(&force) + moment;
            if surface.driven(group) {
                let [own, other] = materials;
                let stiffness = setting.laws.stiffness(own, other, contact.overlap, result.radius());
                let mass = 1.0 / (block.velocity[a][3] + surface.inverse_mass(contact.patch));
                sum.stiffness += stiffness;
                sum.damping += (stiffness * mass).sqrt();
                let &mut PatchContact { point, normal, overlap, .. } = contact;
                let geometry = ContactGeometry { point, normal, overlap, radius: result.radius() };
                let memory = [&before, &contact.history];
                scalar::add_dashpot(
                    &mut sum.dashpots,
                    setting.laws,
                    materials,
                    &geometry,
                    memory,
                    &force,
                    1.0,
                );
            }
        }
    }
    totals.balance.dissipated_dashpot += dashpot;
    totals.balance.dissipated_friction += friction;
    exchange
}

fn new_contact(t: &PatchTouch, sphere: u32, before: &mut [PatchContact]) -> PatchContact {
    let mut contact = PatchContact {
        i: sphere,
        patch: t.patch,
        point: t.geometry.point,
        normal: t.geometry.normal,
        velocity: Vec3::zeros(),
        overlap: t.geometry.overlap,
        side: t.geometry.normal.dot(&Vec3::from(t.closest.normal)),
        history: History::NONE,
    };
    if let Some(old) = before.iter_mut().find(|c| c.patch == t.patch) {
        contact.history = std::mem::replace(&mut old.history, History::NONE);
        (contact.normal, contact.side) = (old.normal, old.side);
    }
    contact
}

fn transfer_history(now: &mut [PatchContact], before: &mut [PatchContact], r: f64) {
    for contact in now.iter_mut().filter(|c| c.history.is_new()) {
        let of = V3::from_vec;
        let new = (of(&contact.normal), of(&contact.point));
        let nearest = before
            .iter_mut()
            .filter(|old| !old.history.is_new())
            .map(|old| (may_follow(new, (of(&old.normal), of(&old.point)), r), old))
            .filter(|((may, _), _)| *may)
            .map(|((_, distance), old)| (distance, old))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, old)) = nearest {
            contact.history = std::mem::replace(&mut old.history, History::NONE);
            contact.normal = old.normal;
        }
    }
}
