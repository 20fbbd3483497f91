//! Contacts of spheres with surfaces made of patches, without counting anything twice.
//!
//! A sphere within reach of several patches touches the surface where its distance to the *union* of them has a
//! local minimum. A closest point inside a patch is one. A closest point on an edge or a vertex is one only if no
//! other patch through that point has a closer point; and points that several patches share count once, for the
//! lowest patch. The test is on points, so it also holds for surfaces whose neighbouring patches do not share
//! vertex numbers.
//!
//! A contact that moves on to another patch takes its memory along: matched by patch first, else with the nearest
//! contact of that sphere that has just ended and has a similar normal.
//!
//! Where two patches meet at a hollow angle both count, as two walls do, unless their normals differ by less than
//! ten degrees: such a seam stands for a smooth surface (the faces of a solid are only C0, and a load bends every
//! seam below it hollow), where counting each patch would double the stiffness near the seam and, as the bend comes
//! and goes, pump energy into the contact. Of such contacts the deepest counts; its overlap is the largest of all
//! and so continuous, and the force keeps a potential.

use super::pass::motion;
use super::{ContactGeometry, ContactLaw, History, PairTable};
use crate::Vec3;
use crate::error::Partner;
use crate::ledger::Impulse;
use crate::state::{Block, Lanes, PatchPair, xyz};
use crate::surface::{Feature, PatchPoint, Surface, SurfaceContact};
use crate::work::{BlockWork, Failure};

/// Points closer than this fraction of the radius are one.
const SAME: f64 = 1e-6;
/// Least cosine between the normals of contacts that are one contact with a smooth surface: ten degrees.
const SMOOTH: f64 = 0.984_807_753_012_208;
/// Least cosine between the normals of a contact before and after it moves on to another patch.
const SIMILAR: f64 = 0.9;

/// What a surface did in one step.
#[derive(Default)]
pub(crate) struct Exchange {
    pub work: f64,
    pub impulse: Impulse,
}

/// One patch against the sphere at hand.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    pub entry: u32,
    pub closest: PatchPoint,
    pub geometry: ContactGeometry,
    /// The centre lies behind a one-sided surface.
    behind: bool,
    pub counts: bool,
}

/// Finds which of the patches `pairs` (all of one sphere at `x`) count. Results are appended to `out`.
fn touches<S: Surface>(surface: &S, x: &Vec3, r: f64, pairs: &mut [PatchPair], out: &mut Vec<Touch>) {
    let first = out.len();
    for (entry, pair) in pairs.iter_mut().enumerate() {
        let closest = surface.closest_point(pair.patch, (*x).into(), pair.local);
        pair.local = closest.local;
        let (point, outward) = (Vec3::from(closest.point), Vec3::from(closest.normal));
        let offset = x - point;
        let distance = offset.norm();
        if distance >= r {
            continue;
        }
        let behind = surface.one_sided() && offset.dot(&outward) < 0.0;
        let (normal, overlap) = match (distance > 0.0, behind) {
            (false, _) => (outward, r),
            (true, false) => (offset / distance, r - distance),
            (true, true) => (-offset / distance, r + distance),
        };
        let geometry = ContactGeometry { point, normal, overlap, radius: r };
        out.push(Touch { entry: entry as u32, closest, geometry, behind, counts: true });
    }
    let found = &mut out[first..];
    let tolerance = SAME * r;
    for k in 0..found.len() {
        let point = found[k].geometry.point;
        let mut shared = false;
        let on_rim = found[k].closest.feature != Feature::Face;
        let mut counts = true;
        for m in 0..found.len() {
            if m == k {
                continue;
            }
            let other = &found[m];
            if (other.geometry.point - point).norm() <= tolerance {
                shared = true;
                // Once for the lowest patch.
                counts &= !(m < k && other.counts);
            } else if on_rim {
                let patch = pairs[other.entry as usize].patch;
                let nearest = surface.closest_point(patch, point.into(), other.closest.local);
                if (Vec3::from(nearest.point) - point).norm() <= tolerance {
                    counts = false;
                }
            }
        }
        // Behind the outer rim of a one-sided surface is beside it, not below it.
        found[k].counts = counts && !(on_rim && found[k].behind && !shared);
    }
    keep_deepest(found);
}

/// Of contacts whose normals differ little keeps the deepest, the first of equals.
fn keep_deepest(found: &mut [Touch]) {
    for k in 0..found.len() {
        for m in 0..k {
            let (first, second) = (&found[m], &found[k]);
            if first.counts && second.counts && first.geometry.normal.dot(&second.geometry.normal) > SMOOTH {
                let loser = if second.geometry.overlap > first.geometry.overlap { m } else { k };
                found[loser].counts = false;
            }
        }
    }
}

