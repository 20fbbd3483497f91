//! Scene objects of a frame.

mod surfaces;

use super::colours;
use super::draw::{Colour, Look, Paint, Scene, Sphere, Tube, V3};
use super::labels;
use super::options::{Options, Part};
use super::run::{Moment, Run, Wanted, of_elements};
use super::sheet::{Key, Legend};
use trackbed_io::failure::Failure;

/// Default colours, as in the viewer.
const STONE: &str = "b9ab94";
/// Lightness variation of grains of one colour.
const SHADES: f32 = 0.17;
/// Strongest chain radius over grain size, and weakest over strongest.
const CHAIN: (f64, f64) = (0.2, 0.1);

/// Colour limits by part.
#[derive(Clone, Copy, Debug, Default)]
pub struct Limits {
    pub grains: Option<[f64; 2]>,
    pub chains: Option<[f64; 2]>,
    pub solid: Option<[f64; 2]>,
}

fn union(a: Option<[f64; 2]>, b: Option<[f64; 2]>) -> Option<[f64; 2]> {
    match (a, b) {
        (Some(a), Some(b)) => Some([a[0].min(b[0]), a[1].max(b[1])]),
        (a, b) => a.or(b),
    }
}

fn ends(values: &[f64]) -> Option<[f64; 2]> {
    values.iter().fold(None, |ends, v| union(ends, Some([*v, *v])))
}

impl Limits {
    pub fn of(run: &Run, moment: &Moment, wanted: &Wanted) -> Limits {
        let forces = moment.chains.as_ref().map(forces);
        let of_skin = moment
            .solid_values
            .as_ref()
            .zip(run.skin.as_ref())
            .map(|(values, skin)| skin.shown(values, wanted.solid.as_deref().is_some_and(of_elements)));
        let stones: Option<Vec<f64>> = moment
            .walls
            .as_ref()
            .zip(moment.stone_values.as_ref())
            .map(|(walls, values)| walls.of_stones(values).collect());
        let grains = moment.grain_values.as_deref().and_then(ends);
        Limits {
            grains: union(grains, stones.as_deref().and_then(ends)),
            chains: forces.as_deref().and_then(ends),
            solid: of_skin.as_deref().and_then(ends),
        }
    }

    #[must_use]
    pub fn and(self, other: Limits) -> Limits {
        Limits {
            grains: union(self.grains, other.grains),
            chains: union(self.chains, other.chains),
            solid: union(self.solid, other.solid),
        }
    }

    /// Applies limits given by the user.
    #[must_use]
    pub fn given(self, options: &Options) -> Limits {
        let of = |part, own| Options::of(&options.ranges, part).or(own);
        Limits {
            grains: of(Part::Grains, self.grains),
            chains: of(Part::Chains, self.chains),
            solid: of(Part::Solid, self.solid),
        }
    }
}

/// Scene, legends and bounding boxes of a picture.
pub struct Parts<'a> {
    pub scene: Scene,
    pub legends: Vec<Legend>,
    pub corners: Vec<V3>,
    /// Bounding box of visible grains, else of chains.
    pub bed: Option<[V3; 2]>,
    run: &'a Run,
    options: &'a Options,
    wanted: &'a Wanted,
    origin: [f64; 3],
    limits: Limits,
}

fn forces(chains: &trackbed_io::results::lines::Chains) -> Vec<f64> {
    let of = |name: &str| chains.forces.iter().find(|(n, _)| *n == name).map(|(_, v)| v.clone());
    of("magnitude").or_else(|| of("normal_force")).unwrap_or_else(|| vec![1.0; chains.ends.len() / 6])
}

fn plain(colour: &str) -> Colour {
    colours::parse(colour).unwrap_or_default()
}

fn scatter(id: u32) -> f32 {
    let mut h = id.wrapping_mul(0x9e37_79b9);
    h ^= h >> 15;
    h = h.wrapping_mul(0x85eb_ca6b);
    h ^= h >> 13;
    (h >> 8) as f32 / 16_777_216.0
}

