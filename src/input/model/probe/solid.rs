//! `[[probe]]` of points, areas and boxes of the solid, in its undeformed position.

use crate::model::solid::{Locator, SolidPart, find_node};
use crate::scene::units::vector;
use crate::scene::{Probe, ProbeField, SceneError, Table};
use trackbed_fem::mesh::Mesh;
use trackbed_fem::samples::{BoxPoints, Samples};

/// Sampling points of a rectangle per side.
const PER_SIDE: usize = 16;
/// Default points of a line.
const POINTS: u32 = 11;
/// Tolerance of natural coordinates, for points on the surface.
const SLACK: f64 = 1e-6;
/// Distance within which a point is a node, over the length of the diagonal of the solid.
const AT_NODE: f64 = 1e-9;

/// Points of the solid with their fields.
#[derive(Clone, Debug)]
pub struct PointProbe {
    /// The points.
    pub samples: Samples,
    /// Fields of the table.
    fields: Vec<ProbeField>,
}

impl PointProbe {
    /// Whether it has the columns of `field`.
    pub fn has(&self, field: ProbeField) -> bool {
        self.fields.contains(&field)
    }

    /// Returns the names of the points of probe `name`: numbered from 1, or that of a single point.
    pub fn names(&self, name: &str) -> Vec<String> {
        match self.samples.count() {
            1 => vec![name.to_string()],
            count => (1..=count).map(|k| format!("{name}_{k}")).collect(),
        }
    }
}

/// Resolves `node` or `at` with `fields`: name and point.
pub(super) fn point(
    table: &Table<Probe>,
    solid: &SolidPart,
    fields: &[ProbeField],
) -> Result<(String, PointProbe), SceneError> {
    if fields.is_empty() {
        return Err(table.error("fields", "an empty list", "one field or more"));
    }
    let mesh = solid.model.mesh();
    let (name, weights) = match (table.node, table.at) {
        (Some(id), _) => (format!("n{id}"), vec![(find_node(table, mesh, id)? as u32, 1.0)]),
        (None, at) => {
            let at = at.map_or([0.0; 3], |at| vector(&at));
            let weights = Places::new(solid).weights(at);
            ("point".into(), weights.ok_or_else(|| outside(table, "at", solid, at))?)
        }
    };
    let samples = Samples::new(mesh, &[weights]);
    Ok((name, PointProbe { samples, fields: fields.to_vec() }))
}

/// Resolves `line`: equally spaced points.
pub(super) fn line(table: &Table<Probe>, solid: &SolidPart) -> Result<PointProbe, SceneError> {
    let ends = table.need("line", table.line, "the ends of a line")?;
    let [from, to] = ends.map(|end| vector(&end));
    if from == to {
        return Err(table.error("line", format!("{from:?} twice"), "two points"));
    }
    let count = table.points.unwrap_or(POINTS);
    table.check("points", count, |n| (2.0..=1000.0).contains(&n), "2 to 1000")?;
    let places = Places::new(solid);
    let at = |k: u32| [0, 1, 2].map(|d| from[d] + (to[d] - from[d]) * f64::from(k) / f64::from(count - 1));
    let weights = |k: u32| places.weights(at(k)).ok_or_else(|| outside(table, "line", solid, at(k)));
    let points: Vec<_> = (0..count).map(weights).collect::<Result<_, _>>()?;
    let fields = match &table.fields {
        Some(fields) if fields.is_empty() => {
            return Err(table.error("fields", "an empty list", "one field or more"));
        }
        Some(fields) => fields.clone(),
        None => vec![ProbeField::Displacement, ProbeField::Velocity],
    };
    Ok(PointProbe { samples: Samples::new(solid.model.mesh(), &points), fields })
}

