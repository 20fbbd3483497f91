//! Common blocks, spheres and quasi-static solutions.

use trackbed_coupling::step;
use trackbed_coupling::surface::SolidSurface;
use trackbed_coupling::transfer::{Transfer, TransferAudit};
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_dem::surface::{Surface, SurfaceContact};
use trackbed_fem as fem;
use trackbed_fem::{Constraint, Mesh};

/// Constraints of a block.
#[derive(Clone, Copy, PartialEq)]
pub enum Held {
    /// Clamped base.
    Base,
    /// Clamped base, rollers on four sides.
    BaseAndSides,
    /// Unconstrained.
    Free,
}

/// Block B: 1 × 1 × 0.5 m, top at z = 0, E = 20 MPa, ν = 0.3, m × m × m/2 elements, full integration.
pub fn block_b(m: usize, held: Held, rayleigh: fem::Rayleigh) -> fem::Model {
    block([m, m, m / 2], [1.0, 1.0, 0.5], 20e6, 0.3, 2000.0, held, rayleigh)
}

/// Block with its top at z = 0 and a base corner at x = y = 0.
pub fn block(
    counts: [usize; 3],
    size: [f64; 3],
    young: f64,
    poisson: f64,
    density: f64,
    held: Held,
    rayleigh: fem::Rayleigh,
) -> fem::Model {
    let mut mesh = Mesh::block(counts, size);
    for x in &mut mesh.coordinates {
        x[2] -= size[2];
    }
    model(mesh, size, young, poisson, density, held, rayleigh)
}

pub fn model(
    mesh: Mesh,
    size: [f64; 3],
    young: f64,
    poisson: f64,
    density: f64,
    held: Held,
    rayleigh: fem::Rayleigh,
) -> fem::Model {
    let mut constraints = Vec::new();
    for (n, x) in mesh.coordinates.iter().enumerate() {
        let mut hold = |direction: u8| constraints.push(Constraint { node: n as u32, direction, value: 0.0 });
        let base = (x[2] + size[2]).abs() < 1e-9;
        if base && held != Held::Free {
            (0..3).for_each(&mut hold);
        } else if held == Held::BaseAndSides {
            for d in 0..2 {
                if x[d].abs() < 1e-9 || (x[d] - size[d]).abs() < 1e-9 {
                    hold(d as u8);
                }
            }
        }
    }
    fem::Model::new(fem::ModelInput {
        mesh,
        materials: [(1, fem::Elastic { young, poisson, density }.into())].into(),
        quadrature: fem::Quadrature::Gauss3,
        constraints,
        gravity: [0.0; 3],
        rayleigh,
        ..Default::default()
    })
    .expect("a valid block")
}

pub fn top(model: &fem::Model) -> SolidSurface {
    SolidSurface::new(model.mesh(), SolidSurface::facing(model.mesh(), [0.0, 0.0, 1.0], 0.3))
}

/// Contact of a sphere at `centre` with the nearest patch.
pub fn contact(surface: &SolidSurface, centre: [f64; 3], force: [f64; 3]) -> SurfaceContact {
    let mut patches = Vec::new();
    surface.candidates(centre.map(|c| c - 0.2), centre.map(|c| c + 0.2), &mut patches);
    let distance = |p: [f64; 3]| (0..3).map(|d| (p[d] - centre[d]).powi(2)).sum::<f64>();
    let nearest = patches
        .iter()
        .map(|&patch| (patch, surface.closest_point(patch, centre, [0.0; 2])))
        .min_by(|a, b| distance(a.1.point).total_cmp(&distance(b.1.point)))
        .expect("a patch within 0.2 m");
    SurfaceContact {
        sphere: 0,
        body: 0,
        patch: nearest.0,
        local: nearest.1.local,
        point: nearest.1.point,
        force,
        dashpot: [0.0; 3],
        couple: [0.0; 3],
        overlap: 0.0,
    }
}

/// Nodal load, shape `[3·nodes]`, and its audit.
pub fn nodal_load(
    model: &fem::Model,
    surface: &SolidSurface,
    contacts: &[SurfaceContact],
) -> (Vec<f64>, TransferAudit) {
    let mut transfer = Transfer::new(surface);
    let mut audit = TransferAudit::default();
    let mut load = vec![0.0; model.dof_count()];
    transfer.add(surface, contacts, 1.0, &mut audit);
    transfer.add_mean_load(surface, 1.0, &mut load);
    (load, audit)
}

/// Vertical displacement at a contact [m].
pub fn deflection(surface: &SolidSurface, contact: &SurfaceContact, u: &[f64]) -> f64 {
    let n = surface.shape_functions(contact.patch, contact.local);
    surface
        .face_nodes(contact.patch)
        .iter()
        .zip(n)
        .map(|(&k, n)| n * u[3 * surface.nodes()[k as usize] as usize + 2])
        .sum()
}

