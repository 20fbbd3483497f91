//! Dilated polyhedron: convex core dilated by a sphere. The core of a disk is a flat disk (`disk.rs`).

mod body_shape;
#[doc(hidden)]
pub mod circle;
pub mod disk;
#[doc(hidden)]
pub mod edge_contact;
mod flat;
mod hull;
mod moments;
#[doc(hidden)]
pub mod part;
pub mod rim;
#[doc(hidden)]
pub mod scan;

use crate::base::Vec3;
use nalgebra::{Matrix3, UnitQuaternion};

/// Largest corner count of a core.
pub const CORNERS: usize = 64;

/// Invalid dilated polyhedron.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DilatedError {
    /// Non-finite coordinate or radius.
    #[error("a coordinate or the radius is not a finite number")]
    NotFinite,
    /// Invalid corner count.
    #[error("{0} corners; expected 4 to {CORNERS}")]
    Count(usize),
    /// Coplanar corners.
    #[error("the corners lie in one plane")]
    Flat,
    /// Corners too close to each other or to face planes.
    #[error(
        "corners lie too close to each other, or to the planes of faces, for faces that fit together; leave some out"
    )]
    Sliver,
    /// Corner not on the convex hull.
    #[error(
        "corner {0} is not a corner of the convex hull of all; the core must be convex, without points in faces or edges"
    )]
    NotConvex(usize),
    /// Radius not positive.
    #[error("radius {0} m; it must be positive")]
    Radius(f64),
}

/// Face of a core.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// Outward unit normal.
    pub normal: Vec3,
    /// Offset of the plane from the origin [m].
    pub offset: f64,
    /// Corners, counter-clockwise from outside.
    pub corners: Vec<u8>,
    /// In-plane outward unit normals of the sides, from corner k, and their offsets [m].
    pub sides: Vec<(Vec3, f64)>,
}

/// Edge of a core.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// Corner indices.
    pub ends: [u8; 2],
    /// Unit vector from first to second corner.
    pub direction: Vec3,
    /// Coordinates of the ends along it [m].
    pub levels: [f64; 2],
    /// Length [m].
    pub length: f64,
    /// Adjacent faces.
    pub faces: [u8; 2],
    /// Its side in each face, bitwise identical.
    pub sides: [(Vec3, f64); 2],
}

/// Convex polyhedron with topology.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Core {
    /// Corners [m].
    pub corners: Vec<Vec3>,
    /// Faces.
    pub faces: Vec<Face>,
    /// Edges.
    pub edges: Vec<Edge>,
    /// Edges of each corner, and the end.
    pub spokes: Vec<Vec<(u8, u8)>>,
    /// Bit sets of edges and faces of each corner.
    pub at: Vec<([u64; 3], [u64; 2])>,
    /// Bounding radius about the origin [m].
    pub reach: f64,
    /// Radius of a flat disk across axis 3, without corners, edges and faces [m].
    pub rim: Option<f64>,
}

fn bits<const N: usize>(words: [u64; N]) -> impl Iterator<Item = usize> {
    (0..N).flat_map(move |n| {
        let mut rest = words[n];
        std::iter::from_fn(move || {
            let bit = (rest != 0).then(|| rest.trailing_zeros() as usize)?;
            rest &= rest - 1;
            Some(64 * n + bit)
        })
    })
}

/// Dilated polyhedron in the principal frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Dilated {
    /// Core.
    pub core: Core,
    /// Dilation radius [m].
    pub radius: f64,
    /// Volume [m³].
    pub volume: f64,
    /// Surface area [m²].
    pub area: f64,
    /// Principal moments of inertia per unit density [m⁵], ascending.
    pub inertia: [f64; 3],
}

/// Volume integrals of a dilated polyhedron.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DilatedMoments {
    /// Volume [m³].
    pub volume: f64,
    /// Surface area [m²].
    pub area: f64,
    /// Centre of mass [m].
    pub centre: Vec3,
    /// Inertia tensor about the centre per unit density [m⁵].
    pub inertia: Matrix3<f64>,
}

/// Support point.
#[inline]
pub fn farthest<'a>(points: &'a [Vec3], n: &Vec3) -> &'a Vec3 {
    let mut best = (0, f64::NEG_INFINITY);
    for (k, p) in points.iter().enumerate() {
        let h = p.dot(n);
        if h > best.1 {
            best = (k, h);
        }
    }
    &points[best.0]
}

