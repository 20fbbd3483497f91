//! `trackbed report`: well-formed pages with the numbers of the result files.

use super::support::{
    COUPLED, Folder, GRAINS, Outcome, PLASTIC, Table, json, repository, run, scene_folder, trackbed,
};
use base64::prelude::{BASE64_STANDARD, Engine};
use quick_xml::events::Event;
use std::fs;
use std::path::Path;
use trackbed_track::settlement::settlement_after;

pub(super) struct Page {
    pub(super) sections: Vec<String>,
    pub(super) text: String,
    /// Full-precision numbers of tooltips.
    pub(super) numbers: Vec<f64>,
    pub(super) figures: usize,
    /// Columns and rows of the JPEG pictures.
    pictures: Vec<[usize; 2]>,
    source: String,
}

impl Page {
    /// Reads a page; requires well-formed, self-contained, finite content.
    #[track_caller]
    pub(super) fn read(file: &Path) -> Page {
        let (source, pictures) = without_pictures(&fs::read_to_string(file).unwrap());
        let mut page = Page {
            sections: vec![],
            text: String::new(),
            numbers: vec![],
            figures: 0,
            pictures,
            source: source.clone(),
        };
        let mut reader = quick_xml::Reader::from_str(&source);
        reader.config_mut().check_end_names = true;
        let mut depth = 0;
        loop {
            let event = reader.read_event().unwrap_or_else(|e| panic!("{}: {e}", reader.buffer_position()));
            match &event {
                Event::Eof => break,
                Event::Text(text) => page.text += &text.unescape().unwrap(),
                Event::Start(tag) | Event::Empty(tag) => {
                    let name = String::from_utf8(tag.name().as_ref().to_vec()).unwrap();
                    depth += i32::from(matches!(event, Event::Start(_)));
                    assert!(!matches!(name.as_str(), "script" | "link" | "iframe"), "<{name}>");
                    page.figures += usize::from(name == "figure");
                    for attribute in tag.attributes() {
                        let attribute = attribute.unwrap();
                        let value = attribute.unescape_value().unwrap().into_owned();
                        match attribute.key.as_ref() {
                            b"id" if name == "section" => page.sections.push(value),
                            b"title" if name == "td" => {
                                page.numbers.push(value.split(' ').next().unwrap().parse().unwrap());
                            }
                            b"src" => assert!(name == "img" && value == INLINE, "{name} {value}"),
                            b"onload" | b"onclick" | b"onerror" => panic!("{value}"),
                            b"href" => assert!(value.starts_with('#'), "{value}"),
                            _ => {}
                        }
                    }
                }
                Event::End(_) => depth -= 1,
                _ => {}
            }
        }
        assert_eq!(depth, 0);
        for word in ["NaN", "undefined", "null", " inf ", " inf<", "\"inf"] {
            assert!(!source.contains(word), "{word}: {}", around(&source, word));
        }
        assert!(!source.replace("http://www.w3.org/2000/svg", "").contains("://"), "something from outside");
        page
    }

    #[track_caller]
    fn has(&self, sections: &[&str]) {
        for name in sections {
            assert!(self.sections.iter().any(|s| s == name), "{name} in {:?}", self.sections);
        }
        assert_eq!(self.sections[0], "verdict", "verdict and warnings come first");
    }

    #[track_caller]
    fn lacks(&self, sections: &[&str]) {
        for name in sections {
            assert!(!self.sections.iter().any(|s| s == name), "{name} in {:?}", self.sections);
        }
    }

    #[track_caller]
    fn says(&self, value: f64) {
        assert!(self.numbers.contains(&value), "{value} is not on the page");
    }

    #[track_caller]
    fn contains(&self, text: &str) {
        assert!(self.text.contains(text), "{text:?} is not in {}", self.text);
    }
}

/// Beginning of an inline picture.
const INLINE: &str = "data:image/jpeg;base64,";

