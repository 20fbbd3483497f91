//! Shipped solid scenes against closed forms and published values. Residual differences are discretisation
//! errors.

use super::support::{Folder, Table, json, repository, run, trackbed};
use std::f64::consts::PI;
use std::path::PathBuf;

fn shipped(name: &str) -> PathBuf {
    repository().join("inputs").join(name)
}

fn finished(name: &str, set: &[&str]) -> (Folder, Table) {
    let folder = Folder::new("shipped");
    run(&shipped(name), &folder.join("out"), set).good();
    let history = Table::read(&folder.join("out/history.csv"));
    (folder, history)
}

/// Frequencies [Hz] from `trackbed modal`; effective masses must not exceed `mass` [kg].
fn frequencies(name: &str, count: usize, mass: f64) -> Vec<f64> {
    let folder = Folder::new("modal");
    let out = folder.join("out").display().to_string();
    let scene = shipped(name).display().to_string();
    trackbed(["modal", &scene, "-n", &count.to_string(), "--out", &out]).good();
    let table = Table::read(&folder.join("out/modes.csv"));
    assert_eq!(table.rows.len(), count);
    for axis in ["x", "y", "z"] {
        let sum: f64 = table.column(&format!("effective_mass_{axis}")).iter().sum();
        assert!(sum <= mass * (1.0 + 1e-6), "{axis}: {sum} kg of {mass} kg");
    }
    for mode in 1..=count {
        assert!(folder.join(&format!("out/frames/mode_{mode:03}.vtu")).is_file());
    }
    table.column("frequency")
}

#[track_caller]
fn near(what: &str, found: f64, exact: f64, tolerance: f64) {
    println!("{what}: {found:.6e}, exact {exact:.6e}, {:+.3} %", 100.0 * (found / exact - 1.0));
    assert!((found / exact - 1.0).abs() <= tolerance, "{what}: {found} against {exact}");
}

fn beam(square: f64, depth: f64) -> f64 {
    let (length, young, density): (f64, f64, f64) = (2.0, 210e9, 7850.0);
    square / (2.0 * PI * length * length) * (young / density).sqrt() * depth / 12.0_f64.sqrt()
}

/// Prandtl: N_c = (N_q − 1) cot φ. The shipped mesh is 8 % high.
#[test]
fn footing_reaches_prandtls_load() {
    let (folder, history) = finished("solid/footing.toml", &[]);
    let phi = 20.0_f64.to_radians();
    let nq = (PI * phi.tan()).exp() * (PI / 4.0 + phi / 2.0).tan().powi(2);
    let exact = (nq - 1.0) / phi.tan();
    // Area 0.5 m × 0.25 m, cohesion 20 kPa.
    let factor: Vec<f64> =
        history.column("footing_reaction_z").iter().map(|r| -r / (0.5 * 0.25 * 20e3)).collect();
    let (last, before) = (factor[factor.len() - 1], factor[factor.len() * 4 / 5]);
    println!("Nc {last:.3}, Prandtl {exact:.3}: {:+.1} %", 100.0 * (last / exact - 1.0));
    assert!(last > exact && last < 1.10 * exact, "{last} against {exact}");
    assert!((last / before - 1.0).abs() < 5e-3, "a plateau: {before} then {last}");
    let summary = json(&folder.join("out/summary.json"));
    assert!(summary["energy"]["relative_error"].as_f64().unwrap() < 1e-4, "{}", summary["energy"]);
    assert!(summary["newton"]["iterations"].as_u64().unwrap() > summary["newton"]["steps"].as_u64().unwrap());
    let reaction = summary["reactions"][0]["force"][2].as_f64().unwrap();
    assert_eq!(reaction, *history.column("footing_reaction_z").last().unwrap());
}

