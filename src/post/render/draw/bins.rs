//! Sorts objects into picture tiles, nearest first.

use rayon::prelude::*;

use super::camera::{Camera, V3};
use super::scene::{Scene, Triangle};

/// Kind in the upper two bits, index in the others.
pub type Id = u32;
/// Background.
pub const NONE: Id = u32::MAX;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Sphere = 0,
    Triangle = 1,
    Tube = 2,
}

pub fn number(kind: Kind, place: usize) -> Id {
    ((kind as u32) << 30) | place as u32
}

/// Kind and index of an id other than [`NONE`].
pub fn thing(id: Id) -> (Kind, usize) {
    let kind = match id >> 30 {
        0 => Kind::Sphere,
        1 => Kind::Triangle,
        _ => Kind::Tube,
    };
    (kind, (id & 0x3fff_ffff) as usize)
}

pub fn look(scene: &Scene, id: Id) -> usize {
    let (kind, k) = thing(id);
    usize::from(match kind {
        Kind::Sphere => scene.spheres[k].look,
        Kind::Triangle => scene.triangles[k].look,
        Kind::Tube => scene.tubes[k].look,
    })
}

/// Object with the samples that it may cover, ends included.
#[derive(Clone, Copy, Debug)]
pub struct Item {
    pub id: Id,
    /// Least depth [m].
    pub near: f32,
    /// First column, first row, last column, last row.
    pub rect: [i32; 4],
}

pub struct Bins {
    pub items: Vec<Item>,
    start: Vec<u32>,
    places: Vec<u32>,
}

impl Bins {
    /// Bins objects accepted by `wanted`; `fine` is the camera of samples.
    pub fn new(
        scene: &Scene,
        fine: &Camera,
        tiles: [usize; 2],
        side: usize,
        wanted: impl Fn(usize) -> bool + Sync,
    ) -> Bins {
        let spheres = scene.spheres.par_iter().enumerate().filter(|(_, s)| wanted(s.look.into()));
        let mut items: Vec<Item> = spheres
            .map(|(k, s)| Item {
                id: number(Kind::Sphere, k),
                near: s.centre.z - s.radius,
                rect: around(fine, &s.centre, s.radius),
            })
            .collect();
        let triangles = scene.triangles.iter().enumerate().filter(|(_, t)| wanted(t.look.into()));
        items.extend(triangles.map(|(k, t)| of_triangle(fine, k, t)));
        let tubes = scene.tubes.iter().enumerate().filter(|(_, t)| wanted(t.look.into()));
        items.extend(tubes.map(|(k, t)| {
            let [a, b] = t.ends.map(|e| around(fine, &e, t.radius));
            let rect = [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])];
            Item { id: number(Kind::Tube, k), near: t.ends[0].z.min(t.ends[1].z) - t.radius, rect }
        }));
        let last = [(tiles[0] * side) as i32 - 1, (tiles[1] * side) as i32 - 1];
        items.retain(|i| {
            let [x0, y0, x1, y1] = i.rect;
            x0 <= x1 && y0 <= y1 && x1 >= 0 && y1 >= 0 && x0 <= last[0] && y0 <= last[1]
        });
        for item in &mut items {
            let [x0, y0, x1, y1] = item.rect;
            item.rect = [x0.max(0), y0.max(0), x1.min(last[0]), y1.min(last[1])];
        }
        items.par_sort_unstable_by(|a, b| a.near.total_cmp(&b.near).then(a.id.cmp(&b.id)));
        Bins::sorted(items, tiles, side)
    }

    fn sorted(items: Vec<Item>, tiles: [usize; 2], side: usize) -> Bins {
        let of = |item: &Item| {
            let [x0, y0, x1, y1] = item.rect.map(|v| v as usize / side);
            (y0..=y1).flat_map(move |y| (x0..=x1).map(move |x| y * tiles[0] + x))
        };
        let mut start = vec![0_u32; tiles[0] * tiles[1] + 1];
        for item in &items {
            of(item).for_each(|tile| start[tile + 1] += 1);
        }
        for k in 1..start.len() {
            start[k] += start[k - 1];
        }
        let mut next = start.clone();
        let mut places = vec![0_u32; start.last().map_or(0, |n| *n as usize)];
        for (k, item) in items.iter().enumerate() {
            of(item).for_each(|tile| {
                places[next[tile] as usize] = k as u32;
                next[tile] += 1;
            });
        }
        Bins { items, start, places }
    }

    /// Objects of a tile, nearest first.
    pub fn of(&self, tile: usize) -> impl Iterator<Item = &Item> {
        let places = &self.places[self.start[tile] as usize..self.start[tile + 1] as usize];
        places.iter().map(|k| &self.items[*k as usize])
    }
}

fn around(fine: &Camera, c: &V3, r: f32) -> [i32; 4] {
    let ends = |across: f32| match fine.perspective {
        // Slopes of the tangents from the eye.
        true => {
            let (z, beside) = (c.z, c.z * c.z - r * r);
            let root = r * (across * across + beside).max(0.0).sqrt();
            [(across * z - root) / beside, (across * z + root) / beside]
        }
        false => [across - r, across + r],
    };
    let (x, y) = (ends(c.x), ends(c.y));
    let px = |s: f32| fine.centre[0] + fine.focal * s;
    let py = |s: f32| fine.centre[1] - fine.focal * s;
    [px(x[0]), py(y[1]), px(x[1]), py(y[0])].map(whole)
}

fn whole(v: f32) -> i32 {
    v.clamp(-1e6, 1e6).floor() as i32
}

fn of_triangle(fine: &Camera, place: usize, t: &Triangle) -> Item {
    let p = t.corners.map(|c| fine.project(&c));
    let least = |k: usize| p[0][k].min(p[1][k]).min(p[2][k]);
    let most = |k: usize| p[0][k].max(p[1][k]).max(p[2][k]);
    Item {
        id: number(Kind::Triangle, place),
        near: t.corners[0].z.min(t.corners[1].z).min(t.corners[2].z),
        rect: [least(0), least(1), most(0), most(1)].map(whole),
    }
}
