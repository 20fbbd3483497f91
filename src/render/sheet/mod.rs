//! What stands around the scene in a picture: caption, legends, axes, scale. Lengths are in units of the sheet, of which a picture is
//! 720 high, so that pictures of any size look alike.

pub mod legend;
pub mod marks;
mod picture;
mod text;

pub use legend::{Key, Legend};
pub use picture::Picture;

use super::draw::Colour;

/// Height of the sheet in its units.
const HIGH: f32 = 720.0;

/// Share of the background behind letters, where the scene reaches below them.
const PANEL: f32 = 0.82;

/// Pixels to a unit of the sheet.
pub fn unit(height: usize) -> f32 {
    (height as f32 / HIGH).max(0.55)
}

/// Colours of letters.
#[derive(Clone, Copy, Debug)]
pub struct Ink {
    /// Of most.
    pub letters: Colour,
    /// Of what matters less.
    pub pale: Colour,
    /// Behind letters.
    pub paper: Colour,
    /// Whether the background is dark.
    pub dark: bool,
}

impl Ink {
    /// For a background.
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
