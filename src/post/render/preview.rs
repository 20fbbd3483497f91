//! Picture of a scene before it runs.

use std::path::Path;

use super::draw::{Colour, Line, Look, Paint, Scene, Sphere, Triangle, Tube, V3};
use super::options::{Options, Part, refuse};
use super::sheet::{Key, Legend};
use super::{Form, NAME, Refused, Written, camera, colours, compose, encode, target};
use crate::preview::{Item, KINDS, Preview};
use trackbed_io::failure::Failure;

/// Radius of lines without surface over the model size.
const LINE: f32 = 0.0012;
/// Most rows of the legend.
const ROWS: usize = 24;
/// Most triangles of a wall with visible edges.
const EDGES: usize = 400;

/// Renders a picture of a scene.
///
/// # Errors
/// Options of results, existing file; I/O errors.
pub fn render(options: &Options, preview: &Preview) -> Result<Written, Failure> {
    let (file, form) = target(options, Path::new(NAME))?;
    if form == Form::Avi {
        return Err(refuse("out", &file.display().to_string(), "a picture: a scene has no frames"));
    }
    for (option, given) in [
        ("frame", options.frames.is_some()),
        ("field", !options.fields.is_empty()),
        ("range", !options.ranges.is_empty()),
        ("colour-map", !options.maps.is_empty()),
        ("since", options.since.is_some()),
    ] {
        if given {
            let found = "found, but it has no effect without a results directory";
            return Err(Failure::Input(format!("--{option}: {found}")));
        }
    }
    let (scene, corners) = drawn(options, preview);
    let names = shown(options, preview).take(ROWS).map(|item| (colour(item), item.name.clone()));
    let legends = [Legend { title: "Model".to_string(), key: Key::Names(names.collect()) }];
    let eye = camera(options, &corners, None, true);
    let picture = compose(options, &eye, (&scene, &legends), (&preview.title, "before the run"));
    encode::write(&file, form, &picture).map_err(Refused::Disk)?;
    Ok(Written { file, size: options.size, frames: Vec::new(), times: Vec::new() })
}

fn part(item: &Item) -> Part {
    match KINDS[item.kind].part {
        "solid" => Part::Solid,
        "grains" => Part::Grains,
        "track" => Part::Track,
        "boundary" => Part::Boundary,
        "water" => Part::Water,
        "sets" => Part::Sets,
        _ => Part::Marks,
    }
}

fn shown<'a>(options: &'a Options, preview: &'a Preview) -> impl Iterator<Item = &'a Item> {
    preview.items.iter().filter(|item| options.shows(part(item), KINDS[item.kind].shown))
}

fn colour(item: &Item) -> Colour {
    colours::parse(item.colour).unwrap_or_default()
}

/// Objects relative to the middle of the model, and the corners of its bounds.
fn drawn(options: &Options, preview: &Preview) -> (Scene, Vec<V3>) {
    let [low, high] = preview.bounds;
    let near = |x: &[f64]| V3::from([0, 1, 2].map(|k| (x[k] - 0.5 * (low[k] + high[k])) as f32));
    let across = near(&high) - near(&low);
    let mut scene = Scene { grain: 0.04 * across.norm(), ..Scene::default() };
    let mut corners = Vec::new();
    for (number, item) in shown(options, preview).enumerate() {
        let (shape, own) = (&item.shape, part(item));
        let given = Options::of(&options.opacities, own);
        let opacity = given.unwrap_or(KINDS[item.kind].opacity);
        let look = scene.look(Look { paint: Paint::Own(colour(item)), opacity, relief: 1.0 });
        let kept =
            |x: &[f64]| options.clips_of(own).all(|c| x[c.axis] >= c.range[0] && x[c.axis] <= c.range[1]);
        let at = |n: u32| &shape.points[n as usize][..];
        let body = number as u32;
        scene.triangles.extend(
            shape.triangles.iter().filter(|t| t.iter().all(|n| kept(at(*n)))).map(|t| Triangle {
                corners: t.map(|n| near(at(n))),
                values: [0.0; 3],
                look,
                body,
            }),
        );
        let edges = shape.edges.iter().filter(|e| e.iter().all(|n| kept(at(*n))));
        let edges = edges.map(|e| e.map(|n| near(at(n))));
        let fine = own == Part::Solid || shape.triangles.len() <= EDGES;
        match shape.triangles.is_empty() {
            true => scene.tubes.extend(edges.map(|ends| Tube {
                ends,
                radius: LINE * across.norm(),
                colour: colour(item),
                look,
            })),
            false if fine && options.shows(Part::Edges, true) => {
                scene.lines.extend(edges.map(|ends| Line { ends, look }));
            }
            false => {}
        }
        scene.spheres.extend(shape.spheres.iter().enumerate().filter(|(_, s)| kept(&s[..3])).map(
            |(k, s)| {
                let body = shape.ids.get(k).copied().unwrap_or(k as u32);
                Sphere { centre: near(&s[..3]), radius: s[3] as f32, colour: colour(item), look, body }
            },
        ));
        if let Some([low, high]) = shape.bounds() {
            let corner = |c: usize| near(&[0, 1, 2].map(|k| if c >> k & 1 == 1 { high[k] } else { low[k] }));
            corners.extend((0..8).map(corner));
        }
    }
    (scene, corners)
}