/// Griffiths and Lane 1999, example 1: 1.4; Bishop and Morgenstern: 1.380, here to 5 % on a quarter of the
/// shipped elements.
#[test]
fn slope_matches_published_factor() {
    let folder = Folder::new("slope");
    let set = [
        "solid.block.x.counts=[10]",
        "solid.block.z.counts=[4]",
        "solid.strength_reduction.tolerance=0.05",
        "output.tecplot=false",
    ];
    run(&shipped("solid/slope.toml"), &folder.join("out"), &set).good();
    let safety = &json(&folder.join("out/summary.json"))["safety"];
    let [stands, fails] = ["stable_at", "unstable_at"].map(|k| safety[k].as_f64().unwrap());
    println!("stable at {stands:.4}, unstable at {fails:.4}");
    assert!(stands < fails && fails - stands <= 0.05);
    near("factor of safety", 0.5 * (stands + fails), 1.380, 0.05);
    let table = Table::read(&folder.join("out/safety.csv"));
    assert_eq!(table.rows.len(), safety["trials"].as_array().unwrap().len());
    // Displacements of stable trials grow with the reduction factor.
    let mut standing: Vec<[f64; 2]> = table
        .rows
        .iter()
        .filter(|r| r[table.index("stands")] == 1.0)
        .map(|r| [r[table.index("factor")], r[table.index("largest_displacement")]])
        .collect();
    standing.sort_by(|a, b| a[0].total_cmp(&b[0]));
    assert!(standing.len() >= 3 && standing.windows(2).all(|w| w[1][1] > w[0][1]), "{standing:?}");
    assert!(folder.join("out/frames/solid_00000.vtu").is_file());
}

/// Hill 1950, Yu 1992: bore displacement at plastic radii of 0.6, 0.8 and 1.0 m. Tolerance 1 %.
#[test]
fn thick_cylinder_matches_closed_form() {
    for (dilation, exact) in [
        ("25 deg", [2.652713650909448e-4, 4.371477541776971e-4, 6.193686171384218e-4]),
        ("5 deg", [2.6825e-4, 4.6462e-4, 6.9498e-4]),
    ] {
        let set = format!("solid.material.0.dilation=\"{dilation}\"");
        let (_folder, history) = finished("solid/cylinder/scene.toml", &[&set]);
        let (time, bore) = (history.column("time"), history.column("bore_u_x"));
        for (level, exact) in exact.into_iter().enumerate() {
            let row = time.iter().position(|t| (t - (level + 1) as f64).abs() < 1e-9).unwrap();
            near(&format!("dilation {dilation}, level {}", level + 1), bore[row], exact, 0.01);
        }
    }
}

/// Cavity pressure [Pa] and wall displacement [m] at plastic radius `c` [m], small strain (Yu and Houlsby
/// 1991).
fn cavity(c: f64) -> (f64, f64) {
    let (young, nu, cohesion, b): (f64, f64, f64, f64) = (50e6, 0.3, 20e3, 8.0);
    let ratio = |angle: f64| (1.0 + angle.to_radians().sin()) / (1.0 - angle.to_radians().sin());
    let (al, be) = (ratio(25.0), ratio(10.0));
    let y = 2.0 * cohesion * al.sqrt();
    // Elastic outside c: s_r = -s (1/r³ - 1/b³), s_t = s (1/(2 r³) + 1/b³), with yield al s_t - s_r = y at c.
    let s = y / ((0.5 * al + 1.0) / c.powi(3) + (al - 1.0) / b.powi(3));
    let border = [-s * (c.powi(-3) - b.powi(-3)), s * (0.5 * c.powi(-3) + b.powi(-3))];
    let power = 2.0 * (al - 1.0) / al;
    let radial = |r: f64| y / (al - 1.0) + (border[0] - y / (al - 1.0)) * (r / c).powf(-power);
    // u' + (2/be) u/r equals its elastic part: integrated inwards by Simpson's rule.
    let q = 2.0 / be;
    let source = |r: f64| {
        let (s_r, s_t) = (radial(r), (radial(r) + y) / al);
        ((s_r - 2.0 * nu * s_t) + q * ((1.0 - nu) * s_t - nu * s_r)) / young * r.powf(q)
    };
    let (n, h) = (400, (c - 1.0) / 400.0);
    let weight = |i: i32| if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    let integral: f64 = (0..=n).map(|i| weight(i) * source(1.0 + f64::from(i) * h)).sum::<f64>() * h / 3.0;
    let at_border = c * ((1.0 - nu) * border[1] - nu * border[0]) / young;
    (-radial(1.0), at_border * c.powf(q) - integral)
}

