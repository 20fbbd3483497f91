//! `trackbed stone`: grains of spheres from surfaces or random shapes.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use super::output::print;
use crate::cli::{RoughArgs, StoneArgs, StoneCommand, StoneKind};
use crate::stone_tools::{Kind, Source, fill, grow, library_file, make, measure, random, rough};
use trackbed_dem::insert::library::Stone;
use trackbed_dem::insert::library::StoneLibrary;
use trackbed_dem::shape::clump::Clump;
use trackbed_dem::shape::dilated::Dilated;
use trackbed_dem::shape::polyhedron::{self, Polyhedron};
use trackbed_input::scene::Document;
use trackbed_io::failure::Failure;
use trackbed_io::read::{Problem, read_surface};
use trackbed_io::write::{atomic, stl::stl_bytes};

/// Moments of the union take n³ operations.
const MOST_CLUMP: usize = 200;
const MOST_BONDED: usize = 2000;
const MOST_STONES: usize = 10_000;
const MOST_ROUGH: usize = 12;

pub(super) fn stone(command: &StoneCommand) -> Result<(), Failure> {
    match command {
        StoneCommand::Make { surfaces, stones } => {
            let kind = kind(stones, false)?;
            free(stones.out.as_deref(), stones.force)?;
            let sources = surfaces.iter().map(|file| source(file)).collect::<Result<Vec<_>, _>>()?;
            let names: Vec<String> = surfaces.iter().map(|f| f.display().to_string()).collect();
            finish(&sources, kind, stones, &format!("surfaces {}", names.join(", ")))
        }
        StoneCommand::Random { count, elongation, flatness, angularity, surfaces, stones } => {
            within("--count", *count, MOST_STONES)?;
            let form = random::Form {
                elongation: range("--elongation", elongation, 0.05)?,
                flatness: range("--flatness", flatness, 0.05)?,
                angularity: range("--angularity", angularity, 0.0)?,
            };
            let kind = kind(stones, true)?;
            free(stones.out.as_deref(), stones.force)?;
            let seed = stones.seed.unwrap_or(1);
            let sources: Vec<Source> = (0..*count)
                .map(|i| Source {
                    name: format!("random {}", i + 1),
                    body: random::stone(seed, i as u64, &form),
                })
                .collect();
            if let Some(dir) = surfaces {
                write_surfaces(dir, &sources, stones.force)?;
            }
            let command = format!(
                "trackbed stone random --count {count} --seed {seed} --elongation {elongation} --flatness {flatness} \
                 --angularity {angularity}"
            );
            finish(&sources, kind, stones, &command)
        }
        StoneCommand::Rough(args) => rough_stones(args),
        StoneCommand::Info { input } => info(input),
    }
}

fn finish(sources: &[Source], kind: Kind, args: &StoneArgs, command: &str) -> Result<(), Failure> {
    let made = make(sources, kind).map_err(|e| Failure::Input(e.to_string()))?;
    let mut text: String = made.iter().map(|m| format!("{}: {}\n", m.stone.name, m.report)).collect();
    if let Some(out) = &args.out {
        let rows: Vec<(&Stone, String)> = made.iter().map(|m| (&m.stone, m.report.to_string())).collect();
        write_library(out, command, library_file::OF_SURFACES, &rows)?;
        let _ = writeln!(text, "{} written", out.display());
    }
    print(&text)
}

