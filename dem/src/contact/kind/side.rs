//! What the partners of a pair can be.

use super::scene::{PatchView, Placed, PlaneView, Scene, Search};
use crate::base::Vec3;
use crate::base::error::Partner;
use crate::bodies::block::PointMotion;
use crate::lanes::record::{Record, xyz};
use crate::spatial::bvh::Aabb;

/// Where bodies are after a new order; `None` where they do not stay.
pub(crate) trait Renamed {
    /// Block and number of what was a sphere of an old block.
    fn sphere(&self, block: usize, sphere: u32) -> Option<[u32; 2]>;

    /// Block and place of what was a body of an old block.
    fn body(&self, block: usize, place: u32) -> Option<[u32; 2]>;
}

/// One partner of a pair. A partner has a number within its block: that of a sphere, of a body, of a corner; planes have
/// numbers of their own.
pub(crate) trait Side {
    /// A partner where it is.
    type View<'a>;

    /// Whether it is a body, which takes forces.
    const BODY: bool;

    /// Whether it has images across periodic borders.
    const IMAGES: bool = true;

    /// Whether it belongs to another program part, which is given the contacts.
    const EXTERNAL: bool = false;

    /// The body, by its place in the block; `None` where it is none.
    fn body(scene: &(impl Scene + ?Sized), block: usize, number: u32) -> Option<usize>;

