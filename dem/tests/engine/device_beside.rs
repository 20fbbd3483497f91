//! Device steps with a CPU part.

use crate::c_machine::{TestMachine, device_is_there};
use crate::device::{STEPS, bonded, fails_alike, gas, mesh, parallel, pressed, smooth, turning, with_clumps};
use crate::device_changes::assert_detected;
use crate::scene::{block, body, stone};
use std::sync::Arc;
use trackbed_dem::bond::Bond;
use trackbed_dem::device::{Device, source};
use trackbed_dem::sheet::SurfaceMesh;
use trackbed_dem::surface::{Feature, PatchPoint, Surface};
use trackbed_dem::{
    AppliedForce, BackEnd, BodyInput, Model, ModelInput, Motion, Shape, State, Vec3, WallInput, Work, step,
};

struct Ground {
    mesh: Arc<SurfaceMesh>,
    height: f64,
    speed: f64,
}

impl Ground {
    fn new() -> Ground {
        const N: u32 = 9;
        let all = (0..=N).flat_map(|j| (0..=N).map(move |i| (i, j)));
        let at = |k: u32| 0.3 * f64::from(k) / f64::from(N) - 0.035;
        let bump = |i: u32, j: u32| -2e-3 * f64::from((3 * i + 5 * j) % 4);
        let vertices = all.map(|(i, j)| Vec3::new(at(i), at(j), bump(i, j))).collect();
        let corner = |i: u32, j: u32| j * (N + 1) + i;
        let cells = (0..N).flat_map(|j| (0..N).map(move |i| (i, j)));
        let triangles = cells.flat_map(|(i, j)| {
            let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            [[a, b, c], [a, c, d]]
        });
        let mesh = Arc::new(SurfaceMesh { vertices, triangles: triangles.collect() });
        Ground { mesh, height: 1e-3, speed: 2.5 }
    }

    fn corners(&self, patch: u32) -> [Vec3; 3] {
        self.mesh.triangles[patch as usize].map(|k| self.mesh.vertices[k as usize] + Vec3::z() * self.height)
    }
}

impl Surface for Ground {
    fn candidates(&self, lo: [f64; 3], hi: [f64; 3], out: &mut Vec<u32>) {
        out.extend((0..self.mesh.triangles.len() as u32).filter(|k| {
            let corners = self.corners(*k);
            (0..3).all(|d| corners.iter().any(|c| c[d] <= hi[d]) && corners.iter().any(|c| c[d] >= lo[d]))
        }));
    }

    fn closest_point(&self, patch: u32, centre: [f64; 3], local: [f64; 2]) -> PatchPoint {
        let (corners, x) = (self.corners(patch), Vec3::from(centre));
        let [a, b, c] = corners;
        let normal = (b - a).cross(&(c - a)).normalize();
        let foot = x - normal * (x - a).dot(&normal);
        let inside = (0..3).all(|k| {
            let (p, q) = (corners[k], corners[(k + 1) % 3]);
            (q - p).cross(&(foot - p)).dot(&normal) >= 0.0
        });
        let mut found = (foot, Feature::Face);
        if !inside {
            let ends = self.mesh.triangles[patch as usize];
            let mut best = f64::INFINITY;
            for k in 0..3 {
                let (p, q) = (corners[k], corners[(k + 1) % 3]);
                let t = (x - p).dot(&(q - p)) / (q - p).norm_squared();
                let point = p + (q - p) * t.clamp(0.0, 1.0);
                let (m, n) = (ends[k], ends[(k + 1) % 3]);
                let feature = match t {
                    t if t <= 0.0 => Feature::Vertex(m),
                    t if t >= 1.0 => Feature::Vertex(n),
                    _ => Feature::Edge(m.min(n) * 1000 + m.max(n)),
                };
                if (point - x).norm() < best {
                    (best, found) = ((point - x).norm(), (point, feature));
                }
            }
        }
        let velocity = [0.0, 0.0, self.speed];
        PatchPoint { point: found.0.into(), normal: normal.into(), velocity, local, feature: found.1 }
    }

    fn vertex(&self, k: u32) -> Option<[Vec3; 2]> {
        Some([self.mesh.vertices[k as usize] + Vec3::z() * self.height, Vec3::z() * self.speed])
    }

    fn max_speed(&self) -> f64 {
        self.speed
    }

    fn one_sided(&self) -> bool {
        true
    }
}

/// First of the thrown blocks; it only moves vertically.
const FIRST: usize = 1085;

