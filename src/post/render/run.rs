//! Results of a run for pictures, frame by frame.

use std::collections::HashMap;
use std::path::Path;

use crate::water::Surface;

use super::options::{Frames, Options, Part, joined, refuse};
use trackbed_io::columns::{
    cycles::CYCLE,
    history::{LOAD, TIME},
};
use trackbed_io::failure::Failure;
use trackbed_io::results::grains::GrainFile;
use trackbed_io::results::lines::{Chains, Walls};
use trackbed_io::results::series::{self, About, Frame};
use trackbed_io::results::solid::{self, CELL, Skin};
use trackbed_io::results::tables::Table;

const MADE: [&str; 4] = ["constant", "diameter", "displacement", "piece"];
const DISPLACEMENTS: [&str; 4] = ["displacement", "displacement_x", "displacement_y", "displacement_z"];
/// Default solid fields, by preference.
const FIRST: [&str; 3] = ["stress_zz", "von_mises", "displacement"];

pub struct Run {
    pub about: About,
    pub frames: Vec<Frame>,
    pub skin: Option<Skin>,
    pub grain_fields: Vec<String>,
    pub solid_fields: Vec<String>,
    /// Water surface.
    pub water: Option<Surface>,
    history: Option<Table>,
    cycles: Option<Table>,
}

#[derive(Clone, Debug)]
pub struct Wanted {
    pub grains: Option<String>,
    pub solid: Option<String>,
    pub chains: bool,
    pub walls: bool,
    pub since: Option<usize>,
}

pub struct Moment {
    /// Time [s].
    pub time: f64,
    pub grains: Option<GrainFile>,
    pub grain_values: Option<Vec<f64>>,
    pub chains: Option<Chains>,
    /// Walls, sleepers, rails, polyhedral grains.
    pub walls: Option<Walls>,
    /// Value per triangle of polyhedral grains.
    pub stone_values: Option<Vec<f64>>,
    /// Nodal displacement, three components [m].
    pub displacement: Option<Vec<f64>>,
    /// Value per node or element.
    pub solid_values: Option<Vec<f64>>,
}

impl Run {
    /// Opens a results directory.
    ///
    /// # Errors
    /// No frames; damaged file.
    pub fn open(dir: &Path) -> Result<Run, Failure> {
        let frames = series::read(dir)?;
        let first = |part: series::Part| frames.iter().find_map(|frame| frame.file(part));
        let (mut grain_fields, mut solid_fields) = (Vec::new(), Vec::new());
        if let Some(file) = first(series::Part::Grains) {
            grain_fields = MADE.map(String::from).to_vec();
            let own = GrainFile::open(file)?.fields();
            if !own.iter().any(|f| f == "fragment") {
                grain_fields.retain(|f| f != "piece");
            }
            grain_fields.extend(own);
        }
        if let Some(file) = first(series::Part::Walls) {
            for field in Walls::open(file)?.fields() {
                if !grain_fields.contains(&field) {
                    grain_fields.push(field);
                }
            }
        }
        let mut skin = None;
        if let Some(file) = first(series::Part::Solid) {
            skin = Some(Skin::open(file)?);
            solid_fields = ["constant"].iter().chain(&DISPLACEMENTS).map(|f| f.to_string()).collect();
            solid_fields.extend(solid::fields(file)?);
        }
        let table = |name: &str| series::own(dir, name).map_or(Ok(None), |file| Table::read(&file));
        let (history, cycles) = (table("history.csv")?, table("cycles.csv")?);
        let (about, water) = (About::of(dir), Surface::of_run(dir, &frames)?);
        Ok(Run { about, frames, skin, grain_fields, solid_fields, water, history, cycles })
    }

    pub fn has(&self, part: series::Part) -> bool {
        self.frames.iter().any(|frame| frame.file(part).is_some())
    }

    /// Selected or default field of a part.
    ///
    /// # Errors
    /// Unknown field.
    pub fn field(&self, options: &Options, part: Part) -> Result<String, Failure> {
        let known = if part == Part::Solid { &self.solid_fields } else { &self.grain_fields };
        let usual = || match part {
            Part::Solid => {
                let first = FIRST.iter().find(|f| known.iter().any(|k| k == *f));
                first.map_or_else(|| "constant".to_string(), |f| f.to_string())
            }
            _ => "constant".to_string(),
        };
        let chosen = options.fields.iter().rev().find(|(of, field)| match of {
            Some(of) => *of == part,
            // A name without part applies to all parts that have it.
            None => known.contains(field),
        });
        Ok(chosen.map_or_else(usual, |(_, field)| field.clone()))
    }

