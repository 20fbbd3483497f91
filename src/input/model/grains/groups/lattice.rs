//! Equal spheres on lattices.

use super::part::GroupsPart;
use super::shapes::MOST;
use crate::scene::grains::{GrainShape, Grains, LatticeFill, LatticeKind};
use crate::scene::units::vector;
use crate::scene::{SceneError, Table};
use trackbed_dem::insert::lattice::Lattice;
use trackbed_dem::shape::Shape;
use trackbed_dem::{BodyInput, Vec3};

pub(super) fn lattice(
    fill: &Table<LatticeFill>,
    model: &BodyInput,
    part: &mut GroupsPart,
) -> Result<(), SceneError> {
    fill.check("size", fill.size, |d| d > 0.0, "a diameter above 0")?;
    let (radius, low) = (0.5 * fill.size.si, Vec3::from(vector(&fill.low)));
    let kind = match fill.kind {
        LatticeKind::Loose => Lattice::Simple,
        LatticeKind::Hexagonal => Lattice::Hexagonal,
        LatticeKind::FaceCentred => Lattice::FaceCentred,
    };
    let few = |n: f64, k: &str| {
        let expected = "1 to 10000000 spheres";
        if (1.0..=MOST).contains(&n) { Ok(()) } else { Err(fill.error(k, format!("{n} spheres"), expected)) }
    };
    let sites = match (&fill.counts, &fill.high) {
        (Some(counts), None) => {
            few(counts.iter().map(|n| *n as f64).product(), "counts")?;
            kind.block(low, radius, *counts)
        }
        (None, Some(high)) => {
            let high = Vec3::from(vector(high));
            // A wrong unit must not exhaust memory.
            let about: f64 = (high - low).iter().map(|l| (l / fill.size.si).max(0.0)).product();
            if about > MOST {
                few(about.round(), "high")?;
            }
            let sites = kind.fill(low, high, radius);
            few(sites.len() as f64, "high")?;
            sites
        }
        (counts, _) => return Err(fill.choice(["counts", "high"], counts.is_some())),
    };
    let shape = part.shapes.len();
    part.shapes.push(Shape::Sphere { radius: 1.0 });
    let body = |position| BodyInput { shape, scale: radius, position, ..model.clone() };
    part.bodies.extend(sites.into_iter().map(body));
    Ok(())
}

pub(super) fn spheres_only(group: &Table<Grains>) -> Result<(), SceneError> {
    if group.shape == GrainShape::Sphere {
        return Ok(());
    }
    Err(group.error("shape", "another shape", "\"sphere\", which a lattice consists of"))
}