impl Core {
    /// Convex hull; every corner must lie on it.
    ///
    /// # Errors
    /// [`DilatedError`] unless the body is convex with volume.
    pub fn new(corners: &[Vec3]) -> Result<Core, DilatedError> {
        hull::core(corners)
    }

    /// Flat disk about axis 3; radius [m].
    pub fn disk(radius: f64) -> Core {
        Core { rim: Some(radius), reach: radius, ..Core::default() }
    }

    /// Maps every point x to `turn` (x − `from`).
    pub fn moved(&self, turn: &UnitQuaternion<f64>, from: &Vec3) -> Core {
        let face = |f: &Face| Face {
            normal: turn * f.normal,
            offset: f.offset - f.normal.dot(from),
            sides: f.sides.iter().map(|(side, level)| (turn * side, level - side.dot(from))).collect(),
            ..f.clone()
        };
        let corners = self.corners.iter().map(|x| turn * (x - from)).collect();
        hull::joined(corners, self.faces.iter().map(face).collect())
    }

    /// Corners of a bit set.
    pub fn corners_of(&self, set: u64) -> impl Iterator<Item = usize> {
        bits([self.there(set)])
    }

    fn there(&self, set: u64) -> u64 {
        set & u64::MAX.checked_shr(64 - self.corners.len() as u32).unwrap_or(0)
    }

    /// Bit sets of edges and faces with a corner in `set`.
    fn meeting(&self, set: u64) -> ([u64; 3], [u64; 2]) {
        let mut all = ([0; 3], [0; 2]);
        for corner in self.corners_of(set) {
            let (edges, faces) = &self.at[corner];
            (0..3).for_each(|n| all.0[n] |= edges[n]);
            (0..2).for_each(|n| all.1[n] |= faces[n]);
        }
        all
    }

    /// Edges with a corner in `set`.
    pub fn edges_of(&self, set: u64) -> impl Iterator<Item = usize> {
        bits(self.meeting(set).0)
    }

    /// Faces with a corner in `set`.
    pub fn faces_of(&self, set: u64) -> impl Iterator<Item = usize> {
        bits(self.meeting(set).1)
    }

    /// Support point [m].
    #[inline]
    pub fn farthest(&self, n: &Vec3) -> Vec3 {
        match self.rim {
            Some(radius) => disk::farthest(radius, n),
            None => *farthest(&self.corners, n),
        }
    }

    /// Half lengths of the bounding box about the origin [m].
    pub fn half_extents(&self) -> Vec3 {
        let round = self.rim.map_or(Vec3::zeros(), |r| Vec3::new(r, r, 0.0));
        self.corners.iter().fold(round, |most, c| most.sup(&c.abs()))
    }

    /// Largest face circumference [m].
    pub fn circumference(&self) -> f64 {
        if let Some(radius) = self.rim {
            return std::f64::consts::TAU * radius;
        }
        let around = |f: &Face| -> f64 {
            let ends = f.corners.iter().zip(f.corners.iter().cycle().skip(1));
            ends.map(|(a, b)| (self.corners[*a as usize] - self.corners[*b as usize]).norm()).sum()
        };
        self.faces.iter().map(around).fold(0.0, f64::max)
    }

    /// Longest edge or rim arc of one contact [m].
    pub fn longest_edge(&self) -> f64 {
        match self.rim {
            Some(radius) => std::f64::consts::TAU * radius / disk::ARCS as f64,
            None => self.edges.iter().map(|e| e.length).fold(0.0, f64::max),
        }
    }
}

impl Dilated {
    /// Dilates the convex hull of `corners` [m]; also returns centre [m] and rotation of its frame.
    ///
    /// # Errors
    /// [`DilatedError`] unless the core is convex with volume and the radius [m] positive.
    pub fn new(corners: &[Vec3], radius: f64) -> Result<(Dilated, Vec3, UnitQuaternion<f64>), DilatedError> {
        if !radius.is_finite() {
            return Err(DilatedError::NotFinite);
        }
        if radius <= 0.0 {
            return Err(DilatedError::Radius(radius));
        }
        let core = Core::new(corners)?;
        let m = moments::moments(&core, radius);
        let (inertia, axes) = super::clump::principal(m.inertia);
        let turn = UnitQuaternion::from_matrix(&axes);
        let core = core.moved(&turn.inverse(), &m.centre);
        Ok((Dilated { core, radius, volume: m.volume, area: m.area, inertia }, m.centre, turn))
    }

