//! The settled beds that are stepped.

use crate::grains;
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{Model, ModelInput, Plane, Shape, State, TimeStep, TriangleSurface, Vec3, Work};

/// A bed in a box with a floor, open at the top.
pub struct Bed {
    pub model: Model,
    pub state: State,
    pub work: Work,
}

impl Bed {
    /// 10,000 spheres.
    pub fn spheres() -> Bed {
        let input = ModelInput {
            shapes: vec![Shape::Sphere { radius: 1.0 }],
            bodies: grains::spheres("s1_10k.csv"),
            ..ModelInput::default()
        };
        Bed::at_rest(input, 0.42, 300)
    }

    /// The same spheres on a floor of 2 × 71 × 71 triangles.
    pub fn triangles() -> Bed {
        let input = ModelInput {
            shapes: vec![Shape::Sphere { radius: 1.0 }],
            bodies: grains::spheres("s1_10k.csv"),
            triangles: vec![floor(0.42, 71)],
            ..ModelInput::default()
        };
        Bed::at_rest(input, 0.42, 300)
    }

    /// 1,000 clumps of ten spheres.
    pub fn clumps() -> Bed {
        let (shape, bodies) = grains::clumps();
        Bed::at_rest(ModelInput { shapes: vec![shape], bodies, ..ModelInput::default() }, 0.4, 500)
    }

    /// `steps` build the contacts' memory up, which the tables do not hold.
    fn at_rest(mut input: ModelInput, width: f64, steps: u32) -> Bed {
        input.materials = vec![grains::stone()];
        input.time_step = TimeStep::Fixed(2e-5);
        input.planes = grains::walls(width);
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

/// A level floor over x, y in [0, width]: squares, `count` to a side, halved.
fn floor(width: f64, count: u32) -> TriangleSurface {
    let at = |k: u32| width * f64::from(k) / f64::from(count);
    let vertices = (0..=count).flat_map(|j| (0..=count).map(move |i| Vec3::new(at(i), at(j), 0.0))).collect();
    let square = |i: u32, j: u32| {
        let a = j * (count + 1) + i;
        let (b, c, d) = (a + 1, a + count + 2, a + count + 1);
        [[a, b, c], [a, c, d]]
    };
    let triangles = (0..count).flat_map(|j| (0..count).flat_map(move |i| square(i, j))).collect();
    TriangleSurface { vertices, triangles, material: 0, velocity: Vec3::zeros() }
}
