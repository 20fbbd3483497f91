//! Check for unsupported sleepers.

use super::{Check, Limits};
use trackbed_track::extremes::TrackRecord;

/// Time without contact over main-stage time; wheels uplift neighbours.
const FREE: Limits = Limits { warn: 0.1, fail: Some(0.9) };

/// Checks sleepers over `duration` [s]; none without sleepers.
pub fn free_sleeper(track: &TrackRecord, duration: f64) -> Option<Check> {
    let times =
        track.sleepers.iter().enumerate().map(|(k, s)| (k + 1, s.lifted_off.map_or(0.0, |l| l.seconds)));
    let (number, seconds) = times.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let value = if duration > 0.0 { seconds / duration } else { 0.0 };
    Some(Check::new("time of a sleeper without contact over the run", value, FREE, || {
        format!(
            "sleeper {number}: no contact for {seconds:.4} s of {duration:.4} s. Seat it first ([[compaction]] with kind = \"bedding\"), place it lower, or reduce the uplift."
        )
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::validity::Outcome;
    use trackbed_track::extremes::{ContactLoss, SleeperRecord};

    #[test]
    fn a_hovering_sleeper_is_found() {
        let lift = |seconds| Some(ContactLoss { first: 0.0, seconds, rise: 0.0 });
        let track = |times: &[f64]| {
            let sleepers =
                times.iter().map(|&t| SleeperRecord { lifted_off: lift(t), ..SleeperRecord::default() });
            TrackRecord { sleepers: sleepers.collect(), vehicles: None }
        };
        let status = |times: &[f64]| free_sleeper(&track(times), 1.0).map(|c| c.status);
        assert_eq!(status(&[]), None);
        assert_eq!(status(&[0.0, 0.05]), Some(Outcome::Passed));
        assert_eq!(status(&[0.0, 0.2]), Some(Outcome::Warned));
        assert_eq!(status(&[1.0, 0.0]), Some(Outcome::Failed));
    }
}
