//! `trackbed render`: pixels of known pictures, threads, videos, rejected input.

pub(super) mod files;

use super::support::{Folder, trackbed};
use files::{Pixels, chains, grains, series, solid};
use std::fs;
use std::path::Path;

#[track_caller]
fn picture(folder: &Folder, arguments: &[&str]) -> Pixels {
    let mut all = vec!["--hide", "caption,axes,scale,legends,edges"];
    for usual in [["--view", "front"], ["--projection", "parallel"]] {
        if !arguments.contains(&usual[0]) {
            all.extend(usual);
        }
    }
    drawn(folder, &[&all[..], arguments].concat())
}

#[track_caller]
fn drawn(folder: &Folder, arguments: &[&str]) -> Pixels {
    let file = folder.join("picture.bmp");
    let fixed = ["render", folder.path().to_str().unwrap(), "--force", "--out", file.to_str().unwrap()];
    trackbed(fixed.iter().chain(arguments)).good();
    Pixels::read(&file)
}

/// 0.2 m across 200 pixels less 11 at each side.
const SQUARE: [&str; 2] = ["--size", "200x200"];

#[test]
fn sphere_covers_its_circle() {
    let folder = Folder::new("render_sphere");
    grains(&folder, 0, &[[5.0, 2.0, 1.0, 0.1]], &[0]);
    series(&folder, 1);
    let seen = picture(&folder, &SQUARE);
    let radius = 0.5 * (200.0 - 22.0);
    for y in 0..200 {
        for x in 0..200 {
            let far = (x as f64 - 99.5).hypot(y as f64 - 99.5);
            let white = seen.at(x, y) == [255; 3];
            assert!(!(white && far < radius - 1.0), "{x}, {y}: a hole");
            assert!(white || far < radius + 1.0, "{x}, {y}: {:?} outside", seen.at(x, y));
        }
    }
    let seen =
        picture(&folder, &[&SQUARE[..], &["--projection", "perspective", "--view", "-70:20"]].concat());
    let [x0, y0, x1, y1] = seen.covered().expect("a sphere");
    assert!((x1 - x0).abs_diff(y1 - y0) <= 1 && x1 - x0 > 80, "{x0} {y0} {x1} {y1}");
    let area = seen.count() as f64 / (0.25 * std::f64::consts::PI * ((x1 - x0 + 1) as f64).powi(2));
    assert!((area - 1.0).abs() < 0.03, "{area}");
    let light = |x, y| seen.at(x, y).iter().map(|c| u32::from(*c)).sum::<u32>();
    assert!(light(80, 80) > light(125, 125) + 40);
}

#[test]
fn nearer_sphere_is_visible() {
    let folder = Folder::new("render_depth");
    grains(&folder, 0, &[[0.0, 0.3, 0.0, 0.1], [0.0, 0.0, 0.0, 0.04]], &[0, 1]);
    series(&folder, 1);
    let blue = |pixel: [u8; 3]| pixel[2] > pixel[0];
    for projection in ["parallel", "perspective"] {
        let all = [&SQUARE[..], &["--field", "part", "--projection", projection]].concat();
        let front = picture(&folder, &all);
        assert!(blue(front.at(100, 100)) && !blue(front.at(100, 170)), "{projection}");
        let back = picture(&folder, &[&all[..], &["--view", "back"]].concat());
        assert!(!blue(back.at(100, 100)), "{projection}");
        let cut = picture(&folder, &[&all[..], &["--clip", "grains:y=:0.1"]].concat());
        assert!(blue(cut.at(100, 30)), "{projection}: the blue one fills the picture");
    }
    let hidden = picture(&folder, &[&SQUARE[..], &["--hide", "grains"]].concat());
    assert_eq!(hidden.covered(), None);
}

/// Ends and middle of viridis.
const VIRIDIS: [[u8; 3]; 3] = [[0x44, 0x01, 0x54], [0x21, 0x91, 0x8c], [0xfd, 0xe7, 0x25]];

#[track_caller]
fn close(found: [u8; 3], expected: [u8; 3], most: u8, what: &str) {
    let far = (0..3).map(|k| found[k].abs_diff(expected[k])).max().unwrap();
    assert!(far <= most, "{what}: found {found:?}, expected {expected:?} within {most}");
}

