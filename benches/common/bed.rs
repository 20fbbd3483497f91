//! Beds at rest.

use crate::{boxes, grains};
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{BodyInput, Material, Model, ModelInput, Plane, Shape, State, TimeStep, Vec3, Work};

/// Bed in an open box.
pub struct Bed {
    pub model: Model,
    pub state: State,
    pub work: Work,
}

impl Bed {
    /// 10,000 spheres, linear contact.
    pub fn spheres() -> Bed {
        Bed::tiled(1, grains::stone())
    }

    /// Bed tiled `n` × `n`; every second tile is mirrored, so that seams act like walls.
    pub fn tiled(n: usize, material: Material) -> Bed {
        let tile = tile();
        let place = |x: f64, k: usize| k as f64 * WIDTH + if k % 2 == 1 { WIDTH - x } else { x };
        let moved = |k: usize| {
            tile.iter().map(move |b| {
                let position =
                    Vec3::new(place(b.position.x, k % n), place(b.position.y, k / n), b.position.z);
                BodyInput { position, ..b.clone() }
            })
        };
        let bodies = (0..n * n).flat_map(moved).collect();
        Bed::at_rest(of_spheres(bodies), WIDTH * n as f64, 300, material)
    }

    /// 1,000 clumps of ten spheres.
    pub fn clumps() -> Bed {
        let (shape, bodies) = boxes::clumps(&grains::table("s2_1k.csv"));
        let input = ModelInput { shapes: vec![shape], bodies, ..ModelInput::default() };
        Bed::at_rest(input, 0.4, 500, grains::stone())
    }

    /// Rebuilds the contact history in `steps`.
    pub fn at_rest(mut input: ModelInput, width: f64, steps: u32, material: Material) -> Bed {
        input.materials = vec![material];
        if input.time_step == ModelInput::default().time_step {
            input.time_step = TimeStep::Fixed(2e-5);
        }
        input.planes = boxes::walls(width);
        if input.triangles.is_empty() {
            let floor =
                Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 0, velocity: Vec3::zeros() };
            input.planes.push(floor);
        }
        let model = Model::new(input).expect("the bed is a model");
        let state = State::new(&model);
        let work = Work::new(&model, &state);
        let mut bed = Bed { model, state, work };
        bed.advance(steps);
        bed
    }

    pub fn advance(&mut self, steps: u32) {
        for _ in 0..steps {
            trackbed_dem::step(&self.model, &mut self.state, &mut self.work, &NoSurface, &[])
                .expect("a settled bed stays settled");
        }
    }
}

/// Bed width [m].
pub const WIDTH: f64 = 0.42;

/// 10,000 spheres.
pub fn tile() -> Vec<BodyInput> {
    grains::spheres(&grains::table("s1_10k.csv"))
}

pub fn of_spheres(bodies: Vec<BodyInput>) -> ModelInput {
    ModelInput { shapes: vec![Shape::Sphere { radius: 1.0 }], bodies, ..ModelInput::default() }
}