    fn view<'a>(scene: &'a (impl Scene + ?Sized), block: usize, number: u32) -> Self::View<'a>;

    /// A point amid it [m].
    fn middle(view: &Self::View<'_>) -> Vec3;

    /// Shows an image of it, moved by a way [m].
    fn image(view: &mut Self::View<'_>, way: &Vec3);

    /// The wall of patches that it belongs to.
    fn wall(_scene: &(impl Scene + ?Sized), _number: u32) -> Option<usize> {
        None
    }

    /// Block and number after a new order of the bodies; `None` where the body does not stay.
    fn renamed(names: &dyn Renamed, block: usize, number: u32) -> Option<[u32; 2]>;

    /// Displacement at a point that no velocity contains [m] ([`Surface::correction`](crate::spatial::surface::Surface::correction)).
    fn correction(_scene: &(impl Scene + ?Sized), _number: u32, _point: &Vec3) -> Option<Vec3> {
        None
    }

    /// Motion at a point.
    #[inline(always)]
    fn motion(scene: &(impl Scene + ?Sized), block: usize, number: u32, point: &Vec3) -> PointMotion {
        match Self::body(scene, block, number) {
            Some(k) => scene.block(block).motion(k, point),
            None => PointMotion::of_plane(&scene.plane(number as usize).velocity),
        }
    }

    #[inline(always)]
    fn material(scene: &(impl Scene + ?Sized), block: usize, number: u32) -> u32 {
        match Self::body(scene, block, number) {
            Some(k) => scene.block(block).material(k),
            None => scene.plane(number as usize).material,
        }
    }

    fn partner(scene: &(impl Scene + ?Sized), block: usize, number: u32) -> Partner {
        match Self::body(scene, block, number) {
            Some(k) => Partner::Body(scene.block(block).bodies[k] as usize),
            None => Partner::Plane(number as usize),
        }
    }

    /// Whether it keeps its velocity whatever the forces.
    fn still(scene: &(impl Scene + ?Sized), block: usize, number: u32) -> bool {
        Self::body(scene, block, number).is_none_or(|k| scene.block(block).velocity[k][3] == 0.0)
    }
}

/// A side that can come first: its partners are looked for.
pub(crate) trait First: Side {
    /// Its numbers within a block, in order.
    fn own(search: &Search<'_>, block: usize, f: impl FnMut(u32));

    /// Bounds [m].
    fn bounds(view: &Self::View<'_>) -> Aabb;
}

/// A side that can come second: it is looked for.
pub(crate) trait Second: Side {
    /// Calls `f` with block and number of all that may come within bounds of one in `block`; ascending.
    fn around(search: &Search<'_>, block: usize, bounds: Aabb, row: &mut Vec<u32>, f: impl FnMut(u32, u32));
}

/// Bounds grown by a length [m].
pub(crate) fn grown((low, high): Aabb, by: f64) -> Aabb {
    (low.map(|x| x - by), high.map(|x| x + by))
}

/// Spheres: single ones and members of clumps.
pub(crate) struct Spheres;

impl Side for Spheres {
    type View<'a> = &'a Record;
    const BODY: bool = true;

    #[inline(always)]
    fn body(scene: &(impl Scene + ?Sized), block: usize, number: u32) -> Option<usize> {
        Some(scene.owner(block, number))
    }

    #[inline(always)]
    fn view(scene: &(impl Scene + ?Sized), block: usize, number: u32) -> &Record {
        scene.sphere(block, number)
    }

    // Spheres come first only, and it is the second partner of which an image is shown.
    fn middle(view: &&Record) -> Vec3 {
        xyz(view)
    }

    fn image(_: &mut &Record, _: &Vec3) {}

    fn renamed(names: &dyn Renamed, block: usize, number: u32) -> Option<[u32; 2]> {
        names.sphere(block, number)
    }
}

impl First for Spheres {
    fn own(search: &Search<'_>, block: usize, f: impl FnMut(u32)) {
        (0..search.now.members[block].count as u32).for_each(f);
    }

    fn bounds(view: &&Record) -> Aabb {
        let x = [view[0], view[1], view[2]];
        grown((x, x), view[3])
    }
}

/// Bodies that are not made of spheres.
pub(crate) struct Solids;

impl Side for Solids {
    type View<'a> = Placed<'a>;
    const BODY: bool = true;

    #[inline(always)]
    fn body(_: &(impl Scene + ?Sized), _: usize, number: u32) -> Option<usize> {
        Some(number as usize)
    }

    #[inline(always)]
    fn view(scene: &(impl Scene + ?Sized), block: usize, number: u32) -> Placed<'_> {
        scene.placed(block, number as usize)
    }

    fn middle(view: &Placed<'_>) -> Vec3 {
        view.centre
    }

    fn image(view: &mut Placed<'_>, way: &Vec3) {
        view.centre += way;
    }

    fn renamed(names: &dyn Renamed, block: usize, number: u32) -> Option<[u32; 2]> {
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

    fn bounds(view: &Placed<'_>) -> Aabb {
        view.bounds()
    }
}

/// Corners that a body can have at most.
const CORNERS: u32 = 1024;

/// Corners of bodies that are not made of spheres: their number is 1024 times the place of the body, plus that of the
/// corner.
pub(crate) struct Corners;

/// A corner where it is.
pub(crate) struct Corner {
    pub point: Vec3,
    /// What laws take for a radius [m]; also the overlap above which a contact has lost its meaning.
    pub size: f64,
}

impl Side for Corners {
    type View<'a> = Corner;
    const BODY: bool = true;

    #[inline(always)]
    fn body(_: &(impl Scene + ?Sized), _: usize, number: u32) -> Option<usize> {
        Some((number / CORNERS) as usize)
    }

    #[inline(always)]
    fn view(scene: &(impl Scene + ?Sized), block: usize, number: u32) -> Corner {
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

    fn renamed(names: &dyn Renamed, block: usize, number: u32) -> Option<[u32; 2]> {
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

/// Infinite planes. They count with the block of their partner.
pub(crate) struct Planes;

impl Side for Planes {
    type View<'a> = PlaneView;
    const BODY: bool = false;
    const IMAGES: bool = false;

    #[inline(always)]
    fn body(_: &(impl Scene + ?Sized), _: usize, _: u32) -> Option<usize> {
        None
    }

    #[inline(always)]
    fn view(scene: &(impl Scene + ?Sized), _: usize, number: u32) -> PlaneView {
        scene.plane(number as usize)
    }

    // A plane lies along all periodic axes: it is its own image.
    fn middle(view: &PlaneView) -> Vec3 {
        view.origin
    }

    fn image(_: &mut PlaneView, _: &Vec3) {}

    fn renamed(_: &dyn Renamed, block: usize, number: u32) -> Option<[u32; 2]> {
        Some([block as u32, number])
    }
}

impl Second for Planes {
    fn around(search: &Search<'_>, block: usize, _: Aabb, _: &mut Vec<u32>, mut f: impl FnMut(u32, u32)) {
        (0..search.planes as u32).for_each(|k| f(block as u32, k));
    }
}

/// Patches of walls. They count with the block of their partner.
pub(crate) struct Patches;

impl Side for Patches {
    type View<'a> = PatchView<'a>;
    const BODY: bool = false;

    #[inline(always)]
    fn body(_: &(impl Scene + ?Sized), _: usize, _: u32) -> Option<usize> {
        None
    }

    #[inline(always)]
    fn view<'a>(scene: &'a (impl Scene + ?Sized), _: usize, number: u32) -> PatchView<'a> {
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

    fn wall(scene: &(impl Scene + ?Sized), number: u32) -> Option<usize> {
        Some(scene.walls().patches[number as usize].wall as usize)
    }

    fn renamed(_: &dyn Renamed, block: usize, number: u32) -> Option<[u32; 2]> {
        Some([block as u32, number])
    }

    #[inline(always)]
    fn motion(scene: &(impl Scene + ?Sized), block: usize, number: u32, point: &Vec3) -> PointMotion {
        let wall = Self::view(scene, block, number).wall;
        PointMotion::of_whole(&wall.velocity, &wall.spin, point - wall.centre, wall.inverse_mass)
    }

    #[inline(always)]
    fn material(scene: &(impl Scene + ?Sized), block: usize, number: u32) -> u32 {
        Self::view(scene, block, number).wall.material
    }

    fn partner(scene: &(impl Scene + ?Sized), block: usize, number: u32) -> Partner {
        Self::view(scene, block, number).patch.partner
    }

    fn still(scene: &(impl Scene + ?Sized), block: usize, number: u32) -> bool {
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