    /// Checks the selected fields.
    ///
    /// # Errors
    /// First unknown field, with the known ones.
    pub fn check_fields(&self, options: &Options) -> Result<(), Failure> {
        for (of, field) in &options.fields {
            let lists: &[(&str, &Vec<String>)] =
                &[("grains", &self.grain_fields), ("the solid", &self.solid_fields)];
            let lists = match of {
                None => lists,
                Some(Part::Grains) => &lists[..1],
                Some(Part::Solid) => &lists[1..],
                Some(_) => {
                    return Err(refuse("field", &format!("\"{field}\""), "a field of grains or of solid"));
                }
            };
            if !lists.iter().any(|(_, known)| known.contains(field)) {
                let known = lists.iter().filter(|(_, known)| !known.is_empty());
                let known: Vec<String> = known
                    .map(|(name, all)| format!("of {name} {}", joined(all.iter().map(String::as_str))))
                    .collect();
                let expected =
                    if known.is_empty() { "results with that part".into() } else { known.join("; ") };
                return Err(refuse("field", &format!("\"{field}\""), &expected));
            }
        }
        Ok(())
    }

    /// Indices of the selected frames.
    ///
    /// # Errors
    /// Unknown frame.
    pub fn chosen(&self, frames: &Frames) -> Result<Vec<usize>, Failure> {
        let last = self.frames.len() - 1;
        let expected = || format!("0 to {last}");
        match frames {
            Frames::Last => Ok(vec![last]),
            Frames::Peak => Ok(vec![self.peak()]),
            Frames::Number(k) if *k <= last => Ok(vec![*k]),
            Frames::Number(k) => Err(refuse("frame", &k.to_string(), &expected())),
            Frames::Time(time) => {
                let (from, to) = (self.frames[0].time, self.frames[last].time);
                let slack = 0.5 * (to - from) / last.max(1) as f64 + 1e-12;
                if *time < from - slack || *time > to + slack {
                    return Err(refuse(
                        "frame",
                        &format!("{time} s"),
                        &format!("a time from {from} to {to} s"),
                    ));
                }
                let far = |k: usize| (self.frames[k].time - time).abs();
                Ok((0..=last).min_by(|a, b| far(*a).total_cmp(&far(*b))).into_iter().collect())
            }
            Frames::Range(from, to, step) => {
                let to_given = *to != usize::MAX;
                if *from > last || (to_given && *to > last) {
                    let found = if *from > last { from } else { to };
                    return Err(refuse("frame", &found.to_string(), &expected()));
                }
                Ok((*from..=(*to).min(last)).step_by(*step).collect())
            }
        }
    }

    fn row(&self, time: f64) -> Option<usize> {
        let times = self.history.as_ref()?.column(TIME)?;
        let after = times.partition_point(|t| *t <= time + 1e-6 * time.abs());
        (!times.is_empty()).then(|| after.saturating_sub(1))
    }

    /// Load by history row [N].
    fn loads(&self) -> Option<&[f64]> {
        let history = self.history.as_ref()?;
        ["", "_1"].into_iter().find_map(|n| history.column(LOAD.of(n)))
    }

    /// Load at a frame [N].
    pub fn load(&self, frame: usize) -> Option<f64> {
        let row = self.row(self.frames[frame].time)?;
        self.loads()?.get(row).copied()
    }

    fn peak(&self) -> usize {
        let last = self.frames.len() - 1;
        let loads: Option<Vec<f64>> = (0..=last).map(|k| self.load(k)).collect();
        let largest =
            |loads: Vec<f64>| (0..=last).max_by(|a, b| loads[*a].total_cmp(&loads[*b]).then(b.cmp(a)));
        loads.and_then(largest).unwrap_or(last)
    }