#[test]
fn contour_colours_match_legend() {
    let folder = Folder::new("render_contours");
    solid(&folder, 0, |x| x[0], |_| [0.0; 3]);
    series(&folder, 1);
    let seen = picture(&folder, &[&SQUARE[..], &["--field", "solid=heat"]].concat());
    for (x, colour) in [(13, VIRIDIS[0]), (100, VIRIDIS[1]), (187, VIRIDIS[2])] {
        for y in [15, 100, 185] {
            close(seen.at(x, y), colour, 16, &format!("{x}, {y}"));
        }
    }
    // Uniform value on the cut.
    let cut = ["--field", "heat", "--clip", "x=:0.5", "--view", "right"];
    let seen = picture(&folder, &[&SQUARE[..], &cut].concat());
    for place in [20, 100, 180] {
        close(seen.at(place, 200 - place), VIRIDIS[1], 16, "in the section");
    }
    let seen = picture(&folder, &[&SQUARE[..], &["--field", "heat", "--range", "solid=0.4:0.6"]].concat());
    close(seen.at(60, 100), VIRIDIS[0], 16, "below the range");
    close(seen.at(140, 100), VIRIDIS[2], 16, "above the range");
    // Legend bar: 18 × 150 pixels, upper right of 1280 × 720.
    let all = drawn(&folder, &["--field", "heat"]);
    for (y, colour) in [(42, VIRIDIS[2]), (115, VIRIDIS[1]), (187, VIRIDIS[0])] {
        close(all.at(1102, y), colour, 12, "legend");
    }
    let other = drawn(&folder, &["--field", "heat", "--colour-map", "solid=cividis"]);
    close(other.at(1102, 187), [0x00, 0x22, 0x4e], 12, "legend of cividis");
    let bare = drawn(&folder, &["--field", "heat", "--hide", "legends"]);
    assert_eq!(bare.at(1270, 115), [255; 3]);
}

#[test]
fn solid_is_drawn_with_scaled_deformation() {
    let folder = Folder::new("render_deformed");
    solid(&folder, 0, |x| x[0], |x| [0.0, 0.0, 0.5 * x[2]]);
    solid(&folder, 1, |x| 3.0 * x[0], |x| [0.0, 0.0, x[2]]);
    series(&folder, 2);
    let shape = |arguments: &[&str]| {
        let seen = picture(&folder, &[&SQUARE[..], arguments].concat());
        let [x0, y0, x1, y1] = seen.covered().unwrap();
        (y1 - y0 + 1) as f64 / (x1 - x0 + 1) as f64
    };
    for (frame, factor, expected) in [("0", "0", 1.0), ("0", "1", 1.5), ("0", "2", 2.0), ("1", "1", 2.0)] {
        let found = shape(&["--frame", frame, "--deform", factor]);
        assert!((found - expected).abs() < 0.03, "frame {frame}, factor {factor}: {found}");
    }
    // `--since 0`: changes of displacement and field.
    assert!((shape(&["--frame", "1", "--since", "0"]) - 1.5).abs() < 0.03);
    let change = ["--frame", "1", "--since", "0", "--deform", "0", "--field", "heat", "--range", "0:4"];
    let seen = picture(&folder, &[&SQUARE[..], &change].concat());
    close(seen.at(187, 100), VIRIDIS[1], 16, "3 - 1 of 4");
    assert!((shape(&["--frame", "0.9s"]) - 2.0).abs() < 0.03);
}

#[test]
fn chain_thickness_follows_force() {
    let folder = Folder::new("render_chains");
    let line = |z: f64| [0.0, 0.0, z, 1.0, 0.0, z];
    chains(&folder, 0, &[line(0.0), line(0.2)], &[40.0, 10.0]);
    series(&folder, 1);
    // One metre across 1280 pixels less 11 at each side.
    let size = ["--size", "1280x360", "--thickness", "2"];
    let seen = picture(&folder, &size);
    let scale = 1280.0 - 22.0;
    let runs = seen.runs(640);
    assert_eq!(runs.len(), 2, "{runs:?}");
    for ((_, wide), share) in runs.iter().zip([0.5, 1.0]) {
        let expected = 2.0 * 2.0 * 0.2 * 0.04 * share * scale;
        assert!((*wide as f64 - expected).abs() <= 1.5, "{wide} pixels, expected {expected}");
    }
    assert!((runs[1].0.abs_diff(runs[0].0) as f64 - 0.2 * scale).abs() <= 1.5);
    let [r, g, b] = seen.at(640, runs[1].0);
    assert!(r > 180 && g > 150 && b < 130, "{r} {g} {b}");
    let strong = picture(&folder, &[&size[..], &["--min-force", "0.5"]].concat());
    assert_eq!(strong.runs(640).len(), 1);
    assert_eq!(picture(&folder, &[&size[..], &["--hide", "chains"]].concat()).covered(), None);
}

