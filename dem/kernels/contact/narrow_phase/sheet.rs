//! Dilated polyhedra on the external surface of triangles, as on walls (`patch.rs`).
//!
//! Limits: as for wall triangles; faces of the solid have no mass.

use super::dilated::Two;
use super::handler::ContactTotals;
use super::pair::{Manifold, PairContactPoint, ShapePair};
use super::patch;
use super::scene::{BodyAccess, Pose, PosedBody, Search};
use super::side::{Second, Side, Solids};
use crate::base::Vec3;
use crate::base::error::Partner;
use crate::bodies::block::PointMotion;
use crate::contact::narrow_phase::Renumbering;
use crate::contact::scalar::{self, PairForce, StepContext};
use crate::law::History;
use crate::pairs::list::Hint;
use crate::spatial::bvh::Aabb;
use crate::spatial::sheet::SheetFacet;
use crate::spatial::surface::SurfaceContact;

pub struct DilatedSheet;

/// Surface triangles, counted in their partner's block.
pub struct SheetFacets;

const WORLD: Pose = Pose {
    centre: Vec3::new(0.0, 0.0, 0.0),
    orientation: nalgebra::UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(1.0, 0.0, 0.0, 0.0)),
    scale: 1.0,
};

impl ShapePair for DilatedSheet {
    type First = Solids;
    type Second = SheetFacets;
    const SHARED: bool = true;
    const JOINED: bool = true;

    fn may_touch(&self, body: &PosedBody<'_>, it: &&SheetFacet, reach: f64) -> bool {
        if !body.dilated() {
            return false;
        }
        let two: Two<'_> = patch::two(body, &WORLD, &it.facet);
        let most = body.radius + reach;
        two.separation(two.line(), most).is_none_or(|(_, apart)| apart < most)
    }

    fn contact_points(&self, body: &PosedBody<'_>, it: &&SheetFacet, found: &mut Manifold) {
        self.contact_points_from_hint(body, it, &mut None, found);
    }

    fn contact_points_from_hint(
        &self,
        body: &PosedBody<'_>,
        it: &&SheetFacet,
        hint: &mut Hint,
        found: &mut Manifold,
    ) {
        patch::on_facet(body, &WORLD, &it.facet, hint, found);
    }
}

impl Side for SheetFacets {
    type View<'a> = &'a SheetFacet;
    const BODY: bool = false;
    const IMAGES: bool = false;
    const EXTERNAL: bool = true;

    #[inline(always)]
    fn body(_: &(impl BodyAccess + ?Sized), _: usize, _: u32) -> Option<usize> {
        None
    }

    #[inline(always)]
    fn view(scene: &(impl BodyAccess + ?Sized), _: usize, number: u32) -> &SheetFacet {
        &scene.sheet().facets[number as usize]
    }

    fn middle(view: &&SheetFacet) -> Vec3 {
        view.facet.corners[0]
    }

    fn image(_: &mut &SheetFacet, _: &Vec3) {}

    fn renamed(_: &dyn Renumbering, block: usize, number: u32) -> Option<[u32; 2]> {
        Some([block as u32, number])
    }

    #[inline(always)]
    fn motion(scene: &(impl BodyAccess + ?Sized), block: usize, number: u32, point: &Vec3) -> PointMotion {
        let facet = Self::view(scene, block, number);
        let (velocity, spin) = facet.motion(&facet.foot(point));
        PointMotion::of_whole(&velocity, &spin, Vec3::zeros(), 0.0)
    }

    fn correction(scene: &(impl BodyAccess + ?Sized), number: u32, point: &Vec3) -> Option<Vec3> {
        let facet = Self::view(scene, 0, number);
        facet.correction.is_some().then(|| facet.correction(&facet.foot(point))).flatten()
    }

    #[inline(always)]
    fn material(scene: &(impl BodyAccess + ?Sized), _: usize, number: u32) -> u32 {
        scene.sheet().material(number)
    }

    fn partner(_: &(impl BodyAccess + ?Sized), _: usize, number: u32) -> Partner {
        Partner::Patch(number)
    }

    fn still(_: &(impl BodyAccess + ?Sized), _: usize, _: u32) -> bool {
        true
    }
}

impl Second for SheetFacets {
    fn around(
        search: &Search<'_>,
        block: usize,
        bounds: Aabb,
        row: &mut Vec<u32>,
        mut f: impl FnMut(u32, u32),
    ) {
        search.facets_near(bounds, row, |facet| f(block as u32, facet));
    }
}

/// Contact with the surface.
pub(super) struct SurfaceContactRef<'a> {
    pub body: u32,
    pub patch: u32,
    pub facet: &'a SheetFacet,
    pub touch: &'a PairContactPoint,
    pub history: &'a History,
}

/// Records for the surface owner, and in the grains' totals.
pub(super) fn add_force(
    setting: &StepContext<'_>,
    met: &SurfaceContactRef<'_>,
    f: &PairForce,
    books: &mut ContactTotals<'_>,
) {
    let PairContactPoint { geometry: g, weight, materials, .. } = met.touch;
    let force = f.force * *weight;
    let foot = met.facet.foot(&g.point);
    let couple = met.touch.couple * force.dot(&g.normal) + f.moment * *weight + foot.aside.cross(&force);
    let (velocity, spin) = met.facet.motion(&foot);
    // The moment contains the rotational part.
    let at_foot = velocity - spin.cross(&foot.aside);
    let surface = &mut *books.surface;
    surface.work += (force.dot(&at_foot) + couple.dot(&spin)) * setting.dt;
    surface.impulse.add(&foot.point, &(force * setting.dt));
    surface.impulse.angular += couple * setting.dt;
    // Dashpot part; a sliding spring holds the remaining limit.
    let (normal, tangential) = scalar::springs(setting.laws, *materials, g.overlap, g.radius, met.history);
    let sprung = (g.normal * normal - met.history.spring * tangential) * *weight;
    surface.contacts.push(SurfaceContact {
        sphere: met.touch.feature,
        body: met.body,
        patch: met.patch,
        local: foot.local,
        point: foot.point.into(),
        force: (-force).into(),
        couple: (-couple).into(),
        dashpot: (sprung - force).into(),
        overlap: g.overlap,
    });
}
