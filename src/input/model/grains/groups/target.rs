//! Fill targets: number of grains for a height or a mass, and the bed expected of a fill.

use super::part::{FilledGroup, GroupsPart};
use super::shapes::MOST;
use super::sizes::SizeSource;
use crate::scene::grains::{FillBox, Grains};
use crate::scene::units::vector;
use crate::scene::walls::WallKind;
use crate::scene::{Scene, SceneError, Table};
use trackbed_dem::Vec3;

/// Highest heap [m]: falling grains take 6 s and arrive at 63 m/s.
pub(super) const HIGHEST: f64 = 200.0;
/// Porosity of a settled bed far from walls.
const POROSITY: f64 = 0.4;
/// Increase of the porosity per ratio of grain size × length of side walls to plan area.
const AT_WALLS: f64 = 0.08;
/// Loosest default.
const LOOSEST: f64 = 0.6;
/// Tries to meet a volume.
const TRIES: usize = 12;

/// Returns the key of the amount of grains, if it is the only one.
pub(super) fn amount(group: &Table<Grains>) -> Result<&'static str, SceneError> {
    let keys = [
        ("count", group.count.is_some()),
        ("target_height", group.target_height.is_some()),
        ("target_mass", group.target_mass.is_some()),
    ];
    match keys.iter().filter(|(_, present)| *present).count() {
        1 => Ok(keys.iter().find(|(_, present)| *present).expect("one is present").0),
        _ => Err(group.one_of(&keys)),
    }
}

/// Box of a fill with its floor and the grains below.
pub(super) struct Site {
    low: [f64; 2],
    high: [f64; 2],
    floor: f64,
    /// Solid volume of earlier groups [m³].
    before: f64,
    /// Planes at the sides: direction, position [m].
    sides: Vec<(usize, f64)>,
}

impl Site {
    pub fn of(scene: &Table<Scene>, fill: &FillBox, part: &GroupsPart) -> Site {
        let [x, y, z] = vector(&fill.low);
        let (low, high) = ([x, y], [fill.high[0].si, fill.high[1].si]);
        let (mut floor, mut sides) = (f64::NEG_INFINITY, Vec::new());
        for wall in scene.walls.iter().filter(|w| w.kind == WallKind::Plane) {
            let (Some(point), Some(normal)) = (&wall.point, wall.normal) else { continue };
            let (point, normal) = (vector(point), Vec3::from(normal));
            let along = normal.iamax();
            if normal[along].abs() < 0.999 * normal.norm() {
                continue;
            }
            match along {
                2 if normal.z > 0.0 && point[2] <= z + 1e-9 => floor = floor.max(point[2]),
                2 => {}
                _ => sides.push((along, point[along])),
            }
        }
        // The solid carries the bed: its surface is not known here.
        if scene.coupling.is_some() || !floor.is_finite() {
            floor = z;
        }
        let below = |b: &&trackbed_dem::BodyInput| {
            let inside = (0..2).all(|d| (low[d]..=high[d]).contains(&b.position[d]));
            !b.absent && inside && b.position.z > floor && !part.fouling.contains(&b.part)
        };
        let solid =
            |b: &trackbed_dem::BodyInput| part.shapes[b.shape].query(|s| s.volume()) * b.scale.powi(3);
        let before = part.bodies.iter().filter(below).map(solid).sum();
        Site { low, high, floor, before, sides }
    }

    fn area(&self) -> f64 {
        (self.high[0] - self.low[0]) * (self.high[1] - self.low[1])
    }

    /// Default porosity for grains of a size [m]. Side walls loosen the bed.
    fn porosity(&self, size: f64) -> f64 {
        let mut length = 0.0;
        for d in 0..2 {
            for end in [self.low[d], self.high[d]] {
                if self.sides.iter().any(|(along, at)| *along == d && (at - end).abs() < size) {
                    length += self.high[1 - d] - self.low[1 - d];
                }
            }
        }
        (POROSITY + AT_WALLS * size * length / self.area()).min(LOOSEST)
    }
}

/// Amount of grains that was resolved.
pub(super) struct Amount {
    pub count: usize,
    porosity: f64,
}

