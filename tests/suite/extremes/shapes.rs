//! Grains: edges, corners, seams, needles, plates, mixed sizes, extreme units, long runs.

use super::case::{Case, off};
use super::scenes::{ball, floor, mass, plane, stone, time};
use super::table::{Row, figure, figures, rows};
use crate::suite::support::Folder;

rows! {
    borders: "ball on an edge, a corner, a seam of triangles";
    needle: "needle 1:50";
    slap: "needle that slaps down, steps that follow the contacts";
    flat: "plate 1:50";
    unlike_bed: "bed of radius ratio 1:100";
    units: "units huge and tiny";
    [long "ten million steps: a minute or two"] quiet: "10⁷ steps of a quiet bed";
    [long "ten million steps: a minute"] tumbling: "10⁷ steps of a tumbling clump";
}

/// Frictionless elastic 10 mm ball, 1 m/s, at the border of a plate.
fn borders() -> Row {
    let radius = 0.01;
    let mut errors = Vec::new();
    for (x, y) in [(0.0, 0.0), (0.3, 0.0), (1.005, 0.1), (1.009, 0.1), (1.004, 1.003), (1.006, 1.007)] {
        let text = stone("weightless\nstiffness = 1e9\nfriction = 0\nrestitution = 1\n")
            + &ball("ball", [x, y, 0.0102], radius, [0.0, 0.0, -1.0])
            + "\n[[walls]]\nkind = \"triangles\"\nmaterial = \"stone\"\n\
               vertices = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]\ntriangles = [[0, 1, 2], [0, 2, 3]]\n"
            + &time(0.02, 200);
        let found = Case::run(&text, &[]).good().velocity("ball", 0.1);
        let (beyond_x, beyond_y) = ((x - 1.0).max(0.0), (y - 1.0).max(0.0));
        let up = (radius * radius - beyond_x * beyond_x - beyond_y * beyond_y).sqrt();
        let normal = [beyond_x / radius, beyond_y / radius, up / radius];
        let right: [f64; 3] =
            std::array::from_fn(|d| 2.0 * normal[2] * normal[d] - if d == 2 { 1.0 } else { 0.0 });
        errors.push((0..3).map(|d| (found[d] - right[d]).powi(2)).sum::<f64>().sqrt());
    }
    assert!(errors.iter().all(|e| *e < 5e-3), "{errors:?}");
    Row::new(
        "frictionless, elastic hit of 1 m/s in a face, on a seam, 0.5 and 0.9 radii beyond an edge, on a corner (two places)",
        format!("right: velocity off by {} m/s", figures(&errors)),
        "reflection at the line from the border to the centre",
    )
}

fn dropped(places: &[[u32; 2]], height: f64, turn: [f64; 4], time: &str) -> Case {
    let list: Vec<String> = places
        .iter()
        .map(|p| p.map(|x| 0.004 * f64::from(x)))
        .map(|[x, y]| format!("[{x:?}, {y:?}, 0.0, 0.002]"))
        .collect();
    let library = format!(
        "name = \"one\"\nsource = \"made\"\n\n[[stones]]\nname = \"flat\"\nspheres = [{}]\n",
        list.join(",\n")
    );
    let folder = Folder::new("extremes");
    folder.write("stones.toml", &library);
    let [w, x, y, z] = turn;
    folder.write("place.csv", &format!("0, 0, {height}, {w}, {x}, {y}, {z}, 1, 0\n"));
    let text = stone("stiffness = 2e4\nrestitution = 0.3\n")
        + "\n[[grains]]\nname = \"flat\"\nshape = \"clump\"\nmaterial = \"stone\"\nrecord = true\n\
           library = \"stones.toml\"\npacking = \"place.csv\"\n"
        + &floor()
        + time;
    Case::in_folder(folder, &text, &[])
}

fn needle_places() -> Vec<[u32; 2]> {
    (0..50).map(|k| [k, 0]).collect()
}

fn lies(case: &Case, count: usize) -> [f64; 2] {
    let forces = case.history("floor_force_z");
    let late = &forces[forces.len() * 9 / 10..];
    let force = late.iter().sum::<f64>() / late.len() as f64;
    [off(-force, count as f64 * mass(0.002) * 9.81), off(case.last("flat_z"), 0.002)]
}

