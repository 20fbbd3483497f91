//! Keys of the solid with closed-form effects.

use super::support::{Folder, SOLID, Table, run, scene_folder, small_block, trackbed, write_lists};

/// 1 m³ between smooth platens, compressed by 10 mm.
const CUBE: &str = r#"title = "cube"

[solid]
gravity = false
integration = "full"

[solid.block]
x = { lines = [0.0, 1.0], counts = [1] }
y = { lines = [0.0, 1.0], counts = [1] }
z = { lines = [0.0, 1.0], counts = [1] }

[[solid.material]]
id = 1
YIELD
young = "20 MPa"
poisson = 0.3
density = 2000

[[solid.support]]
side = "x-"
directions = ["x"]

[[solid.support]]
side = "y-"
directions = ["y"]

[[solid.support]]
side = "z-"
directions = ["z"]

[[solid.support]]
name = "plate"
side = "z+"
directions = ["z"]
displacement = "-10 mm"
history = { kind = "ramp", duration = 1.0 }

[solid.quasi_static]

[time]
end = 1.0
solid_step = 0.1

[output]
vtk = false
tecplot = false
tables = true
"#;

/// Final platen stress [Pa].
fn pressed(yielding: &str, set: &[&str]) -> f64 {
    let folder = Folder::new("cube");
    let scene = folder.write("scene.toml", &CUBE.replace("YIELD", yielding));
    run(&scene, &folder.join("out"), set).good();
    let history = Table::read(&folder.join("out/history.csv"));
    *history.column("plate_reaction_z").last().unwrap()
}

#[test]
fn hardening_in_uniaxial_stress() {
    let exact = -20e6 * (50e3 + 2e6 * 0.01) / (20e6 + 2e6);
    for model in ["von_mises", "tresca"] {
        let slope = format!("model = \"{model}\"\nyield_stress = \"50 kPa\"\nhardening = \"2 MPa\"");
        let table = format!("model = \"{model}\"\nhardening_table = [[0.0, 50e3], [1.0, 2.05e6]]");
        for (law, set) in [(&slope, None), (&table, None), (&slope, Some("solid.order=linear"))] {
            let found = pressed(law, set.as_slice());
            assert!((found / exact - 1.0).abs() < 1e-6, "{law} {set:?}: {found}, expected {exact}");
        }
    }
}

/// 2 c cos φ/(1 − sin φ).
#[test]
fn strength_of_a_frictional_cube() {
    let phi = 30.0_f64.to_radians();
    let exact = -2.0 * 20e3 * phi.cos() / (1.0 - phi.sin());
    let law = |friction: &str| {
        format!("model = \"mohr_coulomb\"\ncohesion = \"20 kPa\"\n{friction}\ndilation = \"10 deg\"")
    };
    let plain = law("friction = \"30 deg\"");
    let table = law("friction_table = [[0.0, \"30 deg\"], [0.5, \"30 deg\"]]");
    for (law, set) in [(&plain, None), (&table, None), (&plain, Some("solid.newton.solver=krylov"))] {
        let found = pressed(law, set.as_slice());
        assert!((found / exact - 1.0).abs() < 1e-6, "{law} {set:?}: {found}, expected {exact}");
    }
}

const GROUND: &str = r#"title = "ground"

[solid]
integration = "full"

[solid.block]
x = { lines = [0.0, 1.0], counts = [1] }
y = { lines = [0.0, 1.0], counts = [1] }
z = { lines = [0.0, 2.0, 4.0], counts = [2, 2] }
layer = [{ material = 1, top = 2.0 }, { material = 2 }]

[solid.initial_stress]
method = "k0"
k0 = 1.5
layers = [[4.0, 1000], [2.0, 2000]]

[[solid.material]]
id = 1
model = "mohr_coulomb"
young = "20 MPa"
poisson = 0.25
density = 2000
cohesion = "1 kPa"
friction = "30 deg"
dilation = "5 deg"

[[solid.material]]
id = 2
k0 = 0.7
young = "20 MPa"
poisson = 0.25
density = 1000

