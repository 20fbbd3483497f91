//! Periodic images of patches, for contacts of spheres.
//!
//! Patch p has the numbers n p to n p + n − 1 for its n images: contacts with several of them at once are distinct.

use crate::base::Vec3;
use crate::pairs::patches::PatchList;
use crate::spatial::periodic::{Periodic, Turns};
use crate::spatial::surface::{Feature, PatchPoint, Surface, SurfaceContact};

/// Offsets of images.
#[derive(Clone, Debug, Default)]
pub(crate) struct Images {
    /// Box lengths along each axis, and their offset [m].
    all: Vec<(Turns, Vec3)>,
}

impl Images {
    /// Images next to the box.
    pub fn new(periodic: &Periodic) -> Images {
        let turns = |d: usize| if periodic.length[d] > 0.0 { -1..=1 } else { 0..=0 };
        let all = turns(0).flat_map(|x| turns(1).flat_map(move |y| turns(2).map(move |z| [x, y, z])));
        Images { all: all.map(|t| (t, periodic.image_offset(&t))).collect() }
    }

    fn count(&self) -> u32 {
        self.all.len() as u32
    }

    /// Returns the patch of a number, and the offset of its image [m].
    pub fn original(&self, number: u32) -> (u32, Vec3) {
        let count = self.count();
        (number / count, self.all[(number % count) as usize].1)
    }

    /// Returns the number of the image seen by a body moved back by `turns`; `None` beyond the images.
    fn seen(&self, number: u32, turns: &Turns) -> Option<u32> {
        let count = self.count();
        let (before, _) = self.all[(number % count) as usize];
        let now: Turns = std::array::from_fn(|d| before[d] - turns[d]);
        let image = self.all.iter().position(|(t, _)| *t == now)?;
        Some(number / count * count + image as u32)
    }

    /// Moves contacts of spheres with their bodies back by `turns`, by sphere.
    pub fn wrap(&self, list: &mut PatchList, turns: &[Turns], offset: impl Fn(&Turns) -> Vec3) {
        list.pairs.clear();
        list.live.retain_mut(|contact| {
            let of = &turns[contact.i as usize];
            contact.point -= offset(of);
            let Some(number) = self.seen(contact.patch, of) else { return false };
            contact.patch = number;
            true
        });
        list.live.sort_unstable_by_key(|c| (c.i, c.patch));
    }

    /// Restores patches and points of contacts with an external surface.
    pub fn restore(&self, contacts: &mut [SurfaceContact]) {
        for contact in contacts {
            let (patch, offset) = self.original(contact.patch);
            contact.patch = patch;
            contact.point = (Vec3::from(contact.point) - offset).into();
        }
    }
}

/// Surface with its periodic images.
pub(crate) struct Repeated<'a, S> {
    pub surface: &'a S,
    pub images: &'a Images,
}

fn moved(x: [f64; 3], way: Vec3) -> [f64; 3] {
    (Vec3::from(x) + way).into()
}

impl<S> Repeated<'_, S> {
    fn original(&self, number: u32) -> (u32, Vec3) {
        self.images.original(number)
    }

    fn patch(&self, number: u32) -> u32 {
        number / self.images.count()
    }
}

impl<S: Surface> Surface for Repeated<'_, S> {
    fn candidates(&self, lo: [f64; 3], hi: [f64; 3], out: &mut Vec<u32>) {
        let first = out.len();
        for (k, (_, offset)) in self.images.all.iter().enumerate() {
            let begin = out.len();
            self.surface.candidates(moved(lo, -offset), moved(hi, -offset), out);
            out[begin..].iter_mut().for_each(|p| *p = *p * self.images.count() + k as u32);
        }
        out[first..].sort_unstable();
    }

    fn closest_point(&self, number: u32, centre: [f64; 3], local: [f64; 2]) -> PatchPoint {
        let (patch, offset) = self.original(number);
        let found = self.surface.closest_point(patch, moved(centre, -offset), local);
        let (count, image) = (self.images.count(), number % self.images.count());
        let feature = match found.feature {
            Feature::Face => Feature::Face,
            Feature::Edge(k) => Feature::Edge(k * count + image),
            Feature::Vertex(k) => Feature::Vertex(k * count + image),
        };
        PatchPoint { point: moved(found.point, offset), feature, ..found }
    }

    fn max_speed(&self) -> f64 {
        self.surface.max_speed()
    }

    fn one_sided(&self) -> bool {
        self.surface.one_sided()
    }

    fn one_sided_patch(&self, number: u32) -> bool {
        self.surface.one_sided_patch(self.patch(number))
    }

    fn clearance(&self, number: u32, centre: [f64; 3]) -> f64 {
        let (patch, offset) = self.original(number);
        self.surface.clearance(patch, moved(centre, -offset))
    }

    fn fetch(&self, number: u32) {
        self.surface.fetch(self.patch(number));
    }

    fn sharp(&self) -> bool {
        self.surface.sharp()
    }

    fn level(&self, a: u32, b: u32) -> bool {
        a % self.images.count() == b % self.images.count() && self.surface.level(self.patch(a), self.patch(b))
    }

    fn foot(&self, number: u32, centre: [f64; 3]) -> Option<[Vec3; 3]> {
        let (patch, offset) = self.original(number);
        let [foot, normal, velocity] = self.surface.foot(patch, moved(centre, -offset))?;
        Some([foot + offset, normal, velocity])
    }

    fn group(&self, number: u32) -> usize {
        self.surface.group(self.patch(number))
    }

    fn groups(&self) -> usize {
        self.surface.groups()
    }

    fn driven(&self, group: usize) -> bool {
        self.surface.driven(group)
    }

    fn moment_centre(&self, number: u32) -> [f64; 3] {
        let (patch, offset) = self.original(number);
        moved(self.surface.moment_centre(patch), offset)
    }

    fn spin(&self, number: u32) -> Vec3 {
        self.surface.spin(self.patch(number))
    }

    fn inverse_mass(&self, number: u32) -> f64 {
        self.surface.inverse_mass(self.patch(number))
    }

    fn vertex(&self, vertex: u32) -> Option<[Vec3; 2]> {
        self.surface.vertex(vertex)
    }

    fn correction(&self, number: u32, local: [f64; 2]) -> Option<[f64; 3]> {
        self.surface.correction(self.patch(number), local)
    }

    fn vertex_correction(&self, vertex: u32) -> Option<[f64; 3]> {
        self.surface.vertex_correction(vertex)
    }

    fn is_empty(&self) -> bool {
        self.surface.is_empty()
    }
}