fn rough_stones(args: &RoughArgs) -> Result<(), Failure> {
    within("--count", args.count, MOST_STONES)?;
    if !(2..=MOST_ROUGH).contains(&args.spheres) {
        return Err(bad("--spheres", &args.spheres.to_string(), &format!("2 to {MOST_ROUGH}")));
    }
    let half = |option: &str, value: f64| match value {
        v if (0.0..=0.5).contains(&v) => Ok(v),
        v => Err(bad(option, &v.to_string(), "0 to 0.5")),
    };
    let form = rough::Form {
        spheres: args.spheres,
        overlap: half("--overlap", args.overlap)?,
        spread: half("--spread", args.spread)?,
        elongation: range("--elongation", &args.elongation, 0.05)?,
        flatness: range("--flatness", &args.flatness, 0.05)?,
    };
    free(args.out.as_deref(), args.force)?;
    let made = rough::stones(args.seed, args.count, &form).map_err(|draws| {
        let found = format!("no stone of these ratios in {draws} trials");
        bad("--elongation, --flatness", &found, "wider ranges, another number of spheres, or another overlap")
    })?;
    let mut text: String = made.iter().map(|m| format!("{}: {m}\n", m.stone.name)).collect();
    if let Some(out) = &args.out {
        let command = format!(
            "trackbed stone rough --count {} --spheres {} --overlap {} --spread {} --elongation {} --flatness {} --seed {}",
            args.count, args.spheres, args.overlap, args.spread, args.elongation, args.flatness, args.seed
        );
        let rows: Vec<(&Stone, String)> = made.iter().map(|m| (&m.stone, m.to_string())).collect();
        write_library(out, &command, rough::MEASURES, &rows)?;
        let _ = writeln!(text, "{} written", out.display());
    }
    print(&text)
}

fn write_library(out: &Path, source: &str, note: &str, rows: &[(&Stone, String)]) -> Result<(), Failure> {
    let name = out.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let text = library_file::text(&name, source, note, rows);
    atomic::write(out, |w| w.write_all(text.as_bytes()).map_err(trackbed_io::write::WriteError::io(out)))?;
    Ok(())
}

fn write_surfaces(dir: &Path, sources: &[Source], force: bool) -> Result<(), Failure> {
    let digits = sources.len().to_string().len();
    let file = |i: usize| dir.join(format!("stone_{:0digits$}.stl", i + 1));
    if !dir.is_dir() {
        return Err(bad("--surfaces", &dir.display().to_string(), "an existing directory"));
    }
    for i in 0..sources.len() {
        free(Some(&file(i)), force)?;
    }
    for (i, source) in sources.iter().enumerate() {
        let file = file(i);
        let bytes = stl_bytes(source.body.surface());
        atomic::write(&file, |w| w.write_all(&bytes).map_err(trackbed_io::write::WriteError::io(&file)))?;
    }
    Ok(())
}

fn source(file: &Path) -> Result<Source, Failure> {
    let surface = read_surface(file)?;
    let body = Polyhedron::new(&surface).map_err(|e| {
        Failure::Input(format!("{}: surface: found {e}, expected one closed surface", file.display()))
    })?;
    if body.pieces() > 1 {
        let found = format!("{} separate pieces", body.pieces());
        let expected = "one, as a stone is in one piece. Write each stone into its own file";
        return Err(Failure::Input(format!(
            "{}: surface: found {found}, expected {expected}",
            file.display()
        )));
    }
    let name = file.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    Ok(Source { name, body })
}

fn bad(option: &str, found: &str, expected: &str) -> Failure {
    Failure::Input(format!("{option}: found {found}, expected {expected}"))
}

fn within(option: &str, found: usize, most: usize) -> Result<(), Failure> {
    if (1..=most).contains(&found) {
        return Ok(());
    }
    Err(bad(option, &found.to_string(), &format!("1 to {most}")))
}

fn range(option: &str, text: &str, least: f64) -> Result<[f64; 2], Failure> {
    let (low, high) = text.split_once(':').unwrap_or((text, text));
    match (low.trim().parse::<f64>(), high.trim().parse::<f64>()) {
        (Ok(low), Ok(high)) if low >= least && low <= high && high <= 1.0 => Ok([low, high]),
        _ => Err(bad(option, text, &format!("a number or a range low:high between {least} and 1"))),
    }
}

