//! Small base scenes.

use rand_core::Rng;
use rand_pcg::Pcg64Mcg;
use trackbed_dem::shape::clump::Clump;
use trackbed_dem::shape::dilated::Dilated;
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{
    AppliedForce, BodyInput, Material, Model, ModelInput, Plane, RigidBody, Shape, State, TimeStep,
    TriangleSurface, Vec3, WallShape, Work,
};

/// Ordinary stone material.
pub fn stone() -> Material {
    Material {
        density: 2600.0,
        stiffness: 1e5,
        tangential_ratio: 0.5,
        tangential_damping_ratio: 0.0,
        friction: 0.5,
        restitution: 0.5,
        ..Material::default()
    }
}

/// Rigid counterpart of [`stone`], doubling contact stiffness.
pub fn rigid(m: Material) -> Material {
    Material { stiffness: f64::INFINITY, ..m }
}

/// Fixed plane of material 0.
pub fn plane(point: Vec3, normal: Vec3) -> Plane {
    Plane { point, normal, material: 0, velocity: Vec3::zeros() }
}

/// Block of half sides [m], rounding included, longest first.
pub fn block(half: [f64; 3], radius: f64) -> Shape {
    let core = |k: usize| Vec3::from_fn(|d, _| (half[d] - radius) * if k >> d & 1 == 1 { 1.0 } else { -1.0 });
    let corners: Vec<Vec3> = (0..8).map(core).collect();
    Shape::Polyhedron(Box::new(Dilated::new(&corners, radius).expect("a convex body").0))
}

/// Box wall of twelve triangles, half sides [m].
pub fn cuboid(centre: Vec3, half: Vec3) -> WallShape {
    let vertices = (0..8)
        .map(|k| centre + Vec3::from_fn(|d, _| if k >> d & 1 == 1 { half[d] } else { -half[d] }))
        .collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
    WallShape::Triangles { vertices, triangles }
}

/// Freely moving wall, at rest.
pub fn free(mass: f64) -> RigidBody {
    RigidBody {
        mass,
        centre: None,
        inertia: None,
        velocity: Vec3::zeros(),
        spin: Vec3::zeros(),
        fixed: [false; 6],
        mount: None,
        rounding: None,
        water: None,
        propulsion: None,
    }
}

/// Body at rest.
pub fn body(shape: usize, position: Vec3) -> BodyInput {
    BodyInput { shape, position, ..BodyInput::default() }
}

pub fn sphere(position: Vec3, velocity: Vec3) -> BodyInput {
    BodyInput { position, velocity, ..BodyInput::default() }
}

/// One material, spheres of radius 1 cm (shape 0), no gravity.
pub fn weightless(material: Material) -> ModelInput {
    ModelInput {
        materials: vec![material],
        shapes: vec![Shape::Sphere { radius: 0.01 }],
        gravity: Vec3::zeros(),
        ..ModelInput::default()
    }
}

/// Step size control by contacts.
pub const FOLLOWED: TimeStep = TimeStep::Measured { share: 0.5, longest: f64::INFINITY, collisions: false };

/// Run without an external surface.
pub struct Run {
    pub model: Model,
    pub state: State,
    pub work: Work,
}

impl Run {
    pub fn new(input: ModelInput) -> Run {
        let model = Model::new(input).expect("a good input");
        let state = State::new(&model);
        let mut work = Work::new(&model, &state);
        work.keep_forces(true);
        Run { model, state, work }
    }

    pub fn step(&mut self) {
        self.step_under(&[]);
    }

    pub fn step_under(&mut self, applied: &[AppliedForce]) {
        trackbed_dem::step(&self.model, &mut self.state, &mut self.work, &NoSurface, applied)
            .expect("a good step");
    }

    /// Step of a model that is [`FOLLOWED`].
    pub fn follow(&mut self) {
        trackbed_dem::stability::follow(&self.model, &mut self.state);
        self.step();
    }

    pub fn until(&mut self, time: f64) {
        while self.state.time < time {
            self.step();
        }
    }

    pub fn follow_until(&mut self, time: f64) {
        while self.state.time < time {
            self.follow();
        }
    }

    pub fn steps(&mut self, n: usize) {
        (0..n).for_each(|_| self.step());
    }
}

/// Random numbers in [0, 1).
pub struct Random(Pcg64Mcg);

impl Random {
    pub fn new(seed: u128) -> Random {
        Random(Pcg64Mcg::new(seed))
    }

    pub fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn vector(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - Vec3::repeat(1.0)
    }
}

/// Asymmetric clump of four spheres, about 4 cm long.
pub fn clump() -> Clump {
    Clump::from_spheres(&[
        ([0.0, 0.0, 0.0], 0.012),
        ([0.012, 0.002, 0.0], 0.010),
        ([0.006, 0.011, 0.003], 0.009),
        ([-0.008, 0.003, 0.007], 0.008),
    ])
    .expect("a connected clump")
}

/// `n`³ clumps and spheres thrown into five planes and a triangle ramp.
pub fn pile(n: usize, with_block: bool) -> ModelInput {
    let mut random = Random::new(42);
    let pitch = 0.05;
    let width = pitch * n as f64;
    let mut input = ModelInput {
        materials: vec![stone(), rigid(stone())],
        shapes: vec![
            Shape::Clump(clump()),
            Shape::Sphere { radius: 0.013 },
            Shape::Box { half: [0.4 * width, 0.2 * width, 0.03] },
        ],
        time_step: TimeStep::Auto { fraction: 0.2 },
        ..ModelInput::default()
    };
    for k in 0..n * n * n {
        let cell = Vec3::new((k % n) as f64, (k / n % n) as f64, (k / n / n) as f64);
        let turn = random.vector() * 3.0;
        input.bodies.push(BodyInput {
            shape: usize::from(k % 5 == 4),
            position: (cell + Vec3::new(0.5, 0.5, 1.1)) * pitch + random.vector() * 0.004,
            orientation: nalgebra::UnitQuaternion::from_scaled_axis(turn),
            velocity: random.vector() * 0.8,
            spin: random.vector() * 20.0,
            ..BodyInput::default()
        });
    }
    if with_block {
        let position = Vec3::new(0.5 * width, 0.5 * width, width + 0.09);
        input.bodies.push(BodyInput { shape: 2, position, ..BodyInput::default() });
    }
    let far = Vec3::repeat(width);
    for (point, normal) in [
        (Vec3::zeros(), Vec3::z()),
        (Vec3::zeros(), Vec3::x()),
        (Vec3::zeros(), Vec3::y()),
        (far, -Vec3::x()),
        (far, -Vec3::y()),
    ] {
        input.planes.push(Plane { material: 1, ..plane(point, normal) });
    }
    let (a, b) = (-0.2 * width, 1.2 * width);
    input.triangles.push(TriangleSurface {
        vertices: vec![
            Vec3::new(a, a, -0.02),
            Vec3::new(b, a, 0.01),
            Vec3::new(b, b, 0.02),
            Vec3::new(a, b, -0.01),
            Vec3::new(0.5 * width, 0.5 * width, 0.02),
        ],
        triangles: vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
        material: 1,
        velocity: Vec3::zeros(),
    });
    input
}
