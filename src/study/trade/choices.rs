//! Settings that trade accuracy for speed: a function each, and a line of `ALL`.

use trackbed_input::scene::Scene;
use trackbed_input::scene::coupling::{FacesName, SchemeName, Substeps, TransferTable};
use trackbed_input::scene::grains::GrainShape;
use trackbed_input::scene::solid::{Integration, MaterialModel, NewtonVariant, Order};

/// Number of spheres over clumps of the same sieve sizes, for equal volume in total.
const SPHERE_COUNT: f64 = 0.73;
/// Size of coarser stones.
const COARSER: f64 = 1.6;

/// Setting of a scene: other values than its own, and the finest for the reference.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Choice {
    /// Name, without = , | or quotes.
    pub name: &'static str,
    /// Label and overrides of each value.
    pub values: Vec<(String, Vec<String>)>,
    /// Overrides of the finest value; empty if it is the scene's own, or if none is finer.
    pub finest: Vec<String>,
}

/// All settings, in the order of the table.
const ALL: &[fn(&Scene) -> Option<Choice>] = &[
    grain_step,
    contact_stiffness,
    mass_factor,
    restitution,
    shape,
    stone_size,
    deposition_stiffness,
    load_frequency,
    servo_gain,
    element_order,
    integration,
    mesh,
    newton,
    reduction,
    numerical_damping,
    solid_step,
    scheme,
    window,
    theta,
    contact_faces,
    transfer,
    jump,
];

/// Returns the settings that a scene has.
pub fn of(scene: &Scene) -> Vec<Choice> {
    ALL.iter().filter_map(|choice| choice(scene)).filter(|c| !c.values.is_empty()).collect()
}

fn one(label: impl Into<String>, set: impl Into<String>) -> (String, Vec<String>) {
    (label.into(), vec![set.into()])
}

fn grain_step(scene: &Scene) -> Option<Choice> {
    if scene.grains.is_empty() {
        return None;
    }
    let (key, own) = match scene.time.grain_step {
        Some(step) => ("time.grain_step", step.si),
        None => ("time.grain_step_fraction", scene.time.grain_step_fraction.unwrap_or(0.8)),
    };
    let set = |parts: u64| {
        let steps = scene.time.steps.map(|n| format!("time.steps={}", n.saturating_mul(parts)));
        std::iter::once(format!("{key}={:?}", own / parts as f64)).chain(steps).collect::<Vec<String>>()
    };
    Some(Choice { name: "grain step", values: vec![("half".to_string(), set(2))], finest: set(4) })
}

/// Of all materials, so that ratios keep their values.
fn contact_stiffness(scene: &Scene) -> Option<Choice> {
    let set = |factor: f64| -> Vec<String> {
        let keys = scene.material.iter().enumerate().flat_map(|(k, m)| {
            [("young", m.young.map(|q| q.si)), ("stiffness", m.stiffness.map(|q| q.si))]
                .into_iter()
                .filter_map(move |(key, own)| Some(format!("material.{k}.{key}={:?}", factor * own?)))
        });
        keys.collect()
    };
    let values = [("1/4", 0.25), ("1/16", 0.0625)].map(|(label, f)| (label.to_string(), set(f)));
    let has = !scene.grains.is_empty() && !set(1.0).is_empty();
    has.then(|| Choice { name: "contact stiffness", values: values.to_vec(), ..Choice::default() })
}

fn mass_factor(scene: &Scene) -> Option<Choice> {
    let own = scene.time.mass_factor.unwrap_or(1.0);
    let value = |factor: f64| one(format!("{}", factor * own), format!("time.mass_factor={}", factor * own));
    let finest = if own > 1.0 { vec!["time.mass_factor=1".to_string()] } else { Vec::new() };
    (!scene.grains.is_empty()).then(|| Choice {
        name: "mass factor",
        values: vec![value(4.0), value(16.0)],
        finest,
    })
}