/// Removes the content of pictures, which may contain any letters; returns their columns and rows.
fn without_pictures(source: &str) -> (String, Vec<[usize; 2]>) {
    let mut parts = source.split(INLINE);
    let mut text = parts.next().unwrap().to_string();
    let mut sizes = Vec::new();
    for part in parts {
        let (content, rest) = part.split_once('"').unwrap();
        let bytes = BASE64_STANDARD.decode(content).unwrap();
        // Start of frame: marker, length, precision, rows, columns.
        let at = bytes.windows(2).position(|w| w == [0xff, 0xc0]).unwrap();
        let number = |k: usize| usize::from(u16::from_be_bytes([bytes[at + k], bytes[at + k + 1]]));
        sizes.push([number(7), number(5)]);
        text += &format!("{INLINE}\"{rest}");
    }
    (text, sizes)
}

fn around(text: &str, word: &str) -> String {
    let at = text.find(word).unwrap();
    text[at.saturating_sub(60)..].chars().take(160).collect()
}

fn report(arguments: &[&Path]) -> Outcome {
    trackbed(std::iter::once(Path::new("report")).chain(arguments.iter().copied()))
}

#[track_caller]
fn reported(folder: &Folder, scene: &str, set: &[&str]) -> (Page, serde_json::Value) {
    let out = folder.join("out");
    run(&repository().join(scene), &out, set).good();
    let said = report(&[&out]).good();
    assert_eq!(said.stdout, format!("{} written\n", out.join("report.html").display()));
    (Page::read(&out.join("report.html")), json(&out.join("summary.json")))
}

#[test]
fn the_main_job() {
    let set = [
        "grains.0.count=200",
        "deposition.max_time=0.1",
        "deposition.level=0.2",
        "track.load.cycles=3",
        "track.load.rest=0.01",
        "track.load.ramp=0.01",
        "track.load.frequency=\"100 Hz\"",
        "output.frames=1",
    ];
    let folder = Folder::new("report_track");
    let (page, summary) = reported(&folder, "inputs/track/cyclic/scene.toml", &set);
    assert_eq!(page.pictures, [[1120, 630]]);
    page.has(&[
        "picture",
        "overview",
        "settlement",
        "loops",
        "pressure",
        "sleepers",
        "packing",
        "gradation",
        "energy",
        "steps",
        "timings",
        "reproduce",
    ]);
    page.lacks(&["compare", "flow", "bonds", "safety", "push", "modes", "walls"]);
    for path in [
        "/energy/work",
        "/energy/largest_relative_error",
        "/model/bodies",
        "/model/nodes",
        "/model/grain_step",
        "/coupling/stability/stiffness",
        "/settlement/per_cycle/2",
        "/track/sleepers/0/largest_force",
        "/packing/coordination",
        "/stages/1/seconds",
        "/cpu_seconds",
    ] {
        page.says(summary.pointer(path).and_then(|v| v.as_f64()).unwrap_or_else(|| panic!("{path}")));
    }
    let cycles = Table::read(&folder.join("out/cycles.csv"));
    for column in ["settlement", "secant_stiffness", "dissipated_energy", "peak_formation_pressure"] {
        cycles.column(column).into_iter().filter(|v| *v != 0.0).for_each(|v| page.says(v));
    }
    page.contains("Cyclic loading of a sleeper on ballast");
    page.contains("2650 kg/m3");
    page.contains("trackbed run ");
    page.contains("--set track.load.cycles=3");
    page.contains("settlement [");
    assert!(page.figures >= 10, "{} plots", page.figures);
}

