//! Caption, axes and scale.

use super::super::draw::{Camera, Colour, V3};
use super::super::labels::figure;
use super::picture::Picture;
use super::text::Text;
use super::{Ink, PANEL};

const AXES: [(Colour, &str); 3] =
    [([0.80, 0.16, 0.14], "x"), ([0.13, 0.56, 0.20], "y"), ([0.16, 0.34, 0.80], "z")];
const ARM: f32 = 34.0;
/// Longest scale over picture width.
const SCALE: f32 = 0.16;

/// Draws title and remark at the upper left.
pub fn caption(picture: &mut Picture, title: &str, remark: &str, width: f32, ink: &Ink, u: f32) {
    let (head, small) = (Text::new(16.0 * u), Text::new(13.0 * u));
    let title = head.cut(title, width - 28.0 * u);
    let remark = small.cut(remark, width - 28.0 * u);
    let wide = head.width(&title).max(small.width(&remark));
    picture.fill([8.0 * u, 9.0 * u, 20.0 * u + wide, 55.0 * u], ink.paper, PANEL);
    head.draw(picture, &title, [14.0 * u, 27.0 * u], ink.letters);
    small.draw(picture, &remark, [14.0 * u, 47.0 * u], ink.pale);
}

pub fn axes(picture: &mut Picture, eye: &Camera, ink: &Ink, u: f32) {
    let from = [56.0 * u, picture.height as f32 - 52.0 * u];
    let text = Text::new(13.0 * u);
    let mut arms: Vec<(V3, usize)> =
        [V3::x(), V3::y(), V3::z()].iter().enumerate().map(|(k, a)| (eye.turn(a), k)).collect();
    // Axes pointing away are drawn first.
    arms.sort_by(|a, b| b.0.z.total_cmp(&a.0.z));
    for (arm, k) in arms {
        let long = (arm.x * arm.x + arm.y * arm.y).sqrt();
        // Axes along the line of sight have no label.
        if long < 0.08 {
            continue;
        }
        let to = [from[0] + ARM * u * arm.x, from[1] - ARM * u * arm.y];
        let (colour, name) = AXES[k];
        let colour = if ink.dark { colour.map(|c| c + 0.45 * (1.0 - c)) } else { colour };
        picture.line(from, to, 2.2 * u, colour);
        let tip = [
            from[0] + (ARM + 10.0) * u * arm.x / long.max(0.55),
            from[1] - (ARM + 10.0) * u * arm.y / long.max(0.55),
        ];
        let wide = text.width(name);
        text.draw(picture, name, [tip[0] - 0.5 * wide, tip[1] + 4.5 * u], colour);
    }
}

/// Draws a length at the lower left, valid at the centre in perspective.
pub fn scale(picture: &mut Picture, eye: &Camera, from: f32, ink: &Ink, u: f32) {
    let metre = eye.scale(eye.distance);
    let most = SCALE * picture.width as f32 / metre;
    if !(most.is_finite() && most > 0.0) {
        return;
    }
    let exponent = libm::log10f(most).floor() as i32;
    let mut size = libm::powf(10.0, exponent as f32);
    let times = [5.0, 2.0, 1.0].into_iter().find(|t| t * size <= most).unwrap_or(1.0);
    size *= times;
    let (factor, unit) = match size {
        s if s >= 1.0 => (1.0, "m"),
        s if s >= 1e-3 => (1e3, "mm"),
        _ => (1e6, "µm"),
    };
    let name = format!("{} {unit}", figure(f64::from(size * factor).round(), 0));
    let name = if eye.perspective { format!("{name} in the middle") } else { name };
    let (x, y) = (from, picture.height as f32 - 26.0 * u);
    let end = x + size * metre;
    let text = Text::new(12.0 * u);
    let wide = text.width(&name).max(end - x);
    picture.fill([x - 5.0 * u, y - 23.0 * u, x + wide + 5.0 * u, y + 9.0 * u], ink.paper, PANEL);
    picture.fill([x, y - 0.8 * u, end, y + 0.8 * u], ink.letters, 1.0);
    for at in [x, end] {
        picture.fill([at - 0.8 * u, y - 5.0 * u, at + 0.8 * u, y + 5.0 * u], ink.letters, 1.0);
    }
    text.draw(picture, &name, [x, y - 9.0 * u], ink.letters);
}
