//! Critical time step by contacts (`trackbed_dem::stability`) against the engine's own stability limit.
//!
//! A settled bed and a copy disturbed by 1e-13 take 100 steps: below the limit the difference does not grow,
//! 2 % above it grows a thousandfold. The estimate assumes sticking contacts, so it must be slightly lower.

use crate::scene::{Random, clump, plane, rigid, stone};
use nalgebra::UnitQuaternion;
use trackbed_dem::bond::{Bond, BondDamping, Criterion, ParallelBond, ParallelStiffness, ShearStrength};
use trackbed_dem::shape::clump::Clump;
use trackbed_dem::surface::{Feature, NoSurface, PatchPoint, Surface};
use trackbed_dem::{
    BodyInput, Material, Model, ModelInput, Plane, Shape, State, TimeStep, TriangleSurface, Vec3, Work, bond,
    measure, stability,
};

struct Level;

impl Surface for Level {
    fn candidates(&self, lo: [f64; 3], _: [f64; 3], out: &mut Vec<u32>) {
        if lo[2] <= 0.0 {
            out.push(0);
        }
    }

    fn closest_point(&self, _: u32, centre: [f64; 3], _: [f64; 2]) -> PatchPoint {
        let [x, y, _] = centre;
        PatchPoint {
            point: [x, y, 0.0],
            normal: [0.0, 0.0, 1.0],
            velocity: [0.0; 3],
            local: [0.0; 2],
            feature: Feature::Face,
        }
    }

    fn max_speed(&self) -> f64 {
        0.0
    }

    fn one_sided(&self) -> bool {
        true
    }
}

const WIDTH: f64 = 0.2;

fn bed(shapes: Vec<Shape>, sizes: impl Fn(f64) -> f64, material: Material, reach: f64) -> ModelInput {
    let mut random = Random::new(7);
    let mut input = ModelInput {
        materials: vec![material, rigid(material)],
        shapes,
        time_step: TimeStep::Measured { share: 0.8, longest: f64::INFINITY, collisions: true },
        ..ModelInput::default()
    };
    let pitch = 2.05 * reach;
    let n = (WIDTH / pitch) as usize;
    for k in 0..n * n * n {
        let cell = Vec3::new((k % n) as f64, (k / n % n) as f64, (k / n / n) as f64);
        input.bodies.push(BodyInput {
            shape: k % input.shapes.len(),
            position: (cell + Vec3::repeat(0.5)) * (WIDTH / n as f64),
            orientation: UnitQuaternion::from_scaled_axis(random.vector() * 3.0),
            velocity: random.vector() * 0.2,
            scale: sizes(random.unit()),
            ..BodyInput::default()
        });
    }
    let far = Vec3::repeat(WIDTH);
    for (point, normal) in [
        (Vec3::zeros(), Vec3::z()),
        (Vec3::zeros(), Vec3::x()),
        (Vec3::zeros(), Vec3::y()),
        (far, -Vec3::x()),
        (far, -Vec3::y()),
    ] {
        input.planes.push(Plane { material: 1, ..plane(point, normal) });
    }
    input
}

fn same(_: f64) -> f64 {
    1.0
}

struct Bed<S> {
    model: Model,
    state: State,
    surface: S,
}

impl<S: Surface> Bed<S> {
    fn settled(input: ModelInput, surface: S, seconds: f64) -> Bed<S> {
        let model = Model::new(input).expect("a good input");
        let mut state = State::new(&model);
        let mut work = Work::new(&model, &state);
        while state.time < seconds {
            stability::follow(&model, &mut state);
            trackbed_dem::step(&model, &mut state, &mut work, &surface, &[]).expect("a good step");
        }
        Bed { model, state, surface }
    }

