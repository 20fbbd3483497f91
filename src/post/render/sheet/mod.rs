//! Caption, legends, axes and scale around a scene.

pub mod legend;
pub mod marks;
mod picture;
mod text;

pub use legend::{Key, Legend};
pub use picture::Picture;

use super::draw::Colour;

const HIGH: f32 = 720.0;

/// Background opacity behind letters.
const PANEL: f32 = 0.82;

/// Pixels per sheet unit.
pub fn unit(height: usize) -> f32 {
    (height as f32 / HIGH).max(0.55)
}

#[derive(Clone, Copy, Debug)]
pub struct Ink {
    pub letters: Colour,
    pub pale: Colour,
    pub paper: Colour,
    pub dark: bool,
}

impl Ink {
    /// Colours for a background.
    pub fn on(background: Colour) -> Ink {
        let [r, g, b] = background;
        match 0.3 * r + 0.59 * g + 0.11 * b < 0.45 {
            true => {
                Ink { letters: [0.95, 0.957, 0.97], pale: [0.75, 0.78, 0.82], paper: background, dark: true }
            }
            false => {
                Ink { letters: [0.11, 0.153, 0.2], pale: [0.33, 0.38, 0.43], paper: background, dark: false }
            }
        }
    }
}
