//! `trackbed render`: images and videos.

use super::output::print;
use super::view;
use crate::cli::RenderArgs;
use trackbed_io::failure::Failure;
use trackbed_post::preview::Preview;
use trackbed_post::render::options::{self, Options, Part, refuse};
use trackbed_post::render::{self, Written};

/// Writes an image of a scene, or an image or video of results.
///
/// # Errors
/// Input and I/O errors.
pub fn render(args: &RenderArgs) -> Result<(), Failure> {
    let source = view::scene(&args.dir, &args.set)?;
    let options = chosen(args)?;
    let threads = args.threads.unwrap_or(0);
    if args.threads == Some(0) {
        return Err(refuse("threads", "0", "1 or more"));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(Failure::thread)?;
    let Written { file, size, frames, times } = pool.install(|| match &source {
        Some(source) => {
            let (document, job) = source.resolve()?;
            render::render_scene(&options, &Preview::new(&document, &job)?)
        }
        None => render::render(&options),
    })?;
    let what = match (&frames[..], &times[..]) {
        ([], _) => "before the run".to_string(),
        ([frame], [time]) => format!("frame {frame}, t = {time:.4} s"),
        _ => format!("{} frames, t = {:.4} to {:.4} s", frames.len(), times[0], times[times.len() - 1]),
    };
    print(&format!("{}: {} x {} pixels, {what}\n", file.display(), size[0], size[1]))
}

fn chosen(args: &RenderArgs) -> Result<Options, Failure> {
    let within = |option: &str, value: f64, low: f64, high: f64| match (low..=high).contains(&value) {
        true => Ok(value),
        false => Err(refuse(option, &value.to_string(), &format!("{low} to {high}"))),
    };
    let perspective = match args.projection.as_deref() {
        None => None,
        Some("perspective") => Some(true),
        Some("parallel") => Some(false),
        Some(other) => return Err(refuse("projection", &format!("\"{other}\""), "perspective or parallel")),
    };
    let near_grains = match args.focus.as_str() {
        "all" => false,
        "grains" => true,
        other => return Err(refuse("focus", &format!("\"{other}\""), "all or grains")),
    };
    let opacity = |text: &str| {
        let share = options::number("opacity", text, "a number from 0 to 1")?;
        Ok(within("opacity", share, 0.0, 1.0)? as f32)
    };
    let colour_map = |name: &str| options::map(name).map(|()| name.to_string());
    Ok(Options {
        dir: args.dir.clone(),
        out: args.out.clone(),
        force: args.force,
        frames: args.frame.as_deref().map(options::frames).transpose()?,
        size: options::size(&args.size)?,
        show: options::parts("show", &args.show)?,
        hide: options::parts("hide", &args.hide)?,
        fields: by_part("field", &args.field, |name| Ok(name.to_string()))?,
        ranges: by_part("range", &args.range, |text| options::limits("range", text))?,
        maps: by_part("colour-map", &args.colour_map, colour_map)?,
        opacities: by_part("opacity", &args.opacity, opacity)?,
        towards: args.view.as_deref().map(options::towards).transpose()?,
        perspective,
        zoom: within("zoom", args.zoom, 0.01, 1000.0)? as f32,
        near_grains,
        background: options::background(&args.background)?,
        clips: args.clip.iter().map(|word| options::clip(word)).collect::<Result<_, _>>()?,
        deform: within("deform", args.deform, -1e6, 1e6)?,
        since: args.since,
        bands: within("bands", args.bands as f64, 0.0, 256.0)? as usize,
        min_force: within("min-force", args.min_force, 0.0, 1.0)?,
        thickness: within("thickness", args.thickness, 0.01, 100.0)?,
        rate: within("fps", args.fps, 0.1, 240.0)?,
    })
}

fn by_part<T>(
    option: &str,
    words: &[String],
    read: impl Fn(&str) -> Result<T, Failure>,
) -> Result<Vec<(Option<Part>, T)>, Failure> {
    let one = |word: &String| {
        let (part, value) = options::of_part(option, word)?;
        Ok((part, read(&value)?))
    };
    words.iter().map(one).collect()
}
