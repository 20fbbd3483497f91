//! Visible surface of a sample: position, normal, colour.

use super::bins::{Id, Kind, thing};
use super::camera::{Camera, V3};
use super::scene::{Colour, Paint, Scene};

pub struct Surface {
    /// In camera coordinates.
    pub place: V3,
    /// Normal towards the eye.
    pub normal: V3,
    pub colour: Colour,
    pub look: usize,
}

pub fn surface(scene: &Scene, fine: &Camera, id: Id, [x, y]: [f32; 2], depth: f32) -> Surface {
    let place = fine.at(x, y, depth);
    let (kind, k) = thing(id);
    let (normal, colour, look) = match kind {
        Kind::Sphere => {
            let s = &scene.spheres[k];
            ((place - s.centre) / s.radius, s.colour, s.look)
        }
        Kind::Tube => {
            let t = &scene.tubes[k];
            let axis = t.ends[1] - t.ends[0];
            let along = (place - t.ends[0]).dot(&axis) / axis.norm_squared().max(1e-30);
            let out = place - (t.ends[0] + axis * along);
            let flat = !(1e-3..=0.999).contains(&along) && out.norm() < 0.99 * t.radius;
            (if flat { axis } else { out }, t.colour, t.look)
        }
        Kind::Triangle => {
            let t = &scene.triangles[k];
            let [a, b, c] = t.corners;
            let normal = (b - a).cross(&(c - a));
            let colour = match &scene.looks[usize::from(t.look)].paint {
                Paint::Own(colour) => *colour,
                paint => {
                    let size = normal.norm_squared().max(1e-38);
                    let v = (place - a).cross(&(c - a)).dot(&normal) / size;
                    let w = (b - a).cross(&(place - a)).dot(&normal) / size;
                    let (v, w) = (v.clamp(0.0, 1.0), w.clamp(0.0, 1.0));
                    let u = (1.0 - v - w).max(0.0);
                    paint.of((u * t.values[0] + v * t.values[1] + w * t.values[2]) / (u + v + w))
                }
            };
            (normal, colour, t.look)
        }
    };
    let normal = normal / normal.norm().max(1e-30);
    let away = normal.dot(&fine.ray(&place)) > 0.0;
    Surface { place, normal: if away { -normal } else { normal }, colour, look: usize::from(look) }
}

/// Body for outlines; 0 for tubes, which have no outlines between them.
pub fn body(scene: &Scene, id: Id) -> u32 {
    let (kind, k) = thing(id);
    match kind {
        Kind::Sphere => 1 + 2 * scene.spheres[k].body,
        Kind::Triangle => 2 + 2 * scene.triangles[k].body,
        Kind::Tube => 0,
    }
}
