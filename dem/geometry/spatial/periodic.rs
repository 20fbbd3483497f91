//! Periodic boundaries.
//!
//! Positions are unwrapped between two sortings (`reordering.rs`). Contacts across a boundary are image pairs in a
//! separate list.
//!
//! Source: Allen & Tildesley, Computer Simulation of Liquids (2017), sec. 1.6.2.
//!
//! Limits: bodies at most half as long as the box; planes along periodic axes; no bonds.

use super::cells::Cells;
use crate::base::Vec3;
use crate::lanes::vec4::{Vec4, xyz};

pub type Turns = [i32; 3];

pub const NONE: Turns = [0; 3];

#[derive(Clone, Copy, Debug)]
pub struct Periodic {
    pub low: Vec3,
    /// Zero along other axes.
    pub length: Vec3,
}

impl Periodic {
    #[inline]
    pub fn new(borders: &[Option<[f64; 2]>; 3]) -> Option<Periodic> {
        if borders.iter().all(Option::is_none) {
            return None;
        }
        let side = |d: usize| borders[d].unwrap_or_default();
        let low = Vec3::from_fn(|d, _| side(d)[0]);
        Some(Periodic { low, length: Vec3::from_fn(|d, _| side(d)[1] - side(d)[0]) })
    }

    /// Box lengths from a point to the box.
    #[inline]
    pub fn turns(&self, x: &Vec3) -> Turns {
        std::array::from_fn(|d| {
            if self.length[d] > 0.0 { ((x[d] - self.low[d]) / self.length[d]).floor() as i32 } else { 0 }
        })
    }

    /// Offset [m].
    #[inline(always)]
    pub fn image_offset(&self, turns: &Turns) -> Vec3 {
        Vec3::from_fn(|d, _| f64::from(turns[d]) * self.length[d])
    }

    /// Offset of the image of `of` nearest to `to` [m].
    #[inline]
    pub fn nearest(&self, to: &Vec3, of: &Vec3) -> Vec3 {
        Vec3::from_fn(|d, _| {
            if self.length[d] > 0.0 {
                ((to[d] - of[d]) / self.length[d]).round() * self.length[d]
            } else {
                0.0
            }
        })
    }

    /// Offsets of adjacent images, with zero [m].
    #[inline]
    pub fn around(&self) -> Vec<Vec3> {
        let turns = |d: usize| if self.length[d] > 0.0 { -1..=1 } else { 0..=0 };
        let ways = turns(0).flat_map(|x| turns(1).flat_map(move |y| turns(2).map(move |z| [x, y, z])));
        ways.map(|t| self.image_offset(&t)).collect()
    }

    #[inline]
    pub fn wrap(&self, x: &Vec3) -> Vec3 {
        let x = x - self.image_offset(&self.turns(x));
        // Just below the lower boundary, the sum rounds to the upper one.
        Vec3::from_fn(|d, _| {
            let past = self.length[d] > 0.0 && x[d] >= self.low[d] + self.length[d];
            if past { self.low[d] } else { x[d] }
        })
    }
}

/// Wrapped spheres.
pub struct Space {
    periodic: Periodic,
    pub points: Vec<Vec4>,
    turns: Vec<Turns>,
    largest: f64,
}

impl Space {
    #[inline]
    pub fn new(periodic: Periodic, spheres: &[Vec4], largest: f64) -> Space {
        let turns: Vec<Turns> = spheres.iter().map(|p| periodic.turns(&xyz(p))).collect();
        let back = |(p, t): (&Vec4, &Turns)| {
            let x = xyz(p) - periodic.image_offset(t);
            Vec4([x.x, x.y, x.z, p[3]])
        };
        let points = spheres.iter().zip(&turns).map(back).collect();
        Space { periodic, points, turns, largest }
    }

    /// Calls `f` with later spheres with an image within `skin`, and the image's box lengths.
    #[inline]
    pub fn neighbours(&self, cells: &Cells, i: u32, skin: f64, mut f: impl FnMut(u32, Turns)) {
        let (p, own) = (&self.points[i as usize], &self.turns[i as usize]);
        let reach = p[3] + self.largest + skin;
        // Possible images along each axis.
        let [x, y, z] = std::array::from_fn(|d| {
            let (from, length) = (p[d] - self.periodic.low[d], self.periodic.length[d]);
            let borders = length > 0.0;
            (-i32::from(borders && from < reach))..=i32::from(borders && from + reach > length)
        });
        for a in x {
            for b in y.clone() {
                for c in z.clone() {
                    let at = xyz(p) - self.periodic.image_offset(&[a, b, c]);
                    cells.neighbours(&Vec4([at.x, at.y, at.z, p[3]]), skin, |j| {
                        let q = &self.points[j as usize];
                        let reach = p[3] + q[3] + skin;
                        if j > i && (at - xyz(q)).norm_squared() < reach * reach {
                            let other = &self.turns[j as usize];
                            f(j, std::array::from_fn(|d| [a, b, c][d] + own[d] - other[d]));
                        }
                    });
                }
            }
        }
    }
}
