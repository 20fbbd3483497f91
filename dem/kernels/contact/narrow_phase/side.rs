//! Partner types of pairs.

use super::scene::{BodyAccess, PatchView, PlaneView, PosedBody, Search};
use crate::base::Vec3;
use crate::base::error::Partner;
use crate::bodies::block::PointMotion;
use crate::lanes::vec4::{Vec4, xyz};
use crate::spatial::bvh::Aabb;

/// Bodies after re-sorting; `None` if removed.
pub trait Renumbering {
    fn sphere(&self, block: usize, sphere: u32) -> Option<[u32; 2]>;

    fn body(&self, block: usize, place: u32) -> Option<[u32; 2]>;
}

/// Partner type, numbered within its block or globally (planes).
pub trait Side {
    type View<'a>;

    /// Whether it is a body, which receives forces.
    const BODY: bool;

    const IMAGES: bool = true;

    /// Whether contacts go to another program part.
    const EXTERNAL: bool = false;

    /// Body index in the block.
    fn body(scene: &(impl BodyAccess + ?Sized), block: usize, number: u32) -> Option<usize>;

    fn view<'a>(scene: &'a (impl BodyAccess + ?Sized), block: usize, number: u32) -> Self::View<'a>;

    /// Interior point [m].
    fn middle(view: &Self::View<'_>) -> Vec3;

    fn image(view: &mut Self::View<'_>, way: &Vec3);

    fn wall(_scene: &(impl BodyAccess + ?Sized), _number: u32) -> Option<usize> {
        None
    }

    /// Block and number after re-sorting; `None` if removed.
    fn renamed(names: &dyn Renumbering, block: usize, number: u32) -> Option<[u32; 2]>;

    /// Displacement not contained in the velocity [m]
    /// ([`Surface::correction`](crate::spatial::surface::Surface::correction)).
    fn correction(_scene: &(impl BodyAccess + ?Sized), _number: u32, _point: &Vec3) -> Option<Vec3> {
        None
    }

    #[inline(always)]
    fn motion(scene: &(impl BodyAccess + ?Sized), block: usize, number: u32, point: &Vec3) -> PointMotion {
        match Self::body(scene, block, number) {
            Some(k) => scene.block(block).motion(k, point),
            None => PointMotion::of_plane(&scene.plane(number as usize).velocity),
        }
    }

    #[inline(always)]
    fn material(scene: &(impl BodyAccess + ?Sized), block: usize, number: u32) -> u32 {
        match Self::body(scene, block, number) {
            Some(k) => scene.block(block).material(k),
            None => scene.plane(number as usize).material,
        }
    }

    fn partner(scene: &(impl BodyAccess + ?Sized), block: usize, number: u32) -> Partner {
        match Self::body(scene, block, number) {
            Some(k) => Partner::Body(scene.block(block).bodies[k] as usize),
            None => Partner::Plane(number as usize),
        }
    }

    /// Whether the velocity is prescribed.
    fn still(scene: &(impl BodyAccess + ?Sized), block: usize, number: u32) -> bool {
        Self::body(scene, block, number).is_none_or(|k| scene.block(block).velocity[k][3] == 0.0)
    }
}

pub trait First: Side {
    /// Its numbers in a block, ascending.
    fn own(search: &Search<'_>, block: usize, f: impl FnMut(u32));

    fn bounds(view: &Self::View<'_>) -> Aabb;
}

pub trait Second: Side {
    /// Visits block and number of partners possibly within bounds, ascending.
    fn around(search: &Search<'_>, block: usize, bounds: Aabb, row: &mut Vec<u32>, f: impl FnMut(u32, u32));
}

pub fn grown((low, high): Aabb, by: f64) -> Aabb {
    (low.map(|x| x - by), high.map(|x| x + by))
}

/// Spheres, including clump members.
pub struct Spheres;

impl Side for Spheres {
    type View<'a> = &'a Vec4;
    const BODY: bool = true;

    #[inline(always)]
    fn body(scene: &(impl BodyAccess + ?Sized), block: usize, number: u32) -> Option<usize> {
        Some(scene.owner(block, number))
    }

    #[inline(always)]
    fn view(scene: &(impl BodyAccess + ?Sized), block: usize, number: u32) -> &Vec4 {
        scene.sphere(block, number)
    }

    fn middle(view: &&Vec4) -> Vec3 {
        xyz(view)
    }

    fn image(_: &mut &Vec4, _: &Vec3) {}

    fn renamed(names: &dyn Renumbering, block: usize, number: u32) -> Option<[u32; 2]> {
        names.sphere(block, number)
    }
}

impl First for Spheres {
    fn own(search: &Search<'_>, block: usize, f: impl FnMut(u32)) {
        (0..search.now.members[block].count as u32).for_each(f);
    }

    fn bounds(view: &&Vec4) -> Aabb {
        let x = [view[0], view[1], view[2]];
        grown((x, x), view[3])
    }
}

/// Non-spherical bodies.
pub struct Solids;

impl Side for Solids {
    type View<'a> = PosedBody<'a>;
    const BODY: bool = true;

    #[inline(always)]
    fn body(_: &(impl BodyAccess + ?Sized), _: usize, number: u32) -> Option<usize> {
        Some(number as usize)
    }

    #[inline(always)]
    fn view(scene: &(impl BodyAccess + ?Sized), block: usize, number: u32) -> PosedBody<'_> {
        scene.placed(block, number as usize)
    }

    fn middle(view: &PosedBody<'_>) -> Vec3 {
        view.centre
    }

    fn image(view: &mut PosedBody<'_>, way: &Vec3) {
        view.centre += way;
    }

    fn renamed(names: &dyn Renumbering, block: usize, number: u32) -> Option<[u32; 2]> {
        names.body(block, number)
    }
}

impl Second for Solids {
    fn around(search: &Search<'_>, _: usize, bounds: Aabb, row: &mut Vec<u32>, f: impl FnMut(u32, u32)) {
        search.solids_near(bounds, row, f);
    }
}

impl First for Solids {
    fn own(search: &Search<'_>, block: usize, f: impl FnMut(u32)) {
        if search.now.members[block].solid() {
            (0..search.now.blocks[block].bodies.len() as u32).for_each(f);
        }
    }

    fn bounds(view: &PosedBody<'_>) -> Aabb {
        view.bounds()
    }
}

const CORNERS: u32 = 1024;

/// Corners of non-spherical bodies, numbered 1024 × body place + corner.
pub struct Corners;

pub struct Corner {
    pub point: Vec3,
    /// Radius for laws, and overlap limit [m].
    pub size: f64,
}

impl Side for Corners {
    type View<'a> = Corner;
    const BODY: bool = true;

    #[inline(always)]
    fn body(_: &(impl BodyAccess + ?Sized), _: usize, number: u32) -> Option<usize> {
        Some((number / CORNERS) as usize)
    }

    #[inline(always)]
    fn view(scene: &(impl BodyAccess + ?Sized), block: usize, number: u32) -> Corner {
        let body = scene.placed(block, (number / CORNERS) as usize);
        let (point, size) = body.shape.corner((number % CORNERS) as usize, body.scale);
        Corner { point: body.centre + body.orientation * point, size }
    }

    fn middle(view: &Corner) -> Vec3 {
        view.point
    }

    fn image(view: &mut Corner, way: &Vec3) {
        view.point += way;
    }

    fn renamed(names: &dyn Renumbering, block: usize, number: u32) -> Option<[u32; 2]> {
        let [block, k] = names.body(block, number / CORNERS)?;
        Some([block, k * CORNERS + number % CORNERS])
    }
}

impl First for Corners {
    fn own(search: &Search<'_>, block: usize, mut f: impl FnMut(u32)) {
        Solids::own(search, block, |k| {
            let corners = search.now.placed(block, k as usize).shape.corners();
            debug_assert!(corners <= CORNERS);
            (0..corners).for_each(|c| f(k * CORNERS + c));
        });
    }

    fn bounds(view: &Corner) -> Aabb {
        (view.point.into(), view.point.into())
    }
}

/// Infinite planes, counted in their partner's block.
pub struct Planes;

impl Side for Planes {
    type View<'a> = PlaneView;
    const BODY: bool = false;
    const IMAGES: bool = false;

    #[inline(always)]
    fn body(_: &(impl BodyAccess + ?Sized), _: usize, _: u32) -> Option<usize> {
        None
    }

    #[inline(always)]
    fn view(scene: &(impl BodyAccess + ?Sized), _: usize, number: u32) -> PlaneView {
        scene.plane(number as usize)
    }

    // Planes lie along all periodic axes: no image.
    fn middle(view: &PlaneView) -> Vec3 {
        view.origin
    }

    fn image(_: &mut PlaneView, _: &Vec3) {}

    fn renamed(_: &dyn Renumbering, block: usize, number: u32) -> Option<[u32; 2]> {
        Some([block as u32, number])
    }
}

impl Second for Planes {
    fn around(search: &Search<'_>, block: usize, _: Aabb, _: &mut Vec<u32>, mut f: impl FnMut(u32, u32)) {
        (0..search.planes as u32).for_each(|k| f(block as u32, k));
    }
}

/// Wall patches, counted in their partner's block.
pub struct Patches;

impl Side for Patches {
    type View<'a> = PatchView<'a>;
    const BODY: bool = false;

    #[inline(always)]
    fn body(_: &(impl BodyAccess + ?Sized), _: usize, _: u32) -> Option<usize> {
        None
    }

    #[inline(always)]
    fn view<'a>(scene: &'a (impl BodyAccess + ?Sized), _: usize, number: u32) -> PatchView<'a> {
        let walls = scene.walls();
        let patch = &walls.patches[number as usize];
        PatchView { patch, wall: &walls.walls[patch.wall as usize], shift: Vec3::zeros() }
    }

    fn middle(view: &PatchView<'_>) -> Vec3 {
        view.wall.origin + view.wall.orientation * view.patch.middle
    }

    fn image(view: &mut PatchView<'_>, way: &Vec3) {
        view.shift = *way;
    }

    fn wall(scene: &(impl BodyAccess + ?Sized), number: u32) -> Option<usize> {
        Some(scene.walls().patches[number as usize].wall as usize)
    }

    fn renamed(_: &dyn Renumbering, block: usize, number: u32) -> Option<[u32; 2]> {
        Some([block as u32, number])
    }

    #[inline(always)]
    fn motion(scene: &(impl BodyAccess + ?Sized), block: usize, number: u32, point: &Vec3) -> PointMotion {
        let wall = Self::view(scene, block, number).wall;
        PointMotion::of_whole(&wall.velocity, &wall.spin, point - wall.centre, wall.inverse_mass)
    }

    #[inline(always)]
    fn material(scene: &(impl BodyAccess + ?Sized), block: usize, number: u32) -> u32 {
        Self::view(scene, block, number).wall.material
    }

    fn partner(scene: &(impl BodyAccess + ?Sized), block: usize, number: u32) -> Partner {
        Self::view(scene, block, number).patch.partner
    }

    fn still(scene: &(impl BodyAccess + ?Sized), block: usize, number: u32) -> bool {
        Self::view(scene, block, number).wall.inverse_mass == 0.0
    }
}

impl Second for Patches {
    fn around(
        search: &Search<'_>,
        block: usize,
        bounds: Aabb,
        row: &mut Vec<u32>,
        mut f: impl FnMut(u32, u32),
    ) {
        search.patches_near(bounds, row, |patch| f(block as u32, patch));
    }
}
