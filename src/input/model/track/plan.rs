//! `[track.load]` and `[track.rail]` resolved.

use super::{trains, vehicles};
use crate::model::tables;
use crate::scene::track::{
    IrregularityTable, RailKind, RailTable, SeatLoad, SeatLoadKind, SeatingTable, TrackTable,
};
use crate::scene::{Number, SceneError, Table, kinds};
use trackbed_io::failure::Failure;
use trackbed_track::influence::Winkler;
use trackbed_track::irregularity::{Dip, Irregularity};
use trackbed_track::load::{AxleSpread, CyclicLoad, Pass, Seating, Waveform};
use trackbed_track::rail::RailInput;
use trackbed_track::rolling::RollingInput;
use trackbed_track::train;

/// Spacings over which a wheel load is ramped at the rail ends.
const TAPER: f64 = 2.0;

/// Keys, their load kinds, whether required.
const KEYS: [(&str, &[SeatLoadKind], bool); 23] = {
    use SeatLoadKind::{Bogie, Gauss, Haversine, History, Ramp, Sine, Train, Vehicle};
    [
        ("minimum", &[Sine, Haversine], true),
        ("minimum", &[Ramp], false),
        ("maximum", &[Sine, Haversine, Ramp, Gauss], true),
        ("frequency", &[Sine, Haversine], true),
        ("cycles", &[Sine, Haversine], true),
        ("cycles", &[Ramp, History, Gauss, Bogie, Train, Vehicle], false),
        ("rise", &[Ramp], true),
        ("hold", &[Ramp], true),
        ("fall", &[Ramp], false),
        ("file", &[History, Train, Vehicle], true),
        ("factor", &[History], false),
        ("speed", &[Gauss, Bogie, Train, Vehicle], true),
        ("speed", &[History], false),
        ("width", &[Gauss], true),
        ("axles", &[Gauss], false),
        ("axle_load", &[Bogie], true),
        ("axle_load", &[Train], false),
        ("wheelbase", &[Bogie], true),
        ("train", &[Train], true),
        ("vehicle", &[Vehicle], true),
        ("share", &[Vehicle], false),
        ("cars", &[Train, Vehicle], false),
        ("excitation", &[Bogie, Train], false),
    ]
};

/// A missing value counts as 0.
fn above_zero<T>(table: &Table<T>, key: &str, value: impl Number) -> Result<f64, SceneError> {
    table.check(key, value.number().unwrap_or(0.0), |x| x > 0.0, "above 0")
}

/// A missing value counts as 0.
fn least_zero<T>(table: &Table<T>, key: &str, value: impl Number) -> Result<f64, SceneError> {
    table.check(key, value.number().unwrap_or(0.0), |x| x >= 0.0, "0 or more")
}

