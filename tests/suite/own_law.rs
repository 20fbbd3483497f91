//! Own contact law: restitution of viscoelastic spheres, shipped laws as formulas in a bed, refused formulas.

use super::support::{Folder, Outcome, Table, repository, run, trackbed};
use std::fs;
use std::process::Command;

#[test]
fn viscoelastic_spheres_lose_speed_as_the_series() {
    let folder = Folder::new("own-law");
    let out = folder.join("out");
    run(&repository().join("inputs/grains/own_law.toml"), &out, &[]).good();
    let history = Table::read(&out.join("history.csv"));
    let (modulus, radius, time) = (0.5 * 1e9 / (1.0 - 0.04), 0.005_f64, 2e-6);
    let stiffness = 4.0 / 3.0 * modulus * radius.sqrt();
    let mass = 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    for (k, speed) in [0.01_f64, 0.03, 0.1, 0.3, 1.0].into_iter().enumerate() {
        let found = history.column(&format!("sphere_{}_v_z", k + 1)).last().unwrap() / speed;
        let b = 1.5 * time * (stiffness / mass).powf(0.4) * speed.powf(0.2);
        let expected = 1.0 - 1.15344 * b + 0.79826 * b * b;
        println!("restitution at {speed} m/s: {found:.5}, series {expected:.5}");
        // The next term is about -0.52 b^3.
        assert!((found - expected).abs() < 0.7 * b.powi(3) + 2e-4, "{speed}: {found} {expected}");
    }
}

const BED: &str = r#"[[material]]
name = "stone"
density = 2600
friction = 0.5
restitution = 0.5
tangential_damping_ratio = 0.3
MATERIAL
[[grains]]
name = "bed"
shape = "sphere"
material = "stone"
count = 300
size = [0.01, 0.02]
fill = { low = [0, 0, 0], high = [0.1, 0.1] }
[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "stone"
[periodic]
x = [0, 0.1]
y = [0, 0.1]
[time]
grain_step = 1e-5
end = 0.3
[output]
frames = 1
vtk = false
packing = true
"#;

const LINEAR: &str = r#"[contact_law]
name = "own"
force = "K*d"
damping = "c = 2*zeta*sqrt(K); x = 0.5*c*dt*sqrt(w); c*(4 + x)/(sqrt(w)*(4 + 3*x))"
"#;
const HERTZ: &str = r#"[contact_law]
name = "own"
force = "t = 2*E*sqrt(R*d); 2/3*t*d"
damping = "t = 2*E*sqrt(R*d); c = 1.8257418583505538*zeta*sqrt(t*w); x = 0.5*dt*c; c*(4 + x)/(w*(4 + 3*x))"
"#;
const WALTON_BRAUN: &str = r#"[contact_law]
name = "own"
force = "K*D - K/(e*e)*(D - d)"
energy = "f = max(K*D - K/(e*e)*(D - d), 0); 0.5*f*f/(K/(e*e))"
loss = "0.5*K*(1 - e*e)*(D*D - D0*D0)"
"#;

#[test]
fn shipped_laws_as_formulas_give_the_same_bed() {
    let folder = Folder::new("own-bed");
    for (name, law, material, shipped) in [
        ("linear", LINEAR, "stiffness = 1e5", "linear"),
        ("hertz", HERTZ, "young = 1e7\npoisson = 0.2", "hertz"),
        ("walton", WALTON_BRAUN, "stiffness = 1e5", "walton_braun"),
    ] {
        let ran = |law: &str, normal: &str, compiler: &str| {
            let keys = format!("{material}\nnormal = \"{normal}\"");
            let damped = if shipped == "walton_braun" { "tangential_damping_ratio = 0.3\n" } else { "" };
            let text = BED.replace("MATERIAL", &keys).replace(damped, "") + law;
            let out = folder.join(&format!("{name}-{normal}-{compiler}"));
            let mut command = Command::new(env!("CARGO_BIN_EXE_trackbed"));
            command.arg("run").arg(folder.write("scene.toml", &text)).arg("--out").arg(&out);
            let done = command.args(["--threads", "1"]).env("CC", compiler).output().unwrap();
            assert!(done.status.success());
            (fs::read(out.join("packing.csv")).unwrap(), String::from_utf8(done.stderr).unwrap())
        };
        let (bed, notes) = ran("", shipped, "");
        assert!(bed.len() > 10_000 && !notes.contains("contact law"), "{name}: {notes}");
        for (compiler, expected) in [
            ("", "contact law \"own\" compiled by cc"),
            ("no-such-compiler", "contact law \"own\" interpreted, slower: no-such-compiler: "),
        ] {
            let (own, notes) = ran(law, "own", compiler);
            assert!(own == bed && notes.contains(expected), "{name}: {notes}");
        }
    }
}

#[test]
fn laws_that_are_wrong_are_refused() {
    let folder = Folder::new("own-refused");
    let bed = |law: &str| BED.replace("MATERIAL", "stiffness = 1e5\nnormal = \"own\"") + law;
    for (law, expected) in [
        (
            LINEAR.replace("K*d", "K*d + 1"),
            "contact_law.force: found for \"stone\" and \"stone\" a force of 1",
        ),
        (LINEAR.replace("\"K*d\"", "\"K*delta\""), "contact_law.force: found the unknown name `delta`"),
        (
            LINEAR.replace("c = 2*zeta", "c = -2*zeta"),
            "contact_law.damping: found for \"stone\" and \"stone\" a closed cycle that gains",
        ),
        (
            LINEAR.to_string() + "constants = { unused = 1.0 }\n",
            "contact_law.constants.unused: found, but it has no effect",
        ),
        (LINEAR.replace("name = \"own\"", "name = \"hertz\""), "a name that no shipped law has"),
        (LINEAR.to_string() + "constants = { K = 1.0 }\n", "new names of letters, digits and _"),
        (LINEAR.to_string() + "loss = \"0\"\n", "contact_law.loss: found a formula"),
    ] {
        let scene = folder.write("scene.toml", &bed(&law)).display().to_string();
        let Outcome { code, stderr, .. } = trackbed(["check", &scene]);
        assert!(code == 2 && stderr.contains(expected), "{code}: {stderr}\nexpected: {expected}");
    }
    let scene = folder.write("scene.toml", &bed(LINEAR)).display().to_string();
    let Outcome { code, stdout, .. } = trackbed(["check", &scene]);
    assert!(code == 0 && stdout.contains("contact law \"own\", stone and stone: force, energy"), "{stdout}");
    let out = folder.join("out").display().to_string();
    let Outcome { code, stderr, .. } = trackbed(["run", &scene, "--out", &out, "--set", "time.end=0.01"]);
    assert!(code == 0 && stderr.contains("contact law \"own\", stone and stone"), "{code}: {stderr}");
}