/// Two frames of 400 spheres in 100 clumps, chains, a solid.
fn crowd(folder: &Folder) {
    let mut seed = 7_u32;
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(seed >> 8) / 16_777_216.0
    };
    let spheres: Vec<[f64; 4]> =
        (0..400).map(|_| [random(), random(), 1.0 + 0.6 * random(), 0.03 + 0.04 * random()]).collect();
    let parts: Vec<u32> = (0..400).map(|k| k % 3).collect();
    let lines: Vec<[f64; 6]> =
        spheres.windows(2).map(|w| [w[0][0], w[0][1], w[0][2], w[1][0], w[1][1], w[1][2]]).collect();
    let forces: Vec<f64> = (1..400).map(|k| f64::from(k * k)).collect();
    for frame in 0..2 {
        grains(folder, frame, &spheres, &parts);
        chains(folder, frame, &lines, &forces);
        solid(folder, frame, |x| x[0] * x[2] + frame as f64, |_| [0.0; 3]);
    }
    series(folder, 2);
}

#[test]
fn pictures_are_identical_across_threads() {
    let folder = Folder::new("render_threads");
    crowd(&folder);
    for ending in ["png", "jpg", "bmp", "avi"] {
        let of = |threads: &str, run: usize| {
            let file = folder.join(&format!("{threads}_{run}.{ending}"));
            let dir = folder.path().to_str().unwrap();
            let look =
                ["--show", "chains", "--opacity", "grains=0.6", "--field", "heat", "--size", "333x250"];
            let fixed = ["render", dir, "--out", file.to_str().unwrap(), "--threads", threads];
            trackbed(fixed.iter().chain(&look)).good();
            fs::read(file).unwrap()
        };
        let first = of("1", 0);
        for (threads, run) in [("1", 1), ("2", 0), ("3", 0)] {
            assert!(of(threads, run) == first, "{ending} on {threads} threads");
        }
    }
    // PNG is lossless.
    let png = fs::read(folder.join("1_0.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    assert!(pixels == Pixels::read(&folder.join("1_0.bmp")).rows());
    let jpg = fs::read(folder.join("1_0.jpg")).unwrap();
    assert!(jpg.starts_with(&[0xff, 0xd8, 0xff]) && jpg.ends_with(&[0xff, 0xd9]));
}

#[test]
fn video_frames_match_index() {
    let folder = Folder::new("render_video");
    crowd(&folder);
    let file = folder.join("a.avi");
    let dir = folder.path().to_str().unwrap();
    let said =
        trackbed(["render", dir, "--out", file.to_str().unwrap(), "--size", "161x99", "--fps", "4"]).good();
    assert!(said.stdout.contains("161 x 99 pixels, 2 frames, t = 0.0000 to 1.0000 s"), "{}", said.stdout);
    let bytes = fs::read(&file).unwrap();
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&bytes[..4], &bytes[8..12]), (&b"RIFF"[..], &b"AVI "[..]));
    assert_eq!(word(4) + 8, bytes.len());
    let (head, movie) = (12, 12 + 8 + word(16));
    assert_eq!((&bytes[head + 8..head + 12], &bytes[movie + 8..movie + 12]), (&b"hdrl"[..], &b"movi"[..]));
    let main = head + 12 + 8;
    assert_eq!((word(main), word(main + 16), word(main + 32), word(main + 36)), (250_000, 2, 161, 99));
    let index = movie + 8 + word(movie + 4);
    assert_eq!((&bytes[index..index + 4], word(index + 4)), (&b"idx1"[..], 2 * 16));
    assert_eq!(index + 8 + 32, bytes.len());
    let mut end = movie + 12;
    for k in 0..2 {
        let entry = index + 8 + 16 * k;
        let (at, length) = (movie + 8 + word(entry + 8), word(entry + 12));
        assert_eq!((at, &bytes[at..at + 4], word(at + 4)), (end, &b"00dc"[..], length), "frame {k}");
        let jpeg = &bytes[at + 8..at + 8 + length];
        assert!(jpeg.starts_with(&[0xff, 0xd8, 0xff]) && jpeg.ends_with(&[0xff, 0xd9]), "frame {k}");
        end = at + 8 + length.next_multiple_of(2);
    }
    assert_eq!(end, index);
}

