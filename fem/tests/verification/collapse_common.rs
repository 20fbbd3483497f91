//! Meshes and footing of the collapse cases.

use std::collections::{BTreeMap, HashMap};
use trackbed_fem::TimeIntegrator;
use trackbed_fem::nonlinear::{Loading, NewtonOptions, QuasiStatic, Statistics, StepControl, Variant};
use trackbed_fem::{
    Constraint, Elastic, ElementKind, Material, Mesh, Model, ModelInput, MohrCoulomb, Quadrature, State,
};

/// Angles [°].
pub fn mohr_coulomb(elastic: Elastic, c: f64, phi: f64, psi: f64) -> Material {
    let (friction, dilation) = (phi.to_radians().into(), psi.to_radians());
    Material::plastic(elastic, MohrCoulomb { cohesion: c.into(), friction, dilation, tension: None })
}

/// Mapped blocks with coincident nodes merged.
#[derive(Default)]
pub struct Builder {
    pub mesh: Mesh,
    nodes: HashMap<[i64; 3], u32>,
}

impl Builder {
    fn node(&mut self, x: [f64; 3]) -> u32 {
        let (mesh, key) = (&mut self.mesh, x.map(|x| (x * 1e7).round() as i64));
        *self.nodes.entry(key).or_insert_with(|| {
            mesh.coordinates.push(x);
            mesh.node_ids.push(mesh.coordinates.len() as u32);
            mesh.coordinates.len() as u32 - 1
        })
    }

    /// Block of `counts` cells: one hexahedron, two wedges (axis along direction 2) or six tetrahedra each.
    /// `position` [m] takes indices on the half-cell grid.
    pub fn block(
        &mut self,
        counts: [usize; 3],
        kind: ElementKind,
        position: impl Fn([usize; 3]) -> [f64; 3],
    ) {
        let parts: &[&[usize]] = match kind.corner_count() {
            8 => &[&[0, 1, 2, 3, 4, 5, 6, 7]],
            6 => &[&[0, 4, 1, 3, 7, 2], &[5, 1, 4, 6, 2, 7]],
            4 => &[&[0, 1, 2, 6], &[0, 5, 1, 6], &[0, 2, 3, 6], &[0, 3, 7, 6], &[0, 4, 5, 6], &[0, 7, 4, 6]],
            _ => panic!("no such cells"),
        };
        let corners =
            [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2], [0, 2, 2]];
        for cell in 0..counts.iter().product() {
            let at = [cell % counts[0], cell / counts[0] % counts[1], cell / (counts[0] * counts[1])];
            for part in parts {
                let mut points: Vec<[usize; 3]> =
                    part.iter().map(|&c| std::array::from_fn(|d| 2 * at[d] + corners[c][d])).collect();
                if !kind.is_linear() {
                    let middle =
                        |e: &[usize; 2]| std::array::from_fn(|d| (points[e[0]][d] + points[e[1]][d]) / 2);
                    let middles: Vec<[usize; 3]> = kind.edges().iter().map(middle).collect();
                    points.extend(middles);
                }
                let nodes: Vec<u32> = points.iter().map(|p| self.node(position(*p))).collect();
                let id = self.mesh.element_count() as u32 + 1;
                self.mesh.push_element(id, 1, kind, &nodes);
            }
        }
    }
}

/// Position of half cell `i`.
pub fn between(lines: &[f64], i: usize) -> f64 {
    0.5 * (lines[i / 2] + lines[i.div_ceil(2)])
}

/// Graded grid lines from 0 to `length`, growth about `ratio`.
pub fn graded(length: f64, first: f64, ratio: f64) -> Vec<f64> {
    let count = (1.0 + length * (ratio - 1.0) / first).ln() / ratio.ln();
    let count = (count.round() as i32).clamp(1, (length / first) as i32);
    let sum = |q: f64| (0..count).map(|k| first * q.powi(k)).sum::<f64>();
    let (mut low, mut high) = (1.0, 4.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if sum(middle) < length { low = middle } else { high = middle }
    }
    let mut lines = vec![0.0];
    for k in 0..count {
        lines.push(lines[k as usize] + first * low.powi(k));
    }
    lines[count as usize] = length;
    lines
}

/// Grid lines refined on both sides of `edge`.
fn about(edge: f64, length: f64, first: f64, ratio: f64) -> Vec<f64> {
    let mut lines: Vec<f64> = graded(edge, first, ratio).iter().rev().map(|x| edge - x).collect();
    lines.extend(graded(length - edge, first, ratio).iter().skip(1).map(|x| edge + x));
    lines
}

/// Rigid rough footing, half width 1 m, on weightless ground: half of a strip or quarter of a square.
#[derive(Clone, Copy)]
pub struct Ground {
    pub kind: ElementKind,
    /// Element size at the footing edge [m].
    pub first: f64,
    /// Growth of the elements away from the edge.
    pub ratio: f64,
    /// Width and depth [m].
    pub extent: [f64; 2],
    pub square: bool,
}