/// All contacts of a block with one surface.
pub(crate) fn contacts<L: ContactLaw, S: Surface, const RIGID: bool>(
    laws: &PairTable<L>,
    surface: &S,
    material: impl Fn(u32) -> u32,
    partner: impl Fn(u32) -> Partner,
    list: &mut [PatchPair],
    block: &Block,
    w: &mut BlockWork,
    external: bool,
    dt: f64,
) -> Exchange {
    let mut exchange = Exchange::default();
    let mut touched = std::mem::take(&mut w.touches);
    for pairs in list.chunk_by_mut(|a, b| a.i == b.i) {
        let i = pairs[0].i as usize;
        let p: Lanes = if RIGID { w.spheres[i] } else { block.centre[i] };
        let (x, r) = (xyz(&p), p[3]);
        touched.clear();
        touches(surface, &x, r, pairs, &mut touched);
        hand_over(&touched, pairs, r);

        let a = if RIGID { w.owner[i] as usize } else { i };
        let own = block.spin[a][3] as u32;
        for (entry, pair) in pairs.iter_mut().enumerate() {
            let on = touched.iter().any(|t| t.counts && t.entry as usize == entry);
            if !on && !pair.history.is_fresh() {
                w.ledger.dissipated_friction +=
                    laws.get(own, material(pair.patch)).release(&mut pair.history);
            }
        }
        for t in touched.iter().filter(|t| t.counts) {
            let pair = &mut pairs[t.entry as usize];
            let g = &t.geometry;
            // A two-sided wall pushes back from whichever side the centre is on: a flipped normal means it passed.
            let passed = !pair.history.is_fresh() && pair.normal.dot(&g.normal) < -0.5;
            let overlap = if passed { 2.0 * r - g.overlap } else { g.overlap };
            let bound = if surface.one_sided() { 2.0 * r } else { r };
            if (passed || overlap > bound) && w.failure.is_none() {
                let partner = partner(pair.patch);
                w.failure = Some(Failure::Overlap { body: block.bodies[a], partner, overlap, bound });
            }
            let ma = motion(block, a, &g.point);
            let wall = Vec3::from(t.closest.velocity);
            let mass = 1.0 / block.velocity[a][3];
            let law = laws.get(own, material(pair.patch));
            let f = law.respond(mass, g, &(ma.at_point() - wall), &ma.spin(), &mut pair.history, dt);
            pair.point = g.point;
            pair.normal = g.normal;
            pair.velocity = wall;
            pair.overlap = g.overlap;
            w.ledger.dissipated_dashpot += f.dashpot;
            w.ledger.dissipated_friction += f.friction;
            exchange.work += f.force.dot(&wall) * dt;
            exchange.impulse.add(&g.point, &(f.force * dt));
            exchange.impulse.angular += f.moment * dt;
            w.push(a, &f.force, &(ma.arm.cross(&f.force) + f.moment));
            if external {
                let sphere = if RIGID { i as u32 - w.first[a] } else { 0 };
                w.contacts.push(SurfaceContact {
                    sphere,
                    body: block.bodies[a],
                    patch: pair.patch,
                    local: t.closest.local,
                    point: g.point.into(),
                    force: (-f.force).into(),
                    overlap: g.overlap,
                });
            }
        }
    }
    w.touches = touched;
    exchange
}

/// Contacts that begin take the memory of contacts that end nearby with a similar normal.
fn hand_over(touched: &[Touch], pairs: &mut [PatchPair], r: f64) {
    for t in touched.iter().filter(|t| t.counts) {
        if !pairs[t.entry as usize].history.is_fresh() {
            continue;
        }
        let mut nearest: Option<(f64, usize)> = None;
        for (m, old) in pairs.iter().enumerate() {
            let on = touched.iter().any(|u| u.counts && u.entry as usize == m);
            let distance = (old.point - t.geometry.point).norm();
            if !on
                && !old.history.is_fresh()
                && old.normal.dot(&t.geometry.normal) > SIMILAR
                && distance < 0.5 * r
                && nearest.is_none_or(|(best, _)| distance < best)
            {
                nearest = Some((distance, m));
            }
        }
        if let Some((_, m)) = nearest {
            let history = std::mem::replace(&mut pairs[m].history, History::NONE);
            let normal = pairs[m].normal;
            let to = &mut pairs[t.entry as usize];
            to.history = history;
            to.normal = normal;
        }
    }
}