    /// Growth factor of a disturbance over steps of `dt`.
    fn growth(&self, dt: f64) -> f64 {
        let (mut calm, mut other) = (self.state.clone(), self.state.clone());
        let mut random = Random::new(3);
        for body in 0..self.model.body_count() {
            let push = |random: &mut Random| random.vector() * 1e-15;
            let (v, w) =
                (other.velocity(body) + push(&mut random), other.spin(body) + push(&mut random) * 100.0);
            other.set_velocity(&self.model, body, v, w);
        }
        let differ = |a: &State, b: &State| {
            let bodies = 0..self.model.body_count();
            bodies.map(|k| (a.velocity(k) - b.velocity(k)).norm_squared()).sum::<f64>().sqrt()
        };
        let start = differ(&calm, &other);
        for state in [&mut calm, &mut other] {
            state.set_dt(dt);
            let mut work = Work::new(&self.model, state);
            for _ in 0..100 {
                if trackbed_dem::step(&self.model, state, &mut work, &self.surface, &[]).is_err() {
                    return f64::INFINITY;
                }
            }
        }
        differ(&calm, &other) / start
    }

    fn true_limit(&self) -> f64 {
        let found = stability::limit(&self.model, &self.state);
        let (mut low, mut high) = (0.3 * found, 4.0 * found);
        assert!(self.growth(low) < 1e3 && self.growth(high) > 1e3);
        while high > 1.01 * low {
            let middle = (low * high).sqrt();
            if self.growth(middle) < 1e3 { low = middle } else { high = middle }
        }
        low
    }

    fn compare(&self, name: &str) {
        let (found, truth) = (stability::limit(&self.model, &self.state), self.true_limit());
        let moving = measure::energies(&self.model, &self.state).kinetic();
        println!(
            "{name}: {} bodies, coordination {:.2}, kinetic energy {moving:.1e} J: limit {found:.3e} s, true {truth:.3e} s, \
             ratio {:.3}; before contacts {:.3e} s ({:.3}); longest {:.3e} s, step {:.3e} s",
            self.model.body_count(),
            measure::coordination(&self.model, &self.state),
            found / truth,
            self.model.dt_limit().dt,
            self.model.dt_limit().dt / truth,
            self.model.longest(true),
            self.state.dt()
        );
        assert!(found <= truth, "{name}: {found} above {truth}");
        assert!(found >= 0.6 * truth, "{name}: {found} far below {truth}");
        assert!(self.state.dt() <= found);
    }
}

fn clumps() -> Vec<Shape> {
    let stone = clump().scaled(0.7);
    let flat = [([-0.008, 0.0, 0.0], 0.006), ([0.0, 0.004, 0.0], 0.007), ([0.009, 0.0, 0.001], 0.005)];
    vec![Shape::Clump(stone), Shape::Clump(Clump::from_spheres(&flat).expect("one piece"))]
}

fn balls() -> Vec<Shape> {
    vec![Shape::Sphere { radius: 0.012 }]
}

#[test]
fn spheres() {
    for (restitution, tangential_damping_ratio) in [(0.5, 0.0), (0.3, 1.0), (0.9, 1.0)] {
        let material = Material { restitution, tangential_damping_ratio, ..stone() };
        let input = bed(balls(), |x| 0.8 + 0.4 * x, material, 0.015);
        Bed::settled(input, NoSurface, 1.0).compare(&format!("spheres, e = {restitution}"));
    }
}

#[test]
fn spheres_that_roll_hard() {
    let material = Material { rolling_friction: 0.2, twisting_friction: 0.1, ..stone() };
    Bed::settled(bed(balls(), same, material, 0.013), NoSurface, 1.0).compare("rolling resistance");
}

#[test]
fn hertzian_spheres() {
    let material = Material { young: Some(2e7), poisson: 0.2, stiffness: f64::INFINITY, ..stone() };
    Bed::settled(bed(balls(), same, material, 0.013), NoSurface, 1.0).compare("spheres, Hertz");
}

#[test]
fn ballast_of_clumps() {
    Bed::settled(bed(clumps(), same, stone(), 0.02), NoSurface, 1.0).compare("clumps");
}

#[test]
fn sizes_of_one_to_twenty() {
    let shapes = vec![Shape::Sphere { radius: 0.001 }];
    let sizes = |x: f64| if x < 0.5 { 20.0 } else { 1.0 + 4.0 * (x - 0.5) };
    // Resistance stops rolling: changing contacts have no limit to compare with.
    let material = Material { rolling_friction: 0.2, ..stone() };
    Bed::settled(bed(shapes, sizes, material, 0.021), NoSurface, 3.0).compare("sizes 1:20");
}