#[track_caller]
fn refused(folder: &Path, arguments: &[&str], expected: &str) {
    let before = super::support::snapshot(folder);
    let fixed = ["render", folder.to_str().unwrap()];
    let outcome = trackbed(fixed.iter().chain(arguments));
    assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""), "{arguments:?}: {}", outcome.stderr);
    assert!(outcome.stderr.contains(expected), "{arguments:?}: {}", outcome.stderr);
    assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
    assert!(super::support::snapshot(folder) == before, "{arguments:?}: something was written");
}

#[test]
fn bad_input_writes_nothing() {
    let folder = Folder::new("render_bad");
    crowd(&folder);
    let dir = folder.path();
    for (arguments, expected) in [
        (&["--frame", "2"][..], "--frame: found 2, expected 0 to 1"),
        (&["--frame", "9s"], "--frame: found 9 s, expected a time from 0 to 1 s"),
        (&["--frame", "soon"], "--frame: found \"soon\", expected a number from 0, a time"),
        (&["--frame", "all"], "found 2 frames for a picture, expected one, or a file that ends in avi"),
        (&["--since", "7"], "--since: found 7, expected 0 to 1"),
        (
            &["--field", "solid=cold"],
            "--field: found \"cold\", expected of the solid constant, displacement,",
        ),
        (&["--field", "cold"], "of grains constant, diameter, displacement, part"),
        (&["--field", "chains=force"], "expected a field of grains or of solid"),
        (&["--range", "solid=2:1"], "--range: found \"2:1\", expected LOW below HIGH"),
        (&["--range", "nan:1"], "--range: found \"nan\", expected LOW:HIGH"),
        (&["--colour-map", "jet"], "found \"jet\", expected one of viridis, cividis, blue-red, diverging"),
        (&["--hide", "sun"], "--hide: found \"sun\", expected one of grains, chains,"),
        (&["--size", "0x720"], "--size: found \"0x720\", expected WIDTHxHEIGHT, 16 to 16384"),
        (&["--size", "16384x16384"], "and at most 33554432 together"),
        (&["--size", "wide"], "--size: found \"wide\""),
        (&["--view", "inside"], "--view: found \"inside\", expected one of oblique, front,"),
        (&["--clip", "w=0:1"], "--clip: found \"w=0:1\", expected [PART:]AXIS=LOW:HIGH"),
        (&["--opacity", "grains=2"], "--opacity: found 2, expected 0 to 1"),
        (&["--background", "blue"], "--background: found \"blue\", expected white, dark or a colour"),
        (&["--out", "picture.gif"], "found picture.gif, expected a name that ends in one of png, jpg"),
        (&["--out", "/nowhere/at/all/a.png"], "found no directory /nowhere/at/all, expected an existing one"),
        (&["--projection", "fisheye"], "expected perspective or parallel"),
        (&["--zoom", "0"], "--zoom: found 0, expected 0.01 to 1000"),
        (&["--threads", "0"], "--threads: found 0, expected 1 or more"),
    ] {
        refused(dir, arguments, expected);
    }
    let empty = Folder::new("render_empty");
    refused(empty.path(), &[], "found no such file, expected the list of frames of a run");
    let outcome = trackbed(["render", dir.join("results.pvd").to_str().unwrap()]);
    assert_eq!(outcome.code, 2);
    assert!(
        outcome.stderr.contains("found a file, expected the results directory of a run"),
        "{}",
        outcome.stderr
    );
    let there = folder.write("there.png", "mine");
    let out = ["--out", there.to_str().unwrap()];
    refused(dir, &out, "or --force to overwrite it");
    let frame = fs::read_to_string(dir.join("frames/grains_1.vtp")).unwrap();
    fs::write(dir.join("frames/grains_1.vtp"), &frame[..frame.len() / 2]).unwrap();
    refused(dir, &[&out[..], &["--force"]].concat(), "grains_1.vtp");
    let video = folder.join("there.avi");
    refused(dir, &["--out", video.to_str().unwrap()], "grains_1.vtp");
    fs::write(dir.join("frames/grains_1.vtp"), frame).unwrap();
    let size = ["--size", "64x64", "--force"];
    trackbed(["render", dir.to_str().unwrap()].iter().chain(&out).chain(&size)).good();
    assert!(fs::read(&there).unwrap().starts_with(b"\x89PNG"));
}