#[test]
fn cavity_expansion_matches_closed_form() {
    let (pressure, exact) = cavity(2.0);
    let (_folder, history) = finished("verify/cavity/scene.toml", &[]);
    let text = std::fs::read_to_string(shipped("verify/cavity/scene.toml")).unwrap();
    let given = text.split("pressure = ").nth(1).unwrap().split('\n').next().unwrap();
    near("pressure of the scene", given.parse().unwrap(), pressure, 1e-9);
    near("wall", *history.column("wall_u_x").last().unwrap(), exact, 0.01);
}

/// Mohr–Coulomb: axial stress −(k p0 + 2 c √k), dilatancy k_ψ − 1. Tolerance 1e-6 of the stress, from
/// Newton's iteration.
#[test]
fn triaxial_test_ends_on_its_plateau() {
    let (folder, history) = finished("verify/triaxial.toml", &[]);
    let ratio = |angle: f64| (1.0 + angle.to_radians().sin()) / (1.0 - angle.to_radians().sin());
    let (k, flow) = (ratio(30.0), ratio(10.0));
    let plateau = -(k * 100e3 + 2.0 * 20e3 * k.sqrt());
    let axial = history.column("plate_reaction_z");
    near("axial stress", *axial.last().unwrap(), plateau, 1e-6);
    let gauss = Table::read(&folder.join("out/gauss.csv"));
    for (found, lateral) in gauss.column("szz").into_iter().zip(gauss.column("sxx")) {
        assert!((found / plateau - 1.0).abs() < 1e-6 && (lateral / -100e3 - 1.0).abs() < 1e-6, "{found}");
    }
    assert!(gauss.column("equivalent_plastic_strain").iter().all(|kappa| *kappa > 0.01));
    let rate = |name: &str| {
        let column = history.column(name);
        column[column.len() - 1] - column[column.len() - 2]
    };
    let [x, y, z] = ["corner_u_x", "corner_u_y", "corner_u_z"].map(rate);
    near("dilatancy", (x + y + z) / z.abs(), flow - 1.0, 1e-4);
    let base = history.column("base_reaction_z");
    assert!(axial.iter().zip(base).all(|(a, b)| (a + b).abs() <= 1e-9 * plateau.abs()));
}

fn clay_points(folder: &Folder) -> Vec<[f64; 3]> {
    let gauss = Table::read(&folder.join("out/gauss.csv"));
    let [x, y, z, pc] = ["sxx", "syy", "szz", "preconsolidation_pressure"].map(|name| gauss.column(name));
    (0..x.len()).map(|i| [-(x[i] + y[i] + z[i]) / 3.0, x[i] - z[i], pc[i]]).collect()
}

/// Undrained modified Cam clay, p/p0 = (R M²/(M² + η²))^Λ (Wood 1990, chapter 5). Tolerance 1e-6, from the
/// equilibrium iteration; the path is independent of the step size.
#[test]
fn undrained_clay_matches_closed_form() {
    let (m, exponent, p0) = (0.95, (0.093 - 0.035) / 0.093, 207e3);
    // Distance to the critical state at 10 % strain.
    for (ratio, end) in [(1.0, 2e-3), (8.0, 4e-2)] {
        let set = [format!("solid.material.0.overconsolidation={ratio}")];
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let (folder, history) = finished("solid/triaxial_undrained.toml", &set);
        let points = clay_points(&folder);
        for [p, q, pc] in &points {
            let eta = q / p;
            near("p", *p, p0 * (ratio * m * m / (m * m + eta * eta)).powf(exponent), 1e-6);
            near("pc", *pc, p * (1.0 + eta * eta / (m * m)), 1e-6);
            near("critical state", eta, m, end);
        }
        let base = *history.column("base_reaction_z").last().unwrap();
        near("base", base, points[0][0] + 2.0 / 3.0 * points[0][1], 1e-6);
    }
}

