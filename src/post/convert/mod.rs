//! Conversion from and to files of older programs.
//!
//! Formats: `docs/guide/formats.md`.

mod animation;
mod chains;
mod deck;
mod options;
mod packing;
mod results;
mod rows;

pub use options::Options;

use std::path::Path;
use trackbed_io::failure::Failure;
use trackbed_io::read::source::{self, LARGEST};
use trackbed_io::write::{FORMATS, Frame, Writers};

enum Input {
    Results,
    Chains(String),
    Animation(String),
    Deck(String),
    Packing(String),
}

/// Converts `input` to `output`; returns notes, one per line.
///
/// # Errors
/// Damaged input, unsupported conversion; I/O errors.
pub fn convert(input: &Path, output: &Path, options: &Options) -> Result<Vec<String>, Failure> {
    if output.exists() && !options.force {
        let found = format!("output: found {}, which exists", output.display());
        return Err(Failure::Input(format!("{found}, expected a new file, or --force")));
    }
    let ending = output.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let no_form = |expected: &str| {
        let found = output.display();
        Err(Failure::Input(format!("output: found {found}, expected {expected} for {}", input.display())))
    };
    match (look(input)?, ending.as_str()) {
        (Input::Deck(text), "toml") => deck::convert((input, &text), output, options),
        (Input::Deck(_), _) => no_form("a scene, .toml,"),
        (Input::Packing(text), "csv") => packing::convert((input, &text), output),
        (Input::Packing(_), _) => no_form("a packing, .csv,"),
        (Input::Animation(text), "csv") => animation::to_csv(&animation::parse(input, &text)?, output),
        (Input::Animation(text), "dat") => animation::write(&animation::parse(input, &text)?, output),
        (Input::Animation(text), "") => folder(output, options, &animation::parse(input, &text)?, &[]),
        (Input::Animation(_), _) => no_form(".csv, .dat, or a directory for frames"),
        (Input::Chains(text), "csv") => chains::to_csv(&chains::parse(input, &text)?, output),
        (Input::Chains(text), "3df") => chains::write(&chains::parse(input, &text)?, output),
        (Input::Chains(text), "") => {
            let Some(grains) = &options.grains else {
                let expected =
                    "--grains ANIMATION with a directory of frames, as the file contains no positions";
                return Err(Failure::Input(format!(
                    "{}: found chains, expected {expected}",
                    input.display()
                )));
            };
            let Input::Animation(animation) = look(grains)? else {
                let found = grains.display();
                return Err(Failure::Input(format!("--grains: found {found}, expected an animation")));
            };
            let moments = animation::parse(grains, &animation)?;
            folder(output, options, &moments, &chains::parse(input, &text)?)
        }
        (Input::Chains(_), _) => no_form(".csv, .3df, or a directory for frames"),
        (Input::Results, "csv") => animation::to_csv(&results::grains(input)?, output),
        (Input::Results, "dat") => animation::write(&results::grains(input)?, output),
        (Input::Results, "3df") => chains::write(&results::chains(input)?, output),
        (Input::Results, "") => folder(output, options, &results::grains(input)?, &results::chains(input)?),
        (Input::Results, _) => no_form(".csv, .dat (animation), .3df (chains), or a directory for frames"),
    }
}

fn look(input: &Path) -> Result<Input, Failure> {
    if input.is_dir() {
        return Ok(Input::Results);
    }
    let bytes = source::bytes(input, LARGEST).map_err(|refusal| Failure::Input(refusal.sentence(input)))?;
    // Comments may use any 8-bit code page; data are ASCII.
    let text = String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes)).into_owned();
    let first = text.lines().map(str::trim).find(|l| !l.is_empty()).unwrap_or_default();
    let starts = |head: &str| first.get(..head.len()).is_some_and(|f| f.eq_ignore_ascii_case(head));
    Ok(match () {
        () if starts(chains::HEAD) => Input::Chains(text),
        () if starts(animation::HEAD) => Input::Animation(text),
        () if first.contains('(') || first.contains("true") || first.contains("false") => Input::Deck(text),
        () => Input::Packing(text),
    })
}

fn folder(
    output: &Path,
    options: &Options,
    moments: &[animation::Moment],
    chains: &[chains::Moment],
) -> Result<Vec<String>, Failure> {
    let key = options.format.as_deref().unwrap_or("vtk");
    let Some(format) = FORMATS.into_iter().find(|f| f.key == key) else {
        let known = FORMATS.map(|f| f.key).join(", ");
        return Err(Failure::Input(format!("--format: found \"{key}\", expected one of {known}")));
    };
    let folder = output.join(format.folder);
    std::fs::create_dir_all(&folder).map_err(|e| Failure::Other(format!("{}: {e}", folder.display())))?;
    // Animations only have the velocity.
    let fields = Some(vec!["velocity".to_string()]);
    let formats = [format];
    let mut writers = Writers::begin(output, &formats)?.only(&fields);
    let mut missed = 0;
    for (number, moment) in moments.iter().enumerate() {
        let drawn = chains.iter().find(|c| c.time == moment.time);
        let (frame, lost) = drawn.map(|c| c.frame(moment)).unzip();
        missed += lost.unwrap_or(0);
        let grains = moment.frame();
        let time = moment.time;
        writers.frame(&Frame {
            number,
            time,
            grains: Some(&grains),
            chains: frame.as_ref(),
            ..Frame::default()
        })?;
    }
    writers.end()?;
    let mut lines = vec![format!("{} frames", moments.len())];
    if missed > 0 {
        lines.push(format!("{missed} chains to walls omitted: the files contain no contact points"));
    }
    Ok(lines)
}
