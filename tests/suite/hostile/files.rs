//! Sizes and counts are checked before allocation.

use super::super::support::{Folder, GRAINS, PLASTIC, SOLID, repository, scene_folder, trackbed};
use super::{refused, within};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;
use std::process::Command;

/// G3: devices never end, pipes block.
#[test]
fn only_regular_files_are_read() {
    let folder = scene_folder("devices", SOLID);
    let pipe = folder.join("pipe.toml");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let device = "found a device or a pipe, expected a regular file";
    refused([Path::new("check"), Path::new("/dev/zero")], &format!("/dev/zero: file: {device}"));
    refused([Path::new("check"), &pipe], device);
    refused([Path::new("check"), folder.path()], "found a directory, expected a regular file");
    let scene = folder.join("scene.toml").display().to_string();
    let out = folder.join("out").display().to_string();
    let zero = "solid.nodes=/dev/zero";
    refused(["run", &scene, "--out", &out, "--set", zero], &format!("/dev/zero: node list: {device}"));
    refused(
        [
            "check",
            &scene,
            "--set",
            "solid.nodes=",
            "--set",
            "solid.elements=",
            "--set",
            "solid.constraints=",
            "--set",
            "solid.mesh=/dev/zero",
        ],
        "file extension",
    );
    for ending in ["inp", "cdb", "msh", "vtu", "vtk", "stl", "obj", "dat"] {
        let link = folder.join(&format!("zero.{ending}"));
        std::os::unix::fs::symlink("/dev/zero", &link).unwrap();
        let command = if ["stl", "obj", "dat"].contains(&ending) { "stone" } else { "mesh" };
        refused([Path::new(command), Path::new("info"), &link], device);
    }
    let large = folder.join("large.toml");
    std::fs::File::create(&large).unwrap().set_len(1 << 30).unwrap();
    refused([Path::new("check"), &large], "found 1073741824 bytes, expected at most 67108864 bytes");
}

/// G3: counts that would exhaust time or memory.
#[test]
fn counts_are_checked_before_allocation() {
    let folder = Folder::new("counts");
    let plastic = folder.write("plastic.toml", PLASTIC).display().to_string();
    let check = |set: &str, words: &str| refused(["check", &plastic, "--set", set], words);
    check(
        "solid.block.x.counts=[4294967296]",
        "solid.block: found 4294967296 x 1 x 2 elements, expected at most 20000000",
    );
    check("solid.block.x.counts=[100000000]", "found 100000000 x 1 x 2 elements, expected at most 20000000");
    check("solid.block.x.counts=[9223372036854775807]", "expected at most 20000000");
    check("solid.newton.tolerance=1e-300", "expected 1e-12 to 0.01");
    check("solid.quasi_static.smallest_step=1e-300", "expected 1e-9 to 1");
    check("time.solid_step=1e-300", "time.solid_step: found ");
    let slope = repository().join("inputs/solid/slope.toml").display().to_string();
    for (key, expected) in [
        ("tolerance=1e-300", "tolerance: found 1e-300"),
        ("start=1e-300", "start: found 1e-300"),
        ("largest=1e300", "largest: found 1e300"),
    ] {
        let set = format!("solid.strength_reduction.{key}");
        refused(["check", &slope, "--set", &set], &format!("solid.strength_reduction.{expected}"));
    }
    let out = folder.join("out").display().to_string();
    let expected = "--threads: found 100000, expected 1 to ";
    refused(["run", &plastic, "--out", &out, "--threads", "100000"], expected);
    refused(["modal", &plastic, "--out", &out, "--threads", "100000"], expected);
    assert!(!folder.join("out").exists());
}