    /// Dilated disk of diameter 2 (`radius` + `rounding`) and thickness 2 `rounding` [m].
    ///
    /// # Errors
    /// [`DilatedError`] unless both radii are positive and finite.
    pub fn disk(radius: f64, rounding: f64) -> Result<Dilated, DilatedError> {
        if !(radius.is_finite() && rounding.is_finite()) {
            return Err(DilatedError::NotFinite);
        }
        if let Some(x) = [radius, rounding].into_iter().find(|x| *x <= 0.0) {
            return Err(DilatedError::Radius(x));
        }
        let [volume, area, other, axial] = disk::moments(radius, rounding);
        Ok(Dilated {
            core: Core::disk(radius),
            radius: rounding,
            volume,
            area,
            inertia: [other, other, axial],
        })
    }

    /// Moments in the core's input frame.
    pub fn moments_of(core: &Core, radius: f64) -> DilatedMoments {
        moments::moments(core, radius)
    }

    /// Half lengths of the bounding box about the origin [m].
    pub fn half_extents(&self) -> Vec3 {
        self.core.half_extents().add_scalar(self.radius)
    }

    /// Bounding box along the body axes [m].
    pub fn extents(&self) -> [f64; 3] {
        if self.core.rim.is_some() {
            return (self.half_extents() * 2.0).into();
        }
        std::array::from_fn(|d| {
            let x = self.core.corners.iter().map(|c| c[d]);
            let [low, high] = x.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
            high - low + 2.0 * self.radius
        })
    }

    /// Chamfered surface for rendering: points [m] on the true surface, polygons counter-clockwise from
    /// outside.
    pub fn outline(&self) -> (Vec<Vec3>, Vec<Vec<u32>>) {
        let core = &self.core;
        if let Some(big) = core.rim {
            return disk::outline(big, self.radius);
        }
        let (mut points, mut polygons) = (Vec::new(), Vec::new());
        // One point per corner and face.
        let mut first = Vec::new();
        for face in &core.faces {
            first.push(points.len() as u32);
            points.extend(face.corners.iter().map(|c| core.corners[*c as usize] + face.normal * self.radius));
            polygons.push((first[first.len() - 1]..points.len() as u32).collect());
        }
        let at = |face: usize, corner: u8| {
            let place = core.faces[face].corners.iter().position(|c| *c == corner);
            first[face] + place.unwrap_or(0) as u32
        };
        for edge in &core.edges {
            let ([f, g], [a, b]) = (edge.faces.map(usize::from), edge.ends);
            polygons.push(vec![at(f, b), at(f, a), at(g, a), at(g, b)]);
        }
        for (corner, spokes) in core.spokes.iter().enumerate() {
            // Sorted by angle about the mean normal.
            let faces: Vec<usize> =
                (0..core.faces.len()).filter(|f| core.faces[*f].corners.contains(&(corner as u8))).collect();
            let axis = faces.iter().map(|f| core.faces[*f].normal).sum::<Vec3>().normalize();
            let x = axis.cross(&core.edges[spokes[0].0 as usize].direction).normalize();
            let y = axis.cross(&x);
            let angle = |f: &usize| {
                let n = core.faces[*f].normal;
                libm::atan2(n.dot(&y), n.dot(&x))
            };
            let mut around = faces;
            around.sort_by(|f, g| angle(f).total_cmp(&angle(g)));
            polygons.push(around.iter().map(|f| at(*f, corner as u8)).collect());
        }
        (points, polygons)
    }

    /// Square sieve size [m]: intermediate extent.
    pub fn sieve_size(&self) -> f64 {
        let mut extents = self.extents();
        extents.sort_by(f64::total_cmp);
        extents[1]
    }

    /// Bounding radius about the centre [m].
    pub fn bounding_radius(&self) -> f64 {
        self.core.reach + self.radius
    }
}

#[cfg(test)]
mod tables;
#[cfg(test)]
#[path = "dilated/dilated_tests.rs"]
mod tests;
