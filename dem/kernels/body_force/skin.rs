//! Triangulated surface of a shape, and its part below a plane.
//!
//! Edges of dilated polyhedra become strips of at most 30°, vertices fans, moved outwards to the exact
//! volume.

use super::disk;
use crate::base::Vec3;
use crate::shape::Shape;
use crate::shape::dilated::Core;
use std::collections::HashMap;
use std::ops::Range;

/// Largest strip angle [rad].
const STRIP: f64 = 0.525;

#[derive(Clone, Copy, Debug)]
struct Facet {
    corners: [u16; 3],
    /// Outward normal times area [m²], and area.
    area: Vec3,
    size: f64,
    volume: f64,
}

#[derive(Clone, Debug)]
struct Group {
    /// Core vertices, and offsets from them: ranges of `owners` and `offsets`.
    owners: Range<u32>,
    offsets: Range<u32>,
    facets: Range<u32>,
    volume: f64,
    moment: Vec3,
    area: f64,
    /// Sum of coplanar normals.
    flat: Option<Vec3>,
}

/// In the body frame; empty for shapes made of spheres.
#[derive(Clone, Debug, Default)]
pub struct Skin {
    /// Core and triangle vertices.
    core: Vec<Vec3>,
    points: Vec<Vec3>,
    facets: Vec<Facet>,
    groups: Vec<Group>,
    owners: Vec<u8>,
    offsets: Vec<Vec3>,
    /// Largest offset from a core vertex [m].
    margin: f64,
    /// Volume [m³]; first moment [m⁴], a discretisation error.
    whole: (f64, Vec3),
    /// Mean vertex distance from the centre [m].
    pub reach: f64,
    /// Radii of a dilated disk [m].
    disk: Option<[f64; 2]>,
}

/// Submerged part of a body.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wet {
    /// Volume [m³].
    pub volume: f64,
    /// Vector from the body's centre to the centre of buoyancy [m].
    pub arm: Vec3,
    /// Wetted area [m²], without the waterplane.
    pub area: f64,
    /// Half the sum of areas projected along a direction, with waterplane [m²].
    pub seen: f64,
}

impl Skin {
    #[doc(hidden)]
    pub fn of(shape: &Shape) -> Skin {
        match shape.query(|s| s.sphere_count()) {
            0 => Skin::new(&shape.core(), shape.rounding(1.0)),
            _ => Skin::default(),
        }
    }

    /// Core dilated by a radius [m].
    pub fn new(core: &Core, radius: f64) -> Skin {
        if let Some(rim) = core.rim {
            return Skin { disk: Some([rim, radius]), reach: rim + radius, ..Skin::default() };
        }
        let mut skin = Skin { core: core.corners.clone(), margin: radius, ..Skin::default() };
        // Face vertices, moved outwards.
        let mut places = HashMap::new();
        for (f, face) in core.faces.iter().enumerate() {
            for &c in &face.corners {
                let place = skin.point(core.corners[c as usize] + face.normal * radius);
                places.insert((f as u8, c), place);
            }
            let ring: Vec<u16> = face.corners.iter().map(|c| places[&(f as u8, *c)]).collect();
            for k in 1..ring.len() - 1 {
                skin.facet([ring[0], ring[k], ring[k + 1]]);
            }
            skin.group(&face.corners, [face.normal * radius], true);
        }
        if radius > 0.0 {
            skin.rounded(core, radius, &places);
        }
        let volume = skin.groups.iter().map(|g| g.volume).sum();
        skin.whole = (volume, skin.groups.iter().map(|g| g.moment).sum());
        let far: f64 = core.corners.iter().map(|c| c.norm()).sum();
        skin.reach = far / core.corners.len().max(1) as f64 + radius;
        skin
    }

