//! Sphere positions at the last search.

use crate::base::Vec3;
use crate::lanes::vec4::{Vec4, xyz};

/// Single precision, relative to one sphere.
#[derive(Clone, Debug, Default)]
pub struct Reference {
    origin: Vec3,
    offsets: Vec<[f32; 3]>,
    /// Error bound of offsets [m].
    error: f64,
}

impl Reference {
    pub fn start(&mut self, origin: Option<&Vec4>) {
        *self = Reference { origin: origin.map(xyz).unwrap_or_default(), ..Reference::default() };
    }

    pub fn push(&mut self, x: &Vec3) {
        let offset = x - self.origin;
        // Half a unit in the last place per component, with margin for all three.
        self.error = self.error.max(1.1e-7 * offset.amax());
        self.offsets.push([offset.x as f32, offset.y as f32, offset.z as f32]);
    }

    pub fn len(&self) -> usize {
        self.offsets.len()
    }

    /// Upper bound on the squared displacement.
    #[inline(always)]
    pub fn moved2(&self, k: usize, x: &Vec3) -> f64 {
        let [a, b, c] = self.offsets[k].map(f64::from);
        let way = (x - self.origin - Vec3::new(a, b, c)).norm() + self.error;
        way * way
    }
}
