//! Grains of a frame: spheres, and the bodies that they make up.

use std::path::Path;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::failure::Failure;
use crate::read::vtk_arrays::Arrays;

/// How far a sphere of a rigid body may be from its place, as a share of the size of the body: rounding.
const RIGID: f64 = 1e-7;

/// Arrays that are no fields to colour by.
const GEOMETRY: [&str; 3] = ["radius", "orientation", "id"];

/// The bodies of a frame: neighbouring spheres of one number.
#[derive(Clone, Debug, PartialEq)]
pub struct Bodies {
    /// Number of each body.
    pub id: Vec<u32>,
    /// First sphere of each body, and the number of all spheres.
    pub start: Vec<u32>,
    /// Radius of each sphere [m].
    pub radius: Vec<f64>,
    /// Place of each sphere seen from the first of its body, in the axes of the body [m].
    pub offset: Vec<Vector3<f64>>,
}

/// Spheres of a frame as the file has them.
struct Spheres {
    position: Vec<f64>,
    orientation: Vec<f64>,
}

impl Spheres {
    fn place(&self, sphere: usize) -> Vector3<f64> {
        Vector3::from_column_slice(&self.position[3 * sphere..3 * sphere + 3])
    }

    fn turn(&self, sphere: usize) -> UnitQuaternion<f64> {
        match self.orientation.get(4 * sphere..4 * sphere + 4) {
            Some(q) => UnitQuaternion::new_normalize(Quaternion::new(q[0], q[1], q[2], q[3])),
            None => UnitQuaternion::identity(),
        }
    }
}

/// A file of grains.
pub struct GrainFile {
    arrays: Arrays,
    spheres: Spheres,
    /// Its bodies.
    pub bodies: Bodies,
}

impl GrainFile {
    /// Reads places, radii and numbers.
    ///
    /// # Errors
    /// The file is not one of grains.
    pub fn open(file: &Path) -> Result<GrainFile, Failure> {
        let arrays = Arrays::open(file, "PolyData")?;
        let position = arrays.values("Points", "Points")?;
        let radius = arrays.values("PointData", "radius")?;
        let given = arrays.components("PointData", "orientation") == Some(4);
        let orientation = if given { arrays.values("PointData", "orientation")? } else { Vec::new() };
        let id = match arrays.components("PointData", "id") {
            Some(1) => arrays.indices("PointData", "id")?,
            _ => (0..arrays.points as u32).collect(),
        };
        let spheres = Spheres { position, orientation };
        let (mut ids, mut start, mut offset) = (Vec::new(), Vec::new(), Vec::with_capacity(radius.len()));
        for (s, number) in id.iter().enumerate() {
            if ids.last() != Some(number) {
                ids.push(*number);
                start.push(s as u32);
            }
            let first = start.last().map_or(s, |f| *f as usize);
            let from_first = spheres.place(s) - spheres.place(first);
            offset.push(if s == first { from_first } else { spheres.turn(s).inverse() * from_first });
        }
        start.push(id.len() as u32);
        Ok(GrainFile { arrays, spheres, bodies: Bodies { id: ids, start, radius, offset } })
    }

    /// Names of the fields that bodies can be coloured by; vectors by their length.
    pub fn fields(&self) -> Vec<String> {
        let names = self.arrays.names("PointData").filter(|(name, _)| !GEOMETRY.contains(name));
        names.map(|(name, _)| if name == "velocity" { "speed".into() } else { name.to_string() }).collect()
    }

    /// One number per body: of a vector its length, for several spheres that of the mean.
    ///
    /// # Errors
    /// There is no such field, or it is damaged.
    pub fn field(&self, name: &str) -> Result<Vec<f64>, Failure> {
        let stored = if name == "speed" { "velocity" } else { name };
        let components = self.arrays.components("PointData", stored).unwrap_or(1);
        let values = self.arrays.values("PointData", stored)?;
        let means = self.bodies.start.windows(2).map(|of| {
            let (first, count) = (of[0] as usize, f64::from(of[1] - of[0]));
            let mean = |c: usize| {
                let sum: f64 = (of[0] as usize..of[1] as usize).map(|s| values[components * s + c]).sum();
                sum / count
            };
            match components {
                // The same for all spheres of a body: no rounding.
                1 if values[first] == values[of[1] as usize - 1] => values[first],
                1 => mean(0),
                _ => (0..components).map(|c| mean(c).powi(2)).sum::<f64>().sqrt(),
            }
        });
        Ok(means.collect())
    }

    /// Centres of all spheres, three numbers each [m].
    pub fn centres(&self) -> &[f64] {
        &self.spheres.position
    }

    /// Orientation of the body that a sphere belongs to.
    pub fn turn(&self, sphere: usize) -> UnitQuaternion<f64> {
        self.spheres.turn(sphere)
    }

    /// Corners of the box around all spheres [m]; `None` without any.
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for (x, r) in self.spheres.position.chunks_exact(3).zip(&self.bodies.radius) {
            for k in 0..3 {
                bounds[0][k] = bounds[0][k].min(x[k] - r);
                bounds[1][k] = bounds[1][k].max(x[k] + r);
            }
        }
        (!self.bodies.radius.is_empty()).then_some(bounds)
    }

    /// Whether the bodies are those of `known`, moved and turned.
    pub fn are(&self, known: &Bodies) -> bool {
        let own = &self.bodies;
        own.id == known.id
            && own.start == known.start
            && own.radius == known.radius
            && own.start.windows(2).all(|of| {
                let all = of[0] as usize..of[1] as usize;
                let size = all.clone().map(|s| known.offset[s].norm() + known.radius[s]).fold(0.0, f64::max);
                all.into_iter().all(|s| (own.offset[s] - known.offset[s]).norm() <= RIGID * size)
            })
    }
}

impl Bodies {
    /// Whether a body has several spheres.
    pub fn clumps(&self) -> bool {
        self.radius.len() > self.id.len()
    }

    /// Longest extent of each body [m].
    pub fn extents(&self) -> Vec<f64> {
        let extent = |of: &[u32]| {
            let all = || of[0] as usize..of[1] as usize;
            let pairs = all().flat_map(|i| all().skip_while(move |j| *j < i).map(move |j| (i, j)));
            let far = |(i, j): (usize, usize)| {
                (self.offset[i] - self.offset[j]).norm() + self.radius[i] + self.radius[j]
            };
            pairs.map(far).fold(0.0, f64::max)
        };
        self.start.windows(2).map(extent).collect()
    }
}