/// Resolves `plane`: midpoints of a grid.
pub(super) fn plane(table: &Table<Probe>, solid: &SolidPart) -> Result<Samples, SceneError> {
    let corners = table.need("plane", table.plane, "the corners of a rectangle")?;
    let [low, high] = corners.map(|corner| vector(&corner));
    if !(low[0] < high[0] && low[1] < high[1] && low[2] == high[2]) {
        let expected = "the lower corner, then the upper, at one height";
        return Err(table.error("plane", format!("{low:?} and {high:?}"), expected));
    }
    let places = Places::new(solid);
    let along = |d: usize, k: usize| low[d] + (high[d] - low[d]) * (k as f64 + 0.5) / PER_SIDE as f64;
    let mut points = Vec::with_capacity(PER_SIDE * PER_SIDE);
    for i in 0..PER_SIDE {
        for j in 0..PER_SIDE {
            let point = [along(0, i), along(1, j), low[2]];
            points.push(places.weights(point).ok_or_else(|| outside(table, "plane", solid, point))?);
        }
    }
    Ok(Samples::new(solid.model.mesh(), &points))
}

/// Resolves `box`.
pub(super) fn volume(table: &Table<Probe>, solid: &SolidPart) -> Result<BoxPoints, SceneError> {
    let corners = table.need("box", table.solid_box, "the corners of a box")?;
    let region = crate::model::grains::region(table, "box", &corners)?;
    let points = BoxPoints::new(&solid.model, 0..ground(solid).1, region.low.into(), region.high.into());
    points.ok_or_else(|| {
        table.error("box", "no integration point in it", "a box of the size of elements or more")
    })
}

fn outside(table: &Table<Probe>, key: &str, solid: &SolidPart, point: [f64; 3]) -> SceneError {
    let nodes = &solid.model.mesh().coordinates[..ground(solid).0];
    let end = |d: usize, of: fn(f64, f64) -> f64, start: f64| nodes.iter().map(|x| x[d]).fold(start, of);
    let low = [0, 1, 2].map(|d| end(d, f64::min, f64::INFINITY));
    let high = [0, 1, 2].map(|d| end(d, f64::max, f64::NEG_INFINITY));
    let found = format!("({}, {}, {})", point[0], point[1], point[2]);
    table.error(key, found, format!("a point of the solid, which lies between {low:?} and {high:?}"))
}

/// Numbers of nodes and elements without sleepers, which move when they are set down.
fn ground(solid: &SolidPart) -> (usize, usize) {
    let mesh = solid.model.mesh();
    let whole = (mesh.node_count(), mesh.element_count());
    solid.sleepers.as_ref().map_or(whole, |s| (s.ground_nodes(), s.ground_elements()))
}

/// Points by nodes and weights.
struct Places<'a> {
    mesh: &'a Mesh,
    nodes: usize,
    /// Largest distance to a node [m].
    near: f64,
    locator: Locator<'a>,
}

impl<'a> Places<'a> {
    fn new(solid: &'a SolidPart) -> Places<'a> {
        let mesh = solid.model.mesh();
        let (nodes, elements) = ground(solid);
        let (low, high) = mesh.bounding_box();
        let diagonal = (0..3).map(|d| (high[d] - low[d]).powi(2)).sum::<f64>().sqrt();
        Places { mesh, nodes, near: AT_NODE * diagonal, locator: Locator::new(mesh, elements) }
    }

    /// Nodes and weights of a point [m]; `None` outside the solid.
    fn weights(&self, point: [f64; 3]) -> Option<Vec<(u32, f64)>> {
        let at_point = |x: &[f64; 3]| (0..3).all(|d| (x[d] - point[d]).abs() <= self.near);
        if let Some(node) = self.mesh.coordinates[..self.nodes].iter().position(at_point) {
            return Some(vec![(node as u32, 1.0)]);
        }
        let (element, xi) = self.locator.find(point, SLACK)?;
        let shape = self.mesh.connectivity.kind(element).shape_functions(xi);
        Some(self.mesh.connectivity[element].iter().copied().zip(shape).collect())
    }
}