#[test]
fn absurd_sizes_are_rejected_at_once() {
    let scene = repository().join("inputs/grains/box.toml").display().to_string();
    let check = |set: &str, words: &str| {
        refused(["check", &scene, "--set", set], words);
        let outcome = trackbed(["check", &scene, "--set", set]);
        let numbers = outcome.stderr.split(|c: char| !c.is_alphanumeric());
        assert!(!numbers.into_iter().any(|w| ["inf", "NaN"].contains(&w)), "{outcome:?}");
    };
    let heap = "grains.0.count: found 10000000 grains, a heap of about ";
    check("grains.0.count=10000000", heap);
    check("grains.0.count=10000000", "expected a heap of at most 200 m");
    check("grains.0.count=1000000", "expected a heap of at most 200 m");
    let beyond = "expected a number of usual size, as ";
    for value in ["material.0.stiffness=1e-320", "material.0.density=1e-300"] {
        check(value, &value.replace('=', ": found "));
        check(value, beyond);
    }
    check("material.0.density=1e-320", "mass is 0; it must be positive and finite");
    let beam = repository().join("inputs/verify/beam_modes.toml").display().to_string();
    let out = Folder::new("heavy").join("modes").display().to_string();
    for density in ["1e300", "1e200", "1e-200"] {
        let set = format!("solid.material.0.density={density}");
        refused(["modal", &beam, "--out", &out, "--set", &set], beyond);
    }
    let wide = ["grains.0.count=20000", "grains.0.fill.high=[2, 2]", "walls.2.point=[2, 0, 0]"];
    let sets = wide.iter().chain(&["walls.4.point=[0, 2, 0]"]).flat_map(|s| ["--set", s]);
    trackbed(["check", &scene].into_iter().chain(sets)).good();
}

/// F3: endless steps.
#[test]
fn runs_without_end_are_refused() {
    let folder = Folder::new("endless");
    let scene = folder.write("scene.toml", GRAINS).display().to_string();
    for (set, words) in [
        ("material.0.restitution=1e-30", "material.0.restitution: found 1e-30, expected 0.0001 to 1"),
        ("material.0.restitution=1e-9", "expected 0.0001 to 1"),
        ("time.grain_step_fraction=1e-320", "expected 0.000001 to 1"),
        (
            "time.grain_step=1e-300",
            "time.end: found 0.02 s in steps of 1.0e-300 s, expected at most 1e12 steps",
        ),
        ("time.end=1e300", "expected at most 1e12 steps"),
    ] {
        refused(["check", &scene, "--set", set], words);
        let out = folder.join("out").display().to_string();
        refused(["run", &scene, "--out", &out, "--set", set], words);
    }
    assert!(!folder.join("out").exists());
    let compaction = repository().join("inputs/grains/compaction.toml").display().to_string();
    let cycles = "compaction.0.cycles=4294967295";
    refused(["check", &compaction, "--set", cycles], "compaction: found ");
}

/// G4: ranges stay ranges; nested sets count once.
#[test]
fn abaqus_sets_use_bounded_memory() {
    let folder = Folder::new("sets");
    let block = repository().join("inputs/solid/triaxial_drained.toml");
    let mesh = folder.join("mesh.inp");
    trackbed([Path::new("mesh"), Path::new("convert"), &block, &mesh]).good();
    let head = std::fs::read_to_string(&mesh).unwrap();
    let info = |name: &str, text: &str| {
        let file = folder.write(name, text);
        within(20, [Path::new("mesh"), Path::new("info"), &file]).expect("it is read at once")
    };
    let ranges = "*NSET, NSET=ALL, GENERATE\n1, 100000000\n0, 4294967295\n*NSET, NSET=ODD, GENERATE\n1, 4294967295, 2\n";
    let said = info("ranges.inp", &format!("{head}{ranges}")).good().stdout;
    let nodes: usize = said.lines().find(|l| l.starts_with("nodes")).unwrap()[5..].trim().parse().unwrap();
    let members = |said: &str, set: &str| -> usize {
        let line = said.lines().find(|l| l.starts_with("set") && l.ends_with(&format!(" in {set}")));
        line.unwrap().split_whitespace().nth(1).unwrap().parse().unwrap()
    };
    assert_eq!((members(&said, "ALL"), members(&said, "ODD")), (nodes, nodes.div_ceil(2)), "{said}");
    let absent = 100_000_000 + 4_294_967_296_u64 - 2 * nodes as u64;
    assert!(said.contains(&format!("set ALL names {absent} nodes that are not there")), "{said}");
    // Each set doubles the last: 2^40 members, all equal.
    let mut nested = "*NSET, NSET=S0\n1, 2, 3\n".to_string();
    for k in 1..=40 {
        writeln!(nested, "*NSET, NSET=S{k}\nS{0}, S{0}", k - 1).unwrap();
    }
    let said = info("nested.inp", &format!("{head}{nested}")).good().stdout;
    assert_eq!(members(&said, "S40"), 3, "{said}");
    let mut many = String::from("*NSET, NSET=MANY\n");
    (1..=20_000).for_each(|n| writeln!(many, "{}", 1_000_000 + n).unwrap());
    (0..2_000).for_each(|k| writeln!(many, "*NSET, NSET=M{k}\nMANY").unwrap());
    let outcome = info("many.inp", &format!("{head}{many}"));
    assert_eq!(outcome.code, 2, "{outcome:?}");
    assert!(
        outcome.stderr.contains("sets: found 10") && outcome.stderr.contains("expected at most 10"),
        "{outcome:?}"
    );
    let outcome = info("held.inp", &format!("{head}{ranges}*BOUNDARY\nALL, 1\n"));
    assert!(outcome.code == 2 && outcome.stderr.contains("*BOUNDARY: found node "), "{outcome:?}");
}