fn needle() -> Row {
    let mut errors = Vec::new();
    for turn in [[0.96, 0.0, 0.28, 0.0], [0.8, 0.0, 0.6, 0.0]] {
        let fixed = time(0.4, 400).replace("end", "grain_step = 2e-6\nend");
        let case = dropped(&needle_places(), 0.11, turn, &fixed).good();
        errors.extend(lies(&case, 50));
    }
    assert!(errors.iter().all(|e| *e < 1e-2), "{errors:?}");
    Row::new(
        "50 spheres in a row, dropped at two orientations, `time.grain_step` within its limit",
        format!("right: lies on its side; weight on the floor and height off by {}", figures(&errors)),
        "weight, radius",
    )
}

fn flat() -> Row {
    let full = |x: u32| x.is_multiple_of(49);
    let places: Vec<[u32; 2]> =
        (0..2500).map(|k| [k % 50, k / 50]).filter(|[x, y]| full(*x) || full(*y)).collect();
    let laid = |turn: [f64; 4], end: f64, keys: &str| {
        dropped(&places, 0.0022, turn, &time(end, 200).replace("end", &format!("{keys}\nend")))
    };
    let level = [1.0, 0.0, 0.0, 0.0];
    let limit = laid(level, 1e-6, "").good().value("/model/grain_step_limit");
    let case = laid(level, 0.05, &format!("grain_step = {:e}", 0.8 * limit)).good();
    let errors = lies(&case, places.len());
    assert!(errors.iter().all(|e| *e < 1e-2), "{errors:?}");
    Row::new(
        "frame of 196 spheres 0.2 m wide and 4 mm thick",
        format!(
            "right: lies flat; weight on the floor off by {}, height by {}",
            figure(errors[0]),
            figure(errors[1])
        ),
        "weight, radius",
    )
}

fn slap() -> Row {
    let mut stopped = 0;
    for turn in [0.1_f64, 0.2, 0.3] {
        let case = dropped(&needle_places(), 0.11, [turn.cos(), 0.0, turn.sin(), 0.0], &time(0.4, 400));
        if case.outcome.code == 0 {
            assert!(case.value("/energy/largest_relative_error") < 0.01, "not right, and nothing said");
        } else {
            case.stopped("energy error: ");
            stopped += 1;
        }
    }
    let outcome = match stopped {
        0 => "right".to_string(),
        _ => format!(
            "limit: {stopped} of 3 stopped, `energy error`, with advice on `time.grain_step`, which helps"
        ),
    };
    Row::new("needle of 50 spheres at three orientations", outcome, "energy account")
}

fn unlike_bed() -> Row {
    let text = stone("stiffness = 5e4\nrestitution = 0.3\nrolling_friction = 0.1\n")
        + "\n[[grains]]\nname = \"fines\"\nshape = \"sphere\"\nmaterial = \"stone\"\n\
           lattice = { kind = \"hexagonal\", size = 0.001, low = [-0.006, -0.0045, 0.0], counts = [12, 10, 2] }\n"
        + &ball("boulder", [0.0, 0.0, 0.05184], 0.05, [0.0; 3])
        + &floor()
        + "\n[deposition]\nmax_time = 0.04\nlocal_damping = 0.8\n"
        + &time(0.02, 200);
    let case = Case::run(&text, &[]).good();
    let forces = case.history("floor_force_z");
    let count = case.value("/model/bodies") - 1.0;
    // Floor force corrected for the boulder's change of momentum from rest.
    let force = -forces[1..].iter().sum::<f64>() / 200.0
        - mass(0.05) * case.velocity("boulder", 0.005)[2] / case.last("time");
    let error = off(force, 9.81 * (mass(0.05) + count * mass(0.0005)));
    assert!(error < 1e-2, "{error}");
    Row::new(
        format!("boulder of 50 mm on {count} grains of 0.5 mm"),
        format!("right: force on the floor off by {}, carried by the grains", figure(error)),
        "weight",
    )
}

