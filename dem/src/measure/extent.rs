//! Highest and lowest points of dilated polyhedra.

use crate::base::Vec3;
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::shape::Shape;
use crate::shape::dilated::Dilated;
use nalgebra::UnitQuaternion;

struct Standing<'a> {
    it: &'a Dilated,
    centre: Vec3,
    turn: UnitQuaternion<f64>,
    scale: f64,
}

impl Standing<'_> {
    fn of<'a>(model: &'a Model, state: &State, body: usize) -> Option<Standing<'a>> {
        let Shape::Polyhedron(it) = model.shape(body) else { return None };
        let (centre, turn) = (state.position(body), state.orientation(model, body));
        Some(Standing { it, centre, turn, scale: model.scale(body) })
    }

    fn corner(&self, k: usize) -> Vec3 {
        self.centre + self.turn * (self.it.core.corners[k] * self.scale)
    }

    /// Top of the core at (x, y), inside its projection.
    fn above(&self, x: f64, y: f64) -> Option<f64> {
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for face in &self.it.core.faces {
            let n = self.turn * face.normal;
            let level = face.offset * self.scale + n.dot(&self.centre) - n.x * x - n.y * y;
            if n.z > 1e-12 {
                high = high.min(level / n.z);
            } else if n.z < -1e-12 {
                low = low.max(level / n.z);
            } else if level < 0.0 {
                return None;
            }
        }
        (low <= high).then_some(high)
    }
}

/// Lowest point of a dilated polyhedron [m]; `None` for other shapes.
pub fn lowest(model: &Model, state: &State, body: usize) -> Option<f64> {
    let it = Standing::of(model, state, body)?;
    let corners = (0..it.it.core.corners.len()).map(|k| it.corner(k).z);
    Some(corners.fold(f64::INFINITY, f64::min) - it.it.radius * it.scale)
}

/// Upper bound on its height over a rectangle (`middle`, `half` sides) [m], within its radius. `None`
/// outside, and for other shapes.
pub fn highest_over(
    model: &Model,
    state: &State,
    body: usize,
    middle: [f64; 2],
    half: [f64; 2],
) -> Option<f64> {
    let it = Standing::of(model, state, body)?;
    let radius = it.it.radius * it.scale;
    let half = half.map(|h| h + radius);
    let mut top: Option<f64> = None;
    let mut put = |z: f64| top = Some(top.map_or(z, |t| t.max(z)));
    for edge in &it.it.core.edges {
        let [a, b] = edge.ends.map(|e| it.corner(e as usize));
        let (way, mut range) = (b - a, [0.0_f64, 1.0]);
        for d in 0..2 {
            for sign in [1.0, -1.0] {
                let (at, slope) = (sign * (a[d] - middle[d]) - half[d], sign * way[d]);
                if slope > 0.0 {
                    range[1] = range[1].min(-at / slope);
                } else if slope < 0.0 {
                    range[0] = range[0].max(-at / slope);
                } else if at > 0.0 {
                    range[1] = -1.0;
                }
            }
        }
        if range[0] <= range[1] {
            range.iter().for_each(|s| put(a.z + s * way.z));
        }
    }
    for (i, j) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
        if let Some(z) = it.above(middle[0] + i * half[0], middle[1] + j * half[1]) {
            put(z);
        }
    }
    top.map(|z| z + radius)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bodies::input::BodyInput;
    use crate::engine::input::ModelInput;
    use crate::law::material::Material;

    /// Face down, then rotated by 45° about y.
    #[test]
    fn cube_extent_matches_corners() {
        let corners: Vec<Vec3> =
            (0..8).map(|k| Vec3::from_fn(|d, _| if k >> d & 1 == 1 { 0.9 } else { -0.9 })).collect();
        let cube = Shape::Polyhedron(Box::new(Dilated::new(&corners, 0.1).unwrap().0));
        let turned = UnitQuaternion::from_axis_angle(&Vec3::y_axis(), std::f64::consts::FRAC_PI_4);
        let body =
            |orientation| BodyInput { orientation, position: Vec3::new(0.0, 0.0, 3.0), ..Default::default() };
        let model = Model::new(ModelInput {
            materials: vec![Material { density: 1.0, stiffness: 1.0, ..Material::RIGID }],
            shapes: vec![cube],
            bodies: vec![body(UnitQuaternion::identity()), body(turned)],
            ..ModelInput::default()
        })
        .unwrap();
        let state = State::new(&model);
        let near = |a: Option<f64>, b: f64| assert!((a.unwrap() - b).abs() < 1e-12, "{a:?} {b}");
        let edge = 0.9 * 2.0_f64.sqrt();
        near(lowest(&model, &state, 0), 2.0);
        near(lowest(&model, &state, 1), 3.0 - edge - 0.1);
        let over = |body, middle, half| highest_over(&model, &state, body, middle, half);
        near(over(0, [0.0, 0.0], [5.0, 5.0]), 4.0);
        near(over(0, [0.0, 0.0], [0.1, 0.1]), 4.0);
        near(over(1, [0.0, 0.0], [0.1, 0.1]), 3.0 + edge + 0.1);
        near(over(1, [0.6, 0.0], [0.1, 0.1]), 3.0 + edge - 0.4 + 0.1);
        assert!(over(0, [3.0, 0.0], [0.5, 0.5]).is_none());
    }
}
