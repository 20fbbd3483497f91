//! Interface numbers W and D of a dense grain layer on the surface.

use super::ContactClass;
use crate::model::grains::GrainsPart;
use trackbed_coupling::face::landmarks;
use trackbed_coupling::interface_stability::{
    InterfaceStability, InterfaceStabilityNumbers, SurfacePoint, undamped,
};
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_dem::surface::Surface;
use trackbed_fem as fem;

const RINGS: i32 = 4;

/// Mean mass and radius of a grain material, and contact mobility of its lightest grain.
struct Stones {
    mass: f64,
    radius: f64,
    /// Largest 1/m + r²/I [1/kg].
    mobility: f64,
}

fn stones(model: &dem::Model, material: usize, grains: u32) -> Option<Stones> {
    let own =
        || (0..model.body_count()).filter(move |&b| model.part(b) < grains && model.material(b) == material);
    let count = own().count() as f64;
    let mean = |f: &dyn Fn(usize) -> f64| own().map(f).sum::<f64>() / count;
    let mobility = |b: usize| {
        let inertia = model.inertia(b).min();
        let turn = if inertia > 0.0 { model.radius(b).powi(2) / inertia } else { 0.0 };
        1.0 / model.mass(b) + turn
    };
    (count > 0.0).then(|| Stones {
        mass: mean(&|b| model.mass(b)),
        radius: mean(&|b| model.radius(b)),
        mobility: own().map(mobility).fold(0.0, f64::max),
    })
}

/// Adds interface numbers on the ground for windows of 1 s. `within`: whether grains reach a face; `own`: DEM
/// material of the ground.
pub fn add_numbers(
    classes: &mut [ContactClass],
    (grains, model, own): (&GrainsPart, &dem::Model, usize),
    (solid, surface): (&fem::Model, &SolidSurface),
    within: impl Fn(u32) -> bool,
) {
    let mut interface = InterfaceStability::new(solid, surface);
    let Some(middle) = lightest(solid, surface, within) else { return };
    let bodies = grains.stone_groups();
    for (material, name) in grains.materials.touching() {
        let Some(stones) = stones(model, material, bodies) else { continue };
        // Ratios do not depend on overlap.
        let law = model.linearised(material, own, stones.mass, stones.radius, 1e-3 * stones.radius);
        let (stiffness, ratio) = model.contact_stiffness(material, own);
        let share = |across: f64, along: f64| if along > 0.0 { across / along } else { 0.0 };
        let springs = [stiffness, stiffness * share(law.tangential, law.normal)];
        let dashpot = 2.0 * ratio * (stones.mass * stiffness).sqrt();
        let damping = [dashpot, dashpot * share(law.tangential_damping, law.damping)];
        let points = lattice(surface, middle, stones.radius, springs, damping);
        let [w, d] = interface.of_points(surface, &points);
        let [along, across] = undamped(springs, damping, stones.mass);
        let phase = (across * stones.mobility).max(along / stones.mass).sqrt();
        let numbers = InterfaceStabilityNumbers { stiffness: w, damping: d, phase };
        classes.iter_mut().filter(|c| c.grains == name).for_each(|c| c.numbers = numbers);
    }
}

fn lightest(
    solid: &fem::Model,
    surface: &SolidSurface,
    within: impl Fn(u32) -> bool,
) -> Option<(u32, [f64; 2])> {
    let diagonal = solid.matrices().mass_diagonal();
    let mut least: Option<(f64, u32, usize)> = None;
    for patch in (0..surface.faces().len() as u32).filter(|&p| within(p)) {
        for (k, &node) in surface.faces()[patch as usize].corners().iter().enumerate() {
            let mass = diagonal[node as usize] * if surface.corner_on_border(patch, k) { 1e3 } else { 1.0 };
            if least.is_none_or(|(m, ..)| mass < m) {
                least = Some((mass, patch, k));
            }
        }
    }
    least.map(|(_, patch, corner)| (patch, landmarks(surface.shape(patch))[corner]))
}

/// Contacts of a hexagonal layer of touching spheres, one at the given point.
fn lattice(
    surface: &SolidSurface,
    (patch, local): (u32, [f64; 2]),
    radius: f64,
    stiffness: [f64; 2],
    damping: [f64; 2],
) -> Vec<SurfacePoint> {
    let normal = Vec3::from(surface.normal(patch, local));
    let middle = Vec3::from(surface.place(patch, local));
    let axis = if normal.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() };
    let a = normal.cross(&axis).normalize();
    let b = normal.cross(&a);
    let mut points = vec![SurfacePoint { patch, local, stiffness, damping }];
    let mut found = Vec::new();
    for i in -RINGS..=RINGS {
        for j in -RINGS..=RINGS {
            if (i, j) == (0, 0) || (i + j).abs() > RINGS {
                continue;
            }
            let (x, y) = (2.0 * f64::from(i) + f64::from(j), 3.0_f64.sqrt() * f64::from(j));
            let place = middle + (a * x + b * y) * radius;
            let [low, high] = [-1.0, 1.0].map(|s| place.add_scalar(s * radius).into());
            found.clear();
            surface.candidates(low, high, &mut found);
            let near = found.iter().map(|&p| (p, surface.closest_point(p, place.into(), [0.0; 2])));
            let near = near.map(|(p, c)| ((Vec3::from(c.point) - place).norm(), p, c.local));
            if let Some((distance, patch, local)) = near.min_by(|a, b| a.0.total_cmp(&b.0))
                && distance < 0.5 * radius
            {
                points.push(SurfacePoint { patch, local, stiffness, damping });
            }
        }
    }
    points
}