fn units() -> Row {
    let mut errors = Vec::new();
    let scales = [1e-6, 1e-3, 1.0, 1e3, 1e6];
    for scale in scales {
        let radius = 0.01 * scale;
        let text = stone(&format!("restitution = 0.1\nstiffness = {:e}\n", 1e3 * scale * scale))
            + &ball("ball", [0.0, 0.0, radius], radius, [0.0; 3])
            + &floor()
            + &time(1.0 * scale.sqrt(), 100);
        let case = Case::run(&text, &[]).good();
        let rest = radius - case.last("ball_z");
        errors.push(off(rest, mass(radius) * 9.81 / (1e3 * scale * scale)));
    }
    assert!(errors.iter().all(|e| *e < 1e-4), "{errors:?}");
    Row::new(
        "radius 10 nm, 10 µm, 10 mm, 10 m, 10 km",
        format!("right: overlap at rest off by {}", figures(&errors)),
        "m g / K",
    )
}

fn quiet() -> Row {
    let mut text = stone(
        "restitution = 0.3\ntangential_damping_ratio = 0.5\nrolling_friction = 0.05\ntwisting_friction = 0.05\n",
    ) + "\n[[grains]]\nname = \"bed\"\nshape = \"sphere\"\nmaterial = \"stone\"\nrecord = true\nspheres = [";
    for k in 0..27_u32 {
        let place = |d: u32| {
            let cell = [k % 3, k / 3 % 3, k / 9][d as usize];
            (f64::from(cell) + 0.5) * 0.021 + f64::from(k + 9 * d).sin() * 3e-4
        };
        text += &format!("[{:?}, {:?}, {:?}, 0.01],\n", place(0), place(1), place(2));
    }
    text += "]\n";
    text += &floor();
    for (name, point, normal) in [
        ("west", [0.0; 3], [1.0, 0.0, 0.0]),
        ("east", [0.063, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        ("south", [0.0; 3], [0.0, 1.0, 0.0]),
        ("north", [0.0, 0.063, 0.0], [0.0, -1.0, 0.0]),
    ] {
        text += &plane(name, point, normal);
    }
    text += "\n[deposition]\nmax_time = 2\n";
    text += &time(201.0, 100).replace("end =", "grain_step = 2e-5\nend =");
    let case = Case::run(&text, &[]).good();
    let steps = case.value("/stages/1/grain_steps");
    assert!(steps >= 1e7);
    // Contact history starts empty: transients end in a tenth of the run.
    let drift = |column: &str| {
        let values = case.history(column);
        (values[100] - values[10]).abs()
    };
    let moved = drift("bed_x").max(drift("bed_y")).max(drift("bed_z"));
    let kinetic = case.last("grains_kinetic");
    assert!(moved < 1e-9 && kinetic < 1e-20, "{moved:e} {kinetic:e}");
    Row::new(
        "27 spheres in a box",
        format!(
            "right: the mean place drifts by {} m in the last 9·10⁶ steps, kinetic energy {} J, elastic energy off by {}",
            figure(moved),
            figure(kinetic),
            figure(drift("contact_springs") / case.last("contact_springs"))
        ),
        "a bed at rest stays",
    )
}

fn tumbling() -> Row {
    let folder = Folder::new("extremes");
    folder.write(
        "stones.toml",
        "name = \"one\"\nsource = \"made\"\n\n[[stones]]\nname = \"bent\"\n\
         spheres = [[0, 0, 0, 1], [1.5, 0, 0, 0.8], [0, 0.9, 0.2, 0.6]]\n",
    );
    let text = stone("weightless\n")
        + "\n[[grains]]\nname = \"bent\"\nshape = \"clump\"\nmaterial = \"stone\"\nrecord = true\ncount = 1\n\
           library = \"stones.toml\"\nsize = [0.02, 0.02]\nspin = [60, 1, 2]\n\
           region = { box = [[0, 0, 0], [0.1, 0.1, 0.1]] }\n"
        + &time(1000.1, 100).replace("end =", "grain_step = 1e-4\naccept_step_above_limit = true\nend =");
    let case = Case::in_folder(folder, &text, &[]).good();
    assert!(case.value("/stages/0/grain_steps") >= 1e7);
    let kinetic = case.history("grains_kinetic");
    let error = kinetic.iter().map(|k| off(*k, kinetic[0])).fold(0.0, f64::max);
    let momentum = case.value("/momentum/angular");
    assert!(error < 1e-9, "{error:e}");
    Row::new(
        "a free clump of three unlike moments of inertia at 60 rad/s",
        format!("right: kinetic energy off by {}, angular momentum by {}", figure(error), figure(momentum)),
        "conservation of energy and angular momentum",
    )
}
