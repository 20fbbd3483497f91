//! Drawing on pixels.

use super::super::draw::Colour;

/// Picture, by rows from above.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    pub width: usize,
    pub height: usize,
    pub pixels: Vec<u8>,
}

impl Picture {
    /// Ignores positions outside.
    pub fn blend(&mut self, x: i32, y: i32, colour: Colour, share: f32) {
        if x < 0 || y < 0 || x as usize >= self.width || y as usize >= self.height {
            return;
        }
        let at = 3 * (y as usize * self.width + x as usize);
        for (byte, c) in self.pixels[at..at + 3].iter_mut().zip(colour) {
            let old = f32::from(*byte);
            *byte = (old + (255.0 * c - old) * share.clamp(0.0, 1.0) + 0.5) as u8;
        }
    }

    /// Fills a rectangle with antialiased edges.
    pub fn fill(&mut self, [x0, y0, x1, y1]: [f32; 4], colour: Colour, share: f32) {
        let covered = |k: i32, low: f32, high: f32| (high.min(k as f32 + 1.0) - low.max(k as f32)).max(0.0);
        for y in y0.floor() as i32..y1.ceil() as i32 {
            for x in x0.floor() as i32..x1.ceil() as i32 {
                self.blend(x, y, colour, share * covered(x, x0, x1) * covered(y, y0, y1));
            }
        }
    }

    /// Draws a line with round ends.
    pub fn line(&mut self, a: [f32; 2], b: [f32; 2], width: f32, colour: Colour) {
        let half = 0.5 * width;
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let range = |k: usize| {
            (a[k].min(b[k]) - half - 1.0).floor() as i32..(a[k].max(b[k]) + half + 1.0).ceil() as i32
        };
        for y in range(1) {
            for x in range(0) {
                let (vx, vy) = (x as f32 + 0.5 - a[0], y as f32 + 0.5 - a[1]);
                let t = ((vx * dx + vy * dy) / (dx * dx + dy * dy).max(1e-12)).clamp(0.0, 1.0);
                let far = ((vx - t * dx) * (vx - t * dx) + (vy - t * dy) * (vy - t * dy)).sqrt();
                self.blend(x, y, colour, (half + 0.5 - far).clamp(0.0, 1.0));
            }
        }
    }

    pub fn frame(&mut self, [x0, y0, x1, y1]: [f32; 4], width: f32, colour: Colour) {
        let w = width;
        self.fill([x0, y0, x1, y0 + w], colour, 1.0);
        self.fill([x0, y1 - w, x1, y1], colour, 1.0);
        self.fill([x0, y0 + w, x0 + w, y1 - w], colour, 1.0);
        self.fill([x1 - w, y0 + w, x1, y1 - w], colour, 1.0);
    }
}