/// Mean vertical displacement of the top [m].
pub fn mean_top(model: &fem::Model, surface: &SolidSurface, u: &[f64]) -> f64 {
    let mut weights = vec![0.0; model.dof_count()];
    for face in surface.faces() {
        fem::loads::face_traction(model.mesh(), face, [0.0, 0.0, 1.0], &mut weights);
    }
    let area: f64 = weights.iter().sum();
    weights.iter().zip(u).map(|(w, u)| w * u).sum::<f64>() / area
}

/// Contact stiffness [N/m], friction, restitution.
pub fn material(density: f64, stiffness: f64, friction: f64, restitution: f64) -> dem::Material {
    dem::Material {
        density,
        stiffness,
        tangential_ratio: 0.5,
        tangential_damping_ratio: 0.0,
        friction,
        restitution,
        ..dem::Material::default()
    }
}

/// Coupled system at rest, undeformed.
pub struct Coupled<'a> {
    pub model: step::Model<'a>,
    pub state: step::State,
    pub work: step::Work,
}

impl<'a> Coupled<'a> {
    pub fn new(solid: &'a fem::Model, grains: dem::ModelInput, substeps: u32) -> Coupled<'a> {
        Coupled::with_surface(solid, grains, substeps, top(solid))
    }

    pub fn with_surface(
        solid: &'a fem::Model,
        grains: dem::ModelInput,
        substeps: u32,
        surface: SolidSurface,
    ) -> Coupled<'a> {
        let n = solid.dof_count();
        let model = step::Model {
            solid,
            grains: dem::Model::new(grains).expect("valid grains"),
            substeps,
            division: 1,
            scheme: Default::default(),
            theta: 0.5,
            newton: Default::default(),
            dead_load: vec![0.0; n],
            reference: vec![0.0; n],
        };
        let state = step::State::new(fem::State::new(solid), dem::State::new(&model.grains));
        let work = step::Work::new(&model, &state, surface).expect("a solid that can be factored");
        Coupled { model, state, work }
    }

    pub fn step(&mut self, applied: &[(usize, [f64; 3])]) {
        self.step_loaded(applied, |_, _| {});
    }

    pub fn step_loaded(&mut self, applied: &[(usize, [f64; 3])], load: impl Fn(f64, &mut [f64])) {
        step::step(
            &self.model,
            &mut self.state,
            &mut self.work,
            |_, grains, out| {
                out.extend(applied.iter().map(|&(body, force)| dem::AppliedForce {
                    body,
                    force: Vec3::from(force),
                    point: grains.position(body),
                }));
            },
            load,
        )
        .expect("a step without failure");
    }
}

/// SplitMix64 (Steele, Lea and Flood 2014).
pub struct Scatter(u64);

impl Scatter {
    pub fn new(seed: u64) -> Scatter {
        Scatter(seed)
    }

    /// Uniform in [−1, 1).
    pub fn symmetric(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Layers of 6 × 6 spheres on block B below a sleeper of 120 kg (body 0).
pub fn sleeper_on_a_bed(layers: u32, dt: f64) -> dem::ModelInput {
    let side = |at: f64, normal: Vec3| dem::Plane {
        point: Vec3::new(at, at, 0.0),
        normal,
        material: 0,
        velocity: Vec3::zeros(),
    };
    let mut random = Scatter::new(5);
    let mut bodies = vec![dem::BodyInput {
        shape: 1,
        position: Vec3::new(0.5, 0.5, 0.05 + 0.17 * f64::from(layers)),
        mass: Some(120.0),
        ..Default::default()
    }];
    bodies.extend((0..36 * layers).map(|k| {
        let at = [k % 6, k / 6 % 6, k / 36].map(|i| f64::from(i) * 0.164 + 0.09);
        let place = Vec3::from(at.map(|c| c + 0.001 * random.symmetric()));
        dem::BodyInput { position: place, ..Default::default() }
    }));
    let stone = dem::Material { tangential_damping_ratio: 0.5, ..material(2650.0, 2e5, 0.5, 0.3) };
    dem::ModelInput {
        materials: vec![stone],
        shapes: vec![dem::Shape::Sphere { radius: 0.08 }, dem::Shape::Box { half: [0.4, 0.15, 0.05] }],
        bodies,
        planes: vec![
            side(0.0, Vec3::x()),
            side(1.0, -Vec3::x()),
            side(0.0, Vec3::y()),
            side(1.0, -Vec3::y()),
        ],
        surface_material: Some(0),
        time_step: dem::TimeStep::Fixed(dt),
        ..Default::default()
    }
}