/// Drained path: q = 3 (p - p0), volumetric strain κ/v ln(p/p0) + (λ - κ)/v ln(pc/p0). Tolerance 1e-5.
#[test]
fn drained_clay_matches_closed_form() {
    let (m, v, lambda, kappa, p0) = (0.95, 1.6, 0.093, 0.035, 207e3_f64);
    let (folder, history) = finished("solid/triaxial_drained.toml", &[]);
    let strain: f64 =
        ["corner_u_x", "corner_u_y", "corner_u_z"].iter().map(|n| -history.column(n).last().unwrap()).sum();
    for [p, q, pc] in clay_points(&folder) {
        near("path", q, 3.0 * (p - p0), 1e-5);
        near("pc", pc, p * (1.0 + (q / (m * p)).powi(2)), 1e-6);
        near(
            "volume strain",
            strain,
            kappa / v * (p / p0).ln() + (lambda - kappa) / v * (pc / p0).ln(),
            1e-5,
        );
        assert!(q / p > 0.85 * m && q / p < m);
    }
}

/// Default Newton tolerance against 1e-11: wall displacement and reactions within 1e-6 (a tolerance of 1e-4
/// gives 4.8e-6 and 3.0e-6).
#[test]
fn default_tolerance_is_sufficient() {
    for (name, column) in
        [("verify/cavity/scene.toml", "wall_u_x"), ("solid/triaxial_drained.toml", "plate_reaction_z")]
    {
        let path = |set: &[&str]| finished(name, set).1.column(column);
        let (found, exact) = (path(&[]), path(&["solid.newton.tolerance=1e-11"]));
        let size = exact.iter().fold(0.0_f64, |m, e| m.max(e.abs()));
        let error = found.iter().zip(&exact).map(|(f, e)| (f - e).abs() / size).fold(0.0, f64::max);
        println!("{name}: {error:.1e}");
        assert!(found.len() == exact.len() && error < 1e-6, "{name}: {error:e}");
    }
}

/// One-dimensional wave: residual energy below 1 %, final displacement −∫ p dt/(ρ c_p) to 0.5 %.
#[test]
fn wave_leaves_through_the_absorbing_base() {
    let (folder, history) = finished("verify/wave_column.toml", &[]);
    let energy = &json(&folder.join("out/summary.json"))["energy"];
    let of = |part: &str, key: &str| energy[part][key].as_f64().unwrap();
    let left = (of("end", "solid_kinetic") + of("end", "solid_strain")) / of("flows", "solid_load_work");
    println!("energy left {left:.1e} of the work, absorbed {:.5} J", of("flows", "absorbed"));
    assert!(left < 0.01);
    near("absorbed", of("flows", "absorbed"), of("flows", "solid_load_work"), 1e-3);
    let modulus = 50e6 * 0.7 / (1.3 * 0.4);
    let exact = -10e3 * 0.5 / 40.0 / (2000.0_f64 * modulus).sqrt();
    for probe in ["top_u_z", "middle_u_z"] {
        near(probe, *history.column(probe).last().unwrap(), exact, 5e-3);
    }
}

/// Clamped beam: (βL)² = 3.51602 and 22.0345. Tolerance 1 %: clamp, shear, rotary inertia.
#[test]
fn clamped_beam_matches_euler_bernoulli() {
    let found = frequencies("verify/beam_modes.toml", 4, 78.5);
    let exact = [beam(3.51602, 0.05), beam(3.51602, 0.1), beam(22.0345, 0.05), beam(22.0345, 0.1)];
    for ((i, found), (exact, tolerance)) in
        found.iter().enumerate().zip(exact.into_iter().zip([0.01, 0.01, 0.01, 0.015]))
    {
        near(&format!("mode {}", i + 1), *found, exact, tolerance);
    }
}

