//! Grains of a frame: spheres and their bodies.

use std::path::Path;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::failure::Failure;
use crate::read::vtk_arrays::Arrays;

/// Rounding tolerance of rigid bodies over their size.
const RIGID: f64 = 1e-7;

const GEOMETRY: [&str; 3] = ["radius", "orientation", "id"];

/// Bodies of a frame: consecutive spheres of equal id.
#[derive(Clone, Debug, PartialEq)]
pub struct Bodies {
    /// Body ids.
    pub id: Vec<u32>,
    /// First sphere of each body, then the total number of spheres.
    pub start: Vec<u32>,
    /// Sphere radius [m].
    pub radius: Vec<f64>,
    /// Position relative to the first sphere of the body, in body axes [m].
    pub offset: Vec<Vector3<f64>>,
}

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

/// Grain file.
pub struct GrainFile {
    arrays: Arrays,
    spheres: Spheres,
    /// Bodies.
    pub bodies: Bodies,
}

impl GrainFile {
    /// Reads positions, radii and ids.
    ///
    /// # Errors
    /// Not a grain file.
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

    /// Returns the colour fields; vectors count by magnitude.
    pub fn fields(&self) -> Vec<String> {
        let names = self.arrays.names("PointData").filter(|(name, _)| !GEOMETRY.contains(name));
        names.map(|(name, _)| if name == "velocity" { "speed".into() } else { name.to_string() }).collect()
    }

    /// Returns a value per body: magnitude of vectors, mean over spheres.
    ///
    /// # Errors
    /// Unknown or damaged field.
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
                // Equal values: no rounding.
                1 if values[first] == values[of[1] as usize - 1] => values[first],
                1 => mean(0),
                _ => (0..components).map(|c| mean(c).powi(2)).sum::<f64>().sqrt(),
            }
        });
        Ok(means.collect())
    }

    /// Returns the sphere centres, three coordinates each [m].
    pub fn centres(&self) -> &[f64] {
        &self.spheres.position
    }

    /// Returns the orientation of a sphere's body.
    pub fn turn(&self, sphere: usize) -> UnitQuaternion<f64> {
        self.spheres.turn(sphere)
    }

    /// Returns the bounding box of all spheres [m]; `None` without spheres.
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

    /// Whether the bodies equal `known` up to rigid motion.
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

    /// Returns the longest extent of each body [m].
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