fn restitution(scene: &Scene) -> Option<Choice> {
    let of_grains = |name: &str| scene.grains.iter().any(|g| g.material == name);
    let own: Vec<(usize, f64)> = scene
        .material
        .iter()
        .enumerate()
        .filter(|(_, m)| of_grains(&m.name))
        .map(|(k, m)| (k, m.restitution))
        .collect();
    let set = |e: f64| own.iter().map(|(k, _)| format!("material.{k}.restitution={e}")).collect();
    let other = |e: &&f64| own.iter().any(|(_, r)| r != *e);
    let values = [0.1, 0.7].iter().filter(other).map(|e| (e.to_string(), set(*e))).collect();
    Some(Choice { name: "restitution", values, ..Choice::default() })
}

/// Single spheres with rolling friction instead of clumps.
fn shape(scene: &Scene) -> Option<Choice> {
    let clumps = || scene.grains.iter().enumerate().filter(|(_, g)| g.shape == GrainShape::Clump);
    let group = |(k, g): (usize, &trackbed_input::scene::grains::Grains)| {
        let count = g.count.map(|n| format!("grains.{k}.count={:.0}", (SPHERE_COUNT * n as f64).max(1.0)));
        let fixed = [format!("grains.{k}.shape=sphere"), format!("grains.{k}.library=")];
        fixed.into_iter().chain(count).collect::<Vec<String>>()
    };
    let rolls = |name: &str| clumps().any(|(_, g)| g.material == name);
    let rolling = scene.material.iter().enumerate().filter(|(_, m)| rolls(&m.name));
    let rolling = rolling.map(|(k, _)| format!("material.{k}.rolling_friction=0.2"));
    let set: Vec<String> = clumps().flat_map(group).chain(rolling).collect();
    let values = vec![("spheres that roll against friction 0.2".to_string(), set)];
    clumps().next().map(|_| Choice { name: "shape", values, ..Choice::default() })
}

/// Of all groups: half a scene of coarser stones says nothing of either.
fn stone_size(scene: &Scene) -> Option<Choice> {
    let mut set = Vec::new();
    for (k, g) in scene.grains.iter().enumerate() {
        match (&g.gradation, g.size) {
            (Some(curve), _) => set.push(format!("grains.{k}.gradation.scale={:?}", COARSER * curve.scale)),
            (None, Some([low, high])) => {
                set.push(format!("grains.{k}.size=[{:?}, {:?}]", COARSER * low.si, COARSER * high.si));
            }
            (None, None) => return None,
        }
        let fewer = |n: usize| (n as f64 / COARSER.powi(3)).max(1.0);
        set.extend(g.count.map(|n| format!("grains.{k}.count={:.0}", fewer(n))));
    }
    let values = vec![(format!("{COARSER} times"), set)];
    (!scene.grains.is_empty()).then(|| Choice { name: "stone size", values, ..Choice::default() })
}

fn deposition_stiffness(scene: &Scene) -> Option<Choice> {
    let own = scene.deposition.as_ref()?.stiffness_factor.unwrap_or(1.0);
    let set = |factor: f64| format!("deposition.stiffness_factor={factor}");
    let finest = if own < 1.0 { vec![set(1.0)] } else { Vec::new() };
    Some(Choice { name: "stiffness in deposition", values: vec![one("1/4", set(0.25 * own))], finest })
}

fn load_frequency(scene: &Scene) -> Option<Choice> {
    let own = scene.track.as_ref()?.load.as_ref()?.frequency?.si;
    let value = |factor: f64| format!("track.load.frequency={:?}", factor * own);
    let label = format!("{} Hz", 2.0 * own);
    Some(Choice { name: "load frequency", values: vec![one(label, value(2.0))], finest: vec![value(0.5)] })
}

