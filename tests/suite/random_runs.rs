//! Random scenes: energy error at most 2 %, or a warning.
//!
//! `TRACKBED_RANDOM` sets the number of each kind:
//!
//! ```text
//! TRACKBED_RANDOM=400 cargo test --workspace --release --test suite random_runs -- --nocapture
//! ```

use super::support::{Folder, json, trackbed};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Relative energy error that requires a warning.
const BOUND: f64 = 0.02;

struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn decade(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.next())
    }

    fn choose<'a>(&mut self, from: &[&'a str]) -> &'a str {
        from[(self.next() * from.len() as f64) as usize]
    }
}

fn material(random: &mut Random, name: &str) -> String {
    let hertz = random.next() < 0.3;
    let constants = if hertz {
        format!("young = {:e}\npoisson = {}", random.decade(1e7, 1e10), random.between(0.0, 0.45))
    } else {
        format!("stiffness = {:e}\ntangential_ratio = {}", random.decade(1e5, 2e7), random.between(0.2, 1.0))
    };
    format!(
        "[[material]]\nname = \"{name}\"\ndensity = {}\nfriction = {}\nrestitution = {}\n{constants}\n",
        random.between(1500.0, 3000.0),
        random.between(0.0, 1.0),
        random.between(0.1, 1.0),
    )
}

fn impact(random: &mut Random) -> String {
    let mut text = material(random, "stone");
    let mut spheres = String::new();
    let (radius, height) = (random.decade(0.01, 0.08), 0.4);
    for k in 0..1 + (random.next() * 4.0) as usize {
        let (x, y) = (0.2 + 0.2 * k as f64, random.between(0.2, 0.8));
        let z = height + radius * random.between(1.01, 1.6);
        write!(spheres, "[{x}, {y}, {z}, {radius}], ").unwrap();
    }
    let speed = random.decade(0.05, 5.0);
    let tilt = random.between(-0.7, 0.7);
    write!(
        text,
        "[[grains]]\nname = \"balls\"\nshape = \"sphere\"\nmaterial = \"stone\"\nspheres = [{spheres}]\n\
         velocity = [{}, 0.0, {}]\n",
        speed * tilt.sin(),
        -speed * tilt.cos(),
    )
    .unwrap();
    format!(
        "{text}\n[solid]\nblock = {{ x = {{ lines = [0.0, 1.0], counts = [{n}] }}, y = {{ lines = [0.0, 1.0], counts = [{n}] }}, z = \
         {{ lines = [0.0, {height}], counts = [2] }} }}\n[[solid.material]]\nid = 1\nyoung = {:e}\npoisson = {}\ndensity = {}\n\
         [[solid.support]]\nside = \"z-\"\ndirections = [\"x\", \"y\", \"z\"]\n[coupling]\nmaterial = \"stone\"\nscheme = \"{}\"\n\
         substeps = \"auto\"\n[time]\nend = {}\n[output]\nframes = 0\n",
        random.decade(3e6, 3e9),
        random.between(0.0, 0.45),
        random.between(1500.0, 2500.0),
        random.choose(&["predicted", "predicted", "iterated", "lagged"]),
        (2.0 * radius / speed).min(0.3) + 0.01,
        n = 2 + (random.next() * 3.0) as usize,
    )
}

fn bed(random: &mut Random) -> String {
    let mut text = material(random, "stone") + &material(random, "box");
    // Both materials need constants of the same law.
    if text.matches("young").count() == 1 {
        text = material(&mut Random(1), "stone") + &material(&mut Random(1), "box");
    }
    let size = random.decade(0.01, 0.05);
    let wide = 8.0 * size;
    write!(
        text,
        "[[grains]]\nname = \"bed\"\nshape = \"sphere\"\nmaterial = \"stone\"\ncount = {}\nsize = [{size}, {}]\nseed = {}\nfill = \
         {{ low = [0.0, 0.0, 0.0], high = [{wide}, {wide}] }}\n",
        60 + (random.next() * 120.0) as usize,
        size * random.between(1.0, 2.5),
        1 + (random.next() * 1e6) as usize,
    )
    .unwrap();
    for (point, normal) in [
        ([0.0; 3], [0.0, 0.0, 1.0]),
        ([0.0; 3], [1.0, 0.0, 0.0]),
        ([wide, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        ([0.0; 3], [0.0, 1.0, 0.0]),
        ([0.0, wide, 0.0], [0.0, -1.0, 0.0]),
    ] {
        write!(
            text,
            "[[walls]]\nkind = \"plane\"\nmaterial = \"box\"\npoint = {point:?}\nnormal = {normal:?}\n"
        )
        .unwrap();
    }
    text + &format!("[time]\nend = {}\n[output]\nframes = 0\n", 6.0 * (size / 9.81).sqrt())
}

/// Runs scenes; outcomes by kind and the largest error without warning.
fn run_all(name: &str, scene: impl Fn(&mut Random) -> String, count: u64) {
    let folder = Folder::new(name);
    let mut ends: BTreeMap<String, u32> = BTreeMap::new();
    let (mut worst, mut wrong) = (0.0_f64, Vec::new());
    for k in 0..count {
        let mut random = Random(k.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0xd1b5_4a32_d192_ed03);
        for _ in 0..4 {
            random.next();
        }
        let file = folder.write(&format!("scene{k}.toml"), &scene(&mut random));
        let out = folder.join(&format!("out{k}"));
        let done =
            trackbed(["run", file.to_str().unwrap(), "--out", out.to_str().unwrap(), "--threads", "1"]);
        if done.code != 0 {
            let said = done.stderr.lines().last().unwrap_or_default();
            let known =
                [2, 3].contains(&done.code) && said.starts_with("error: ") && !said.contains("has failed");
            if !known {
                wrong.push(format!("scene {k}: {done:?}"));
            }
            let class = if done.code == 2 { "refused: " } else { "stopped: " };
            let head: String = said.chars().skip_while(|c| *c != ':').take(60).collect();
            *ends
                .entry(format!("{class}{}", head.replace(|c: char| c.is_ascii_digit(), "#")))
                .or_default() += 1;
            continue;
        }
        let summary = json(&out.join("summary.json"));
        let error = summary["energy"]["largest_relative_error"].as_f64().unwrap();
        let warned =
            summary["verdict"]["outcome"] != "passed" || summary.to_string().contains("energy account");
        if error > BOUND && !warned {
            wrong.push(format!("scene {k}: an error of {error:.2e}, and not a word\n{}", scene(&mut random)));
        }
        if !warned {
            worst = worst.max(error);
        }
        *ends.entry(if warned { "warned".into() } else { "passed".to_string() }).or_default() += 1;
    }
    println!("{name}: {ends:?}, largest error of those that passed {worst:.1e}");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    // Most runs must pass.
    assert!(ends.get("passed").copied().unwrap_or(0) as u64 * 2 > count, "{ends:?}");
}

fn count(ordinary: u64) -> u64 {
    std::env::var("TRACKBED_RANDOM").ok().and_then(|n| n.parse().ok()).unwrap_or(ordinary)
}

#[test]
fn impacts_on_a_solid() {
    run_all("random_impacts", impact, count(25));
}

#[test]
fn beds_in_a_box() {
    run_all("random_beds", bed, count(15));
}
