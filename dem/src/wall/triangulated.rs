//! Triangle surfaces as walls: touched from both sides, each moving as a whole with its own velocity.
//!
//! All surfaces of a model form one [`Surface`]: patches are numbered through, in the order given. The tree is
//! built once, over the vertices at the start; a query is shifted back by the way that the surface has come.

use crate::Vec3;
use crate::error::ModelError;
use crate::input::TriangleSurface;
use crate::search::bvh::{Aabb, Bvh};
use crate::shape::triangle::{self, Region};
use crate::surface::{Feature, PatchPoint, Surface};
use serde::{Deserialize, Serialize};

/// Smallest height over longest side that a triangle may have: below it its normal has no meaning.
const FLATTEST: f64 = 1e-9;

/// Where an open wall is said to be [m]: out of reach of everything.
const FAR: f64 = 1e30;

/// How far a wall has come, and where it goes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WallMotion {
    /// Displacement since the start [m].
    pub offset: Vec3,
    /// Velocity [m/s].
    pub velocity: Vec3,
    /// Whether grains pass through.
    pub open: bool,
}

#[derive(Clone, Debug)]
struct Patch {
    corners: [Vec3; 3],
    normal: Vec3,
    edges: [u32; 3],
    vertices: [u32; 3],
    surface: u32,
}

/// All triangle surfaces of a model.
#[derive(Clone, Debug, Default)]
pub struct TriangleWalls {
    patches: Vec<Patch>,
    trees: Vec<Bvh>,
    /// First patch of each surface, and one past the last.
    first: Vec<u32>,
    materials: Vec<u32>,
    velocities: Vec<Vec3>,
}

impl TriangleWalls {
    /// Numbers patches, edges and vertices, and builds the trees.
    ///
    /// # Errors
    /// A triangle that names a vertex which does not exist, has a vertex that is not finite, or no area.
    pub fn new(surfaces: &[TriangleSurface]) -> Result<TriangleWalls, ModelError> {
        let mut walls = TriangleWalls { first: vec![0], ..TriangleWalls::default() };
        let (mut edge_base, mut vertex_base) = (0_u32, 0_u32);
        for (s, surface) in surfaces.iter().enumerate() {
            let mut keys: Vec<[u32; 2]> = surface.triangles.iter().flat_map(sides).collect();
            keys.sort_unstable();
            keys.dedup();
            let mut boxes: Vec<Aabb> = Vec::with_capacity(surface.triangles.len());
            for (t, triangle) in surface.triangles.iter().enumerate() {
                let error =
                    |problem| ModelError::Wall { wall: format!("triangle {t} of surface {s}"), problem };
                if triangle.iter().any(|&v| v as usize >= surface.vertices.len()) {
                    return Err(error("it names a vertex that does not exist"));
                }
                let corners = triangle.map(|v| surface.vertices[v as usize]);
                let [a, b, c] = corners;
                let area = (b - a).cross(&(c - a));
                let longest2 = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
                if !longest2.is_finite() {
                    return Err(error("it has a vertex that is not finite"));
                }
                if area.norm() <= FLATTEST * longest2 {
                    return Err(error("it has no area"));
                }
                let number = |key: [u32; 2]| keys.partition_point(|k| *k < key) as u32 + edge_base;
                walls.patches.push(Patch {
                    corners,
                    normal: area.normalize(),
                    edges: sides(triangle).map(number),
                    vertices: triangle.map(|v| v + vertex_base),
                    surface: s as u32,
                });
                boxes.push((a.inf(&b).inf(&c).into(), a.sup(&b).sup(&c).into()));
            }
            edge_base += keys.len() as u32;
            vertex_base += surface.vertices.len() as u32;
            walls.trees.push(Bvh::new(&boxes));
            walls.first.push(walls.patches.len() as u32);
            walls.materials.push(surface.material as u32);
            walls.velocities.push(surface.velocity);
        }
        Ok(walls)
    }

    /// Motion of each surface at the start.
    pub fn motion(&self) -> Vec<WallMotion> {
        self.velocities
            .iter()
            .map(|&velocity| WallMotion { offset: Vec3::zeros(), velocity, open: false })
            .collect()
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.patches.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.patches.is_empty()
    }

    /// Material (index) of a patch.
    pub fn material(&self, patch: u32) -> u32 {
        self.materials[self.patches[patch as usize].surface as usize]
    }

    /// The walls where they are now.
    pub fn moved<'a>(&'a self, motion: &'a [WallMotion]) -> MovedWalls<'a> {
        MovedWalls { walls: self, motion }
    }
}

/// The three sides of a triangle as sorted vertex pairs.
fn sides(t: &[u32; 3]) -> [[u32; 2]; 3] {
    [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]].map(|[a, b]| [a.min(b), a.max(b)])
}

/// Triangle walls together with how far they have come.
#[derive(Clone, Copy, Debug)]
pub struct MovedWalls<'a> {
    walls: &'a TriangleWalls,
    motion: &'a [WallMotion],
}

impl Surface for MovedWalls<'_> {
    fn candidates(&self, lo: [f64; 3], hi: [f64; 3], out: &mut Vec<u32>) {
        for (s, tree) in self.walls.trees.iter().enumerate() {
            if self.motion[s].open {
                continue;
            }
            let offset = self.motion[s].offset;
            let first = out.len();
            tree.query((Vec3::from(lo) - offset).into(), (Vec3::from(hi) - offset).into(), out);
            out[first..].iter_mut().for_each(|p| *p += self.walls.first[s]);
        }
    }

    #[inline]
    fn closest_point(&self, patch: u32, centre: [f64; 3], _: [f64; 2]) -> PatchPoint {
        let patch = &self.walls.patches[patch as usize];
        let motion = &self.motion[patch.surface as usize];
        if motion.open {
            let point = (Vec3::from(centre) + Vec3::repeat(FAR)).into();
            let (normal, velocity) = (patch.normal.into(), motion.velocity.into());
            return PatchPoint { point, normal, velocity, local: [0.0; 2], feature: Feature::Face };
        }
        let [a, b, c] = &patch.corners;
        let ([v, w], region) = triangle::closest_point(a, b, c, &(Vec3::from(centre) - motion.offset));
        let point = a + (b - a) * v + (c - a) * w + motion.offset;
        let feature = match region {
            Region::Face => Feature::Face,
            Region::Edge(k) => Feature::Edge(patch.edges[k]),
            Region::Vertex(k) => Feature::Vertex(patch.vertices[k]),
        };
        PatchPoint {
            point: point.into(),
            normal: patch.normal.into(),
            velocity: motion.velocity.into(),
            local: [v, w],
            feature,
        }
    }

    fn max_speed(&self) -> f64 {
        self.motion.iter().map(|m| m.velocity.norm()).fold(0.0, f64::max)
    }

    fn one_sided(&self) -> bool {
        false
    }

    fn is_empty(&self) -> bool {
        self.walls.is_empty()
    }
}
