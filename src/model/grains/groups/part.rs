//! What the groups of a scene come to: shapes, grains, and what is done with them.

use crate::model::tables::Grading;
use trackbed_dem::insert::container::Container;
use trackbed_dem::insert::grow::Growth;
use trackbed_dem::shape::Shape;
use trackbed_dem::{BodyInput, Vec3};

/// The groups of a scene, and all grains where they start.
#[derive(Clone, Default)]
pub struct GroupsPart {
    /// Names of the groups; rigid sleepers are the group after the last.
    pub names: Vec<String>,
    /// Shapes, at scale 1.
    pub shapes: Vec<Shape>,
    /// First shape of each group; a stone's number in its library is its shape less that.
    pub first_shape: Vec<usize>,
    /// All grains where they start.
    pub bodies: Vec<BodyInput>,
    /// Groups whose sizes follow a sieve curve.
    pub graded: Vec<GradedGroup>,
    /// Groups that grow to their size before anything else.
    pub growths: Vec<GrowthPlan>,
    /// Groups of prescribed motion.
    pub moving: Vec<Moving>,
    /// Groups that foul the bed.
    pub fouling: Vec<u32>,
    /// Groups whose grains may overlap at the start.
    pub overlapping: Vec<u32>,
    /// Groups whose mean place and force are recorded.
    pub recorded: Vec<u32>,
    /// What the summary should say about them.
    pub remarks: Vec<String>,
}

impl GroupsPart {
    /// Radius about its centre of mass that holds a body [m].
    pub fn reach(&self, body: &BodyInput) -> f64 {
        body.scale * bounding_radius(&self.shapes[body.shape])
    }

    /// Mean bounding radius of the grains [m].
    pub fn mean_reach(&self) -> f64 {
        self.bodies.iter().map(|b| self.reach(b)).sum::<f64>() / self.bodies.len().max(1) as f64
    }

    /// Whether any shape is a polyhedron.
    pub fn polyhedra(&self) -> bool {
        self.shapes.iter().any(|s| matches!(s, Shape::Polyhedron(_)))
    }

    /// Adds a shape; returns its number.
    pub fn add_shape(&mut self, shape: Shape) -> usize {
        self.shapes.push(shape);
        self.shapes.len() - 1
    }
}

/// A group of prescribed motion.
#[derive(Clone, Copy, Debug)]
pub struct Moving {
    /// Its number.
    pub part: u32,
    /// Velocity [m/s].
    pub velocity: Vec3,
}

/// A group whose sizes follow a sieve curve.
#[derive(Clone)]
pub struct GradedGroup {
    /// Its number.
    pub part: u32,
    /// Its name.
    pub name: String,
    /// Limits and curve.
    pub grading: Grading,
}

/// Grains that grow to their size in a container.
#[derive(Clone)]
pub struct GrowthPlan {
    /// Name of the group.
    pub group: String,
    /// Bodies that grow.
    pub bodies: std::ops::Range<usize>,
    /// Where.
    pub container: Container,
    /// How.
    pub how: Growth,
}

/// Radius about the centre of mass that holds a grain of scale 1 [m].
pub(super) fn bounding_radius(shape: &Shape) -> f64 {
    match shape {
        Shape::Sphere { radius } => *radius,
        Shape::Clump(clump) => clump.bounding_radius(),
        Shape::Box { half } => half.iter().map(|h| h * h).sum::<f64>().sqrt(),
        Shape::Polyhedron(it) => it.bounding_radius(),
    }
}
