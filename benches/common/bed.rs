//! The settled beds that are stepped.

use crate::grains;
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{
    BodyInput, Material, Model, ModelInput, Plane, Shape, State, TimeStep, TriangleSurface, Vec3, Work,
};

/// A bed in a box with a floor, open at the top.
pub struct Bed {
    pub model: Model,
    pub state: State,
    pub work: Work,
}

impl Bed {
    /// 10,000 spheres with linear contact.
    pub fn spheres() -> Bed {
        Bed::tiled(1, grains::stone())
    }

    /// The bed of 10,000 spheres `n` × `n` times side by side, of one material; every other one is a mirror image, so
    /// that spheres at the seams have what the wall was to them.
    #[allow(dead_code)] // Not every benchmark uses every bed.
    pub fn tiled(n: usize, material: Material) -> Bed {
        let tile = grains::spheres("s1_10k.csv");
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

    /// A cube of about `count` spheres cut from the bed, settled anew.
    #[allow(dead_code)]
    pub fn cut(count: usize) -> Bed {
        let tile = grains::spheres("s1_10k.csv");
        let side = WIDTH * (count as f64 / tile.len() as f64).cbrt();
        let inside = |b: &BodyInput| b.position.iter().all(|&x| x + b.scale < side);
        Bed::at_rest(of_spheres(tile.into_iter().filter(inside).collect()), side, 20_000, grains::stone())
    }

    /// Spheres 20 times smaller in the pores between those of a cube cut from the bed: about 80 of them per large one.
    #[allow(dead_code)]
    pub fn two_sizes() -> Bed {
        let side = 0.06;
        let mut bodies: Vec<_> = grains::spheres("s1_10k.csv")
            .into_iter()
            .filter(|b| b.position.iter().all(|&x| x + b.scale < side))
            .collect();
        let large = bodies.clone();
        let r = 0.0005;
        // Simple cubic, just touching: like a packed bed it has close to six neighbours.
        let n = (side / (2.0 * r)) as usize;
        for k in 0..n * n * n {
            let place = [k % n, k / n % n, k / n / n].map(|c| (c as f64 + 0.5) * (2.0 * r - 1e-8));
            let position = Vec3::from(place);
            if large.iter().all(|b| (b.position - position).norm() > b.scale + r) {
                bodies.push(BodyInput { position, scale: r, ..BodyInput::default() });
            }
        }
        // The step of the small ones.
        let mut input = of_spheres(bodies);
        input.time_step = TimeStep::Auto { fraction: 0.2 };
        Bed::at_rest(input, side, 300, grains::stone())
    }

    /// The same spheres on a floor of 2 × 71 × 71 triangles.
    #[allow(dead_code)]
    pub fn triangles() -> Bed {
        let input =
            ModelInput { triangles: vec![floor(WIDTH, 71)], ..of_spheres(grains::spheres("s1_10k.csv")) };
        Bed::at_rest(input, WIDTH, 300, grains::stone())
    }

    /// 1,000 clumps of ten spheres.
    pub fn clumps() -> Bed {
        let (shape, bodies) = grains::clumps();
        let input = ModelInput { shapes: vec![shape], bodies, ..ModelInput::default() };
        Bed::at_rest(input, 0.4, 500, grains::stone())
    }

    /// `steps` build the contacts' memory up, which the tables do not hold.
    fn at_rest(mut input: ModelInput, width: f64, steps: u32, material: Material) -> Bed {
        input.materials = vec![material];
        if input.time_step == ModelInput::default().time_step {
            input.time_step = TimeStep::Fixed(2e-5);
        }
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

/// Width of the bed of 10,000 spheres [m].
const WIDTH: f64 = 0.42;

fn of_spheres(bodies: Vec<BodyInput>) -> ModelInput {
    ModelInput { shapes: vec![Shape::Sphere { radius: 1.0 }], bodies, ..ModelInput::default() }
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
