//! Round ice floes: dilated disks without overlap, up to a given concentration.

use super::part::GroupsPart;
use super::sizes::SizeSource;
use crate::scene::grains::{Floes, Grains};
use crate::scene::{SceneError, Table};
use nalgebra::UnitQuaternion;
use std::f64::consts::PI;
use trackbed_dem::random::Random;
use trackbed_dem::shape::Shape;
use trackbed_dem::shape::dilated::Dilated;
use trackbed_dem::{BodyInput, Vec3};

/// Random stream of the positions.
const PLACES: u64 = 11;
const MOST: f64 = 1e5;
/// Target gap over mean diameter; it may close.
const GAP: f64 = 2e-3;
const ROUNDS: usize = 20_000;

type Point = [f64; 2];

struct Field {
    low: Point,
    high: Point,
    clear: Vec<[f64; 3]>,
}

pub(super) fn pancakes(
    group: &Table<Grains>,
    field: &Table<Floes>,
    model: &BodyInput,
    part: &mut GroupsPart,
) -> Result<(), SceneError> {
    let idle = [
        ("count", field.count.is_some()),
        ("radius", field.radius.is_some()),
        ("gap", field.gap.is_some()),
        ("relax", field.relax.is_some()),
    ];
    field
        .reject_with(idle, "`shape = \"disk\"`")
        .map_err(|e| e.remedy("`size`, `concentration` and `thickness` define disks"))?;
    let thickness = field.check("thickness", field.thickness, |t| t > 0.0, "above 0")?.si;
    let sizes = SizeSource::of(group)?;
    let [low, high] = [&field.low, &field.high].map(|corner| corner.map(|x| x.si));
    let place = Field { low, high, clear: field.clear.iter().map(|c| c.map(|q| q.si)).collect() };
    let expected = "floe area over the area of the box without its clear circles";
    let concentration = field.need("concentration", field.concentration, expected)?;
    let diameters = enough(&sizes, concentration * place.area(), group.seed).ok_or_else(|| {
        field.error("concentration", concentration.to_string(), "1 to 100000 floes, with room for each")
    })?;
    if let Some(d) = diameters.iter().find(|d| **d <= thickness) {
        let expected = format!("less than the diameter of each floe; one has {d} m");
        return Err(field.error("thickness", format!("{thickness} m"), &expected));
    }
    if diameters.iter().any(|d| (0..2).any(|k| *d > high[k] - low[k])) {
        return Err(field.error("high", "a box smaller than a floe", "room for each floe"));
    }
    let mut random = Random::new(group.seed, PLACES);
    let radii: Vec<f64> = {
        let order = random.permutation(diameters.len());
        order.into_iter().map(|k| 0.5 * diameters[k]).collect()
    };
    let places = place.spread(&radii, &mut random).map_err(|left| {
        let found = format!("{concentration}, at which floes of these sizes still overlap by {left:.2e} m");
        field.error("concentration", found, "one at which random floes find room, 0.75 or less")
    })?;
    let z = field.elevation.map_or(0.0, |z| z.si);
    let rounding = 0.5 * thickness;
    for ([x, y], radius) in places.into_iter().zip(&radii) {
        let shape = Dilated::disk(radius - rounding, rounding)
            .map_err(|e| field.here(e.to_string(), "floes that are dilated disks"))?;
        let shape = part.add_shape(Shape::Polyhedron(Box::new(shape)));
        part.bodies.push(BodyInput {
            shape,
            scale: 1.0,
            position: Vec3::new(x, y, z),
            orientation: UnitQuaternion::identity(),
            ..model.clone()
        });
    }
    let covered: f64 = radii.iter().map(|r| PI * r * r).sum::<f64>() / place.area();
    part.remarks.push(format!(
        "grains \"{}\": {} round floes cover {covered:.4} of the water",
        group.name,
        radii.len()
    ));
    Ok(())
}

fn enough(sizes: &SizeSource, area: f64, seed: u64) -> Option<Vec<f64>> {
    let covered = |all: &[f64]| all.iter().map(|d| 0.25 * PI * d * d).sum::<f64>();
    let mut count = 1000.0;
    for _ in 0..4 {
        let all = sizes.sample(count as usize, seed);
        count = (count * area / covered(&all)).round();
        if !(1.0..=MOST).contains(&count) {
            return None;
        }
    }
    Some(sizes.sample(count as usize, seed))
}

impl Field {
    fn area(&self) -> f64 {
        let circles: f64 = self.clear.iter().map(|[_, _, r]| PI * r * r).sum();
        (self.high[0] - self.low[0]) * (self.high[1] - self.low[1]) - circles
    }

    /// Random positions, relaxed until no circles overlap. Error: remaining overlap [m].
    fn spread(&self, radii: &[f64], random: &mut Random) -> Result<Vec<Point>, f64> {
        let mean = radii.iter().sum::<f64>() / radii.len() as f64;
        let gap = 2.0 * GAP * mean;
        let mut at: Vec<Point> = radii
            .iter()
            .map(|r| {
                std::array::from_fn(|d| {
                    let (low, high) = (self.low[d] + r, self.high[d] - r);
                    low + random.uniform() * (high - low)
                })
            })
            .collect();
        let cell = 2.0 * radii.iter().fold(0.0, |a: f64, r| a.max(*r)) + gap;
        let mut cells = Cells::new(self, cell);
        let mut left = f64::INFINITY;
        for _ in 0..ROUNDS {
            cells.sort(&at);
            left = 0.0;
            for i in 0..at.len() {
                left = f64::max(left, self.inside(&mut at[i], radii[i], gap));
                cells.around(i, |j| {
                    let way = [at[j][0] - at[i][0], at[j][1] - at[i][1]];
                    let far = libm::hypot(way[0], way[1]);
                    let missing = radii[i] + radii[j] + gap - far;
                    if missing > 0.0 {
                        left = left.max(missing);
                        let unit = if far > 0.0 { way.map(|x| x / far) } else { [1.0, 0.0] };
                        for d in 0..2 {
                            at[i][d] -= 0.5 * missing * unit[d];
                            at[j][d] += 0.5 * missing * unit[d];
                        }
                    }
                });
            }
            // The last moves may have left the field.
            if left < 0.5 * gap {
                cells.sort(&at);
                (0..at.len()).for_each(|i| {
                    self.inside(&mut at[i], radii[i], gap);
                });
                if (0..at.len()).all(|i| cells.is_free(i, &at, radii)) {
                    return Ok(at);
                }
            }
        }
        Err(left - gap)
    }

