//! Text in DejaVu Sans (licence: `font/LICENSE.txt`), with Latin, Greek and Cyrillic letters embedded.

use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};

use super::super::draw::Colour;
use super::picture::Picture;

const FONT: &[u8] = include_bytes!("font/DejaVuSans-subset.ttf");
/// Replaces missing letters.
const UNKNOWN: char = '\u{fffd}';

pub struct Text {
    font: FontRef<'static>,
    scale: PxScale,
}

impl Text {
    /// An em has `size` pixels.
    pub fn new(size: f32) -> Text {
        let font = FontRef::try_from_slice(FONT).expect("the font in the program is whole");
        // The crate scales by the height from ascent to descent.
        let units = font.units_per_em().unwrap_or(2048.0);
        let scale = PxScale::from(size * font.height_unscaled() / units);
        Text { font, scale }
    }

    fn letters(&self, text: &str) -> impl Iterator<Item = ab_glyph::GlyphId> {
        text.chars().map(|c| {
            let own = self.font.glyph_id(c);
            if own.0 == 0 { self.font.glyph_id(UNKNOWN) } else { own }
        })
    }

    pub fn width(&self, text: &str) -> f32 {
        let scaled = self.font.as_scaled(self.scale);
        self.letters(text).map(|id| scaled.h_advance(id)).sum()
    }

    /// Draws text from `x` on base line `y`; returns its end.
    pub fn draw(&self, picture: &mut Picture, text: &str, [x, y]: [f32; 2], colour: Colour) -> f32 {
        let scaled = self.font.as_scaled(self.scale);
        let mut at = x;
        for id in self.letters(text) {
            let glyph = id.with_scale_and_position(self.scale, point(at, y));
            if let Some(outline) = self.font.outline_glyph(glyph) {
                let corner = outline.px_bounds().min;
                outline.draw(|i, j, share| {
                    picture.blend(corner.x as i32 + i as i32, corner.y as i32 + j as i32, colour, share);
                });
            }
            at += scaled.h_advance(id);
        }
        at
    }

    /// Wraps text at `most` pixels between words.
    pub fn lines(&self, text: &str, most: f32) -> Vec<String> {
        let mut lines: Vec<String> = Vec::new();
        for word in text.split_whitespace() {
            match lines.last_mut() {
                Some(line) if self.width(&format!("{line} {word}")) <= most => {
                    line.push(' ');
                    line.push_str(word);
                }
                _ => lines.push(word.to_string()),
            }
        }
        lines.iter().map(|line| self.cut(line, most)).collect()
    }

    /// Truncates text to `most` pixels.
    pub fn cut(&self, text: &str, most: f32) -> String {
        if self.width(text) <= most {
            return text.to_string();
        }
        let mut kept: Vec<char> = text.chars().collect();
        while !kept.is_empty() {
            kept.pop();
            let short: String = kept.iter().chain(['…'].iter()).collect();
            if self.width(&short) <= most {
                return short;
            }
        }
        String::new()
    }
}