/// Resolves the load on sleepers at `places` [m], through an optional `rail`, of `vehicles`, if any.
///
/// # Errors
/// Input errors.
pub fn load(
    l: &Table<SeatLoad>,
    places: Vec<f64>,
    rail: Option<&RailPlan>,
    vehicles: Option<&RollingInput>,
) -> Result<CyclicLoad, Failure> {
    which_keys(l)?;
    let cycles = l.check("cycles", l.cycles.unwrap_or(1), |n| n >= 1.0, "1 or more")?;
    let (rest, ramp) = (least_zero(l, "rest", l.rest)?, least_zero(l, "ramp", l.ramp)?);
    let minimum = l.minimum.map_or(0.0, |f| f.si);
    let maximum = l.check("maximum", l.maximum, |f| f > minimum, "more than the minimum")?;
    let maximum = maximum.map_or(0.0, |f| f.si);
    let speed = l.speed.map(|v| above_zero(l, "speed", v)).transpose()?;
    if matches!(l.kind, SeatLoadKind::Bogie | SeatLoadKind::Train | SeatLoadKind::Vehicle) != rail.is_some() {
        let (found, expected) = match rail {
            Some(_) => ("a load on the sleepers", "\"bogie\", \"train\" or \"vehicle\" on a rail"),
            None => ("wheels", "[track.rail], on which they roll"),
        };
        return Err(l.error("kind", found, expected).into());
    }
    let waveform = match l.kind {
        SeatLoadKind::Sine | SeatLoadKind::Haversine => Waveform::Wave {
            sine: l.kind == SeatLoadKind::Sine,
            minimum,
            maximum,
            frequency: above_zero(l, "frequency", l.frequency)?,
        },
        SeatLoadKind::Ramp => Waveform::Ramp {
            minimum,
            maximum,
            rise: above_zero(l, "rise", l.rise)?,
            hold: least_zero(l, "hold", l.hold)?,
            fall: l.fall.map(|t| above_zero(l, "fall", t)).transpose()?,
        },
        SeatLoadKind::History => {
            let factor = l.check("factor", l.factor.unwrap_or(1.0), |f| f != 0.0, "other than 0")?;
            let file = l.file.as_deref().unwrap_or_else(|| std::path::Path::new(""));
            let rows = tables::history(&l.locate(file), tables::FORCE)?;
            let first = rows[0].0;
            if rows.len() < 2 {
                return Err(l.error("file", "one row", "two or more").into());
            }
            let points = rows.iter().map(|(t, f)| (t - first, f * factor)).collect();
            Waveform::Measured { points, speed }
        }
        SeatLoadKind::Gauss => {
            let width = above_zero(l, "width", l.width)?;
            let behind: Vec<f64> = l.axles.as_ref().map_or(vec![0.0], |a| a.iter().map(|x| x.si).collect());
            if behind.first() != Some(&0.0) || behind.windows(2).any(|a| a[1] <= a[0]) {
                let found = format!("{behind:?}");
                return Err(l.error("axles", found, "ascending distances, the first 0").into());
            }
            let axles = behind.iter().map(|&b| [b, maximum]).collect();
            Waveform::Pass(Pass::over(
                &places,
                speed.unwrap_or(1.0),
                axles,
                AxleSpread::Gauss(width),
                Vec::new(),
            ))
        }
        SeatLoadKind::Bogie | SeatLoadKind::Train | SeatLoadKind::Vehicle => {
            let axles = axles(l, vehicles)?;
            let waves = waves(l, speed.unwrap_or(0.0))?;
            let rail = rail.expect("checked above");
            Waveform::Pass(Pass::over(&places, speed.unwrap_or(1.0), axles, rail.spread(&places), waves))
        }
    };
    let mut load = CyclicLoad { waveform, cycles, rest, ramp, seating: None, places };
    load.seating = l.optional("seating", &l.seating).map(|s| seating(&s, &load)).transpose()?;
    Ok(load)
}

fn seating(s: &Table<SeatingTable>, load: &CyclicLoad) -> Result<Seating, SceneError> {
    let base = (0..load.places.len()).map(|k| load.on(k, load.seating_begins())).fold(0.0, f64::max);
    let expected = format!("more than the {base} N that the load begins with");
    Ok(Seating {
        cycles: s.check("cycles", s.cycles, |n| (1.0..=1e6).contains(&n), "1 to 1000000")?,
        maximum: s.check("maximum", s.maximum, |f| f > base, &expected)?.si,
        frequency: above_zero(s, "frequency", s.frequency)?,
    })
}

fn which_keys(l: &Table<SeatLoad>) -> Result<(), SceneError> {
    let present = |name: &str| match name {
        "minimum" => l.minimum.is_some(),
        "maximum" => l.maximum.is_some(),
        "frequency" => l.frequency.is_some(),
        "cycles" => l.cycles.is_some(),
        "rise" => l.rise.is_some(),
        "hold" => l.hold.is_some(),
        "fall" => l.fall.is_some(),
        "file" => l.file.is_some(),
        "factor" => l.factor.is_some(),
        "speed" => l.speed.is_some(),
        "width" => l.width.is_some(),
        "axles" => l.axles.is_some(),
        "axle_load" => l.axle_load.is_some(),
        "wheelbase" => l.wheelbase.is_some(),
        "train" => l.train.is_some(),
        "vehicle" => l.vehicle.is_some(),
        "share" => l.share.is_some(),
        "cars" => l.cars.is_some(),
        _ => l.excitation.is_some(),
    };
    for (name, _, _) in KEYS {
        let mut allowed = KEYS.iter().filter(|(n, kinds, _)| *n == name && kinds.contains(&l.kind));
        match (allowed.next(), present(name)) {
            (None, true) => {
                let of = KEYS.iter().filter(|(n, ..)| *n == name).flat_map(|(_, of, _)| *of);
                return Err(l.no_effect(name, kinds(&of.collect::<Vec<_>>())));
            }
            (Some((_, _, true)), false) => {
                return Err(l.missing(name, "a value for this kind of load"));
            }
            _ => {}
        }
    }
    Ok(())
}

/// Number of cars.
fn cars(l: &Table<SeatLoad>) -> Result<u32, SceneError> {
    l.check("cars", l.cars.unwrap_or(1), |n| (1.0..=1000.0).contains(&n), "1 to 1000")
}

