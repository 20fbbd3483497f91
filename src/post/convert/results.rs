//! Grains and chains of result frames.

use super::{animation, chains};
use std::collections::HashMap;
use std::path::Path;
use trackbed_io::failure::Failure;
use trackbed_io::read::ReadError;
use trackbed_io::read::vtk_arrays::Arrays;
use trackbed_io::results::series::{self, Frame, Part};
use trackbed_io::write::{NO_BODY, STONE_BODY, STONE_CENTRE, WallKind};

/// Particles of a frame: spheres, then polyhedra and disks, which have no spheres.
struct Particles {
    /// Body of each particle.
    id: Vec<u32>,
    moment: animation::Moment,
}

impl Particles {
    /// `None` without a file of grains.
    fn of(frame: &Frame) -> Result<Option<Particles>, Failure> {
        let Some(file) = frame.file(Part::Grains) else { return Ok(None) };
        let mut particles = spheres(file, frame.time)?;
        if let Some(file) = frame.file(Part::Walls) {
            particles.add_stones(file)?;
        }
        Ok(Some(particles))
    }

    /// Polyhedra count as spheres of equal volume.
    fn add_stones(&mut self, file: &Path) -> Result<(), Failure> {
        let arrays = Arrays::open(file, "PolyData")?;
        let cells = |name: &str| arrays.components("CellData", name).is_some();
        if !cells(STONE_BODY) {
            let stone = |kind: &u32| *kind == WallKind::Stone as u32;
            if cells("kind") && arrays.indices("CellData", "kind")?.iter().any(stone) {
                let expected = "the bodies of polyhedra and disks; run the scene again";
                let key = format!("array {STONE_BODY} of CellData");
                return Err(ReadError::whole(file, key, "none", expected).into());
            }
            return Ok(());
        }
        let body = arrays.indices("CellData", STONE_BODY)?;
        let centre = triples(&arrays.values("CellData", STONE_CENTRE)?);
        let points = triples(&arrays.values("Points", "Points")?);
        let corners = arrays.indices("Polys", "connectivity")?;
        let ends = arrays.indices("Polys", "offsets")?;
        let velocity = cells("velocity").then(|| arrays.values("CellData", "velocity")).transpose()?;
        let part = ["fragment", "part"].into_iter().find(|name| cells(name));
        let part = part.map(|name| arrays.values("CellData", name)).transpose()?;
        let fits = ends.is_sorted() && ends.last().is_none_or(|last| *last as usize <= corners.len());
        if !fits || corners.iter().any(|c| *c as usize >= points.len()) {
            let found = format!("{} corners of {} polygons", corners.len(), ends.len());
            return Err(ReadError::whole(file, "Polys", found, "points of the file for each").into());
        }
        let polygon = |p: usize| {
            let begin = if p == 0 { 0 } else { ends[p - 1] };
            corners[begin as usize..ends[p] as usize].iter().map(|c| points[*c as usize])
        };
        let mut first = 0;
        while first < body.len() {
            let end = first + body[first..].iter().take_while(|b| **b == body[first]).count();
            if body[first] != NO_BODY {
                let volume: f64 = (first..end).map(|p| cone(centre[first], polygon(p))).sum();
                self.id.push(body[first]);
                self.moment.position.push(centre[first]);
                self.moment.radius.push(libm::cbrt(0.75 / std::f64::consts::PI * volume.abs()));
                self.moment
                    .velocity
                    .push(velocity.as_ref().map_or([0.0; 3], |v| triples(&v[3 * first..])[0]));
                if let Some(all) = &mut self.moment.part {
                    all.push(part.as_ref().map_or(0.0, |part| part[first]));
                }
            }
            first = end;
        }
        Ok(())
    }
}

fn spheres(file: &Path, time: f64) -> Result<Particles, Failure> {
    let arrays = Arrays::open(file, "PolyData")?;
    let there = |name: &str| arrays.components("PointData", name).is_some();
    let position = triples(&arrays.values("Points", "Points")?);
    let velocity = match there("velocity") {
        true => triples(&arrays.values("PointData", "velocity")?),
        false => vec![[0.0; 3]; position.len()],
    };
    let part = ["fragment", "part"].into_iter().find(|name| there(name));
    let moment = animation::Moment {
        time,
        radius: arrays.values("PointData", "radius")?,
        velocity,
        part: part.map(|name| arrays.values("PointData", name)).transpose()?,
        position,
    };
    Ok(Particles { id: arrays.indices("PointData", "id")?, moment })
}

/// Volume of the cone from `apex` over a polygon [m³].
fn cone(apex: [f64; 3], polygon: impl Iterator<Item = [f64; 3]>) -> f64 {
    let arms: Vec<[f64; 3]> = polygon.map(|x| [x[0] - apex[0], x[1] - apex[1], x[2] - apex[2]]).collect();
    let triple = |a: [f64; 3], b: [f64; 3], c: [f64; 3]| {
        a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    arms.windows(2).skip(1).map(|edge| triple(arms[0], edge[0], edge[1]) / 6.0).sum()
}

/// Reads the particles of all frames; the last column is the fragment, else the part.
///
/// # Errors
/// Missing or damaged frames, polyhedra without bodies.
pub fn grains(dir: &Path) -> Result<Vec<animation::Moment>, Failure> {
    let mut moments = Vec::new();
    for frame in series::read(dir)? {
        moments.extend(Particles::of(&frame)?.map(|particles| particles.moment));
    }
    Ok(moments)
}

/// Reads the force chains of all frames, numbered as [`grains`]; clumps by their first sphere.
///
/// # Errors
/// Missing or damaged frames, chains without partner ids, polyhedra without bodies.
pub fn chains(dir: &Path) -> Result<Vec<chains::Moment>, Failure> {
    let mut moments = Vec::new();
    for frame in series::read(dir)? {
        let (Some(file), Some(grains)) = (frame.file(Part::Chains), Particles::of(&frame)?) else {
            continue;
        };
        let mut number = HashMap::new();
        for (k, id) in grains.id.iter().enumerate() {
            number.entry(*id).or_insert(k as u32 + 1);
        }
        let arrays = Arrays::open(file, "PolyData")?;
        let partners = |name: &str| arrays.indices("CellData", name);
        let (a, b) = (partners("a")?, partners("b")?);
        let normal = arrays.values("CellData", "normal_force")?;
        let tangential = arrays.values("CellData", "tangential_force")?;
        // Sleepers are bodies, but no particles.
        let of = |id: &u32| number.get(id).copied().unwrap_or(0);
        let chains = (0..normal.len()).map(|k| chains::Chain {
            first: of(&a[k]),
            second: of(&b[k]),
            normal: normal[k],
            tangential: tangential[k],
        });
        moments.push(chains::Moment { time: frame.time, chains: chains.collect() });
    }
    Ok(moments)
}

fn triples(flat: &[f64]) -> Vec<[f64; 3]> {
    flat.chunks_exact(3).map(|x| [x[0], x[1], x[2]]).collect()
}