    fn inside(&self, at: &mut Point, radius: f64, gap: f64) -> f64 {
        let before = *at;
        for [x, y, r] in &self.clear {
            let way = [at[0] - x, at[1] - y];
            let (far, least) = (libm::hypot(way[0], way[1]), radius + r + gap);
            if far < least {
                let unit = if far > 0.0 { way.map(|x| x / far) } else { [1.0, 0.0] };
                *at = [x + least * unit[0], y + least * unit[1]];
            }
        }
        for d in 0..2 {
            at[d] = at[d].max(self.low[d] + radius).min(self.high[d] - radius);
        }
        libm::hypot(at[0] - before[0], at[1] - before[1])
    }
}

struct Cells {
    low: Point,
    size: f64,
    count: [usize; 2],
    first: Vec<u32>,
    members: Vec<u32>,
    of: Vec<u32>,
}

impl Cells {
    fn new(field: &Field, size: f64) -> Cells {
        let count = [0, 1].map(|d| (((field.high[d] - field.low[d]) / size) as usize).clamp(1, 1000));
        Cells { low: field.low, size, count, first: Vec::new(), members: Vec::new(), of: Vec::new() }
    }

    fn sort(&mut self, at: &[Point]) {
        let along = |p: &Point, d: usize| {
            (((p[d] - self.low[d]) / self.size).max(0.0) as usize).min(self.count[d] - 1)
        };
        self.of = at.iter().map(|p| (along(p, 1) * self.count[0] + along(p, 0)) as u32).collect();
        self.first = vec![0; self.count[0] * self.count[1] + 1];
        self.of.iter().for_each(|c| self.first[*c as usize + 1] += 1);
        for c in 1..self.first.len() {
            self.first[c] += self.first[c - 1];
        }
        let mut next = self.first.clone();
        self.members = vec![0; at.len()];
        for (i, c) in self.of.iter().enumerate() {
            self.members[next[*c as usize] as usize] = i as u32;
            next[*c as usize] += 1;
        }
    }

    fn is_free(&self, i: usize, at: &[Point], radii: &[f64]) -> bool {
        let mut free = true;
        self.around(i, |j| {
            free &= libm::hypot(at[j][0] - at[i][0], at[j][1] - at[i][1]) > radii[i] + radii[j];
        });
        free
    }

    /// Circles after `i` in its cell and the eight neighbours.
    fn around(&self, i: usize, mut f: impl FnMut(usize)) {
        let cell = self.of[i] as usize;
        let [x, y] = [cell % self.count[0], cell / self.count[0]];
        for row in y.saturating_sub(1)..=(y + 1).min(self.count[1] - 1) {
            let from = row * self.count[0] + x.saturating_sub(1);
            let to = row * self.count[0] + (x + 1).min(self.count[0] - 1);
            let range = self.first[from] as usize..self.first[to + 1] as usize;
            self.members[range].iter().filter(|j| **j as usize > i).for_each(|j| f(*j as usize));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trackbed_dem::insert::sizes::SizeLaw;

    #[test]
    fn floes_do_not_overlap() {
        let field = Field { low: [-10.0, 0.0], high: [20.0, 20.0], clear: vec![[5.0, 10.0, 2.0]] };
        for (law, concentration) in [
            (SizeLaw::Equal(1.5), 0.7),
            (SizeLaw::ByNumber { low: 0.8, high: 2.5 }, 0.75),
            (SizeLaw::Equal(1.0), 0.3),
        ] {
            let area = concentration * field.area();
            let diameters = enough(&SizeSource::Law(law), area, 3).unwrap();
            let radii: Vec<f64> = diameters.iter().map(|d| 0.5 * d).collect();
            let covered: f64 = radii.iter().map(|r| PI * r * r).sum();
            assert!((covered - area).abs() < 0.5 * PI * 1.25 * 1.25 + 1.0, "{covered} {area}");
            let at = field.spread(&radii, &mut Random::new(3, PLACES)).unwrap();
            for i in 0..at.len() {
                assert!(libm::hypot(at[i][0] - 5.0, at[i][1] - 10.0) > 2.0 + radii[i]);
                for d in 0..2 {
                    let inner = [field.low[d] + radii[i] - 1e-12, field.high[d] - radii[i] + 1e-12];
                    assert!(at[i][d] >= inner[0] && at[i][d] <= inner[1]);
                }
                for j in 0..i {
                    let far = libm::hypot(at[i][0] - at[j][0], at[i][1] - at[j][1]);
                    assert!(far > radii[i] + radii[j], "{i} {j}: {far}");
                }
            }
        }
        let radii = vec![0.5; 740];
        assert!(field.spread(&radii, &mut Random::new(3, PLACES)).is_err());
    }
}