#[test]
fn settlement_laws_of_many_cycles() {
    let set = [
        "grains.0.count=120",
        "deposition.max_time=0.3",
        "deposition.level=0.15",
        "track.load.cycles=24",
        "track.load.frequency=\"80 Hz\"",
        "track.load.rest=0.02",
        "track.load.ramp=0.02",
        "output.frames=0",
    ];
    let folder = Folder::new("report_box");
    let (page, summary) = reported(&folder, "inputs/ballast/box.toml", &set);
    let fits = summary["settlement"]["fits"].as_array().unwrap();
    assert!(fits.len() >= 5, "{fits:?}");
    for fit in fits {
        page.contains(fit["law"].as_str().unwrap());
        page.says(fit["r2"].as_f64().unwrap());
        page.says(fit["rms_error"].as_f64().unwrap());
    }
    page.says(summary["packing"]["measures"][0]["porosity"].as_f64().unwrap());
    page.contains("cycle 24");
    // Dashed laws on both plots.
    assert!(page.source.matches("Alva-Hurtado").count() >= 3);
    page.lacks(&["pressure", "solid", "traffic"]);
    page.contains(" ± ");
    let out = folder.join("out");
    report(&[&out, Path::new("--axle-load"), Path::new("22.5")]).good();
    let page = Page::read(&out.join("report.html"));
    page.has(&["traffic"]);
    // 10 MGT are 444,444 axles of 22.5 t.
    page.contains("444444");
    let at = |fit: &serde_json::Value| {
        let values: Vec<f64> =
            fit["parameters"].as_array().unwrap().iter().map(|p| p[1].as_f64().unwrap()).collect();
        settlement_after(fit["law"].as_str().unwrap(), &values, 10e6 / 22.5)
    };
    // A law that rises again is no extrapolation.
    let fair = fits.iter().filter(|fit| fit["r2"].as_f64().unwrap() >= 0.5);
    let all: Vec<f64> = fair.filter_map(at).filter(|s| *s > 0.0).collect();
    for bound in [all.iter().copied().reduce(f64::min), all.iter().copied().reduce(f64::max)] {
        page.says(bound.unwrap());
    }
    for wrong in ["0", "-3", "101"] {
        let said = report(&[&out, Path::new(&format!("--axle-load={wrong}"))]);
        assert_eq!(said.code, 2, "{said:?}");
        assert!(said.stderr.contains("expected above 0, at most 100 t"), "{}", said.stderr);
    }
}

#[test]
fn results_folder_stands_alone() {
    let folder = Folder::new("report_alone");
    let part = GRAINS.find("[[material]]").unwrap();
    let end = part + GRAINS[part + 1..].find("\n[").map_or(GRAINS.len(), |n| n + 2);
    fs::create_dir(folder.join("parts")).unwrap();
    folder.write("parts/stone.toml", &GRAINS[part..end]);
    let text = format!("include = [\"parts/stone.toml\"]\n{}{}", &GRAINS[..part], &GRAINS[end..]);
    let scene = folder.write("scene.toml", &text);
    run(&scene, &folder.join("out"), &[]).good();
    let before = {
        report(&[&folder.join("out")]).good();
        Page::read(&folder.join("out/report.html"))
    };
    fs::create_dir(folder.join("elsewhere")).unwrap();
    fs::rename(folder.join("out"), folder.join("elsewhere/out")).unwrap();
    fs::remove_file(&scene).unwrap();
    fs::remove_dir_all(folder.join("parts")).unwrap();
    report(&[&folder.join("elsewhere/out")]).good();
    let after = Page::read(&folder.join("elsewhere/out/report.html"));
    after.contains("2650");
    after.contains("Included file parts/stone.toml");
    assert!(!after.text.contains("another program version"), "the scene is understood");
    assert_eq!((after.sections, after.numbers), (before.sections, before.numbers));
    assert!(!after.source.contains(&folder.path().display().to_string()), "an absolute path");
}

#[test]
fn failed_verdict_comes_first() {
    let folder = scene_folder("report_failed", COUPLED);
    let [good, bad] = ["good", "bad"].map(|name| folder.join(name));
    run(&folder.join("scene.toml"), &good, &[]).good();
    run(&folder.join("scene.toml"), &bad, &[]).good();
    let file = bad.join("summary.json");
    let mut summary = json(&file);
    summary["verdict"]["outcome"] = "failed".into();
    let check = serde_json::json!({ "name": "strain", "value": 9.0, "limit": 1.0, "status": "failed", "message": "strain 9" });
    summary["validity"].as_array_mut().unwrap().push(check);
    summary["warnings"] = serde_json::json!(["a small thing", "strain 9"]);
    fs::write(&file, summary.to_string()).unwrap();
    let html = folder.join("both.html");
    report(&[&good, &bad, Path::new("--out"), &html]).good();
    let page = Page::read(&html);
    let at = |text: &str| page.source.find(text).unwrap_or_else(|| panic!("{text}"));
    assert!(at("run failed") < at("run passed") || at("run failed") < at("run warned"));
    assert!(at("failed: strain 9") < at("a small thing"));
}