pub(crate) fn on_ground(mut input: ModelInput) -> ModelInput {
    input.planes.remove(0);
    input.bodies.iter_mut().for_each(|b| b.position.z += 1e-3);
    input.surface_material = Some(1);
    input
}

pub(crate) fn among_blocks(input: ModelInput) -> ModelInput {
    let mut input = on_ground(input);
    input.surface_mesh = Some(Ground::new().mesh);
    let lid = input.planes.last_mut().expect("a lid");
    lid.point = Vec3::repeat(0.36);
    for (k, sphere) in input.bodies.iter_mut().enumerate() {
        if k % 11 < 5 && k / 11 % 11 < 5 && k / 121 < 2 {
            sphere.position.z += 0.207;
        }
    }
    let first = input.shapes.len();
    input.shapes.push(Shape::Box { half: [0.04, 0.03, 0.02] });
    input.shapes.push(block([0.02, 0.018, 0.015], 2e-3));
    for k in 0..9 {
        let place = Vec3::new(0.04 + 0.07 * f64::from(k % 3), 0.04 + 0.07 * f64::from(k / 3), 0.28);
        let shape = if k == 0 { first } else { first + 1 };
        let mut one = BodyInput { velocity: Vec3::new(0.2, 0.1, -6.0), ..body(shape, place) };
        one.spin = if k == 0 { Vec3::zeros() } else { Vec3::new(3.0, f64::from(k), -2.0) };
        one.fixed = if k == 0 { [true, true, false, true, true, true] } else { [false; 6] };
        if k == 0 {
            one.velocity = Vec3::z() * -1.0;
        }
        input.bodies.push(one);
    }
    for k in 0..4 {
        let place = Vec3::new(0.03 + 0.045 * f64::from(k % 2), 0.03 + 0.045 * f64::from(k / 2), 0.0165);
        input.bodies.push(BodyInput { velocity: Vec3::new(0.3, 0.0, -2.0), ..body(first + 1, place) });
    }
    input
}

fn beside_a_wall(mut input: ModelInput) -> ModelInput {
    let sides = [Vec3::y() * 0.4, Vec3::z() * 0.7];
    let side = mesh(4, Vec3::new(0.002, 0.11, 0.12), sides, || 0.0);
    let motion = Motion { angular_velocity: Vec3::new(0.5, 3.0, 0.8), ..Motion::default() };
    input.walls.push(WallInput { motion, ..WallInput::fixed(side, 1) });
    input
}

/// First difference, and events up to it.
pub(crate) struct Compared {
    pub differs: Option<usize>,
    state: State,
    /// Surface contacts of spheres and of blocks.
    met: [usize; 2],
    /// Numbers and counts read per step.
    read: usize,
}

pub(crate) fn compare(input: ModelInput, change: impl Fn(String) -> String) -> Compared {
    let model = Model::new(input).expect("a good input");
    let text = change(source(&model).expect("a model for a device"));
    let (mut ours, mut theirs) = (State::new(&model), State::new(&model));
    let mut work = Work::new(&model, &theirs);
    // Includes a re-sorting of bodies.
    (ours.steps, theirs.steps) = (4750, 4750);
    let mut device = Device::new(TestMachine::new(&text, &model), &model, &ours).expect("memory");
    let (mut ground, mut met, mut differs) = (Ground::new(), [0; 2], None);
    for k in 1..=STEPS {
        ground.height += ground.speed * theirs.dt();
        let mut applied = Vec::new();
        if model.body_count() > FIRST {
            let force = Vec3::new(0.0, 0.0, -3.0 * (k as f64 * 0.02).sin().abs());
            applied.push(AppliedForce { body: FIRST, force, point: theirs.position(FIRST) });
        }
        if (200..205).contains(&k) {
            applied.push(AppliedForce { body: 3, force: Vec3::x(), point: theirs.position(3) });
        }
        step(&model, &mut theirs, &mut work, &ground, &applied).expect("a good step");
        if let Err(e) = device.step(&model, &mut ours, &ground, &applied) {
            println!("step {k} on the device: {e}");
            differs = Some(k);
            break;
        }
        let contacts = work.surface_contacts();
        let of_blocks = contacts.iter().filter(|c| c.body as usize >= FIRST).count();
        met = [met[0] + contacts.len() - of_blocks, met[1] + of_blocks];
        let mut same = contacts == BackEnd::surface_contacts(&device) && ours.balance == theirs.balance;
        if k % 7 == 0 || k == STEPS {
            device.download(&model, &mut ours).expect("a device that responds");
            same &= postcard::to_stdvec(&ours).unwrap() == postcard::to_stdvec(&theirs).unwrap();
        }
        if !same {
            differs = Some(k);
            break;
        }
    }
    Compared { differs, state: theirs, met, read: device.machine().read / STEPS }
}