/// G4: nested, repeated includes.
#[test]
fn includes_are_counted() {
    let folder = Folder::new("includes");
    for k in 0..5 {
        let text = format!("*INCLUDE, INPUT=f{}.inp\n", k + 1).repeat(100);
        folder.write(&format!("f{k}.inp"), &text);
    }
    folder.write("f5.inp", "*NODE\n1, 0, 0, 0\n");
    let file = folder.join("f0.inp");
    refused(
        [Path::new("mesh"), Path::new("info"), &file],
        "*INCLUDE: found 201 files included, expected at most 200",
    );
    folder.write("self.inp", &"*INCLUDE, INPUT=self.inp\n".repeat(100));
    refused([Path::new("mesh"), Path::new("info"), &folder.join("self.inp")], "expected 10 deep");
}

/// `.vtu` file with compressed zeros as points.
fn bomb(points: &str, zeros: usize) -> Vec<u8> {
    let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    let chunk = vec![0_u8; 1 << 20];
    (0..zeros >> 20).for_each(|_| packed.write_all(&chunk).unwrap());
    let packed = packed.finish().unwrap();
    let head = [1, zeros as u32, 0, packed.len() as u32].map(u32::to_le_bytes).concat();
    let mut file = format!(
        "<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkZLibDataCompressor\"><UnstructuredGrid>\
         <Piece NumberOfPoints=\"{points}\" NumberOfCells=\"1\"><Points><DataArray type=\"Float32\" \
         NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points></Piece></UnstructuredGrid>\
         <AppendedData encoding=\"raw\">_"
    )
    .into_bytes();
    file.extend(head);
    file.extend(packed);
    file
}

/// G4: 0.5 MB that expand to hundreds.
#[test]
fn compressed_arrays_are_checked_before_expansion() {
    let folder = Folder::new("bomb");
    let zeros = 256 << 20;
    let file = folder.join("bomb.vtu");
    std::fs::write(&file, bomb("8", zeros)).unwrap();
    let words = "array  of Points: found 67108864 numbers, expected at most 24 numbers";
    refused([Path::new("mesh"), Path::new("info"), &file], words);
    // Matching count, but too many for the file's size.
    std::fs::write(&file, bomb(&(zeros / 12).to_string(), zeros)).unwrap();
    refused([Path::new("mesh"), Path::new("info"), &file], "numbers, expected at most 1");
}

/// G4: decimal commas would change the values.
#[test]
fn packings_with_decimal_commas_are_refused() {
    let folder = Folder::new("commas");
    let spheres = "spheres = [[0.0, 0.0, 0.051, 0.05], [0.01, 0.0, 0.152, 0.05]]";
    let scene = folder
        .write("scene.toml", &GRAINS.replace(spheres, "packing = \"packing.csv\""))
        .display()
        .to_string();
    let good = "x,y,z,r,note\n0.0,0.0,0.051,0.05,a\n0.01,0.0,0.152,0.05,b\n";
    folder.write("packing.csv", good);
    trackbed(["check", &scene]).good();
    folder.write("packing.csv", "x;y;z;r\n0,0;0,0;0,051;0,05\n0,01;0,0;0,152;0,05\n");
    trackbed(["check", &scene]).good();
    for (text, words) in [
        (
            "0,0,0,0,0,051,0,05\n",
            "packing.csv:1: row: found 8 columns, expected x, y, z, r: 4 columns; decimals behind a point",
        ),
        (
            "x,y,z,r\n0,01,0,0,0,051,0,05\n",
            "packing.csv:2: row: found 8 columns, expected x, y, z, r: 4 columns, as in the heading",
        ),
        (
            "x\ty\tz\tr\n0,01\t0,0\t0,051\t0,05\n",
            "packing.csv:2: x: found \"0,01\", expected a number with a decimal point; decimal commas only between semicolons",
        ),
        ("0.0,0.0,0.051\n", "packing.csv:1: row: found 3 columns, expected x, y, z, r: 4 columns"),
    ] {
        folder.write("packing.csv", text);
        refused(["check", &scene], words);
    }
}