#[test]
fn solid_with_factor_of_safety() {
    let folder = Folder::new("report_solid");
    let set = ["output.frames=1", "output.tables=true", "time.solid_step=0.1"];
    let (page, summary) = reported(&folder, "inputs/solid/footing.toml", &set);
    page.has(&["overview", "solid", "energy", "reproduce"]);
    page.lacks(&["settlement", "packing", "loops", "sleepers", "gradation"]);
    page.says(summary["reactions"][0]["force"][2].as_f64().unwrap());
    page.contains("Load–displacement");
    page.contains("fraction at the end");
    let gauss = Table::read(&folder.join("out/gauss.csv")).column("equivalent_plastic_strain");
    let share = gauss.iter().filter(|k| **k > 0.0).count() as f64 / gauss.len() as f64;
    assert!(share > 0.0 && share < 1.0);
    page.says(share);
    let set = [
        "solid.block.x.counts=[8]",
        "solid.block.z.counts=[3]",
        "solid.strength_reduction.tolerance=0.1",
        "solid.newton.max_iterations=40",
    ];
    let (page, summary) = reported(&folder, "inputs/solid/slope.toml", &set);
    page.has(&["safety"]);
    page.says(summary["safety"]["stable_at"].as_f64().unwrap());
    page.says(summary["safety"]["unstable_at"].as_f64().unwrap());
}

#[test]
fn line_probes_are_profiles() {
    let folder = Folder::new("report_line");
    let set = ["output.frames=1", "probe.3.points=4"];
    let (page, _) = reported(&folder, "inputs/solid/moving_load.toml", &set);
    page.has(&["solid", "profiles"]);
    page.contains("Vertical displacement along lines");
    page.contains("crest, largest in time");
    assert!(!page.text.contains("crest_1"), "points of lines have no curves in time");
    let history = Table::read(&folder.join("out/history.csv"));
    let columns: Vec<Vec<f64>> = (1..=4).map(|k| history.column(&format!("crest_{k}_u_z"))).collect();
    let time = history.column("time");
    let row = (0..time.len())
        .max_by(|&a, &b| {
            let size = |row: usize| columns.iter().fold(0.0_f64, |m, c| m.max(c[row].abs()));
            size(a).total_cmp(&size(b))
        })
        .unwrap();
    page.contains(&format!("crest, at {} ms", (1e3 * time[row]).round()));
}

#[test]
fn grains_alone() {
    let folder = Folder::new("report_grains");
    let (page, summary) = reported(
        &folder,
        "inputs/grains/hopper_flow.toml",
        &["time.end=0.1", "output.vtk=false", "grains.0.count=600"],
    );
    page.has(&["overview", "walls", "packing", "flow", "energy"]);
    page.says(summary["flow"]["mean_rate_out"].as_f64().unwrap());
    page.lacks(&["picture", "solid", "settlement", "sleepers"]);
    // Results of an earlier version have other names.
    let (file, out) = (folder.join("out/summary.json"), folder.join("out"));
    let mut text = fs::read_to_string(&file).unwrap();
    for (new, old) in [("flows", "spent"), ("reference_energy", "turned_over"), ("inserted", "came_in")] {
        text = text.replace(&format!("\"{new}\":"), &format!("\"{old}\":"));
    }
    fs::write(&file, text).unwrap();
    report(&[&out]).good();
    let earlier = Page::read(&out.join("report.html"));
    assert_eq!((earlier.sections, earlier.numbers), (page.sections, page.numbers));
    let (page, _) = reported(
        &folder,
        "inputs/grains/servo.toml",
        &["grains.0.count=150", "output.frames=0", "time.end=0.6"],
    );
    page.contains("Stress and strain of servo walls");
    page.has(&["applied"]);
    let (page, summary) = (page, json(&folder.join("out/summary.json")));
    page.says(summary["loads"][0]["applied"]["mean"].as_f64().unwrap());
}