#[test]
fn spheres_and_blocks_on_moving_ground() {
    if device_is_there() {
        let materials = [turning(stone()), smooth()];
        let clumps = |k: usize| k % 3 == 1;
        let scenes: [(&str, ModelInput); 8] = [
            ("spheres on ground", on_ground(gas([stone(), smooth()], Vec::new()))),
            ("clumps on ground", on_ground(with_clumps(gas(materials, Vec::new()), clumps))),
            ("spheres and blocks", among_blocks(gas([stone(), smooth()], Vec::new()))),
            ("spheres that roll and blocks", among_blocks(gas(materials, Vec::new()))),
            (
                "blocks beside a wall",
                beside_a_wall(among_blocks(with_clumps(gas([stone(), smooth()], Vec::new()), clumps))),
            ),
            ("blocks under a plate", among_blocks(pressed(gas([stone(), smooth()], Vec::new()), Vec3::x()))),
            ("bonded spheres, which break", on_ground(bonded(Bond::Parallel(parallel()), stone()))),
            ("clumps and blocks", among_blocks(with_clumps(gas([stone(), smooth()], Vec::new()), clumps))),
        ];
        for (name, input) in scenes {
            let (blocks, driven) =
                (input.bodies.len() > FIRST, input.walls.iter().any(|w| w.servo.is_some()));
            let Compared { differs, state, met, read } = compare(input, |text| text);
            let l = &state.balance;
            println!(
                "{name}: {met:?} contacts with the ground, work of the ground {:.3e} J, applied {:.3e} J, friction {:.3e} J, \
                 {read} numbers read a step",
                l.work_surface, l.work_applied, l.dissipated_friction
            );
            assert_eq!(differs, None, "{name}: the first step after which the states differ");
            assert!(met[0] > 1000 && (met[1] > 100) == blocks && l.work_surface > 0.0, "{name}: {met:?}");
            assert_eq!(l.work_servo != 0.0, driven, "{name}");
            let broken = state.broken_bonds();
            assert!(!name.contains("break") || broken.0 + broken.1 > 20, "{name}: {broken:?}");
            assert!((l.work_applied != 0.0) && l.dissipated_friction > 0.0, "{name}");
        }
    }
}

#[test]
fn a_changed_part_is_seen() {
    if device_is_there() {
        let spheres = on_ground(gas([stone(), smooth()], Vec::new()));
        let blocks = among_blocks(with_clumps(gas([stone(), smooth()], Vec::new()), |k| k % 3 == 1));
        let changes = [
            ("add(&s->torque, HANDED[2 * k + 1]);", ""),
            ("add(&s->force, HANDED[2 * k]);", "add(&s->force, HANDED[2 * HANDED_START[c]]);"),
            ("picked[1] = OLD_V[i];", "picked[1] = NEW_V[i];"),
            ("picked[3] = OLD_ORIENTATION[i];", "picked[3] = NEW_ORIENTATION[i];"),
            ("if (SINGLE[i] & ELSEWHERE) return;", "if (i == 5) return;"),
        ];
        assert_detected("device_beside::a_changed_part_is_seen", &changes, |k, change| {
            let input = if k < 2 { &spheres } else { &blocks };
            compare(input.clone(), change).differs
        });
    }
}

#[test]
fn failing_step_has_engine_message() {
    if device_is_there() {
        for body in [3, FIRST + 1] {
            let input = among_blocks(gas([stone(), smooth()], Vec::new()));
            let words = fails_alike(input, (body, Vec3::z() * -300.0), &Ground::new());
            let named = [' ', ':'].iter().any(|end| words.contains(&format!("body {body}{end}")));
            assert!(named, "{words}");
        }
    }
}

#[test]
fn what_has_no_spheres_is_refused() {
    let mut input = among_blocks(gas([stone(), smooth()], Vec::new()));
    input.bodies.drain(..FIRST);
    let why = source(&Model::new(input).expect("a good input")).expect_err("not for a device").to_string();
    assert!(why.starts_with("not supported on a GPU: scenes of boxes and polyhedra only"), "{why}");
}
