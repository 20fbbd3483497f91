//! Surfaces of patches: triangle walls, and external surfaces (deforming solid faces).

use crate::base::Vec3;

/// Feature of a closest point; edge and vertex numbers are shared by neighbouring patches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// Interior.
    Face,
    /// Edge.
    Edge(u32),
    /// Vertex.
    Vertex(u32),
}

/// Closest point of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchPoint {
    /// Position [m].
    pub point: [f64; 3],
    /// Outward unit normal.
    pub normal: [f64; 3],
    /// Surface velocity [m/s].
    pub velocity: [f64; 3],
    /// Local coordinates.
    pub local: [f64; 2],
    /// Feature.
    pub feature: Feature,
}

/// Contact with the external surface in the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceContact {
    /// Sphere of the body; with faces, the feature pair.
    pub sphere: u32,
    /// Body.
    pub body: u32,
    /// Patch.
    pub patch: u32,
    /// Local coordinates of the contact point.
    pub local: [f64; 2],
    /// Contact point [m].
    pub point: [f64; 3],
    /// Force on the surface [N].
    pub force: [f64; 3],
    /// Moment about the point [N m], nonzero for bodies with faces only.
    pub couple: [f64; 3],
    /// Dashpot part of the force [N]; in a sticky contact's first step also missing adhesion.
    pub dashpot: [f64; 3],
    /// Overlap [m].
    pub overlap: f64,
}

/// Surface in contact with grains.
pub trait Surface: Sync {
    /// Appends patches whose bounds overlap `[lo, hi]`, ascending.
    fn candidates(&self, lo: [f64; 3], hi: [f64; 3], out: &mut Vec<u32>);

    /// Closest point of `patch` to `centre`; the initial guess `local` affects rounding only.
    fn closest_point(&self, patch: u32, centre: [f64; 3], local: [f64; 2]) -> PatchPoint;

    /// Bound on the surface speed [m/s].
    fn max_speed(&self) -> f64;

    /// Returns true if grains are on the outward side only; centres below are pushed outward. Otherwise the
    /// normal points to the centre.
    fn one_sided(&self) -> bool;

    /// One-sidedness of a patch.
    fn one_sided_patch(&self, _patch: u32) -> bool {
        self.one_sided()
    }

    /// Cheap lower bound of the distance to `patch` [m], may be zero; saves [`Surface::closest_point`] calls.
    fn clearance(&self, _patch: u32, _centre: [f64; 3]) -> f64 {
        0.0
    }

    /// Prefetches data of [`Surface::closest_point`].
    fn fetch(&self, _patch: u32) {}

    /// Returns true if [`Surface::clearance`] is tight and normals inside patches are exact: distances follow
    /// them.
    fn sharp(&self) -> bool {
        false
    }

    /// Cheap coplanarity test.
    fn level(&self, _a: u32, _b: u32) -> bool {
        false
    }

    /// Foot, normal and velocity if `centre` is above the interior of a flat two-sided patch.
    fn foot(&self, _patch: u32, _centre: [f64; 3]) -> Option<[Vec3; 3]> {
        None
    }

    /// Rigid wall of a patch, below [`Surface::groups`], for force sums.
    fn group(&self, _patch: u32) -> usize {
        0
    }

    /// Number of rigid walls.
    fn groups(&self) -> usize {
        1
    }

    /// Returns true if a wall is servo-controlled.
    fn driven(&self, _group: usize) -> bool {
        false
    }

    /// Moment centre of the patch's wall [m].
    fn moment_centre(&self, _patch: u32) -> [f64; 3] {
        [0.0; 3]
    }

    /// Angular velocity of the patch's wall [rad/s].
    fn spin(&self, _patch: u32) -> Vec3 {
        Vec3::zeros()
    }

    /// Inverse mass of the patch's wall [1/kg]; zero if prescribed.
    fn inverse_mass(&self, _patch: u32) -> f64 {
        0.0
    }

    /// Position [m] and velocity [m/s] of a vertex ([`SurfaceMesh`](super::sheet::SurfaceMesh)); `None`
    /// without triangles.
    fn vertex(&self, _vertex: u32) -> Option<[Vec3; 2]> {
        None
    }

    /// Displacement [m] in the last step not contained in the velocity; shortens tangential springs.
    fn correction(&self, _patch: u32, _local: [f64; 2]) -> Option<[f64; 3]> {
        None
    }

    /// Vertex displacement likewise.
    fn vertex_correction(&self, _vertex: u32) -> Option<[f64; 3]> {
        None
    }

    /// Returns true without patches.
    fn is_empty(&self) -> bool {
        false
    }
}

/// Empty surface.
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