[[solid.support]]
side = "x-"
directions = ["x"]

[[solid.support]]
side = "x+"
directions = ["x"]

[[solid.support]]
side = "y-"
directions = ["y"]

[[solid.support]]
side = "y+"
directions = ["y"]

[[solid.support]]
side = "z-"
directions = ["z"]

[solid.quasi_static]

[time]
end = 1.0
solid_step = 1.0

[output]
vtk = false
tecplot = false
tables = true
"#;

/// Layered K₀ ground: γ z and K₀ γ z at every Gauss point, no motion. Gravity loading gives ν/(1 − ν).
#[test]
fn initial_stress_of_level_ground() {
    let gravity = GROUND
        .replace("method = \"k0\"\nk0 = 1.5\nlayers = [[4.0, 1000], [2.0, 2000]]", "method = \"gravity\"")
        .replace("k0 = 0.7\n", "");
    for (scene, ratios) in [(GROUND, [1.5, 0.7]), (gravity.as_str(), [1.0 / 3.0; 2])] {
        let folder = Folder::new("ground");
        let file = folder.write("scene.toml", scene);
        run(&file, &folder.join("out"), &[]).good();
        let gauss = Table::read(&folder.join("out/gauss.csv"));
        let column = |name: &str| gauss.column(name);
        let (element, zeta) = (column("element"), column("zeta"));
        for i in 0..element.len() {
            let z = element[i] - 0.5 + 0.5 * zeta[i];
            let vertical = -9.81 * if z > 2.0 { 1000.0 * (4.0 - z) } else { 2000.0 + 2000.0 * (2.0 - z) };
            let ratio = ratios[usize::from(z > 2.0)];
            for (name, expected) in [("szz", vertical), ("sxx", ratio * vertical), ("syy", ratio * vertical)]
            {
                let found = column(name)[i];
                assert!((found - expected).abs() < 1.0, "{name} at {z}: {found}, expected {expected} Pa");
            }
        }
        let nodes = Table::read(&folder.join("out/nodes.csv"));
        assert!(nodes.column("uz").iter().all(|u| u.abs() < 1e-9), "displacements are set to zero");
    }
}

#[test]
fn a_mesh_in_millimetres() {
    let metres = scene_folder("metres", SOLID);
    let scaled = SOLID.replace("[solid]\n", "[solid]\nscale = 0.001\n");
    let millimetres = Folder::new("millimetres");
    let mut mesh = small_block();
    mesh.coordinates.iter_mut().flatten().for_each(|x| *x *= 1e3);
    write_lists(&mesh, millimetres.path());
    millimetres.write("scene.toml", &scaled);
    let settlement = |folder: &Folder| {
        run(&folder.join("scene.toml"), &folder.join("out"), &[]).good();
        Table::read(&folder.join("out/nodes.csv")).column("uz")
    };
    let (a, b) = (settlement(&metres), settlement(&millimetres));
    let largest = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert!(largest > 1e-5 && a.len() == b.len());
    assert!(a.iter().zip(&b).all(|(x, y)| (x - y).abs() < 1e-10 * largest));
    let scene = millimetres.join("scene.toml");
    millimetres.write("scene.toml", &SOLID.replace("[solid]\n", "[solid]\nscale = -1\n"));
    let refused = trackbed(["check", scene.to_str().unwrap()]);
    assert!(
        refused.code == 2 && refused.stderr.contains("solid.scale: found -1, expected above 0"),
        "{refused:?}"
    );
    let block = "title = \"a\"\n[solid]\nscale = 2\nblock = { x = { lines = [0, 1], counts = [1] }, y = { lines = [0, 1], counts = [1] }, z \
                 = { lines = [0, 1], counts = [1] } }\n[[solid.material]]\nid = 1\nyoung = 1e7\npoisson = 0.2\ndensity = 2000\n";
    millimetres.write("scene.toml", block);
    let refused = trackbed(["check", scene.to_str().unwrap()]);
    assert!(refused.stderr.contains("solid.scale: found together with [solid.block]"), "{refused:?}");
}
