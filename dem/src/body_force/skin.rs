//! The surface of a shape as triangles, and what of it is below a plane.
//!
//! Faces of a dilated polyhedron are as they are; an edge is divided into strips of at most 30°, whose corners are moved out so
//! that the volume of the edge is right, and each corner into a fan whose middle is moved out until its volume is right. What is
//! under water of it is cut exactly; faces, edges and corners that are wholly above or below are not looked into. Dilated disks have no
//! triangles: slices of them are cut in closed form (`disk.rs`).

use super::disk;
use crate::base::Vec3;
use crate::shape::Shape;
use crate::shape::dilated::Core;
use std::collections::HashMap;
use std::ops::Range;

/// Largest angle of a strip of an edge [rad].
const STRIP: f64 = 0.525;

/// A triangle.
#[derive(Clone, Copy, Debug)]
struct Facet {
    corners: [u16; 3],
    /// Outward normal, as long as the area [m²], and that area.
    area: Vec3,
    size: f64,
    /// Volume of the tetrahedron between it and the origin [m³].
    volume: f64,
}

/// The triangles of a face, an edge or a corner.
#[derive(Clone, Debug)]
struct Group {
    /// Corners of the core that it belongs to, and how far its points are from them: ranges of `owners` and `offsets`.
    owners: Range<u32>,
    offsets: Range<u32>,
    facets: Range<u32>,
    /// What its triangles add up to: tetrahedra and areas.
    volume: f64,
    moment: Vec3,
    area: f64,
    /// The sum of the normals where all lie in one plane.
    flat: Option<Vec3>,
}

/// The surface of a shape, in its own frame; empty of shapes made of spheres.
#[derive(Clone, Debug, Default)]
pub(crate) struct Skin {
    /// Corners of the core, and of triangles.
    core: Vec<Vec3>,
    points: Vec<Vec3>,
    facets: Vec<Facet>,
    groups: Vec<Group>,
    owners: Vec<u8>,
    offsets: Vec<Vec3>,
    /// Largest distance of a point from its corner of the core [m].
    margin: f64,
    /// First moment of the whole, which a finer surface would not have [m⁴], and its volume [m³].
    whole: (f64, Vec3),
    /// Mean distance of the corners from the centre [m].
    pub reach: f64,
    /// Radii of a dilated disk, which has no triangles [m].
    disk: Option<[f64; 2]>,
}

/// What of a body is under water.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Wet {
    /// Volume [m³].
    pub volume: f64,
    /// From the body's centre to that of the volume, world axes [m].
    pub arm: Vec3,
    /// Area of its surface, the plane of the water excepted [m²].
    pub area: f64,
    /// Half of the sum of the areas of its surface, the plane of the water included, each as seen along a direction [m²].
    pub seen: f64,
}

impl Skin {
    /// The surface of a shape.
    pub fn of(shape: &Shape) -> Skin {
        match shape {
            Shape::Sphere { .. } | Shape::Clump(_) => Skin::default(),
            Shape::Box { .. } => Skin::new(&shape.core(), 0.0),
            Shape::Polyhedron(it) => Skin::new(&it.core, it.radius),
        }
    }

    /// The surface of a core dilated by a radius [m].
    pub fn new(core: &Core, radius: f64) -> Skin {
        if let Some(rim) = core.rim {
            return Skin { disk: Some([rim, radius]), reach: rim + radius, ..Skin::default() };
        }
        let mut skin = Skin { core: core.corners.clone(), margin: radius, ..Skin::default() };
        // Corners of the faces, moved out.
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

    /// Strips of the edges and fans of the corners.
    fn rounded(&mut self, core: &Core, radius: f64, places: &HashMap<(u8, u8), u16>) {
        // Arcs around each corner: directions and points along them.
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
                // Pairs of neighbours: a fan needs no order of the arcs around it.
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
                // Solid angle of the three directions (Van Oosterom & Strackee 1983).
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

    /// Adds a triangle, so that the origin, which lies within, is behind it.
    fn facet(&mut self, corners: [u16; 3]) {
        let [a, b, c] = corners.map(|k| self.points[k as usize]);
        let area = (b - a).cross(&(c - a)) * 0.5;
        let volume = a.dot(&area) / 3.0;
        let (corners, area) =
            if volume < 0.0 { ([corners[0], corners[2], corners[1]], -area) } else { (corners, area) };
        self.facets.push(Facet { corners, area, size: area.norm(), volume: volume.abs() });
    }

    /// Makes the triangles that are in no group yet one, of a face, an edge or a corner with these corners of the core
    /// and points at `offsets` from them.
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

    /// What lies below the plane that is normal to the unit vector `up` at `level` [m] along it, all in the frame of the shape; its
    /// areas as seen along the unit vector `along`. `heights` is scratch.
    pub fn below(&self, up: &Vec3, level: f64, along: &Vec3, heights: &mut Vec<f64>) -> Wet {
        if let Some(radii) = self.disk {
            return disk::below(radii, up, level, along);
        }
        heights.clear();
        heights.extend(self.core.iter().map(|p| up.dot(p) - level));
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
                // The corner that is alone on its side comes first.
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

/// The smallest and the largest of some numbers.
fn ends(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    numbers.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], h| [low.min(h), high.max(h)])
}

/// Sums over tetrahedra between the origin and triangles.
#[derive(Default)]
struct Part {
    volume: f64,
    moment: Vec3,
    area: f64,
    seen: f64,
    /// The plane of the water, as its normal times its area.
    lid: Vec3,
}

impl Part {
    /// Adds a triangle in the plane of a facet that has a `share` of its area.
    #[inline(always)]
    fn add(&mut self, corners: &[Vec3; 3], facet: &Facet, along: &Vec3, share: f64) {
        let [a, b, c] = corners;
        let volume = facet.volume * share;
        self.volume += volume;
        self.moment += (a + b + c) * (0.25 * volume);
        self.area += facet.size * share;
        self.seen += facet.area.dot(along).abs() * share;
    }

    /// Adds what of a triangle, whose corners have heights `h` above a plane, is below it, and its share of the lid: a fan about
    /// `foot`, a point of the plane. Its first corner is alone on its side.
    #[inline(always)]
    fn cut(&mut self, facet: &Facet, p: &[Vec3; 3], h: &[f64; 3], foot: &Vec3, along: &Vec3) {
        let alone = h[0] <= 0.0;
        let [s, t] = [h[0] / (h[0] - h[1]), h[0] / (h[0] - h[2])];
        let (first, last) = (p[0] + (p[1] - p[0]) * s, p[0] + (p[2] - p[0]) * t);
        let tip = [p[0], first, last];
        // The lid is run through against the sense of the triangle.
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

/// Directions from one unit normal to another in equal angles of at most [`STRIP`]; those in between are longer than 1, so that the
/// triangles between neighbours have together the area of the sector.
fn strip(n: &Vec3, m: &Vec3) -> Vec<Vec3> {
    let angle = libm::atan2(n.cross(m).norm(), n.dot(m));
    let count = ((angle / STRIP).ceil() as usize).max(if angle > 0.035 { 2 } else { 1 });
    let step = angle / count as f64;
    let (sin, inner) = (libm::sin(step), (count - 2.min(count)) as f64);
    // longer sin + inner/2 longer² sin = angle/2: two triangles have one such side, the others two.
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