/// Free beam: six rigid-body modes, then (βL)² = 22.3733. Tolerance 1 %.
#[test]
fn free_beam_has_six_rigid_motions() {
    let found = frequencies("verify/free_beam.toml", 8, 78.5);
    assert!(found[..6].iter().all(|f| *f < 0.01), "{found:?}");
    near("mode 7", found[6], beam(22.3733, 0.05), 0.01);
    near("mode 8", found[7], beam(22.3733, 0.1), 0.01);
}

/// d'Alembert: surface motion 2 [u(t − H/c) − u(t − 3H/c) + …] for base motion u. Tolerance 1 % of the
/// largest motion.
#[test]
fn layer_response_matches_dalembert() {
    let (_folder, history) = finished("solid/base_motion/scene.toml", &["output.vtk=false"]);
    let pulse = |t: f64| if (0.0..0.1).contains(&t) { 0.01 * (PI * t / 0.1).sin().powi(4) } else { 0.0 };
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    let columns = ["time", "surface_u_x", "ground_u_x"].map(|name| history.column(name));
    for ((t, surface), ground) in columns[0].iter().zip(&columns[1]).zip(&columns[2]) {
        let exact: f64 =
            (0..4).map(|n| 2.0 * (-1.0_f64).powi(n) * pulse(t - 0.1 * f64::from(2 * n + 1))).sum();
        worst = worst.max((surface - exact).abs());
        largest = largest.max(surface.abs());
        assert!((ground - pulse(*t)).abs() < 1e-5, "the base at {t}: {ground}");
    }
    println!("surface: largest {largest:.6} m, farthest from d'Alembert {:.2} %", 100.0 * worst / 0.02);
    assert!(worst < 0.01 * 0.02 && largest > 0.0198);
}

#[test]
fn deflection_runs_along_with_the_axle() {
    let (folder, history) = finished("solid/moving_load.toml", &["output.vtk=false"]);
    let time = history.column("time");
    let trough = |history: &Table, probe: &str| {
        let course = history.column(&format!("{probe}_u_z"));
        let least = (0..course.len()).min_by(|&a, &b| course[a].total_cmp(&course[b])).unwrap();
        (least, course[least], course[course.len() - 1])
    };
    let [three, six, nine] = ["y3", "y6", "y9"].map(|probe| trough(&history, probe));
    println!("troughs at {:.3} {:.3} {:.3} s", time[three.0], time[six.0], time[nine.0]);
    for (first, second) in [(three, six), (six, nine)] {
        let speed = 3.0 / (time[second.0] - time[first.0]);
        assert!((speed / 50.0 - 1.0).abs() < 0.1, "{speed} m/s");
    }
    assert!(six.2.abs() < 0.1 * six.1.abs(), "what stays: {} of {}", six.2, six.1);
    let energy = &json(&folder.join("out/summary.json"))["energy"];
    for sink in ["absorbed", "rayleigh"] {
        assert!(energy["flows"][sink].as_f64().unwrap() > 0.0, "{sink}");
    }
    let text = std::fs::read_to_string(shipped("solid/moving_load.toml")).unwrap();
    let line = |start: &str| text.lines().find(|l| l.starts_with(start)).unwrap();
    let slow = text
        .replace(&format!("{}\n{}\n", line("dynamics"), line("rayleigh")), "quasi_static = {}\n")
        .replace("solid_step = \"2 ms\"", "solid_step = \"5 ms\"")
        .replace("history_interval = \"2 ms\"", "history_interval = \"5 ms\"");
    let scene = folder.write("slow.toml", &slow);
    run(&scene, &folder.join("slow"), &["output.vtk=false"]).good();
    let standing = trough(&Table::read(&folder.join("slow/history.csv")), "y6");
    let factor = six.1 / standing.1;
    println!("trough {:.3} mm, of a standing load {:.3} mm: {factor:.3}", 1e3 * six.1, 1e3 * standing.1);
    // Half of the shear wave speed: inertia adds 6 % on an undamped half-space, damping takes as much.
    assert!(factor > 0.95 && factor < 1.1, "{factor}");
}