pub struct Footing {
    pub model: Model,
    /// Constrained dofs that move with the footing.
    moved: Vec<bool>,
    /// Footing area in the model [m²].
    area: f64,
}

impl Footing {
    pub fn new(ground: &Ground, material: Material) -> Footing {
        let [width, depth] = ground.extent;
        let x = about(1.0, width, ground.first, ground.ratio);
        let z: Vec<f64> = graded(depth, ground.first, ground.ratio).iter().rev().map(|z| 0.0 - z).collect();
        let thickness = ground.first;
        let y = if ground.square { x.clone() } else { vec![0.0, thickness] };
        let mut builder = Builder::default();
        builder.block([x.len() - 1, y.len() - 1, z.len() - 1], ground.kind, |[i, j, k]| {
            [between(&x, i), between(&y, j), between(&z, k)]
        });
        let mesh = builder.mesh;
        let loaded =
            |p: &[f64; 3]| p[2] > -1e-9 && p[0] < 1.0 + 1e-9 && (!ground.square || p[1] < 1.0 + 1e-9);
        let mut constraints = Vec::new();
        for (node, p) in mesh.coordinates.iter().enumerate() {
            let base = p[2] < 1e-9 - depth;
            let side = |d: usize| p[d] < 1e-9 || p[d] > width - 1e-9;
            let held = [
                side(0) || base || loaded(p),
                !ground.square || side(1) || base || loaded(p),
                base || loaded(p),
            ];
            for direction in (0..3).filter(|d| held[*d as usize]) {
                constraints.push(Constraint { node: node as u32, direction, value: 0.0 });
            }
        }
        let materials: BTreeMap<u32, Material> = [(1, material)].into();
        let input =
            ModelInput { mesh, materials, quadrature: Quadrature::Gauss2, constraints, ..Default::default() };
        let model = Model::new(input).unwrap();
        let at = |dof: u32| loaded(&model.mesh().coordinates[dof as usize / 3]);
        let moved = model.supports().fixed().iter().map(|(dof, _)| dof % 3 == 2 && at(*dof)).collect();
        let area = if ground.square { 1.0 } else { thickness };
        Footing { model, moved, area }
    }

    /// Mean pressure [Pa].
    pub fn pressure(&self, reactions: &[f64]) -> f64 {
        let fixed = self.model.supports().fixed().iter().zip(&self.moved);
        -fixed.filter(|(_, moved)| **moved).map(|((dof, _), _)| reactions[*dof as usize]).sum::<f64>()
            / self.area
    }
}

/// Time is the settlement [m].
impl Loading for &Footing {
    fn load(&mut self, _time: f64, _load: &mut [f64]) {}

    fn prescribed(&mut self, time: f64, values: &mut [f64]) {
        values.iter_mut().zip(&self.moved).filter(|(_, moved)| **moved).for_each(|(v, _)| *v = -time);
    }
}

/// Without dilation a tighter tolerance stalls or costs many iterations, at equal load.
pub fn loose() -> NewtonOptions {
    NewtonOptions {
        force_tolerance: 1e-4,
        energy_tolerance: 1e-4,
        max_iterations: 40,
        ..NewtonOptions::new(Variant::Full)
    }
}

pub struct Course {
    /// Settlement [m] and mean pressure [Pa] per station.
    pub curve: Vec<[f64; 2]>,
    pub statistics: Statistics,
    pub stopped: Option<String>,
    /// Final settlement [m].
    pub settlement: f64,
}

impl Course {
    pub fn factor(&self, c: f64) -> f64 {
        self.curve.last().map_or(0.0, |p| p[1] / c)
    }
}

/// Loads to `settlement` [m]; steps between stations are halved at most six times.
pub fn push(footing: &Footing, options: NewtonOptions, settlement: f64, stations: u32) -> Course {
    let length = settlement / f64::from(stations);
    let control = StepControl {
        initial: length,
        min: length / 64.0,
        max: length,
        target_iterations: options.max_iterations / 2,
    };
    let mut solver = QuasiStatic::new(&footing.model, options, control).unwrap();
    let mut state = State::new(&footing.model);
    let (mut curve, mut stopped) = (Vec::new(), None);
    for station in 1..=stations {
        let to = if station == stations { settlement } else { length * f64::from(station) };
        let mut loading = footing;
        if let Err(error) = solver.integrate(&footing.model, &mut state, to, &mut loading, &mut |_, _, _| ())
        {
            stopped = Some(error.to_string());
            break;
        }
        curve.push([to, footing.pressure(solver.reactions())]);
    }
    Course { curve, statistics: solver.statistics(), stopped, settlement: state.time }
}