    /// Closed surface of outward triangles, concave or not, about a centre within it; `None` beyond 65,536
    /// vertices.
    pub fn of_surface(vertices: &[Vec3], faces: &[[u32; 3]], centre: &Vec3) -> Option<Skin> {
        u16::try_from(vertices.len().saturating_sub(1)).ok()?;
        let points: Vec<Vec3> = vertices.iter().map(|v| v - centre).collect();
        let facet = |f: &[u32; 3]| {
            let [a, b, c] = f.map(|k| points[k as usize]);
            let area = (b - a).cross(&(c - a)) * 0.5;
            Facet { corners: f.map(|k| k as u16), area, size: area.norm(), volume: a.dot(&area) / 3.0 }
        };
        let facets: Vec<Facet> = faces.iter().map(facet).collect();
        let margin = points.iter().map(|p| p.norm()).fold(0.0, f64::max);
        let mut skin = Skin { core: vec![Vec3::zeros()], points, facets, margin, ..Skin::default() };
        let moment =
            |f: &Facet| f.corners.iter().map(|&k| skin.points[k as usize]).sum::<Vec3>() * (0.25 * f.volume);
        let whole = Group {
            owners: 0..1,
            offsets: 0..skin.points.len() as u32,
            facets: 0..skin.facets.len() as u32,
            volume: skin.facets.iter().map(|f| f.volume).sum(),
            moment: skin.facets.iter().map(moment).sum(),
            area: skin.facets.iter().map(|f| f.size).sum(),
            flat: None,
        };
        // The centre of buoyancy of a submerged surface need not be its centre of mass.
        skin.whole = (whole.volume, Vec3::zeros());
        skin.owners = vec![0];
        skin.offsets = skin.points.clone();
        skin.groups = vec![whole];
        skin.reach = margin;
        Some(skin)
    }

    /// Vertices of the surface about the centre [m].
    pub fn points(&self) -> &[Vec3] {
        &self.points
    }

    fn rounded(&mut self, core: &Core, radius: f64, places: &HashMap<(u8, u8), u16>) {
        // Arcs around vertices: directions and points.
        let mut arcs: Vec<Vec<(Vec3, u16)>> = vec![Vec::new(); core.corners.len()];
        for edge in &core.edges {
            let [n, m] = edge.faces.map(|f| core.faces[f as usize].normal);
            let directions = strip(&n, &m);
            let last = directions.len() - 1;
            let ends = edge.ends.map(|c| -> Vec<u16> {
                let middle = |d: &Vec3| core.corners[c as usize] + d * radius;
                let mut ring = vec![places[&(edge.faces[0], c)]];
                ring.extend(directions[1..last].iter().map(|d| self.point(middle(d))));
                ring.push(places[&(edge.faces[1], c)]);
                ring
            });
            for k in 0..last {
                let [a, b] = [&ends[0], &ends[1]].map(|ring| (ring[k], ring[k + 1]));
                self.facet([a.0, b.0, b.1]);
                self.facet([a.0, b.1, a.1]);
            }
            self.group(&edge.ends, directions.iter().map(|d| d * radius), false);
            for (end, &c) in ends.iter().zip(&edge.ends) {
                // Neighbour pairs: a fan needs no order.
                for k in 0..last {
                    arcs[c as usize].push((directions[k], end[k]));
                    arcs[c as usize].push((directions[k + 1], end[k + 1]));
                }
            }
        }
        for (c, (corner, arcs)) in core.corners.iter().zip(&arcs).enumerate() {
            let sum: Vec3 = arcs.iter().map(|(d, _)| d).sum();
            let middle = sum.normalize();
            let (mut solid, mut flat) = (0.0, 0.0);
            for pair in arcs.chunks_exact(2) {
                let [a, b] = [pair[0].0, pair[1].0];
                let spread = middle.dot(&a.cross(&b)).abs();
                let [u, v] = [a.normalize(), b.normalize()];
                let above = 1.0 + middle.dot(&u) + u.dot(&v) + v.dot(&middle);
                // Solid angle of three directions (Van Oosterom & Strackee 1983).
                solid += 2.0 * libm::atan2(middle.dot(&u.cross(&v)).abs(), above);
                flat += spread;
            }
            let far = radius * 2.0 * solid / flat;
            let longest = arcs.iter().map(|(d, _)| d.norm()).fold(0.0, f64::max);
            self.margin = self.margin.max(far).max(radius * longest);
            let apex = self.point(corner + middle * far);
            for pair in arcs.chunks_exact(2) {
                self.facet([apex, pair[0].1, pair[1].1]);
            }
            let around = arcs.iter().map(|(d, _)| d * radius);
            self.group(&[c as u8], around.chain([middle * far]), false);
        }
    }

