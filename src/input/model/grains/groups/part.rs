//! Resolved groups: shapes, grains, and their treatment.

use super::net_group::NetGroup;
use crate::model::tables::Grading;
use trackbed_dem::insert::container::Container;
use trackbed_dem::insert::radius_expansion::Growth;
use trackbed_dem::shape::Shape;
use trackbed_dem::{BodyInput, Vec3};

/// Groups with all grains in initial position.
#[derive(Clone, Default)]
pub struct GroupsPart {
    /// Group names; rigid sleepers come last.
    pub names: Vec<String>,
    /// Shapes, at scale 1.
    pub shapes: Vec<Shape>,
    /// First shape of each group; library indices are relative to it.
    pub first_shape: Vec<usize>,
    /// All grains in their initial positions.
    pub bodies: Vec<BodyInput>,
    /// Groups with a sieve curve.
    pub graded: Vec<GradedGroup>,
    /// Groups stacked in a box, with their expected bed.
    pub filled: Vec<FilledGroup>,
    /// Groups with radius expansion.
    pub growths: Vec<GrowthPlan>,
    /// Groups with prescribed motion.
    pub moving: Vec<Moving>,
    /// Fouling groups.
    pub fouling: Vec<u32>,
    /// Groups with accepted initial overlap.
    pub overlapping: Vec<u32>,
    /// Groups with recorded mean position and force.
    pub recorded: Vec<u32>,
    /// Nets, group by group.
    pub nets: Vec<NetGroup>,
    /// Warnings for the summary.
    pub remarks: Vec<String>,
}

impl GroupsPart {
    /// Returns the bounding radius about the centre of mass [m].
    pub fn reach(&self, body: &BodyInput) -> f64 {
        body.scale * self.shapes[body.shape].query(|s| s.bounding_radius())
    }

    /// Returns the mean bounding radius of the grains [m].
    pub fn mean_reach(&self) -> f64 {
        self.bodies.iter().map(|b| self.reach(b)).sum::<f64>() / self.bodies.len().max(1) as f64
    }

    /// Whether any shape is a polyhedron.
    pub fn polyhedra(&self) -> bool {
        self.shapes.iter().any(|s| matches!(s, Shape::Polyhedron(_)))
    }

    /// Adds a shape; returns its index.
    pub fn add_shape(&mut self, shape: Shape) -> usize {
        self.shapes.push(shape);
        self.shapes.len() - 1
    }
}

/// Group with prescribed motion.
#[derive(Clone, Copy, Debug)]
pub struct Moving {
    /// Group index.
    pub part: u32,
    /// Velocity [m/s].
    pub velocity: Vec3,
}

/// Group with a sieve curve.
#[derive(Clone)]
pub struct GradedGroup {
    /// Group index.
    pub part: u32,
    /// Group name.
    pub name: String,
    /// Limits and curve.
    pub grading: Grading,
}

/// Group stacked in a box, and the bed expected of it.
#[derive(Clone, Debug)]
pub struct FilledGroup {
    /// Group index.
    pub part: u32,
    /// Group name.
    pub name: String,
    /// Number of grains.
    pub count: usize,
    /// Total mass [kg].
    pub mass: f64,
    /// Corners of the plan [m].
    pub plan: [[f64; 2]; 2],
    /// Height of the floor [m].
    pub floor: f64,
    /// Target height above the floor [m].
    pub target: Option<f64>,
    /// Diameter of a sphere of the mean volume [m].
    pub size: f64,
    /// Expected porosity.
    pub porosity: f64,
    /// Expected height above the floor [m].
    pub height: f64,
}

impl FilledGroup {
    /// Formats the expected bed for `check`.
    pub fn line(&self) -> String {
        format!(
            "{}: {} grains, {:.4} kg, expected bed height {:.4} m above z = {} m (porosity {:.3})",
            self.name, self.count, self.mass, self.height, self.floor, self.porosity
        )
    }
}

/// Radius expansion of grains in a container.
#[derive(Clone)]
pub struct GrowthPlan {
    /// Group name.
    pub group: String,
    /// Growing bodies.
    pub bodies: std::ops::Range<usize>,
    /// Container.
    pub container: Container,
    /// Growth parameters.
    pub how: Growth,
}