/// Reads the vehicle of a load of that kind.
fn vehicle(l: &Table<SeatLoad>) -> Result<vehicles::Vehicle, SceneError> {
    let file = l.file.as_deref().unwrap_or_else(|| std::path::Path::new(""));
    vehicles::vehicle(&l.locate(file), l.vehicle.as_deref().unwrap_or_default())
}

/// Distance behind the first axle [m], force [N].
fn axles(l: &Table<SeatLoad>, vehicles: Option<&RollingInput>) -> Result<Vec<[f64; 2]>, SceneError> {
    if let Some(rolling) = vehicles {
        let force = rolling.share * rolling.vehicle.axle_load();
        return Ok(vehicle(l)?.axles(cars(l)?).into_iter().map(|behind| [behind, force]).collect());
    }
    let given = l.axle_load.map(|f| above_zero(l, "axle_load", f)).transpose()?;
    if l.kind == SeatLoadKind::Bogie {
        let base = above_zero(l, "wheelbase", l.wheelbase)?;
        let force = given.unwrap_or(0.0);
        return Ok(vec![[0.0, force], [base, force]]);
    }
    let file = l.file.as_deref().unwrap_or_else(|| std::path::Path::new(""));
    let cars = l.cars.map(|_| cars(l)).transpose()?;
    trains::axles(&l.locate(file), l.train.as_deref().unwrap_or_default(), cars, given)
}

/// Force amplitude [N] and length [m] of irregularities.
fn waves(l: &Table<SeatLoad>, speed: f64) -> Result<Vec<[f64; 2]>, SceneError> {
    let Some(e) = l.optional("excitation", &l.excitation) else { return Ok(Vec::new()) };
    let mass = above_zero(&e, "mass", e.mass)?;
    let wave = |[length, amplitude]: &[crate::scene::units::Quantity<crate::scene::units::Length>; 2]| {
        let length = e.check("waves", length.si, |x| x > 0.0, "lengths above 0")?;
        Ok(train::excitation(mass, amplitude.si, length, speed))
    };
    e.waves.iter().map(wave).collect()
}

/// Rail model.
#[derive(Clone, Debug)]
pub enum RailPlan {
    /// Winkler formula.
    Winkler(Winkler),
    /// Beam.
    Beam(Box<RailInput>),
}

impl RailPlan {
    fn spread(&self, places: &[f64]) -> AxleSpread {
        match self {
            RailPlan::Winkler(w) => AxleSpread::Winkler(*w),
            RailPlan::Beam(input) => {
                let before = input.beyond as f64 * input.spacing;
                let ends = [-before, before + places.last().copied().unwrap_or(0.0)];
                AxleSpread::Beam { ends, taper: TAPER * input.spacing }
            }
        }
    }
}

/// Resolves vehicles on a rail under `gravity` [m/s²]; none with other loads.
///
/// # Errors
/// Input errors.
pub fn vehicles(track: &Table<TrackTable>, gravity: f64) -> Result<Option<RollingInput>, Failure> {
    let rail = track.optional("rail", &track.rail);
    let uneven = rail.as_ref().and_then(|r| r.optional("irregularity", &r.irregularity));
    let Some(l) = track.optional("load", &track.load).filter(|l| l.kind == SeatLoadKind::Vehicle) else {
        return match uneven {
            Some(_) => Err(track.requirement("rail.irregularity", "track.load.kind = \"vehicle\"").into()),
            None => Ok(None),
        };
    };
    which_keys(&l)?;
    if rail.as_ref().is_none_or(|r| r.kind != RailKind::Beam) {
        return Err(l.error("kind", kinds(&[l.kind]), "a rail of kind \"beam\" in [track.rail]").into());
    }
    l.check("kind", gravity, |g| g > 0.0, "gravity downwards")?;
    let vehicle = vehicle(&l)?;
    Ok(Some(RollingInput {
        vehicle: vehicle.input(gravity),
        hertz: vehicle.hertz(),
        share: l.check("share", l.share.unwrap_or(1.0), |s| s > 0.0 && s <= 1.0, "above 0, at most 1")?,
        irregularity: uneven.map(|u| irregularity(&u)).transpose()?.unwrap_or_default(),
    }))
}