    fn point(&mut self, at: Vec3) -> u16 {
        self.points.push(at);
        self.points.len() as u16 - 1
    }

    /// Adds a triangle, oriented away from the interior origin.
    fn facet(&mut self, corners: [u16; 3]) {
        let [a, b, c] = corners.map(|k| self.points[k as usize]);
        let area = (b - a).cross(&(c - a)) * 0.5;
        let volume = a.dot(&area) / 3.0;
        let (corners, area) =
            if volume < 0.0 { ([corners[0], corners[2], corners[1]], -area) } else { (corners, area) };
        self.facets.push(Facet { corners, area, size: area.norm(), volume: volume.abs() });
    }

    /// Groups the remaining triangles of one face, edge or vertex.
    fn group(&mut self, corners: &[u8], offsets: impl IntoIterator<Item = Vec3>, flat: bool) {
        let from = self.groups.last().map_or(0, |g| g.facets.end);
        let (first, second) = (self.owners.len() as u32, self.offsets.len());
        self.owners.extend(corners);
        for offset in offsets {
            if !self.offsets[second..].contains(&offset) {
                self.offsets.push(offset);
            }
        }
        let own = &self.facets[from as usize..];
        let moment =
            |f: &Facet| f.corners.iter().map(|&k| self.points[k as usize]).sum::<Vec3>() * (0.25 * f.volume);
        let group = Group {
            owners: first..self.owners.len() as u32,
            offsets: second as u32..self.offsets.len() as u32,
            facets: from..self.facets.len() as u32,
            volume: own.iter().map(|f| f.volume).sum(),
            moment: own.iter().map(moment).sum(),
            area: own.iter().map(|f| f.size).sum(),
            flat: flat.then(|| own.iter().map(|f| f.area).sum()),
        };
        self.groups.push(group);
    }

    /// Part below the plane up·x = `level` [m]; projected along `along`; `heights` is scratch.
    pub fn below(&self, up: &Vec3, level: f64, along: &Vec3, heights: &mut Vec<f64>) -> Wet {
        if let Some(radii) = self.disk {
            return disk::below(radii, up, level, along);
        }
        heights.clear();
        heights.extend(self.core.iter().map(|p| up.dot(p) - level));
        self.below_at(up, level, along, heights)
    }

    /// As [`Skin::below`], for [`Skin::of_surface`].
    pub fn surface_below(&self, up: &Vec3, level: f64, along: &Vec3) -> Wet {
        self.below_at(up, level, along, &[-level])
    }