impl Amount {
    /// `units`: volumes at a sieve size of 1 m, by shape [m³]; `density` [kg/m³].
    pub fn of(
        group: &Table<Grains>,
        site: &Site,
        (source, units): (&SizeSource, &[f64]),
        density: f64,
    ) -> Result<Amount, SceneError> {
        let key = amount(group)?;
        group.check("count", group.count, |n| (1.0..=MOST).contains(&n), "1 to 10000000")?;
        let height = group.check(
            "target_height",
            group.target_height,
            |h| h > 0.0 && h <= HIGHEST,
            "above 0, at most 200 m",
        )?;
        let mass = group.check("target_mass", group.target_mass, |m| m > 0.0, "above 0")?;
        group.check("porosity", group.porosity, |n| n > 0.0 && n < 1.0, "above 0, below 1")?;
        let mean = source.mean_cube() * units.iter().sum::<f64>() / units.len() as f64;
        let porosity = group.porosity.unwrap_or_else(|| site.porosity(diameter(mean)));
        let volume = |count: usize| {
            let sizes = source.sample(count, group.seed);
            let dealt = super::shapes::deal(&sizes, units.len());
            sizes.iter().zip(dealt).map(|(s, d)| units[d] * s.powi(3)).sum::<f64>()
        };
        let count = match (group.count, height, mass) {
            (Some(count), ..) => count,
            (None, Some(height), _) => {
                let room = (1.0 - porosity) * site.area() * height.si - site.before;
                number(group, key, room, mean, &volume)?
            }
            (None, None, mass) => number(group, key, mass.map_or(0.0, |m| m.si) / density, mean, &volume)?,
        };
        Ok(Amount { count, porosity })
    }
}

fn diameter(volume: f64) -> f64 {
    libm::cbrt(6.0 / std::f64::consts::PI * volume)
}

/// Returns the expected bed of grains with a `solid` volume [m³], if it has a height.
pub(super) fn bed(
    group: &Table<Grains>,
    site: &Site,
    (amount, solid): (&Amount, f64),
    (density, part): (f64, u32),
) -> Option<FilledGroup> {
    let bed = FilledGroup {
        part,
        name: group.name.clone(),
        count: amount.count,
        mass: density * solid,
        plan: [site.low, site.high],
        floor: site.floor,
        target: group.target_height.map(|h| h.si),
        size: diameter(solid / amount.count as f64),
        porosity: amount.porosity,
        height: (solid + site.before) / ((1.0 - amount.porosity) * site.area()),
    };
    // Fines lie in voids.
    let numbers = [bed.mass, bed.height, bed.porosity, bed.floor];
    (!group.fouling && numbers.iter().all(|x| x.is_finite())).then_some(bed)
}

/// Returns the number of grains of a solid volume `room` [m³] with grains of a `mean` volume [m³].
fn number(
    group: &Table<Grains>,
    key: &str,
    room: f64,
    mean: f64,
    volume: &impl Fn(usize) -> f64,
) -> Result<usize, SceneError> {
    let about = room / mean;
    if !(0.5..=MOST).contains(&about) {
        let found = format!("{about:.4} grains");
        return Err(group.error(key, found, "an amount of 1 to 10000000 grains"));
    }
    Ok(nearest(room, mean, volume))
}

fn nearest(room: f64, mean: f64, volume: &impl Fn(usize) -> f64) -> usize {
    let mut count = (room / mean).round().max(1.0);
    let mut best = (f64::INFINITY, count);
    for _ in 0..TRIES {
        let missing = room - volume(count as usize);
        if missing.abs() < best.0 {
            best = (missing.abs(), count);
        }
        // Half a grain is as near as a number can be.
        if missing.abs() <= 0.5 * mean {
            break;
        }
        let step = (missing / mean).round();
        count = (count + if step == 0.0 { missing.signum() } else { step }).clamp(1.0, MOST);
    }
    best.1 as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_number_meets_the_volume() {
        for room in [0.6, 1.0, 77.3, 250.4, 1000.0] {
            let even = nearest(room, 1.0, &|n| n as f64);
            assert!((even as f64 - room).abs() <= 0.5, "{even} {room}");
            let scattered = |n: usize| n as f64 * 1.02 + 0.3 * libm::sin(n as f64);
            let found = nearest(room, 1.0, &scattered);
            assert!((scattered(found) - room).abs() <= 0.9, "{found} {room}");
        }
    }
}
