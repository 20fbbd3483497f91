//! Legends.

use super::super::draw::Colour;
use super::super::labels::{figure, scaled, ticks};
use super::picture::Picture;
use super::text::Text;
use super::{Ink, PANEL};

#[derive(Clone, Debug)]
pub enum Key {
    Scale { unit: &'static str, range: [f64; 2], table: Vec<Colour>, bands: usize },
    Names(Vec<(Colour, String)>),
}

#[derive(Clone, Debug)]
pub struct Legend {
    pub title: String,
    pub key: Key,
}

/// Legend width [sheet units].
const WIDE: f32 = 172.0;
const HIGH: f32 = 150.0;
const BAR: f32 = 18.0;
const ROW: f32 = 19.0;
const LINE: f32 = 16.0;
const LETTER: f32 = 13.0;
const STEPS: usize = 6;

/// Width reserved at the right edge [sheet units].
pub const ROOM: f32 = WIDE + 26.0;

/// Draws legends at the right edge, with `u` pixels per sheet unit.
pub fn draw(picture: &mut Picture, legends: &[Legend], ink: &Ink, u: f32) {
    let text = Text::new(LETTER * u);
    let x = picture.width as f32 - (WIDE + 14.0) * u;
    let mut y = 16.0 * u;
    for legend in legends {
        y = one(picture, legend, ink, &text, [x, y], u) + 26.0 * u;
    }
}

fn one(picture: &mut Picture, legend: &Legend, ink: &Ink, text: &Text, [x, y]: [f32; 2], u: f32) -> f32 {
    let (factor, unit) = match &legend.key {
        Key::Scale { unit, range, .. } => scaled(unit, range[0].abs().max(range[1].abs())),
        Key::Names(_) => (1.0, String::new()),
    };
    let head = if unit.is_empty() { legend.title.clone() } else { format!("{} [{unit}]", legend.title) };
    let title = text.lines(&head, WIDE * u);
    let below = match &legend.key {
        Key::Names(rows) => ROW * rows.len() as f32,
        Key::Scale { .. } => HIGH + 8.0,
    };
    let end = y + (LINE * title.len() as f32 + 10.0 + below) * u;
    picture.fill([x - 8.0 * u, y - 6.0 * u, x + (WIDE + 8.0) * u, end], ink.paper, PANEL);
    let mut y = y;
    for line in title {
        y += LINE * u;
        text.draw(picture, &line, [x, y - 3.0 * u], ink.letters);
    }
    y += 8.0 * u;
    match &legend.key {
        Key::Names(rows) => {
            for (colour, name) in rows {
                picture.fill([x, y, x + 14.0 * u, y + 13.0 * u], *colour, 1.0);
                picture.frame([x, y, x + 14.0 * u, y + 13.0 * u], 0.8 * u, ink.letters);
                let name = text.cut(name, (WIDE - 22.0) * u);
                text.draw(picture, &name, [x + 22.0 * u, y + 11.0 * u], ink.letters);
                y += ROW * u;
            }
            y
        }
        Key::Scale { range, table, bands, .. } => {
            let high = (HIGH * u).round();
            let (x, y) = (x.round(), y.round());
            for k in 0..high as usize {
                let mut t = 1.0 - (k as f32 + 0.5) / high;
                if *bands > 0 {
                    t = ((t * *bands as f32).floor() + 0.5) / *bands as f32;
                }
                let row = y + k as f32;
                picture.fill([x, row, x + BAR * u, row + 1.0], table[(t * 255.0 + 0.5) as usize], 1.0);
            }
            picture.frame([x, y, x + BAR * u, y + high], 0.9 * u, ink.letters);
            let [low, top] = range.map(|v| v / factor);
            let (marks, decimals) = ticks(low, top, STEPS);
            for mark in marks {
                let share = if top > low { ((mark - low) / (top - low)) as f32 } else { 0.5 };
                let at = y + high * (1.0 - share);
                picture.fill(
                    [x + BAR * u, at - 0.5 * u, x + (BAR + 5.0) * u, at + 0.5 * u],
                    ink.letters,
                    1.0,
                );
                let place = [x + (BAR + 10.0) * u, at + 0.36 * LETTER * u];
                text.draw(picture, &figure(mark, decimals), place, ink.letters);
            }
            y + high
        }
    }
}