#[test]
fn modes_and_several_runs() {
    let folder = scene_folder("report_several", COUPLED);
    let [one, two] = ["a/one", "b/one"].map(|name| folder.join(name));
    let scene = folder.join("scene.toml");
    run(&scene, &one, &[]).good();
    run(&scene, &two, &["track.load.maximum=\"8 kN\""]).good();
    let page = folder.join("both.html");
    report(&[&one, &two, Path::new("--out"), &page, Path::new("--title"), Path::new("Two loads")]).good();
    report(&[&one, Path::new("--out"), &page]).good();
    let notes = folder.write("notes.html", "<p>mine</p>\n");
    let outcome = report(&[&one, Path::new("--out"), &notes]);
    assert!(
        outcome.code == 2 && outcome.stderr.contains("notes.html: found an existing file"),
        "{outcome:?}"
    );
    assert_eq!(fs::read_to_string(&notes).unwrap(), "<p>mine</p>\n");
    report(&[&one, Path::new("--out"), &notes, Path::new("--force")]).good();
    report(&[&one, &two, Path::new("--out"), &page, Path::new("--title"), Path::new("Two loads")]).good();
    let both = Page::read(&page);
    both.has(&["compare", "settlement", "overview", "reproduce"]);
    both.contains("Two loads");
    both.contains("track.load.maximum");
    assert!(!both.source.contains(&folder.path().display().to_string()), "an absolute path");
    let [first, second] =
        [&one, &two].map(|dir| Table::read(&dir.join("cycles.csv")).column("settlement").pop().unwrap());
    let percent = 100.0 * (second - first) / first.abs();
    assert!(percent > 100.0, "three digits, no decimals");
    both.contains(&format!("({percent:+.0} %)"));
    for dir in [&one, &two] {
        both.says(json(&dir.join("summary.json"))["energy"]["work"].as_f64().unwrap());
        Table::read(&dir.join("cycles.csv")).column("settlement").into_iter().for_each(|v| both.says(v));
    }
    let modes = folder.join("modes");
    let beam = repository().join("inputs/verify/beam_modes.toml");
    trackbed([Path::new("modal"), &beam, Path::new("-n"), Path::new("3"), Path::new("--out"), &modes]).good();
    report(&[&modes]).good();
    let page = Page::read(&modes.join("report.html"));
    page.has(&["modes"]);
    Table::read(&modes.join("modes.csv")).column("frequency").into_iter().for_each(|f| page.says(f));
    assert_eq!(page.sections, ["verdict", "overview", "modes"]);
}

#[test]
fn hostile_names_are_escaped() {
    let folder = Folder::new("report_hostile");
    let wall = "wall</script><script>alert(4)</script>";
    let material = "<img src=x onerror=alert(2)>";
    let group = "'><svg onload=alert(3)>";
    let text = GRAINS
        .replace("\"stone\"", &format!("\"{material}\""))
        .replace("\"pair\"", &format!("\"{group}\""))
        .replace("[[walls]]\n", &format!("[[walls]]\nname = \"{wall}\"\nrecord = true\n"));
    let scene = folder.write("x.toml", &text);
    let title = "title=\"<script>alert(1)</script> & \\u0007 ]]> \\\"q\\\" </title>\"";
    let names = ["a<b>&\"c\" 'd'", "{{DATA}}", "\"><img src=x onerror=alert(1)>", "<script>alert(5)<!--"];
    let outs = names.map(|name| folder.join(name));
    for (name, out) in names.iter().zip(&outs) {
        run(&scene, out, &[title]).good();
        report(&[out]).good();
        let page = Page::read(&out.join("report.html"));
        page.contains("<script>alert(1)</script> & \\u{7} ]]> \"q\" </title>");
        page.contains(name);
        page.contains(material);
        page.contains(group);
        page.contains(&format!("{wall}, z"));
    }
    report(&[&outs[0], Path::new("--title"), Path::new("<b>\"own\"</b>")]).good();
    Page::read(&outs[0].join("report.html")).contains("<b>\"own\"</b>");
    let html = folder.join("all.html");
    report(&[&outs[1], &outs[2], &outs[3], Path::new("--out"), &html]).good();
    let page = Page::read(&html);
    names[1..].iter().for_each(|name| page.contains(name));
    names[1..].iter().for_each(|name| page.contains(&format!("{name}: {wall}, z")));
}

