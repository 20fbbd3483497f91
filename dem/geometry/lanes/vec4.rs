//! Four numbers loaded together.

use crate::base::Vec3;
use serde::{Deserialize, Serialize};

/// Four numbers, aligned to avoid crossing cache lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
#[repr(C, align(32))]
pub struct Vec4(pub [f64; 4]);

impl Vec4 {
    #[inline(always)]
    pub fn of(v: &Vec3, last: f64) -> Vec4 {
        Vec4([v.x, v.y, v.z, last])
    }
}

impl std::ops::Deref for Vec4 {
    type Target = [f64; 4];
    #[inline(always)]
    fn deref(&self) -> &[f64; 4] {
        &self.0
    }
}

impl std::ops::DerefMut for Vec4 {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64; 4] {
        &mut self.0
    }
}

#[inline(always)]
pub fn xyz(record: &Vec4) -> Vec3 {
    Vec3::new(record[0], record[1], record[2])
}

#[inline(always)]
pub fn set_xyz(record: &mut Vec4, v: &Vec3) {
    record[0] = v.x;
    record[1] = v.y;
    record[2] = v.z;
}