/// Rejects options of other types. The seed also affects random shapes.
fn kind(args: &StoneArgs, random: bool) -> Result<Kind, Failure> {
    let share = |option: &str, value: Option<f64>, default: f64, most: f64| {
        let v = value.unwrap_or(default);
        if (0.0..=most).contains(&v) {
            return Ok(v);
        }
        Err(bad(option, &v.to_string(), &format!("0 to {most}")))
    };
    let foreign = |option: &str, given: bool, without: &str| match given {
        true => Err(Failure::Input(format!("{option}: {}", Problem::no_effect(without)))),
        false => Ok(()),
    };
    match args.kind {
        StoneKind::Clump => {
            within("--spheres", args.spheres, MOST_CLUMP)?;
            foreign("--spread", args.spread.is_some(), "`--as bonded`")?;
            foreign("--gap", args.gap.is_some(), "`--as bonded`")?;
            foreign("--seed", args.seed.is_some() && !random, "`--as bonded`")?;
            Ok(Kind::Clump(fill::Options {
                spheres: args.spheres,
                overhang: share("--overhang", args.overhang, 0.1, 1.0)?,
            }))
        }
        StoneKind::Bonded => {
            within("--spheres", args.spheres, MOST_BONDED)?;
            foreign("--overhang", args.overhang.is_some(), "`--as clump`")?;
            Ok(Kind::Bonded(grow::Options {
                spheres: args.spheres,
                seed: args.seed.unwrap_or(1),
                spread: share("--spread", args.spread, 0.2, 0.9)?,
                gap: share("--gap", args.gap, 0.2, 2.0)?,
            }))
        }
    }
}

fn free(out: Option<&Path>, force: bool) -> Result<(), Failure> {
    let Some(out) = out else { return Ok(()) };
    let shown = out.display().to_string();
    if out.is_dir() || out.extension().is_none() {
        return Err(bad("--out", &shown, "a file name such as stones.toml"));
    }
    let folder = out.parent().filter(|p| !p.as_os_str().is_empty()).map(PathBuf::from);
    if folder.is_some_and(|p| !p.is_dir()) {
        return Err(bad("--out", &shown, "a file in an existing directory"));
    }
    if out.exists() && !force {
        return Err(bad(
            "--out",
            &format!("{shown}, which exists"),
            "a new file, or --force to overwrite it",
        ));
    }
    Ok(())
}

fn info(input: &Path) -> Result<(), Failure> {
    if input.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml")) {
        return library_info(input);
    }
    let surface = read_surface(input)?;
    let topology = surface.topology().map_err(|e| Failure::Input(e.to_string()))?;
    let [lo, hi] = surface.bounds();
    let mut text = String::new();
    let mut line = |t: String| writeln!(text, "{t}").expect("writing to a string does not fail");
    line(format!("vertices          {:>12}", surface.vertices.len()));
    line(format!("triangles         {:>12}", surface.triangles.len()));
    line(format!("edges             {:>12}", topology.edges));
    line(format!("  open            {:>12}", topology.open_edges));
    line(format!("  branching       {:>12}", topology.branching_edges));
    line(format!("  inverted        {:>12}   orientation differs from neighbours", topology.turned_edges));
    line(format!("pieces            {:>12}", topology.pieces));
    for (k, name) in ["x", "y", "z"].iter().enumerate() {
        line(format!("{name}                 {:>12.6} to {:.6} m", lo[k], hi[k]));
    }
    line(format!("area              {:>12.6e} m²", surface.area()));
    match Polyhedron::new(&surface) {
        Ok(body) => {
            let m = body.moments();
            let [x, y, z] = m.principal();
            let mut e = body.extents();
            e.sort_by(|a, b| b.total_cmp(a));
            if body.pieces() > 1 {
                line(format!("note: {} separate pieces, measured as one body", body.pieces()));
            }
            line(format!("volume            {:>12.6e} m³", m.volume));
            line(format!("holes             {:>12}", body.holes()));
            line(format!(
                "centroid          {:>12.6} {:.6} {:.6} m",
                m.centroid.x, m.centroid.y, m.centroid.z
            ));
            line(format!("principal inertia {x:>12.6e} {y:.6e} {z:.6e} m⁵, per unit density"));
            line(format!(
                "extents           {:>12.6} {:.6} {:.6} m, in the principal frame",
                e[0], e[1], e[2]
            ));
            line(format!("sieve size        {:>12.6} m", body.sieve_size()));
            line(format!("b/a, c/b          {:>12.4} {:.4}", e[1] / e[0], e[2] / e[1]));
            line(format!("sphericity        {:>12.4}   Wadell", body.sphericity()));
        }
        Err(e) => line(format!("note: {e}")),
    }
    print(&text)
}