#[test]
fn plastic_embankment_carries_and_settles() {
    let (folder, history) = finished("solid/embankment_plastic.toml", &[]);
    let (time, base) = (history.column("time"), history.column("base_reaction_z"));
    // Four elements of 4/14 m under the load.
    let (weight, load) = (base[0], 100e3 * 4.0 * 4.0 / 14.0);
    for (t, carried) in time.iter().zip(&base) {
        let share = if *t <= 1.0 { *t } else { 2.0 - t };
        near("base", *carried, weight + share * load, 1e-5);
    }
    // Width 28 m at the base, 8 m on top, height 7 m.
    let width = |z: f64| 14.0 - 10.0 * (z + 4.0) / 7.0;
    let ground = 0.5 * (width(-4.0) + width(0.0)) * 4.0 * 1800.0;
    let embankment = 0.5 * (width(0.0) + width(3.0)) * 3.0 * 2000.0;
    near("weight", weight, 9.81 * (ground + embankment), 1e-5);
    let crest = history.column("crest_u_z");
    let deepest = crest.iter().copied().fold(0.0, f64::min);
    let left = crest[crest.len() - 1];
    println!("settles by {:.2} mm under the load, {:.2} mm stay", -1e3 * deepest, -1e3 * left);
    assert!(left < -1e-3 && deepest < 1.5 * left, "{left} of {deepest}");

    trackbed([
        "mesh",
        "convert",
        &shipped("solid/embankment_plastic.toml").display().to_string(),
        &folder.join("lists").display().to_string(),
    ])
    .good();
    let list = std::fs::read_to_string(folder.join("lists/ELEMENTNUM.DAT")).unwrap();
    let material: std::collections::HashMap<u32, u32> = list
        .lines()
        .map(|l| l.split_whitespace().map(|w| w.parse().unwrap()).collect::<Vec<u32>>())
        .map(|row| (row[0], row[1]))
        .collect();
    let gauss = Table::read(&folder.join("out/gauss.csv"));
    let at = ["element", "sxx", "syy", "szz", "sxy", "syz", "szx"].map(|name| gauss.index(name));
    let tan = 20.0_f64.to_radians().tan();
    let root = (9.0 + 12.0 * tan * tan).sqrt();
    let (kappa, mut seen, mut yielded) = (gauss.index("equivalent_plastic_strain"), [0; 2], [0; 2]);
    for row in &gauss.rows {
        let [e, xx, yy, zz, xy, yz, zx] = at.map(|i| row[i]);
        let stress = nalgebra::Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz);
        let upper = usize::from(material[&(e as u32)] == 2);
        seen[upper] += 1;
        yielded[upper] += usize::from(row[kappa] > 1e-6);
        if upper == 1 {
            let most = stress.symmetric_eigenvalues().max();
            assert!(most < 2e3 * 1.001, "element {e}: tension {most} Pa");
        } else {
            let p = stress.trace() / 3.0;
            let deviator = stress - nalgebra::Matrix3::identity() * p;
            let f = (0.5 * deviator.norm_squared()).sqrt() + 3.0 * tan / root * p - 3.0 / root * 15e3;
            assert!(f < 1.0, "element {e}: {f} Pa outside the cone");
        }
    }
    assert_eq!(seen, [14 * 4 * 8, 14 * 3 * 8]);
    println!("points that have yielded: {yielded:?} of {seen:?}");
    assert!(yielded.iter().all(|n| *n > 50), "both materials yield: {yielded:?}");
}