fn servo_gain(scene: &Scene) -> Option<Choice> {
    let servos = || scene.walls.iter().enumerate().filter_map(|(k, wall)| Some((k, wall.servo.as_ref()?)));
    let set =
        servos().map(|(k, servo)| format!("walls.{k}.servo.gain={:?}", 0.5 * servo.gain.unwrap_or(0.5)));
    let values = vec![("half".to_string(), set.collect())];
    servos().next().map(|_| Choice { name: "servo gain", values, ..Choice::default() })
}

fn element_order(scene: &Scene) -> Option<Choice> {
    let solid = scene.solid.as_ref()?;
    let linear = solid.order == Some(Order::Linear);
    let other = if linear { "quadratic" } else { "linear" };
    let set = format!("solid.order={other}");
    let finest = if linear { vec![set.clone()] } else { Vec::new() };
    Some(Choice { name: "element order", values: vec![one(other, set)], finest })
}

fn integration(scene: &Scene) -> Option<Choice> {
    let solid = scene.solid.as_ref().filter(|solid| solid.order != Some(Order::Linear))?;
    let own = solid.integration;
    let all =
        [("reduced", Integration::Reduced), ("irons14", Integration::Irons14), ("full", Integration::Full)];
    let others = all.into_iter().filter(|(_, rule)| *rule != own);
    let values = others.map(|(name, _)| one(name, format!("solid.integration={name}"))).collect();
    Some(Choice { name: "integration", values, ..Choice::default() })
}

/// Elements of a block, twice and half as many along each axis that has more than one.
fn mesh(scene: &Scene) -> Option<Choice> {
    let block = scene.solid.as_ref()?.block.as_ref()?;
    let set = |of: fn(usize) -> usize| -> Vec<String> {
        let axes = [("x", &block.x), ("y", &block.y), ("z", &block.z)];
        let varied = axes.into_iter().filter(|(_, axis)| axis.counts.iter().sum::<usize>() > 1);
        let line = |(name, axis): (&str, &trackbed_input::scene::solid::Axis)| {
            let counts: Vec<usize> = axis.counts.iter().map(|n| of(*n)).collect();
            format!("solid.block.{name}.counts={counts:?}")
        };
        varied.map(line).collect()
    };
    let halved = ("half the elements along each axis".to_string(), set(|n| n.div_ceil(2)));
    Some(Choice { name: "mesh", values: vec![halved], finest: set(|n| 2 * n) })
}

fn newton(scene: &Scene) -> Option<Choice> {
    let solid = scene.solid.as_ref()?;
    if solid.material.iter().all(|m| m.model == MaterialModel::Elastic) {
        return None;
    }
    let own = solid.newton.as_ref().and_then(|n| n.tolerance).unwrap_or(1e-5);
    let set = |tolerance: f64| format!("solid.newton.tolerance={tolerance:?}");
    let coarse = (100.0 * own).min(0.01);
    let mut values = vec![one(format!("tolerance {coarse:?}"), set(coarse))];
    if solid.newton.as_ref().and_then(|n| n.variant) != Some(NewtonVariant::Modified) {
        values.push(one("modified", "solid.newton.variant=modified"));
    }
    Some(Choice { name: "newton", values, finest: vec![set((0.01 * own).max(1e-12))] })
}

fn reduction(scene: &Scene) -> Option<Choice> {
    let solid = scene.solid.as_ref().filter(|_| scene.coupling.is_some())?;
    let basis = |kind: &str| one(kind, format!("solid.reduction={{ kind = \"{kind}\" }}"));
    let (values, finest) = match solid.reduction {
        None => (vec![basis("surface"), basis("modes")], Vec::new()),
        Some(_) => (vec![one("none", "solid.reduction=")], vec!["solid.reduction=".to_string()]),
    };
    Some(Choice { name: "solid reduction", values, finest })
}

fn numerical_damping(scene: &Scene) -> Option<Choice> {
    let dynamics = scene.solid.as_ref()?.dynamics.as_ref()?;
    let (label, set) = match dynamics.hht_alpha {
        None => ("hht_alpha −0.1", "solid.dynamics={ hht_alpha = -0.1 }"),
        Some(_) => ("Newmark", "solid.dynamics={}"),
    };
    Some(Choice { name: "time integration", values: vec![one(label, set)], ..Choice::default() })
}