fn of_polyhedron(body: &Dilated) -> String {
    let (mut extents, sieve) = (body.extents(), body.sieve_size());
    extents.sort_by(|a, b| b.total_cmp(a));
    let [x, y, z] = body.inertia.map(|v| v / sieve.powi(5));
    format!(
        "polyhedron, {} corners, {} faces, sieve size {sieve:.6} m; for sieve size 1 m: volume {:.6} m³, inertia {x:.6} {y:.6} {z:.6} m⁵, \
         radius of its edges {:.4} m; b/a {:.3}, c/b {:.3}, sphericity {:.3}",
        body.core.corners.len(),
        body.core.faces.len(),
        body.volume / sieve.powi(3),
        body.radius / sieve,
        extents[1] / extents[0],
        extents[2] / extents[1],
        polyhedron::sphericity(body.volume, body.area),
    )
}

fn library_info(input: &Path) -> Result<(), Failure> {
    let document = Document::open(input)?;
    let library: StoneLibrary = document.read()?;
    let fault = |e: &dyn std::fmt::Display| {
        document.error(
            "stones",
            e.to_string(),
            "stones of connected spheres, or of convex `corners`, with positive radii",
        )
    };
    if library.stones.is_empty() {
        return Err(document.error("stones", "none", "at least one stone").into());
    }
    let mut text = format!("{}: {} stones\n{}\n", library.name, library.stones.len(), library.source);
    for (i, stone) in library.stones.iter().enumerate() {
        // Rigid and bonded grains may share a file.
        let alone = StoneLibrary { stones: vec![stone.clone()], ..library.clone() };
        if !stone.corners.is_empty() {
            let body = alone.polyhedra().map_err(|e| fault(&e))?.swap_remove(0);
            let _ = writeln!(text, "{i} '{}': {}", stone.name, of_polyhedron(&body));
            continue;
        }
        let least = stone.spheres.iter().map(|s| s[3]).fold(f64::INFINITY, f64::min);
        let (kind, shape, volume, inertia, mut extents, sieve) = if stone.bonds.is_empty() {
            let c: Clump = alone.clumps().map_err(|e| fault(&e))?.swap_remove(0);
            (
                String::from("clump"),
                Some(measure::union_shape(&c)),
                c.volume,
                c.inertia,
                c.extents(),
                c.sieve_size(),
            )
        } else {
            let c = alone.clusters().map_err(|e| fault(&e))?.swap_remove(0);
            let kind = format!("bonded, {} bonds, density factor {:.4}", c.bonds.len(), c.density_factor);
            (kind, None, c.volume, c.inertia, c.extents(), c.sieve_size())
        };
        extents.sort_by(|a, b| b.total_cmp(a));
        let [x, y, z] = inertia.map(|v| v / sieve.powi(5));
        let _ = writeln!(
            text,
            "{i} '{}': {kind}, {} spheres, sieve size {sieve:.6} m; for sieve size 1 m: volume {:.6} m³, inertia {x:.6} \
             {y:.6} {z:.6} m⁵, least radius {:.4} m; b/a {:.3}, c/b {:.3}{}",
            stone.name,
            stone.spheres.len(),
            volume / sieve.powi(3),
            least / sieve,
            extents[1] / extents[0],
            extents[2] / extents[1],
            shape.map_or(String::new(), |s| format!(", {s}")),
        );
    }
    print(&text)
}
