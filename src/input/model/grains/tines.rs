//! `[compaction.tines]` resolved.

use super::check::find;
use super::compaction::rigid_sleepers;
use crate::scene::compaction::Compaction;
use crate::scene::units::vector;
use crate::scene::{Scene, SceneError, Table};

/// Default speed of insertion [m/s].
const INSERTION: f64 = 1.0;
/// Default speed of lift and of closing [m/s].
const SQUEEZE: f64 = 0.1;
/// Default time closed [s].
const HOLD: f64 = 0.1;

/// Tines that tamp each sleeper: lift, insertion, squeeze, hold, withdrawal, release.
#[derive(Clone, Debug)]
pub struct TinesPlan {
    /// Half edges of a blade: across the track, along it, upright [m].
    pub half: [f64; 3],
    /// Material.
    pub material: usize,
    /// Positions of the pairs from the centre of a sleeper, across the track [m].
    pub at: Vec<f64>,
    /// Axis along the track: 0 or 1.
    pub axis: usize,
    /// Lift of the sleeper [m].
    pub lift: f64,
    /// Depth of the tips below the base of the lifted sleeper [m].
    pub depth: f64,
    /// Distance from the sleeper before closing [m].
    pub gap: f64,
    /// Longest way towards the sleeper [m].
    pub travel: f64,
    /// Amplitude of vibration [m].
    pub amplitude: f64,
    /// Frequency of vibration [Hz].
    pub frequency: f64,
    /// Force at which a blade closes no further [N].
    pub force: f64,
    /// Speed of insertion [m/s].
    pub insertion: f64,
    /// Speed of lift and of closing [m/s].
    pub squeeze: f64,
    /// Time closed [s].
    pub hold: f64,
    /// Number of sleepers.
    pub sleepers: u32,
}

impl TinesPlan {
    /// Half edges of a blade in x and y, without vibration [m].
    pub fn half_in_plan(&self) -> [f64; 2] {
        let [across, along, _] = self.half;
        if self.axis == 0 { [along, across] } else { [across, along] }
    }

    /// Half edges of the space that a blade vibrates in [m].
    pub fn reach(&self) -> [f64; 3] {
        let mut half = [self.half_in_plan()[0], self.half_in_plan()[1], self.half[2]];
        half[self.axis] += self.amplitude;
        half
    }

    /// Distance of a blade's centre from that of a sleeper of half width `half`, along the track [m].
    pub fn distance(&self, half: f64) -> f64 {
        half + self.gap + self.half[1]
    }
}

pub(super) fn build(scene: &Table<Scene>, c: &Table<Compaction>) -> Result<TinesPlan, SceneError> {
    let sleeper = rigid_sleepers(scene, c)?;
    let t = c.need("tines", c.optional("tines", &c.tines), "the tines")?;
    let frequency = c.need("frequency", c.frequency, "a frequency")?.si;
    c.check("frequency", frequency, |f| f > 0.0, "above 0")?;
    let size = vector(&t.size);
    for l in size {
        t.check("size", l, |l| l > 0.0, "lengths above 0")?;
    }
    let [lift, depth, gap, travel, amplitude] =
        [&t.lift, &t.depth, &t.gap, &t.travel, &t.amplitude].map(|l| l.si);
    t.check("lift", lift, |l| l >= 0.0, "0 or more")?;
    t.check("travel", travel, |l| l > 0.0, "above 0")?;
    t.check("amplitude", amplitude, |l| l >= 0.0, "0 or more")?;
    t.check("gap", gap, |l| l > travel + amplitude, "more than `travel` and `amplitude` together")?;
    let axis = sleeper.along.axis();
    let height = sleeper.size[2].si;
    t.check(
        "depth",
        depth,
        |l| l > 0.0 && l < size[2] - height,
        "above 0, within the blades, which begin above the sleeper's top",
    )?;
    let half = 0.5 * (sleeper.size[1 - axis].si - size[0]);
    let at: Vec<f64> = t.at.iter().map(|x| x.si).collect();
    if at.is_empty() || at.iter().any(|x| x.abs() > half) {
        let expected = format!("at least one position, each within {:.3} m of the sleeper's centre", half);
        return Err(t.error("at", format!("{at:?}"), expected));
    }
    t.check("force", t.force, |f| f > 0.0, "above 0")?;
    let force = t.force.map_or(f64::INFINITY, |f| f.si);
    let insertion = t.insertion.map_or(INSERTION, |v| v.si);
    t.check("insertion", insertion, |v| v > 0.0, "above 0")?;
    let squeeze = t.squeeze.map_or(SQUEEZE, |v| v.si);
    t.check("squeeze", squeeze, |v| v > 0.0, "above 0")?;
    let hold = t.hold.map_or(HOLD, |t| t.si);
    t.check("hold", hold, |t| t >= 0.0, "0 or more")?;
    let material = find(scene, &t, "material", &t.material)?;
    let half = size.map(|l| 0.5 * l);
    Ok(TinesPlan {
        half,
        material,
        at,
        axis,
        lift,
        depth,
        gap,
        travel,
        amplitude,
        frequency,
        force,
        insertion,
        squeeze,
        hold,
        sleepers: sleeper.count,
    })
}