/// Longer steps only if they divide the duration, so that all runs end together.
fn solid_step(scene: &Scene) -> Option<Choice> {
    let own = scene.time.solid_step?.si;
    let count = match (scene.time.steps, scene.time.end) {
        (Some(steps), _) => steps as f64,
        (None, Some(end)) => end.si / own,
        (None, None) => return None,
    };
    let set = |factor: f64| {
        let steps = scene.time.steps.map(|_| format!("time.steps={:.0}", count / factor));
        std::iter::once(format!("time.solid_step={:?}", factor * own)).chain(steps).collect::<Vec<String>>()
    };
    let divides = |factor: &&f64| {
        let steps = count / **factor;
        (steps - steps.round()).abs() < 1e-6 * steps && steps.round() >= 1.0
    };
    let all = [2.0, 4.0, 5.0];
    let values = all.iter().filter(divides).take(2).map(|f| (format!("{f} times"), set(*f))).collect();
    Some(Choice { name: "solid step", values, finest: set(0.5) })
}

fn scheme(scene: &Scene) -> Option<Choice> {
    let own = scene.coupling.as_ref()?.scheme;
    let all = [
        ("predicted", SchemeName::Predicted),
        ("lagged", SchemeName::Lagged),
        ("iterated", SchemeName::Iterated),
    ];
    let others = all.into_iter().filter(|(_, scheme)| *scheme != own);
    let values = others.map(|(name, _)| one(name, format!("coupling.scheme={name}"))).collect();
    let finest = vec!["coupling.scheme=iterated".to_string()];
    Some(Choice { name: "coupling scheme", values, finest })
}

fn window(scene: &Scene) -> Option<Choice> {
    let coupling = scene.coupling.as_ref()?;
    let steps = |n: i64| format!("coupling.substeps={n}");
    let (values, finest) = match (coupling.window, coupling.substeps.unwrap_or_default()) {
        (Some(window), _) => {
            let set = |factor: f64| format!("coupling.window={:?}", factor * window.si);
            (vec![one("2 times", set(2.0))], set(0.5))
        }
        (None, Substeps::Auto) => (vec![one("10 steps", steps(10))], steps(2)),
        (None, Substeps::Count(n)) => {
            (vec![one(format!("{} steps", 2 * n), steps(2 * n))], steps((n / 2).max(1)))
        }
    };
    Some(Choice { name: "coupling window", values, finest: vec![finest] })
}

fn theta(scene: &Scene) -> Option<Choice> {
    let own = scene.coupling.as_ref()?.theta;
    let others = [0.6, 1.0].into_iter().filter(|theta| own != Some(*theta));
    let values = others.map(|theta| one(theta.to_string(), format!("coupling.theta={theta:?}"))).collect();
    Some(Choice { name: "theta", values, ..Choice::default() })
}

fn contact_faces(scene: &Scene) -> Option<Choice> {
    let flat = scene.coupling.as_ref()?.faces == Some(FacesName::Flat);
    let other = if flat { "curved" } else { "flat" };
    let set = format!("coupling.faces={other}");
    let finest = if flat { vec![set.clone()] } else { Vec::new() };
    Some(Choice { name: "contact faces", values: vec![one(other, set)], finest })
}

fn transfer(scene: &Scene) -> Option<Choice> {
    let value = match scene.coupling.as_ref()?.transfer {
        TransferTable::Point => one("spread", "coupling.transfer={ spread_factor = 0.5 }"),
        TransferTable::Spread(_) => one("point", "coupling.transfer=point"),
    };
    Some(Choice { name: "load transfer", values: vec![value], ..Choice::default() })
}

