//! Surfaces made of patches: triangle walls of this crate, and surfaces that another crate owns and moves
//! (the deformed faces of a solid). One mechanism serves both.

use crate::base::Vec3;

/// What of its patch a closest point lies on. Edge and vertex numbers are unique within the surface and shared
/// by neighbouring patches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// The inside of the patch.
    Face,
    /// An edge.
    Edge(u32),
    /// A vertex.
    Vertex(u32),
}

/// The point of a patch that is closest to a given one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchPoint {
    /// The closest point [m].
    pub point: [f64; 3],
    /// Outward unit normal of the patch there.
    pub normal: [f64; 3],
    /// Velocity of the surface there [m/s].
    pub velocity: [f64; 3],
    /// The patch's own coordinates of the point.
    pub local: [f64; 2],
    /// Where on the patch it lies.
    pub feature: Feature,
}

/// A contact with the external surface in the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceContact {
    /// Sphere of the body, from 0; of a body with faces what of it and of the patch touch.
    pub sphere: u32,
    /// Body.
    pub body: u32,
    /// Patch of the surface.
    pub patch: u32,
    /// Patch coordinates of the contact point.
    pub local: [f64; 2],
    /// Contact point [m].
    pub point: [f64; 3],
    /// Force on the surface [N].
    pub force: [f64; 3],
    /// Moment on the surface about the point [N m]: none of spheres; of bodies with faces, whose force acts a little beside it.
    pub couple: [f64; 3],
    /// The part of it that the contact's dashpots make [N]; in the first step of a sticky contact also what its adhesion
    /// lacks yet.
    pub dashpot: [f64; 3],
    /// Overlap [m].
    pub overlap: f64,
}

/// A surface that grains may touch.
pub trait Surface: Sync {
    /// Appends the patches whose bounding box meets the box `[lo, hi]` to `out`, in ascending order.
    fn candidates(&self, lo: [f64; 3], hi: [f64; 3], out: &mut Vec<u32>);

    /// Closest point of `patch` to `centre`. `local` is a start for iterations, usually the result of the step
    /// before; it must not change the result beyond rounding.
    fn closest_point(&self, patch: u32, centre: [f64; 3], local: [f64; 2]) -> PatchPoint;

    /// Bound on the speed of any point of the surface [m/s].
    fn max_speed(&self) -> f64;

    /// Whether grains are on the outward side only: their centres may then lie below the surface and are still
    /// pushed outward. Otherwise the normal points from the closest point to the centre.
    fn one_sided(&self) -> bool;

    /// Whether one patch is one-sided; as the whole surface unless it says otherwise.
    fn one_sided_patch(&self, _patch: u32) -> bool {
        self.one_sided()
    }

    /// A lower bound of the distance from `centre` to `patch` [m], finite, found without a search: it spares most calls
    /// of [`Surface::closest_point`]. Zero tells nothing.
    fn clearance(&self, _patch: u32, _centre: [f64; 3]) -> f64 {
        0.0
    }

    /// Has the processor fetch what [`Surface::closest_point`] will read of a patch.
    fn fetch(&self, _patch: u32) {}

    /// Whether [`Surface::clearance`] is near enough to the truth for lists, and normals inside a patch are exact: the
    /// distance is then measured along them.
    fn sharp(&self) -> bool {
        false
    }

    /// Whether two patches lie in one plane, stated without a search.
    fn level(&self, _a: u32, _b: u32) -> bool {
        false
    }

    /// Of a flat patch with two sides, stated without a search: where `centre` stands above its inside, the normal, and the
    /// velocity there. `None` tells nothing.
    fn foot(&self, _patch: u32, _centre: [f64; 3]) -> Option<[Vec3; 3]> {
        None
    }

    /// Rigid wall that a patch belongs to, below [`Surface::groups`]; forces are summed for each.
    fn group(&self, _patch: u32) -> usize {
        0
    }

    /// Number of rigid walls.
    fn groups(&self) -> usize {
        1
    }

    /// Whether the forces on a rigid wall set its speed.
    fn driven(&self, _group: usize) -> bool {
        false
    }

    /// Point that moments on the patch's wall refer to [m].
    fn moment_centre(&self, _patch: u32) -> [f64; 3] {
        [0.0; 3]
    }

    /// Angular velocity of the patch's wall [rad/s].
    fn spin(&self, _patch: u32) -> Vec3 {
        Vec3::zeros()
    }

    /// One over the mass of the patch's wall [1/kg]; zero where its motion is prescribed.
    fn inverse_mass(&self, _patch: u32) -> f64 {
        0.0
    }

    /// Place [m] and velocity [m/s] of a vertex, as the model numbers them ([`SurfaceMesh`](super::sheet::SurfaceMesh)); `None` where the
    /// surface is not made of triangles.
    fn vertex(&self, _vertex: u32) -> Option<[Vec3; 2]> {
        None
    }

    /// Displacement [m] of a point of `patch` since the last step that its velocity does not contain: tangential springs are shortened by it.
    /// `None` where velocities tell the whole motion.
    fn correction(&self, _patch: u32, _local: [f64; 2]) -> Option<[f64; 3]> {
        None
    }

    /// The same of a vertex.
    fn vertex_correction(&self, _vertex: u32) -> Option<[f64; 3]> {
        None
    }

    /// Whether there is nothing to touch.
    fn is_empty(&self) -> bool {
        false
    }
}

/// No surface at all.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoSurface;

impl Surface for NoSurface {
    fn candidates(&self, _: [f64; 3], _: [f64; 3], _: &mut Vec<u32>) {}

    fn closest_point(&self, _: u32, centre: [f64; 3], local: [f64; 2]) -> PatchPoint {
        let (normal, velocity) = ([0.0, 0.0, 1.0], [0.0; 3]);
        PatchPoint { point: centre, normal, velocity, local, feature: Feature::Face }
    }

    fn max_speed(&self) -> f64 {
        0.0
    }

    fn one_sided(&self) -> bool {
        false
    }

    fn is_empty(&self) -> bool {
        true
    }
}
