use super::form::{CHECKSUM, FORM, MAGIC, read};
use super::*;
use crate::hash::Hash;
use trackbed_dem as dem;
use trackbed_io::scratch::folder;

const SCENE: &str = "title = \"a\"\n[time]\nend = 1.0\n[[probe]]\nnode = 1\n";

fn document(text: &str) -> Document {
    Document::parse(Path::new("scene.toml"), text.to_string()).unwrap()
}

fn origin(text: &str, hash: &str) -> Origin {
    Origin {
        version: "1.2.3".into(),
        scene_hash: hash.into(),
        scene: text.into(),
        files: vec![("mesh.cdb".into(), "77".into())],
        ..Origin::default()
    }
}

fn moment(step: u64) -> Moment {
    Moment { stage: "run".into(), step, time: 0.1 * step as f64 }
}

#[test]
fn restores_parts_bitwise() {
    let dir = folder("checkpoint_bits");
    let mut slots = Slots::new(&dir, origin(SCENE, "5"));
    let values: Vec<f64> =
        (0..100_000).map(|k| f64::from_bits(0x9e37_79b9_7f4a_7c15_u64.wrapping_mul(k))).collect();
    let special = [f64::INFINITY, f64::NEG_INFINITY, -0.0, f64::MIN_POSITIVE / 8.0, f64::MAX];
    slots
        .save(moment(3), |body| {
            body.put(&values)?;
            body.put(&(special, Some("text"), u64::MAX))
        })
        .unwrap();
    let (mut loaded, remark) = Slots::new(&dir, origin(SCENE, "5")).load(&document(SCENE)).unwrap();
    assert_eq!((loaded.moment.clone(), remark), (moment(3), vec![]));
    let bits = |v: &[f64]| v.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&loaded.take::<Vec<f64>>().unwrap()), bits(&values));
    let (back, text, number): ([f64; 5], Option<String>, u64) = loaded.take().unwrap();
    assert_eq!((bits(&back), text.as_deref(), number), (bits(&special), Some("text"), u64::MAX));
    assert!(loaded.take::<u64>().is_err(), "there is no more");
    fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn falls_back_to_undamaged_slot() {
    let dir = folder("checkpoint_slots");
    let new = || Slots::new(&dir, origin(SCENE, "5"));
    let none = new().load(&document(SCENE)).err().unwrap().to_string();
    assert!(none.contains("no checkpoint in"), "{none}");
    let mut slots = new();
    for step in 0..5 {
        slots.save(moment(step), |body| body.put(&(step, vec![1.5; 1000]))).unwrap();
    }
    let (a, b) = (dir.join("checkpoint/a.checkpoint"), dir.join("checkpoint/b.checkpoint"));
    let load = || {
        let (mut loaded, remark) = new().load(&document(SCENE))?;
        Ok::<_, Failure>((loaded.take::<(u64, Vec<f64>)>()?.0, remark))
    };
    assert_eq!(load().unwrap(), (4, vec![]));
    let whole = fs::read(&a).unwrap();
    // Single bit flips and truncations.
    for at in (0..whole.len()).step_by(97).chain([0, 30, whole.len() - 1]) {
        let mut bytes = whole.clone();
        bytes[at] ^= 4;
        fs::write(&a, &bytes).unwrap();
        let (step, remark) = load().unwrap();
        assert!(step == 3 && remark.concat().contains("a.checkpoint is damaged"), "byte {at}");
        fs::write(&a, &whole[..at]).unwrap();
        assert_eq!(load().unwrap().0, 3, "cut at {at}");
    }
    fs::write(&b, "nonsense").unwrap();
    let error = load().unwrap_err();
    assert!(error.is_input(), "{error}");
    assert!(error.to_string().contains("b.checkpoint is damaged"), "{error}");
    // Resuming overwrites the damaged slot first.
    fs::write(&a, &whole).unwrap();
    let mut slots = new();
    slots.load(&document(SCENE)).unwrap();
    slots.save(moment(5), |body| body.put(&(5_u64, Vec::<f64>::new()))).unwrap();
    assert_eq!(load().unwrap(), (5, vec![]));
    assert_eq!(fs::read(&a).unwrap(), whole);
    slots.clear().unwrap();
    assert!(!dir.join("checkpoint").exists());
    fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn first_save_removes_foreign_checkpoints() {
    let dir = folder("checkpoint_other");
    let mut old = Slots::new(&dir, origin(SCENE, "4"));
    (0..4).for_each(|k| old.save(moment(k), |body| body.put(&k)).unwrap());
    let mut slots = Slots::new(&dir, origin(SCENE, "5"));
    assert!(!slots.has_one());
    slots.save(moment(0), |body| body.put(&7_u64)).unwrap();
    assert!(slots.has_one() && fs::read_dir(slots.dir()).unwrap().count() == 1);
    let (mut loaded, _) = Slots::new(&dir, origin(SCENE, "5")).load(&document(SCENE)).unwrap();
    assert_eq!(loaded.take::<u64>().unwrap(), 7);
    fs::remove_dir_all(&dir).unwrap();
}

/// No partial file remains.
#[test]
fn failed_write_keeps_last_checkpoint() {
    let dir = folder("checkpoint_full");
    let mut slots = Slots::new(&dir, origin(SCENE, "5"));
    slots.save(moment(1), |body| body.put(&1_u64)).unwrap();
    for _ in 0..2 {
        let full = slots.save(moment(2), |body| {
            body.put(&vec![0.5; 100_000])?;
            Err(io::Error::other("no space left on device"))
        });
        assert!(full.unwrap_err().to_string().contains("no space left on device"));
        assert_eq!(fs::read_dir(slots.dir()).unwrap().count(), 1);
    }
    let (loaded, _) = Slots::new(&dir, origin(SCENE, "5")).load(&document(SCENE)).unwrap();
    assert_eq!(loaded.moment, moment(1));
    fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn another_program_or_scene_is_named() {
    let old = origin(SCENE, "5");
    let difference_of = |now: Origin, text: &str, set: &[&str]| {
        let mut document = document(text);
        set.iter().for_each(|s| document.set(s).unwrap());
        now.difference(&old, &document).unwrap_or_default()
    };
    assert_eq!(difference_of(old.clone(), SCENE, &[]), "");
    assert_eq!(
        difference_of(Origin { version: "1.2.4".into(), ..old.clone() }, SCENE, &[]),
        "found program version 1.2.3, expected 1.2.4"
    );
    let changed = SCENE.replace("1.0", "2.0");
    assert!(difference_of(origin(&changed, "6"), &changed, &[]).ends_with("time.end was 1.0, now 2.0"));
    let longer = format!("{SCENE}at = [1, 2]\n");
    assert!(difference_of(origin(&longer, "6"), &longer, &[]).ends_with("probe.0.at was absent, now [1, 2]"));
    let overridden = Origin { overrides: vec!["probe.0.node=2".into()], ..origin(SCENE, "6") };
    assert!(difference_of(overridden, SCENE, &["probe.0.node=2"]).ends_with("probe.0.node was 1, now 2"));
    let mesh = Origin { files: vec![("mesh.cdb".into(), "78".into())], ..origin(SCENE, "6") };
    assert!(difference_of(mesh, SCENE, &[]).ends_with("mesh.cdb has changed"));
    let comment = format!("# more\n{SCENE}");
    assert!(difference_of(origin(&comment, "6"), &comment, &[]).ends_with("but no key"));
}

#[test]
fn another_processor_is_remarked() {
    let dir = folder("checkpoint_processor");
    let of = |processor: &str| Origin { processor: processor.into(), ..origin(SCENE, "5") };
    Slots::new(&dir, of("x86_64 avx2 fma")).save(moment(1), |body| body.put(&1_u64)).unwrap();
    let load = |processor| Slots::new(&dir, of(processor)).load(&document(SCENE)).unwrap().1;
    assert!(load("x86_64 avx2 fma").is_empty());
    let remarks = load("aarch64");
    assert!(
        remarks.len() == 1 && remarks[0].contains("x86_64 avx2 fma") && remarks[0].contains("aarch64"),
        "{remarks:?}"
    );
    assert!(processor().starts_with(std::env::consts::ARCH));
    fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn another_form_is_refused() {
    let dir = folder("checkpoint_form");
    let mut slots = Slots::new(&dir, origin(SCENE, "5"));
    slots.save(moment(1), |body| body.put(&1_u64)).unwrap();
    let file = dir.join("checkpoint/a.checkpoint");
    let mut bytes = fs::read(&file).unwrap();
    let digits = FORM.to_string().len();
    bytes.splice(MAGIC.len()..MAGIC.len() + digits, *b"9876");
    // A foreign format, not damage.
    let end = bytes.len() - CHECKSUM;
    let mut hash = Hash::default();
    hash.add(&bytes[..end]);
    bytes.splice(end.., hash.value().to_le_bytes());
    fs::write(&file, bytes).unwrap();
    let error = Slots::new(&dir, origin(SCENE, "5")).load(&document(SCENE)).err().unwrap();
    let message = format!("found checkpoint format version 9876, expected {FORM}");
    assert!(error.to_string().ends_with(&message), "{error}");
    fs::remove_dir_all(&dir).unwrap();
}

/// Random bytes with a valid checksum: never a panic or huge allocation.
#[test]
fn crafted_checkpoints_are_read_or_refused() {
    let dir = folder("checkpoint_crafted");
    let mut slots = Slots::new(&dir, origin(SCENE, "5"));
    let parts = (vec![1.5_f64; 20], vec![vec![1_u32; 3]; 4], Some("text".to_string()), [0.5; 3]);
    slots.save(moment(1), |body| body.put(&parts)).unwrap();
    let whole = fs::read(dir.join("checkpoint/a.checkpoint")).unwrap();
    let mut number = 1_u64;
    let mut below = |n: usize| {
        number = number.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (number >> 33) as usize % n
    };
    for _ in 0..20_000 {
        let mut bytes = whole[..whole.len() - CHECKSUM].to_vec();
        for _ in 0..=below(4) {
            let at = below(bytes.len());
            match below(3) {
                0 => bytes[at] = below(256) as u8,
                1 => bytes.truncate(at + 1),
                _ => bytes.splice(at..at, [0xff; 9]).for_each(drop),
            }
        }
        let mut hash = Hash::default();
        hash.add(&bytes);
        bytes.extend(hash.value().to_le_bytes());
        if let Ok((header, mut loaded)) = read(bytes) {
            let _ = origin(SCENE, "6").difference(&header.origin, &document(SCENE));
            let _ = loaded.take::<(Vec<f64>, Vec<Vec<u32>>, Option<String>, [f64; 3])>();
        }
    }
    fs::remove_dir_all(&dir).unwrap();
}

fn spheres(centres: impl Iterator<Item = dem::Vec3>) -> dem::ModelInput {
    let material = dem::Material {
        density: 2600.0,
        stiffness: 1e5,
        tangential_ratio: 0.5,
        tangential_damping_ratio: 0.1,
        friction: 0.5,
        restitution: 0.5,
        ..dem::Material::default()
    };
    dem::ModelInput {
        materials: vec![material],
        shapes: vec![dem::shape::Shape::Sphere { radius: 0.01 }],
        bodies: centres.map(|position| dem::BodyInput { position, ..dem::BodyInput::default() }).collect(),
        ..dem::ModelInput::default()
    }
}

#[test]
fn grain_state_is_bitwise_after_restarts() {
    const RESTARTS: [u64; 8] = [1, 331, 700, 1234, 4999, 5000, 5001, 5390];
    let place = |k: usize| {
        let wave = 0.002 * (k as f64 * 1.7).sin();
        dem::Vec3::new(
            0.021 * (k % 6) as f64 + wave,
            0.021 * (k / 6 % 6) as f64,
            0.03 + 0.021 * (k / 36) as f64,
        )
    };
    let mut input = spheres((0..288).map(place));
    input.time_step = dem::TimeStep::Auto { fraction: 0.5 };
    input.bodies.iter_mut().for_each(|b| b.velocity.z = -1.0);
    input.planes.push(dem::Plane {
        point: dem::Vec3::zeros(),
        normal: dem::Vec3::z(),
        material: 0,
        velocity: dem::Vec3::zeros(),
    });
    let at = |x: f64, y: f64| dem::Vec3::new(x, y, 0.012);
    input.triangles.push(dem::TriangleSurface {
        vertices: vec![at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        material: 0,
        velocity: dem::Vec3::new(0.3, 0.0, 0.0),
    });
    let model = dem::Model::new(input).unwrap();
    let dir = folder("checkpoint_grains");
    let run = |restarts: &[u64]| {
        let mut slots = Slots::new(&dir, origin(SCENE, "5"));
        let mut state = dem::State::new(&model);
        let mut work = dem::Work::new(&model, &state);
        let mut seen = Vec::new();
        while state.steps < 5400 {
            dem::step(&model, &mut state, &mut work, &dem::surface::NoSurface, &[]).unwrap();
            // A later neighbour list rebuild would hide differences.
            if RESTARTS.contains(&(state.steps - 1)) {
                seen.push(postcard::to_stdvec(&state).unwrap());
            }
            if restarts.contains(&state.steps) {
                slots.save(moment(state.steps), |body| body.put(&state)).unwrap();
                let (mut loaded, _) = Slots::new(&dir, origin(SCENE, "5")).load(&document(SCENE)).unwrap();
                state = loaded.take().unwrap();
                work = dem::Work::new(&model, &state);
            }
        }
        assert!(state.balance.dissipated() > 0.0 && dem::measure::coordination(&model, &state) > 0.1);
        seen.push(postcard::to_stdvec(&state).unwrap());
        seen
    };
    assert!(run(&[]) == run(&RESTARTS));
    fs::remove_dir_all(&dir).unwrap();
}

/// `cargo test --release --lib checkpoint_of_a_bed -- --ignored --nocapture` prints size and time.
#[test]
#[ignore = "figures of 100,000 spheres, 5 s"]
fn checkpoint_of_a_bed() {
    use std::time::Instant;
    let side = 59_usize;
    // FCC packing: twelve contacts per sphere.
    let pitch = 0.02 * 0.999 * std::f64::consts::SQRT_2;
    let cell = |k: usize| [k % side, k / side % side, k / side / side];
    let cells = (0..side * side * side).map(cell).filter(|c| c.iter().sum::<usize>().is_multiple_of(2));
    let input = spheres(cells.map(|c| dem::Vec3::from(c.map(|c| 0.5 * pitch * c as f64))));
    let model = dem::Model::new(input).unwrap();
    let mut state = dem::State::new(&model);
    let mut work = dem::Work::new(&model, &state);
    for _ in 0..5 {
        dem::step(&model, &mut state, &mut work, &dem::surface::NoSurface, &[]).unwrap();
    }
    let dir = folder("checkpoint_bed");
    let mut slots = Slots::new(&dir, origin(SCENE, "5"));
    for _ in 0..3 {
        let begun = Instant::now();
        slots.save(moment(5), |body| body.put(&state)).unwrap();
        let written = begun.elapsed().as_secs_f64();
        let begun = Instant::now();
        let (mut loaded, _) = Slots::new(&dir, origin(SCENE, "5")).load(&document(SCENE)).unwrap();
        let back: dem::State = loaded.take().unwrap();
        let read = begun.elapsed().as_secs_f64();
        assert_eq!((back.steps, back.time.to_bits()), (state.steps, state.time.to_bits()));
        let bytes = fs::metadata(dir.join("checkpoint/a.checkpoint")).unwrap().len() as f64;
        println!(
            "{} spheres, {:.1} contacts each: {:.0} bytes per sphere, written in {written:.2} s, read in {read:.2} s",
            model.body_count(),
            dem::measure::coordination(&model, &state),
            bytes / model.body_count() as f64
        );
    }
    fs::remove_dir_all(&dir).unwrap();
}