fn jump(scene: &Scene) -> Option<Choice> {
    let own = scene.track.as_ref()?.jump.as_ref()?;
    let tolerance = 5.0 * own.tolerance;
    let largest = 2.0 * own.largest;
    let values = vec![
        one(format!("tolerance {tolerance:?}"), format!("track.jump.tolerance={tolerance:?}")),
        one(format!("largest {largest:?}"), format!("track.jump.largest={largest:?}")),
    ];
    Some(Choice { name: "cycle jumps", values, finest: vec!["track.jump=".to_string()] })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;
    use trackbed_input::scene::Document;

    fn names(scene: &str, set: &[&str]) -> Vec<Choice> {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("inputs").join(scene);
        let mut document = Document::open(&file).unwrap();
        document.set_all(&set.iter().map(ToString::to_string).collect::<Vec<_>>()).unwrap();
        of(&document.scene().unwrap())
    }

    fn of_name<'a>(choices: &'a [Choice], name: &str) -> &'a Choice {
        choices.iter().find(|c| c.name == name).unwrap_or_else(|| panic!("{name}"))
    }

    #[test]
    fn coupled_track_has_all_kinds() {
        let all = names("track/cyclic/scene.toml", &["track.jump.first=10"]);
        let found: Vec<&str> = all.iter().map(|c| c.name).collect();
        let expected = [
            "grain step",
            "contact stiffness",
            "mass factor",
            "restitution",
            "shape",
            "stone size",
            "load frequency",
            "element order",
            "integration",
            "solid reduction",
            "coupling scheme",
            "coupling window",
            "theta",
            "contact faces",
            "load transfer",
            "cycle jumps",
        ];
        assert!(expected.iter().all(|name| found.contains(name)), "{found:?}");
        // Linear ground has no Newton iteration, a mesh from a file no finer block.
        assert!(!found.contains(&"newton") && !found.contains(&"mesh"), "{found:?}");
        // The finest: 0.2 of the critical step, the full solid, iterated windows, all cycles.
        let finest: Vec<&String> = all.iter().flat_map(|c| &c.finest).collect();
        for set in [
            "time.grain_step_fraction=0.2",
            "solid.reduction=",
            "coupling.scheme=iterated",
            "coupling.substeps=2",
            "track.load.frequency=4.0",
            "track.jump=",
        ] {
            assert!(finest.iter().any(|f| *f == set), "{set}: {finest:?}");
        }
        assert_eq!(of_name(&all, "load frequency").values[0].1, ["track.load.frequency=16.0"]);
    }

    #[test]
    fn values_keep_ratios() {
        let all = names("ballast/triaxial-cyclic.toml", &["time.mass_factor=4"]);
        let quarter = &of_name(&all, "contact stiffness").values[0].1;
        let moduli: Vec<f64> =
            quarter.iter().map(|set| set.split_once('=').unwrap().1.parse().unwrap()).collect();
        assert_eq!(moduli[0], 3.75e9);
        assert!(quarter.iter().all(|set| set.contains(".young=")), "{quarter:?}");
        let servo = &of_name(&all, "servo gain").values[0].1;
        assert_eq!(servo.len(), 3);
        assert!(servo.iter().all(|set| set.ends_with(".servo.gain=0.5")), "{servo:?}");
        assert_eq!(of_name(&all, "mass factor").values[0].0, "16");
        assert_eq!(of_name(&all, "mass factor").finest, ["time.mass_factor=1"]);
        assert_eq!(of_name(&all, "stone size").values[0].1, ["grains.0.gradation.scale=2.5600000000000005"]);
        let mesh = names("solid/footing.toml", &[]);
        let mesh = of_name(&mesh, "mesh");
        // Plane strain keeps its one element across.
        assert_eq!(mesh.finest, ["solid.block.x.counts=[10, 18]", "solid.block.z.counts=[18]"]);
        assert_eq!(mesh.values[0].1, ["solid.block.x.counts=[3, 5]", "solid.block.z.counts=[5]"]);
    }
}