#[test]
fn beside_a_sleeper() {
    let mut input = bed(balls(), same, stone(), 0.013);
    input.shapes.push(Shape::Box { half: [0.08, 0.04, 0.03] });
    let position = Vec3::new(0.5 * WIDTH, 0.5 * WIDTH, WIDTH + 0.05);
    input.bodies.push(BodyInput { shape: 1, position, ..BodyInput::default() });
    Bed::settled(input, NoSurface, 1.2).compare("spheres under a sleeper");
}

#[test]
fn on_an_external_surface() {
    let mut input = bed(clumps(), same, stone(), 0.02);
    input.planes.remove(0);
    input.surface_material = Some(1);
    Bed::settled(input, Level, 1.0).compare("clumps on a surface");
}

#[test]
fn on_triangles() {
    let mut input = bed(clumps(), same, stone(), 0.02);
    input.planes.remove(0);
    let (a, b) = (-0.1 * WIDTH, 1.1 * WIDTH);
    let corner = |x, y, z| Vec3::new(x, y, z);
    input.triangles.push(TriangleSurface {
        vertices: vec![corner(a, a, 0.01), corner(b, a, 0.0), corner(b, b, 0.01), corner(a, b, 0.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        material: 1,
        velocity: Vec3::zeros(),
    });
    Bed::settled(input, NoSurface, 1.0).compare("clumps on triangles");
}

#[test]
fn bonded_stones() {
    for damping in [BondDamping::None, BondDamping::Fraction(0.2)] {
        let mut input = bed(vec![Shape::Sphere { radius: 0.01 }], same, stone(), 0.0102);
        input.bodies.iter_mut().for_each(|b| b.velocity = Vec3::zeros());
        input.bond_kinds.push(Bond::Parallel(ParallelBond {
            radius_factor: 0.8,
            stiffness: ParallelStiffness::Modulus { young: 1e8, ratio: 2.5 },
            tensile_strength: f64::INFINITY,
            shear_strength: ShearStrength::Constant(f64::INFINITY),
            moment_factor: 1.0,
            criterion: Criterion::Stress,
            damping,
            contact: false,
        }));
        let spheres: Vec<(Vec3, f64)> = input.bodies.iter().map(|b| (b.position, 0.01)).collect();
        // Stones of 2 × 2 × 2 cells.
        let n = (WIDTH / (2.05 * 0.0102)) as usize;
        let stone_of = |k: usize| (k % n / 2, k / n % n / 2, k / n / n / 2);
        let pairs = bond::within_gap(&spheres, 0.004, |a, b| stone_of(a) == stone_of(b));
        input.bonds = pairs.iter().map(|[a, b]| bond::BondInput::new(*a, *b, 0)).collect();
        assert!(input.bonds.len() > 200, "{}", input.bonds.len());
        Bed::settled(input, NoSurface, 0.6).compare(&format!("bonded stones, {damping:?}"));
    }
}

#[test]
fn step_growth_is_limited() {
    let model = Model::new(bed(balls(), same, stone(), 0.02)).expect("a good input");
    let mut state = State::new(&model);
    let mut work = Work::new(&model, &state);
    let mut grown = 0;
    while state.time < 0.2 {
        let before = state.dt();
        if stability::follow(&model, &mut state) {
            let factor = state.dt() / before;
            assert!(factor <= 1.25 * (1.0 + 1e-12), "from {before:e} s by {factor} at {} s", state.time);
            grown += usize::from(factor > 1.05);
        }
        trackbed_dem::step(&model, &mut state, &mut work, &NoSurface, &[]).expect("a good step");
    }
    assert!(grown >= 3, "{grown}");
}

#[test]
fn steps_of_changing_length() {
    let mut errors = Vec::new();
    for changing in [false, true] {
        let input =
            ModelInput { time_step: TimeStep::Auto { fraction: 0.3 }, ..bed(clumps(), same, stone(), 0.02) };
        let model = Model::new(input).expect("a good input");
        let mut state = State::new(&model);
        let mut work = Work::new(&model, &state);
        let total =
            |s: &State| measure::energies(&model, s).total() + s.balance.dissipated() - s.balance.work();
        let (start, before) = (total(&state), measure::momentum(&model, &state));
        while state.time < 0.15 {
            if changing && state.steps.is_multiple_of(50) {
                let longer = state.steps.is_multiple_of(100);
                state.set_dt(model.dt() * if longer { 1.2 } else { 0.8 });
            }
            trackbed_dem::step(&model, &mut state, &mut work, &NoSurface, &[]).expect("a good step");
        }
        let (after, impulse) = (measure::momentum(&model, &state), state.balance.impulse());
        let gravity = state.balance.gravity.linear.norm();
        let linear = (after.linear - before.linear - impulse.linear).norm() / gravity;
        let angular = (after.angular - before.angular - impulse.angular).norm() / gravity / WIDTH;
        assert!(linear < 1e-11 && angular < 1e-11, "{linear:e} {angular:e}");
        errors.push((total(&state) - start).abs() / state.balance.dissipated());
    }
    println!("energy error with equal steps {:.2e}, with changing ones {:.2e}", errors[0], errors[1]);
    assert!(errors[1] < 3.0 * errors[0] + 1e-4, "{errors:?}");
}

#[test]
fn restitution_at_automatic_step() {
    for given in [0.3, 0.5, 0.7, 0.9] {
        let (mut sum, mut worst) = (0.0, 0.0_f64);
        for k in 0..64 {
            let mut input =
                crate::scene::weightless(Material { restitution: given, friction: 0.0, ..stone() });
            input.time_step = TimeStep::Measured { share: 0.8, longest: f64::INFINITY, collisions: true };
            input.planes.push(plane(Vec3::zeros(), Vec3::z()));
            let height = 0.0101 + 1e-6 * f64::from(k);
            input.bodies.push(crate::scene::sphere(Vec3::z() * height, -Vec3::z()));
            let model = Model::new(input).expect("a good input");
            let mut state = State::new(&model);
            let mut work = Work::new(&model, &state);
            while state.position(0).z < 0.0102 {
                stability::follow(&model, &mut state);
                trackbed_dem::step(&model, &mut state, &mut work, &NoSurface, &[]).expect("a good step");
            }
            let found = state.velocity(0).z;
            sum += found / 64.0;
            worst = worst.max((found - given).abs());
        }
        println!("restitution {given}: mean {sum:.4}, largest difference {worst:.4}");
        assert!((sum / given - 1.0).abs() < 0.01, "{given}: {sum}");
        assert!(worst < 0.025 * given, "{given}: {worst}");
    }
}

#[test]
fn an_elastic_gas_does_not_heat() {
    let material = Material { restitution: 1.0, friction: 0.0, ..stone() };
    let mut input = bed(vec![Shape::Sphere { radius: 0.01 }], same, material, 0.02);
    input.gravity = Vec3::zeros();
    input.planes.push(Plane { material: 1, ..plane(Vec3::repeat(WIDTH), -Vec3::z()) });
    let model = Model::new(input).expect("a good input");
    let mut state = State::new(&model);
    let mut work = Work::new(&model, &state);
    let start = measure::energies(&model, &state).total();
    while state.time < 10.0 {
        stability::follow(&model, &mut state);
        trackbed_dem::step(&model, &mut state, &mut work, &NoSurface, &[]).expect("a good step");
    }
    let change = measure::energies(&model, &state).total() / start - 1.0;
    println!("{} elastic spheres: {} steps, energy {change:+.2e}", model.body_count(), state.steps);
    assert!(change.abs() < 1e-3, "{change}");
}

/// With K = Kₜ and 1/I = 5/(2 m r²), ω² in K/m: 1 normal; 1 + 5/2 tangential; 5/2 rotation; with a rolling
/// spring Kₜ r² the larger root of λ² − 6 λ + 5/2; twisting 5/2.
#[test]
fn limit_on_plane_matches_closed_form() {
    let (free, held) = (false, true);
    for (name, fixed, rolling, twisting, expected) in [
        ("free", [free; 6], 0.0, 0.0, 3.5),
        ("rolling resistance", [free; 6], 0.1, 0.0, 3.0 + 6.5_f64.sqrt()),
        ("twisting resistance", [free; 6], 0.0, 0.1, 3.5),
        ("held along the plane", [held, held, free, free, free, free], 0.0, 0.0, 2.5),
        ("kept from turning", [free, free, free, held, held, held], 0.1, 0.1, 1.0),
    ] {
        let mut input = crate::scene::weightless(Material {
            tangential_ratio: 1.0,
            restitution: 1.0,
            rolling_friction: rolling,
            twisting_friction: twisting,
            ..stone()
        });
        input.planes.push(plane(Vec3::zeros(), Vec3::z()));
        let place = Vec3::z() * (0.01 - 1e-7);
        input.bodies.push(BodyInput { fixed, ..crate::scene::sphere(place, Vec3::zeros()) });
        let model = Model::new(input).expect("a good input");
        let mut state = State::new(&model);
        let mut work = Work::new(&model, &state);
        trackbed_dem::find_contacts(&model, &mut state, &mut work, &NoSurface).expect("contacts");
        let exact = 2.0 / (expected * stone().stiffness / model.mass(0)).sqrt();
        let share = stability::limit(&model, &state) / exact;
        println!("{name}: {share:.4} of the closed form");
        assert!(share <= 1.0 && share > 0.99, "{name}: {share}");
    }
}

/// Two planes (Hertz) double the overlap and reduce the limit by a sixth per check.
#[test]
fn falling_limit_reduces_step_fraction() {
    let material =
        Material { young: Some(2e7), stiffness: f64::INFINITY, friction: 0.0, restitution: 0.3, ..stone() };
    let mut input = crate::scene::weightless(material);
    let overlap = 1e-7;
    input.planes.push(plane(Vec3::z() * overlap, Vec3::z()));
    input.planes.push(plane(Vec3::z() * (0.02 - overlap), -Vec3::z()));
    input.bodies.push(crate::scene::sphere(Vec3::z() * 0.01, Vec3::zeros()));
    input.impact_speed = Some(1e-6);
    let share = 0.8;
    input.time_step = TimeStep::Measured { share, longest: f64::INFINITY, collisions: false };
    let model = Model::new(input).expect("a good input");
    let mut state = State::new(&model);
    let mut work = Work::new(&model, &state);
    let (mut before, mut changing, mut steady) = (f64::INFINITY, 0, 0);
    let mut speed = 1e-7;
    while steady < 6 {
        trackbed_dem::step(&model, &mut state, &mut work, &NoSurface, &[]).expect("a good step");
        if !stability::follow(&model, &mut state) {
            continue;
        }
        let found = state.measured_limit().expect("two contacts");
        let part = state.dt() / found;
        if found < before / 1.1 {
            changing += 1;
            assert!(
                part <= 0.7 * share * (1.0 + 1e-12),
                "{part} of the limit, which has fallen to {found:e} s"
            );
        } else if found > before / 1.03 {
            steady += 1;
            assert!(part <= share * (1.0 + 1e-12));
        }
        before = found;
        speed = if changing < 8 { 2.0 * speed } else { 0.0 };
        state.set_plane_velocity(0, Vec3::z() * speed);
        state.set_plane_velocity(1, -Vec3::z() * speed);
    }
    let part = state.dt() / before;
    assert!(
        changing == 8 && part > share / 1.1,
        "{changing} looks at a falling limit, {part} of it in the end"
    );
}

/// Two planes (Hertz) raise the overlap a hundredfold, the limit falls to a third, between two regular
/// evaluations; nothing is dissipated.
#[test]
fn step_follows_a_fast_load() {
    let material =
        Material { young: Some(2e7), stiffness: f64::INFINITY, friction: 0.0, restitution: 1.0, ..stone() };
    let mut input = crate::scene::weightless(material);
    let overlap = 1e-6;
    input.planes.push(plane(Vec3::z() * overlap, Vec3::z()));
    input.planes.push(plane(Vec3::z() * (0.02 - overlap), -Vec3::z()));
    input.bodies.push(crate::scene::sphere(Vec3::z() * 0.01, Vec3::zeros()));
    input.impact_speed = Some(1e-6);
    input.time_step = TimeStep::Measured { share: 0.8, longest: f64::INFINITY, collisions: false };
    let model = Model::new(input).expect("a good input");
    let mut state = State::new(&model);
    let mut work = Work::new(&model, &state);
    let (mut evaluated, mut interval) = (0, 0);
    while interval < stability::MOST {
        trackbed_dem::step(&model, &mut state, &mut work, &NoSurface, &[]).expect("a good step");
        if stability::follow(&model, &mut state) {
            (interval, evaluated) = (state.steps - evaluated, state.steps);
        }
    }
    let speed = 99.0 * overlap / (0.5 * stability::MOST as f64 * state.dt());
    let (mut worst, mut changes, before) = (0.0_f64, 0, stability::limit(&model, &state));
    for (sign, plane) in [(1.0, 0), (-1.0, 1)] {
        state.set_plane_velocity(plane, Vec3::z() * sign * speed);
    }
    while state.plane_point(&model, 0).z < 100.0 * overlap {
        trackbed_dem::step(&model, &mut state, &mut work, &NoSurface, &[]).expect("a good step");
        changes += usize::from(stability::follow(&model, &mut state));
        worst = worst.max(state.dt() / stability::limit(&model, &state));
    }
    let fall = stability::limit(&model, &state) / before;
    println!("limit falls to {fall:.2}, {changes} changes of the step, at most {worst:.3} of the limit");
    assert!(fall < 0.4 && worst < 1.0, "{fall} {worst}");
}

#[test]
fn window_has_fewest_stable_steps() {
    let mut input = crate::scene::weightless(Material { friction: 0.0, ..stone() });
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    input.bodies.push(crate::scene::sphere(Vec3::z() * (0.01 - 1e-7), Vec3::zeros()));
    input.time_step = TimeStep::Measured { share: 0.8, longest: f64::INFINITY, collisions: false };
    let model = Model::new(input).expect("a good input");
    let mut state = State::new(&model);
    let allowed = state.dt();
    for parts in [0.3, 1.0, 1.01, 1.99, 2.0, 7.5] {
        let steps = stability::divide(&model, &mut state, parts * allowed, 1);
        let length = parts * allowed / f64::from(steps);
        assert_eq!(steps, f64::ceil(parts) as u32, "a window of {parts} steps");
        assert!((state.dt() / length - 1.0).abs() < 1e-15 && length <= allowed * (1.0 + 1e-12));
    }
}

/// ω² = 12 K/m · max(1, 7/2 α or 6 α).
#[test]
fn sphere_bound_matches_closed_form() {
    for (alpha, rolling, expected) in [(0.1, 0.0, 1.0), (0.5, 0.0, 1.75), (1.0, 0.0, 3.5), (0.5, 0.1, 3.0)] {
        let mut input = crate::scene::weightless(Material {
            tangential_ratio: alpha,
            restitution: 1.0,
            rolling_friction: rolling,
            ..stone()
        });
        input.bodies.push(crate::scene::sphere(Vec3::zeros(), Vec3::zeros()));
        let model = Model::new(input).expect("a good input");
        let exact = 2.0 / (12.0 * expected * stone().stiffness / model.mass(0)).sqrt();
        let share = model.dt_limit().dt / exact;
        assert!((share - 1.0).abs() < 1e-12, "ratio {alpha}, rolling {rolling}: {share}");
    }
}

/// ω² = 24 K (1/m + (a + r)²/I), spheres of radius r at ±a.
#[test]
fn dumbbell_bound_matches_closed_form() {
    let (a, r) = (0.006, 0.008);
    let mut input = crate::scene::weightless(Material { restitution: 1.0, ..stone() });
    let dumbbell = Clump::from_spheres(&[([-a, 0.0, 0.0], r), ([a, 0.0, 0.0], r)]).expect("a clump");
    input.shapes.push(Shape::Clump(dumbbell));
    input.bodies.push(BodyInput { shape: 1, fixed: [false; 6], ..BodyInput::default() });
    let model = Model::new(input).expect("a good input");
    let inertia = model.inertia(0);
    let (long, across) = (inertia.min(), inertia.max());
    let turn = f64::max(r * r / long, (a + r) * (a + r) / across);
    let exact = 2.0 / (24.0 * stone().stiffness * (1.0 / model.mass(0) + turn)).sqrt();
    assert!((model.dt_limit().dt / exact - 1.0).abs() < 1e-9, "{} {exact}", model.dt_limit().dt);
}

#[test]
fn contact_and_bond_bounds_add() {
    let mut input = crate::scene::weightless(Material { restitution: 1.0, ..stone() });
    input.bodies.push(crate::scene::sphere(Vec3::zeros(), Vec3::zeros()));
    input.bodies.push(crate::scene::sphere(Vec3::x() * 0.02, Vec3::zeros()));
    let contacts = Model::new(input.clone()).expect("a good input").dt_limit().dt;
    input.bond_kinds.push(Bond::Parallel(ParallelBond {
        radius_factor: 0.8,
        stiffness: ParallelStiffness::Modulus { young: 1e7, ratio: 2.5 },
        tensile_strength: f64::INFINITY,
        shear_strength: ShearStrength::Constant(f64::INFINITY),
        moment_factor: 1.0,
        criterion: Criterion::Stress,
        damping: BondDamping::None,
        contact: false,
    }));
    input.bonds = vec![bond::BondInput::new(0, 1, 0)];
    let model = Model::new(input).expect("a good input");
    let (found, bonds) = (model.dt_limit().dt, model.dt_limit().bonds);
    let exact = 2.0 / (4.0 / (contacts * contacts) + bonds).sqrt();
    assert!(bonds > 0.1 * 4.0 / (contacts * contacts), "both count");
    assert!((found / exact - 1.0).abs() < 1e-12, "{found} against {exact}");
}

/// 0.08 √(m*/K) without loss, m* = m₁ m₂/(m₁ + m₂), stiffest contact.
#[test]
fn collision_time_uses_reduced_mass() {
    let light = Material { restitution: 1.0, ..stone() };
    let heavy = Material { density: 100.0 * light.density, ..light };
    let mut input = crate::scene::weightless(light);
    input.materials.push(heavy);
    input.shapes.push(Shape::Sphere { radius: 0.01 });
    let stiffness = 10.0 * light.stiffness;
    input.contacts.push(trackbed_dem::PairOverride {
        a: 0,
        b: 1,
        stiffness: Some(stiffness),
        ..Default::default()
    });
    input.bodies.push(crate::scene::sphere(Vec3::zeros(), Vec3::zeros()));
    input.bodies.push(BodyInput { material: 1, ..crate::scene::sphere(Vec3::x(), Vec3::zeros()) });
    let model = Model::new(input).expect("a good input");
    let [a, b] = [model.mass(0), model.mass(1)];
    let exact = 0.08 * (a * b / (a + b) / stiffness).sqrt();
    assert!((model.longest(false) / exact - 1.0).abs() < 1e-12, "{} {exact}", model.longest(false));
}

#[test]
fn fall_speed_sets_hertz_limit() {
    let material = Material { young: Some(2e7), poisson: 0.2, stiffness: f64::INFINITY, ..stone() };
    let mut input = crate::scene::weightless(material);
    input.gravity = Vec3::z() * -9.81;
    input.bodies.push(crate::scene::sphere(Vec3::zeros(), Vec3::zeros()));
    input.bodies.push(crate::scene::sphere(Vec3::z() * 0.48, Vec3::zeros()));
    let limit = |impact_speed| {
        let input = ModelInput { impact_speed, ..input.clone() };
        Model::new(input).expect("a good input").dt_limit().dt
    };
    let height = 0.48 + 2.0 * 0.01;
    let (found, exact) = (limit(None), limit(Some(f64::sqrt(2.0 * 9.81 * height))));
    assert!((found / exact - 1.0).abs() < 1e-12, "{found} against {exact}");
}