#[test]
fn unfinished_runs_are_reported() {
    let folder = Folder::new("report_open");
    let scene = folder.write("scene.toml", PLASTIC);
    let out = folder.join("out");
    run(&scene, &out, &[]).good();
    let summary = fs::read_to_string(out.join("summary.json")).unwrap();
    let page = |out: &Path| {
        report(&[out]).good();
        Page::read(&out.join("report.html"))
    };
    page(&out).contains("Passed.");
    let status = |text: &str| {
        fs::write(
            out.join("summary.json"),
            summary.replace("\"status\": \"done\"", &format!("\"status\": \"{text}\"")),
        )
        .unwrap();
    };
    status("interrupted");
    page(&out).contains("Interrupted.");
    status("failed: at t = 0.5 s: no equilibrium <here>");
    let failed = page(&out);
    failed.contains("Failed.");
    failed.contains("at t = 0.5 s: no equilibrium <here>");
    // Killed: no summary, truncated row.
    fs::remove_file(out.join("summary.json")).unwrap();
    let history = fs::read_to_string(out.join("history.csv")).unwrap();
    fs::write(out.join("history.csv"), &history[..history.len() - 7]).unwrap();
    let stopped = page(&out);
    stopped.contains("No summary.");
    stopped.contains("pressed block");
    stopped.has(&["solid", "energy", "reproduce"]);
    fs::write(out.join("run.lock"), format!("{}\n", std::process::id())).unwrap();
    page(&out).contains("Still running.");
    assert!(out.join("run.lock").exists());
    // Invalid rows are counted; without run.json the scene is unknown.
    fs::write(out.join("history.csv"), history.replacen('\n', "\n1,2\nx\n", 1)).unwrap();
    fs::remove_file(out.join("run.json")).unwrap();
    let damaged = page(&out);
    damaged.contains("history.csv: 2 damaged rows omitted");
    damaged.contains("run.json is missing");
    damaged.lacks(&["reproduce"]);
}

#[test]
fn rejects_directories_without_results() {
    let folder = Folder::new("report_refused");
    let scene = folder.write("scene.toml", GRAINS);
    let out = folder.join("out");
    run(&scene, &out, &[]).good();
    let refused = |arguments: &[&Path], words: &str| {
        let said = report(arguments);
        assert_eq!((said.code, said.stdout.as_str()), (2, ""), "{said:?}");
        assert_eq!(said.stderr.lines().count(), 1, "{}", said.stderr);
        assert!(said.stderr.contains(words), "{}", said.stderr);
    };
    let expected = "expected a results directory";
    refused(&[&folder.join("nowhere")], &format!("nowhere: found nothing, {expected}"));
    refused(&[&scene], &format!("scene.toml: found a file, {expected}"));
    refused(
        &[folder.path()],
        &format!("found no summary.json, run.json, history.csv or modes.csv, {expected}"),
    );
    refused(&[&out, &out], "--out: found nothing, expected a file such as report.html");
    let summary = out.join("summary.json");
    refused(&[&out, Path::new("--out"), &summary], "expected a file .html");
    fs::create_dir(folder.join("x.html")).unwrap();
    refused(&[&out, Path::new("--out"), &folder.join("x.html")], "expected a file");
    for (text, words) in
        [("{\"status\": 3}", "found no status"), ("{\"status\": \"do", "expected the summary of a run")]
    {
        fs::write(&summary, text).unwrap();
        refused(&[&out], words);
    }
    assert!(!out.join("report.html").exists());
    let waiting = folder.join("waiting");
    fs::create_dir(&waiting).unwrap();
    fs::write(waiting.join("run.lock"), "1\n").unwrap();
    refused(&[&waiting], "found a run without results");
}
