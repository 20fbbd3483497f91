//! Sphere–patch candidates and neighbour lists.

use super::patches::PatchPair;
use crate::base::Vec3;
use crate::lanes::vec4::{Vec4, xyz};
use crate::spatial::surface::Surface;

#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    i: u32,
    patch: u32,
    /// Lower bound of the gap [m].
    gap: f32,
}

impl Candidate {
    fn new(i: u32, patch: u32, gap: f64) -> Candidate {
        Candidate { i, patch, gap: (gap - 1e-6 * gap.abs()) as f32 }
    }
}

/// Patches near free spheres (all spheres, if the patch can move).
pub fn candidates<S: Surface>(
    surface: &S,
    spheres: &[Vec4],
    skin: f64,
    free: impl Fn(u32) -> bool,
    row: &mut Vec<u32>,
    out: &mut Vec<Candidate>,
) {
    out.clear();
    if surface.is_empty() || spheres.is_empty() {
        return;
    }
    let bounds = |p: &Vec4| {
        let reach = p[3] + skin;
        ([p[0] - reach, p[1] - reach, p[2] - reach], [p[0] + reach, p[1] + reach, p[2] + reach])
    };
    let all = spheres.iter().map(bounds).fold(([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]), |a, b| {
        ([0, 1, 2].map(|d| a.0[d].min(b.0[d])), [0, 1, 2].map(|d| a.1[d].max(b.1[d])))
    });
    row.clear();
    surface.candidates(all.0, all.1, row);
    if row.is_empty() {
        return;
    }
    for (i, p) in spheres.iter().enumerate() {
        let (lo, hi) = bounds(p);
        row.clear();
        surface.candidates(lo, hi, row);
        let near = |&patch: &u32| {
            let gap = surface.clearance(patch, [p[0], p[1], p[2]]) - p[3];
            let meets = gap <= skin && (free(i as u32) || surface.inverse_mass(patch) > 0.0);
            meets.then(|| Candidate::new(i as u32, patch, gap))
        };
        out.extend(row.iter().filter_map(near));
    }
}

/// Candidates within `near` of contact, sorted by sphere and patch.
pub fn refresh<S: Surface>(
    surface: &S,
    spheres: &[Vec4],
    (near, approach): (f64, f64),
    candidates: &[Candidate],
    fresh: &mut Vec<PatchPair>,
    list: &mut Vec<PatchPair>,
) {
    fresh.clear();
    let mut k = 0;
    let may_meet = |c: &&Candidate| f64::from(c.gap) <= near + approach;
    candidates.iter().filter(may_meet).for_each(|c| surface.fetch(c.patch));
    for &Candidate { i, patch, .. } in candidates.iter().filter(may_meet) {
        while k < list.len() && (list[k].i, list[k].patch) < (i, patch) {
            k += 1;
        }
        let known = list.get(k).filter(|old| (old.i, old.patch) == (i, patch));
        let p = &spheres[i as usize];
        let reach = p[3] + near;
        let clearance = surface.clearance(patch, [p[0], p[1], p[2]]);
        let local = known.map_or([0.0; 2], |old| old.local);
        let mut pair = PatchPair { i, patch, local, spare: clearance - p[3] };
        let mut close = clearance <= reach;
        if close && !surface.sharp() {
            let closest = surface.closest_point(patch, [p[0], p[1], p[2]], pair.local);
            pair.local = closest.local;
            let distance = (Vec3::from(closest.point) - xyz(p)).norm();
            pair.spare = distance - p[3];
            close = distance < reach;
        }
        if close {
            fresh.push(pair);
        }
    }
    std::mem::swap(list, fresh);
}