    /// Load cycle at a frame: unloadings through the mean load, as in the cycle table.
    pub fn cycle(&self, frame: usize) -> Option<u64> {
        let numbers = self.cycles.as_ref()?.column(CYCLE)?;
        let loads = self.loads()?;
        let row = self.row(self.frames[frame].time)?;
        let (low, high) =
            loads.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |b, l| (b.0.min(*l), b.1.max(*l)));
        let middle = 0.5 * (low + high);
        let ended = loads[..=row].windows(2).filter(|w| w[0] > middle && w[1] <= middle).count();
        numbers.get(ended.min(numbers.len().checked_sub(1)?)).map(|n| *n as u64)
    }

    /// Reads a frame.
    ///
    /// # Errors
    /// Damaged file.
    pub fn moment(&self, frame: usize, wanted: &Wanted) -> Result<Moment, Failure> {
        let file = |part: series::Part| self.frames[frame].file(part);
        let read_grains = wanted.grains.as_ref().zip(file(series::Part::Grains));
        let grains = read_grains.map(|(_, file)| GrainFile::open(file)).transpose()?;
        let grain_values = match (&grains, &wanted.grains) {
            (Some(grains), Some(field)) => self.grain_values(grains, field, wanted.since.unwrap_or(0))?,
            _ => None,
        };
        let open = |wanted: bool, part| if wanted { file(part) } else { None };
        let chains = open(wanted.chains, series::Part::Chains).map(Chains::open).transpose()?;
        let walls = open(wanted.walls, series::Part::Walls).map(Walls::open).transpose()?;
        let stone_values = match (&walls, &wanted.grains) {
            (Some(walls), Some(field)) => walls.field(field)?,
            _ => None,
        };
        let (mut displacement, mut solid_values) = (None, None);
        if let (Some(field), Some(skin), Some(file)) = (&wanted.solid, &self.skin, file(series::Part::Solid))
        {
            let before = wanted.since.and_then(|k| self.frames[k].file(series::Part::Solid));
            let change = |read: &dyn Fn(&Path) -> Result<Vec<f64>, Failure>| {
                let mut values = read(file)?;
                if let Some(before) = before {
                    values.iter_mut().zip(read(before)?).for_each(|(v, b)| *v -= b);
                }
                Ok::<_, Failure>(values)
            };
            let u = change(&|file| skin.displacement_of_mesh(file))?;
            solid_values = match field.as_str() {
                "constant" => None,
                made if DISPLACEMENTS.contains(&made) => Some(reduced(&u, made)),
                field => Some(change(&|file| skin.field_of_mesh(file, field))?),
            };
            displacement = Some(u);
        }
        let time = self.frames[frame].time;
        Ok(Moment { time, grains, grain_values, chains, walls, stone_values, displacement, solid_values })
    }

    /// Value per grain; `None` for a constant colour.
    fn grain_values(
        &self,
        grains: &GrainFile,
        field: &str,
        since: usize,
    ) -> Result<Option<Vec<f64>>, Failure> {
        Ok(match field {
            "constant" => None,
            "diameter" => Some(grains.bodies.extents()),
            "piece" => Some(pieces(grains, &grains.field("fragment")?)),
            "displacement" => {
                let before =
                    self.frames[since].file(series::Part::Grains).map(GrainFile::open).transpose()?;
                Some(moved(grains, before.as_ref()))
            }
            field => Some(grains.field(field)?),
        })
    }
}

/// Whether a solid field has values per element.
pub fn of_elements(field: &str) -> bool {
    field.starts_with(CELL)
}

fn reduced(u: &[f64], name: &str) -> Vec<f64> {
    let part = DISPLACEMENTS.iter().position(|d| *d == name).unwrap_or(0);
    let of = |u: &[f64]| match part {
        0 => u.iter().map(|v| v * v).sum::<f64>().sqrt(),
        k => u[k - 1],
    };
    u.chunks_exact(3).map(of).collect()
}

/// Grain displacement since another frame [m]; 0 for new grains.
fn moved(grains: &GrainFile, before: Option<&GrainFile>) -> Vec<f64> {
    let place = |file: &GrainFile, body: usize| {
        let s = 3 * file.bodies.start[body] as usize;
        [file.centres()[s], file.centres()[s + 1], file.centres()[s + 2]]
    };
    let known: HashMap<u32, usize> =
        before.iter().flat_map(|b| b.bodies.id.iter().enumerate().map(|(k, id)| (*id, k))).collect();
    let of = |(k, id): (usize, &u32)| {
        let from = before.zip(known.get(id)).map(|(file, body)| place(file, *body));
        let to = place(grains, k);
        from.map_or(0.0, |from| (0..3).map(|c| (to[c] - from[c]).powi(2)).sum::<f64>().sqrt())
    };
    grains.bodies.id.iter().enumerate().map(of).collect()
}

/// Rank by volume of each grain's piece, 0 the largest.
fn pieces(grains: &GrainFile, fragment: &[f64]) -> Vec<f64> {
    let mut volume: Vec<(u64, f64)> = Vec::new();
    let mut at: HashMap<u64, usize> = HashMap::new();
    for (of, f) in grains.bodies.start.windows(2).zip(fragment) {
        let own = grains.bodies.radius[of[0] as usize..of[1] as usize].iter().map(|r| r * r * r).sum::<f64>();
        let k = *at.entry(*f as u64).or_insert_with(|| {
            volume.push((*f as u64, 0.0));
            volume.len() - 1
        });
        volume[k].1 += own;
    }
    volume.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let place: HashMap<u64, usize> = volume.iter().enumerate().map(|(k, (f, _))| (*f, k)).collect();
    fragment.iter().map(|f| place[&(*f as u64)] as f64).collect()
}