fn irregularity(u: &Table<IrregularityTable>) -> Result<Irregularity, Failure> {
    let mut all = Irregularity::default();
    for [length, amplitude] in &u.waves {
        let length = u.check("waves", length.si, |x| x > 0.0, "lengths above 0")?;
        all.waves.push([length, amplitude.si]);
    }
    for row in u.rows("dips", &u.dips) {
        let (depth, length) =
            (above_zero(&row, "depth", row.depth)?, above_zero(&row, "length", row.length)?);
        all.dips.push(Dip { at: row.at.si, depth, length });
    }
    if let Some(file) = &u.file {
        all.profile = tables::profile(&u.locate(file))?;
    }
    Ok(all)
}

/// Height that the seats of each sleeper lack for the rail [m]; 0 for all but hanging ones.
///
/// # Errors
/// Input errors.
pub fn gaps(track: &Table<TrackTable>, count: usize) -> Result<Vec<f64>, SceneError> {
    let mut gaps = vec![0.0; count];
    let Some(rail) = track.optional("rail", &track.rail) else { return Ok(gaps) };
    for row in rail.rows("hanging", &rail.hanging) {
        let gap = row.gap.si;
        row.check("gap", gap, |g| g > 0.0 && g <= LARGEST_GAP, "above 0, at most 50 mm")?;
        match (row.sleeper as usize).checked_sub(1).and_then(|k| gaps.get_mut(k)) {
            Some(own) if *own == 0.0 => *own = gap,
            Some(_) => return Err(row.error("sleeper", row.sleeper.to_string(), "each sleeper once")),
            None => return Err(row.error("sleeper", row.sleeper.to_string(), format!("1 to {count}"))),
        }
    }
    Ok(gaps)
}

/// Largest gap below a hanging sleeper [m].
const LARGEST_GAP: f64 = 0.05;

/// Resolves the rail, one per seat.
///
/// # Errors
/// Input errors.
pub fn rail(track: &Table<TrackTable>, r: &Table<RailTable>) -> Result<RailPlan, SceneError> {
    let Some(load) = &track.load else {
        return Err(r.here("a rail", "[track.load] with wheels on it"));
    };
    let Some(spacing) = track.sleeper.spacing.map(|s| s.si) else {
        return Err(track.missing("sleeper.spacing", "the distance of the sleepers under a rail"));
    };
    let axis = track.sleeper.along.axis();
    if let Some(seat) = load.seats.iter().find(|s| s[axis].si != 0.0) {
        let found = format!("({}, {})", seat[0].si, seat[1].si);
        return Err(track.error("load.seats", found, "rails on the line across the track"));
    }
    let bending = above_zero(r, "bending_stiffness", r.bending_stiffness)?;
    let foundation = above_zero(r, "foundation", r.foundation)?;
    let beam = r.kind == RailKind::Beam;
    for (name, present, needed) in [
        ("mass", r.mass.is_some(), true),
        ("pad_stiffness", r.pad_stiffness.is_some(), true),
        ("pad_damping", r.pad_damping.is_some(), false),
        ("foundation_damping", r.foundation_damping.is_some(), false),
        ("extension", r.extension.is_some(), true),
        ("elements", r.elements.is_some(), false),
        ("hanging", !r.hanging.is_empty(), false),
    ] {
        if beam && needed && !present {
            return Err(r.missing(name, "a value for a beam"));
        }
        r.reject_without([(name, present && !beam)], &kinds(&[RailKind::Beam]))?;
    }
    if !beam {
        return Ok(RailPlan::Winkler(Winkler::new(bending, foundation, spacing)));
    }
    let extension = above_zero(r, "extension", r.extension)?;
    let beyond = (extension / spacing).round();
    if !(TAPER + 1.0..=10_000.0).contains(&beyond) {
        let expected = format!("{} to 10000 sleepers of {spacing} m", TAPER + 1.0);
        return Err(r.error("extension", extension.to_string(), expected));
    }
    let good = |n| (1.0..=100.0).contains(&n);
    let elements = r.check("elements", r.elements.unwrap_or(4), good, "1 to 100")?;
    let rails = load.seats.len().max(1);
    Ok(RailPlan::Beam(Box::new(RailInput {
        elements: elements as usize,
        spacing,
        bending,
        mass: above_zero(r, "mass", r.mass)?,
        pad: [above_zero(r, "pad_stiffness", r.pad_stiffness)?, least_zero(r, "pad_damping", r.pad_damping)?],
        gravity: 0.0,
        sleepers: track.sleeper.count as usize,
        beyond: beyond as usize,
        sleeper_mass: track.sleeper.mass.map_or(0.0, |m| m.si) / rails as f64,
        foundation: [foundation, least_zero(r, "foundation_damping", r.foundation_damping)?],
    })))
}
