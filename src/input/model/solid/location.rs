//! Elements that contain points.

use trackbed_coupling::inverse_map;
use trackbed_fem::mesh::Mesh;

/// Finds the element of a point.
pub struct Locator<'a> {
    mesh: &'a Mesh,
    /// Corners per element, with a margin for curved faces [m].
    boxes: Vec<[[f64; 3]; 2]>,
}

impl<'a> Locator<'a> {
    /// Creates a locator in the first `elements` elements.
    pub fn new(mesh: &'a Mesh, elements: usize) -> Locator<'a> {
        let of_element = |e: usize| {
            let x = mesh.element_coordinates(e);
            let nodes = &x[..mesh.connectivity[e].len()];
            let mut corners = [[0.0; 3]; 2];
            for d in 0..3 {
                let low = nodes.iter().map(|p| p[d]).fold(f64::INFINITY, f64::min);
                let high = nodes.iter().map(|p| p[d]).fold(f64::NEG_INFINITY, f64::max);
                let margin = 0.25 * (high - low);
                (corners[0][d], corners[1][d]) = (low - margin, high + margin);
            }
            corners
        };
        Locator { mesh, boxes: (0..elements).map(of_element).collect() }
    }

    /// Returns the first element that contains `point` [m] and its natural coordinates there, if any.
    /// `slack`: tolerance of natural coordinates.
    pub fn find(&self, point: [f64; 3], slack: f64) -> Option<(usize, [f64; 3])> {
        let near = |e: &usize| {
            let [low, high] = &self.boxes[*e];
            (0..3).all(|d| low[d] <= point[d] && point[d] <= high[d])
        };
        (0..self.boxes.len()).filter(near).find_map(|e| {
            let (x, kind) = (self.mesh.element_coordinates(e), self.mesh.connectivity.kind(e));
            let natural = inverse_map::natural_point(kind, &x, point, kind.natural_centre())?;
            kind.contains(natural.xi, slack).then_some((e, natural.xi))
        })
    }
}