impl<'a> Parts<'a> {
    /// Visible parts of a frame, relative to `origin`.
    ///
    /// # Errors
    /// Unknown map.
    pub fn of(
        run: &'a Run,
        moment: &Moment,
        options: &'a Options,
        wanted: &'a Wanted,
        origin: [f64; 3],
        limits: Limits,
    ) -> Result<Parts<'a>, Failure> {
        let (scene, legends, corners) = (Scene::default(), Vec::new(), Vec::new());
        let mut parts = Parts {
            scene,
            legends,
            corners,
            bed: None,
            run,
            options,
            wanted,
            origin,
            limits: limits.given(options),
        };
        let size = parts.grain_size(moment);
        parts.scene.grain = size as f32;
        parts.grains(moment);
        parts.chains(moment, size);
        parts.solid(moment);
        parts.walls(moment);
        parts.water(moment);
        Ok(parts)
    }

    /// Size [m] of the median grain, otherwise a fraction of the solid.
    fn grain_size(&self, moment: &Moment) -> f64 {
        if let Some(grains) = moment.grains.as_ref().filter(|g| !g.bodies.id.is_empty()) {
            let mut sizes = grains.bodies.extents();
            let middle = sizes.len() / 2;
            return *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
        }
        let bounds = self.run.skin.as_ref().map(|s| s.bounds());
        let across = |b: [[f64; 3]; 2]| (0..3).map(|k| (b[1][k] - b[0][k]).powi(2)).sum::<f64>().sqrt();
        0.04 * bounds.map_or(1.0, across)
    }

    fn near(&self, x: &[f64]) -> V3 {
        V3::from([0, 1, 2].map(|k| (x[k] - self.origin[k]) as f32))
    }

    fn kept(&self, part: Part, x: &[f64]) -> bool {
        self.options.clips_of(part).all(|c| x[c.axis] >= c.range[0] && x[c.axis] <= c.range[1])
    }

    fn opacity(&self, part: Part, normally: f32) -> f32 {
        Options::of(&self.options.opacities, part).unwrap_or(normally)
    }

    fn table(&self, part: Part) -> Vec<Colour> {
        let name = Options::of(&self.options.maps, part).unwrap_or_else(|| "viridis".to_string());
        colours::table(&name).unwrap_or_default()
    }

    fn boxed(&mut self, low: V3, high: V3) {
        if low.x <= high.x {
            let corner =
                |c: usize| V3::from([0, 1, 2].map(|k| if c >> k & 1 == 1 { high[k] } else { low[k] }));
            self.corners.extend((0..8).map(corner));
        }
    }

    fn grains(&mut self, moment: &Moment) {
        let (Some(grains), Some(field)) = (&moment.grains, &self.wanted.grains) else { return };
        let look =
            Look { paint: Paint::Own(plain(STONE)), opacity: self.opacity(Part::Grains, 1.0), relief: 1.0 };
        let look = self.scene.look(look);
        let table = self.table(Part::Grains);
        let range = self.limits.grains.unwrap_or([0.0, 1.0]);
        let paint = Paint::Map { table: table.clone(), range: range.map(|v| v as f32), bands: 0 };
        let (mut low, mut high) = (V3::repeat(f32::INFINITY), V3::repeat(f32::NEG_INFINITY));
        for (body, of) in grains.bodies.start.windows(2).enumerate() {
            let (first, end) = (of[0] as usize, of[1] as usize);
            if !self.kept(Part::Grains, &grains.centres()[3 * first..3 * first + 3]) {
                continue;
            }
            let value = moment.grain_values.as_ref().map(|v| v[body]);
            let colour = match (value, field.as_str()) {
                (Some(v), "part") => colours::group(v as usize),
                (Some(v), "piece") => colours::piece(v as usize),
                (Some(v), _) => paint.of(v as f32),
                (None, _) => {
                    let shade = 1.0 + SHADES * (2.0 * scatter(grains.bodies.id[body]) - 1.0);
                    plain(STONE).map(|c| (c * shade).min(1.0))
                }
            };
            for s in first..end {
                let (centre, radius) =
                    (self.near(&grains.centres()[3 * s..3 * s + 3]), grains.bodies.radius[s] as f32);
                (low, high) = (low.inf(&centre.add_scalar(-radius)), high.sup(&centre.add_scalar(radius)));
                self.scene.spheres.push(Sphere { centre, radius, colour, look, body: body as u32 });
            }
        }
        self.boxed(low, high);
        self.bed = (low.x <= high.x).then_some([low, high]);
        self.grain_legend(moment, field, (range, table));
    }

    fn grain_legend(&mut self, moment: &Moment, field: &str, (range, table): ([f64; 2], Vec<Colour>)) {
        let stones = moment.walls.as_ref().zip(moment.stone_values.as_ref());
        let stones = stones.into_iter().flat_map(|(walls, values)| walls.of_stones(values));
        let values: Vec<f64> = moment.grain_values.iter().flatten().copied().chain(stones).collect();
        if values.is_empty() {
            return;
        }
        let (label, unit) = labels::grains(field);
        let key = match field {
            "part" => {
                let mut groups: Vec<usize> = values.iter().map(|v| *v as usize).collect();
                groups.sort_unstable();
                groups.dedup();
                Key::Names(
                    groups.iter().take(8).map(|g| (colours::group(*g), format!("group {g}"))).collect(),
                )
            }
            "piece" => {
                let largest = values.iter().filter(|v| **v == 0.0).count();
                let others = values.iter().fold(0.0, |m: f64, v| m.max(*v)) as usize;
                let mut rows = vec![(colours::piece(0), format!("largest: {largest} of {}", values.len()))];
                if others > 0 {
                    rows.push((
                        colours::piece(3),
                        format!("{others} other{}", if others > 1 { "s" } else { "" }),
                    ));
                }
                Key::Names(rows)
            }
            _ => Key::Scale { unit, range, table, bands: 0 },
        };
        self.legends.push(Legend { title: format!("Stones: {}", label.to_lowercase()), key });
    }

    fn chains(&mut self, moment: &Moment, size: f64) {
        let Some(chains) = &moment.chains else { return };
        let forces = forces(chains);
        let Some(range) = self.limits.chains else { return };
        let look =
            Look { paint: Paint::Own([0.0; 3]), opacity: self.opacity(Part::Chains, 1.0), relief: 0.75 };
        let look = self.scene.look(look);
        let table = self.table(Part::Chains);
        let paint = Paint::Map { table: table.clone(), range: range.map(|v| v as f32), bands: 0 };
        let most = range[0].abs().max(range[1].abs()).max(1e-30);
        let (mut low, mut high) = (V3::repeat(f32::INFINITY), V3::repeat(f32::NEG_INFINITY));
        for (ends, force) in chains.ends.chunks_exact(6).zip(&forces) {
            let middle = [0, 1, 2].map(|k| 0.5 * (ends[k] + ends[k + 3]));
            let share = force.abs() / most;
            if share < self.options.min_force || !self.kept(Part::Chains, &middle) {
                continue;
            }
            let radius = (CHAIN.0 * size * self.options.thickness * share.sqrt().clamp(CHAIN.1, 1.0)) as f32;
            let ends = [self.near(&ends[..3]), self.near(&ends[3..])];
            for end in &ends {
                (low, high) = (low.inf(end), high.sup(end));
            }
            self.scene.tubes.push(Tube { ends, radius, colour: paint.of(*force as f32), look });
        }
        // Grains cover the same positions.
        if self.bed.is_none() {
            self.boxed(low, high);
            self.bed = (low.x <= high.x).then_some([low, high]);
        }
        let key = Key::Scale { unit: "N", range, table, bands: 0 };
        self.legends.push(Legend { title: "Contact force".to_string(), key });
    }
}