    /// `heights`: of the core over the plane [m].
    fn below_at(&self, up: &Vec3, level: f64, along: &Vec3, heights: &[f64]) -> Wet {
        let (mut sum, foot) = (Part::default(), up * level);
        for g in &self.groups {
            let owners = &self.owners[g.owners.start as usize..g.owners.end as usize];
            let [mut low, mut high] = ends(owners.iter().map(|&c| heights[c as usize]));
            if low > self.margin {
                continue;
            }
            if high > -self.margin {
                let offsets = &self.offsets[g.offsets.start as usize..g.offsets.end as usize];
                let [down, over] = ends(offsets.iter().map(|d| up.dot(d)));
                (low, high) = (low + down, high + over);
            }
            if low > 0.0 {
                continue;
            }
            let facets = &self.facets[g.facets.start as usize..g.facets.end as usize];
            if high <= 0.0 {
                sum.volume += g.volume;
                sum.moment += g.moment;
                sum.area += g.area;
                sum.seen += match &g.flat {
                    Some(area) => area.dot(along).abs(),
                    None => facets.iter().map(|f| f.area.dot(along).abs()).sum(),
                };
                continue;
            }
            let at = |k: u16| self.points[k as usize];
            for f in facets {
                let [a, b, c] = f.corners;
                let h = [a, b, c].map(|k| up.dot(&at(k)) - level);
                let wet = h.map(|h| h <= 0.0);
                // The vertex alone on its side is first.
                let (p, h) = match wet {
                    [false, false, false] => continue,
                    [true, true, true] => {
                        sum.add(&[at(a), at(b), at(c)], f, along, 1.0);
                        continue;
                    }
                    [x, y, z] if x != y && x != z => ([at(a), at(b), at(c)], h),
                    [x, y, _] if x != y => ([at(b), at(c), at(a)], [h[1], h[2], h[0]]),
                    _ => ([at(c), at(a), at(b)], [h[2], h[0], h[1]]),
                };
                sum.cut(f, &p, &h, &foot, along);
            }
        }
        let (volume, moment) = self.whole;
        if sum.volume <= 0.0 {
            return Wet::default();
        }
        let arm = (sum.moment - moment * (sum.volume / volume)) / sum.volume;
        let seen = 0.5 * (sum.seen + sum.lid.dot(along).abs());
        Wet { volume: sum.volume, arm, area: sum.area, seen }
    }
}

fn ends(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    numbers.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], h| [low.min(h), high.max(h)])
}

#[derive(Default)]
struct Part {
    volume: f64,
    moment: Vec3,
    area: f64,
    seen: f64,
    /// Waterplane: normal times area.
    lid: Vec3,
}

impl Part {
    /// Adds a coplanar part of a facet.
    #[inline(always)]
    fn add(&mut self, corners: &[Vec3; 3], facet: &Facet, along: &Vec3, share: f64) {
        let [a, b, c] = corners;
        let volume = facet.volume * share;
        self.volume += volume;
        self.moment += (a + b + c) * (0.25 * volume);
        self.area += facet.size * share;
        self.seen += facet.area.dot(along).abs() * share;
    }

    /// Adds the part below the plane, and its waterplane as a fan about `foot`.
    #[inline(always)]
    fn cut(&mut self, facet: &Facet, p: &[Vec3; 3], h: &[f64; 3], foot: &Vec3, along: &Vec3) {
        let alone = h[0] <= 0.0;
        let [s, t] = [h[0] / (h[0] - h[1]), h[0] / (h[0] - h[2])];
        let (first, last) = (p[0] + (p[1] - p[0]) * s, p[0] + (p[2] - p[0]) * t);
        let tip = [p[0], first, last];
        // The waterplane is traversed against the triangle.
        let (before, after) = if alone {
            self.add(&tip, facet, along, s * t);
            (last, first)
        } else {
            self.add(p, facet, along, 1.0);
            self.add(&tip, facet, along, -s * t);
            (first, last)
        };
        let area = (before - foot).cross(&(after - foot)) * 0.5;
        let volume = foot.dot(&area) / 3.0;
        self.volume += volume;
        self.moment += (foot + before + after) * (0.25 * volume);
        self.lid += area;
    }
}

/// Directions between two normals in equal angles up to [`STRIP`].
fn strip(n: &Vec3, m: &Vec3) -> Vec<Vec3> {
    let angle = libm::atan2(n.cross(m).norm(), n.dot(m));
    let count = ((angle / STRIP).ceil() as usize).max(if angle > 0.035 { 2 } else { 1 });
    let step = angle / count as f64;
    let (sin, inner) = (libm::sin(step), (count - 2.min(count)) as f64);
    let longer =
        if inner == 0.0 { 0.5 * angle / sin } else { (-1.0 + (1.0 + inner * angle / sin).sqrt()) / inner };
    let side = (m - n * n.dot(m)).normalize();
    let at = |k: usize| {
        let way = n * libm::cos(step * k as f64) + side * libm::sin(step * k as f64);
        if k == 0 || k == count { way } else { way * longer }
    };
    (0..=count).map(at).collect()
}

#[cfg(test)]
#[path = "skin_tests.rs"]
mod tests;
