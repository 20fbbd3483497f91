//! Track output: rails in frames, push curve.

use std::path::Path;
use trackbed_io::columns::push;
use trackbed_io::failure::Failure;
use trackbed_io::write::csv::{Field, write_table};
use trackbed_io::write::{WallFrame, WallKind};
use trackbed_track::Track;
use trackbed_track::push_test::PushTestSummary;

const HALF_WIDTH: f64 = 0.035;

/// Adds a ribbon per rail, half a spacing beyond end sleepers.
pub fn draw(track: &Track<'_>, frame: &mut WallFrame) {
    let Some((rails, laid, row)) = track.laid_rails() else { return };
    let along = row.axis;
    let first = row.centres[0];
    let [from, to] = [-0.5, row.centres.len() as f64 - 0.5].map(|k| k * rails.spacing());
    for r in 0..laid.count() {
        let seat = row.seats[r];
        let id = frame.id.last().map_or(0, |id| id + 1);
        let height = laid.mean_height(r);
        let mut last: Option<u32> = None;
        for [x, w] in laid.line(rails, r).filter(|p| p[0] >= from - 1e-9 && p[0] <= to + 1e-9) {
            let begin = frame.points.len() as u32;
            for side in [-HALF_WIDTH, HALF_WIDTH] {
                let mut point = [first[0] + seat[0], first[1] + seat[1], height + w];
                point[along] += x;
                point[1 - along] += side;
                frame.points.push(point);
            }
            if let Some(before) = last {
                frame.polygons.push(vec![before, before + 1, begin + 1, begin]);
                frame.id.push(id);
                frame.kind.push(WallKind::Rail as u32);
            }
            last = Some(begin);
        }
    }
}

/// Writes `push.csv` and returns its results, if any.
///
/// # Errors
/// I/O errors.
pub fn push(track: &Track<'_>, dir: &Path) -> Result<Option<PushTestSummary>, Failure> {
    let Some((rows, summary)) = track.push_curve() else { return Ok(None) };
    let columns: [Field<[f64; 3]>; 3] =
        [(push::DISPLACEMENT, |r| r[0]), (push::FORCE, |r| r[1]), (push::UPLIFT, |r| r[2])];
    write_table(&dir.join("push.csv"), &columns, rows)?;
    Ok(Some(summary))
}
