use super::*;
use crate::assumed::{AssumedStrain, Dilatation};
use crate::element::ElementKind;
use crate::material::{Cone, DruckerPrager, Elastic, Material, MohrCoulomb};
use crate::mesh::{Constraint, Mesh};
use crate::model::ModelInput;

const SOIL: Elastic = Elastic { young: 2e7, poisson: 0.3, density: 1000.0 };

struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Two distorted elements, pairs p > q included; the second is elastic.
fn model(kind: ElementKind, material: Material, assumed: AssumedStrain) -> Model {
    let mut random = Random(3);
    let mut mesh = Mesh::default();
    for (shift, number) in [(0.0, 1), (5.0, 2)] {
        let first = mesh.coordinates.len() as u32;
        for x in kind.natural().iter().rev() {
            mesh.node_ids.push(mesh.coordinates.len() as u32 + 1);
            mesh.coordinates.push([x[0] + shift, x[1], x[2]].map(|x| x + 0.04 * random.next()));
        }
        let nodes: Vec<u32> = (first..first + kind.node_count() as u32).rev().collect();
        mesh.push_element(number, number, kind, &nodes);
    }
    let constraints = vec![Constraint { node: 1, direction: 2, value: 0.0 }];
    Model::new(ModelInput {
        mesh,
        materials: [(1, material), (2, SOIL.into())].into(),
        assumed,
        constraints,
        ..Default::default()
    })
    .unwrap_or_else(|e| panic!("{}: {e}", kind.name()))
}

fn materials() -> [Material; 4] {
    let mohr_coulomb = |psi: f64| {
        let law = MohrCoulomb { cohesion: 5e3.into(), friction: 0.5.into(), dilation: psi, tension: None };
        Material::plastic(SOIL, law)
    };
    let cone = |psi: f64| {
        let cone = Cone::Compression;
        let law =
            DruckerPrager { cohesion: 5e3.into(), friction: 0.5.into(), dilation: psi, cone, tension: None };
        Material::plastic(SOIL, law)
    };
    [mohr_coulomb(0.5), mohr_coulomb(0.1), cone(0.5), cone(0.0)]
}

/// Solver entries belong to the same matrix.
#[test]
fn tangent_differentiates_internal_force() {
    let assumed = AssumedStrain { dilatation: Dilatation::Mean, incompatible_modes: true };
    let cases = ElementKind::ALL.into_iter().flat_map(|k| materials().map(|m| (k, m)));
    for ((kind, material), assumed) in cases.flat_map(|c| [(c.clone(), assumed), (c, Default::default())]) {
        let model = model(kind, material.clone(), assumed);
        let n = model.dof_count();
        let mut random = Random(11);
        // Beyond yield at every point.
        let mut w = vec![0.0; n];
        for (node, x) in model.mesh().coordinates.iter().enumerate() {
            let uniform = [-0.0005 * x[0] + 0.006 * x[2], 0.0004 * x[1], -0.001 * x[2]];
            (0..3).for_each(|k| w[3 * node + k] = uniform[k] + 1e-5 * random.next());
        }
        let direction: Vec<f64> = (0..n).map(|_| random.next()).collect();
        let old = model.new_points();
        let mut force = InternalForce::new(&model);
        let at = |force: &mut InternalForce, step: f64| {
            let moved: Vec<f64> = w.iter().zip(&direction).map(|(w, d)| w + step * d).collect();
            assert!(force.evaluate(&model, &old, &moved).is_ok());
            force.force.clone()
        };
        let h = 1e-8;
        let (ahead, back) = (at(&mut force, h), at(&mut force, -h));
        at(&mut force, 0.0);
        assert!(force.plastic > 0, "{}", kind.name());
        let mut tangent = Tangent::new(&model);
        assert_eq!(tangent.symmetric(), material.symmetric_tangent());
        tangent.assemble(&model, &force, &old, &w, Combination::default(), false);
        let mut product = vec![0.0; n];
        tangent.times(&model, &direction, &mut product);
        let size = product.iter().fold(0.0, |m: f64, p| m.max(p.abs()));
        for d in 0..n {
            let difference = (ahead[d] - back[d]) / (2.0 * h);
            let miss = (product[d] - difference).abs() / size;
            assert!(miss < 1e-5, "{} dof {d}: {} {difference}", kind.name(), product[d]);
        }
        let mut equations = vec![0.0; model.free_dof_count()];
        let (supports, analysis) = (model.supports(), model.analysis().unwrap());
        let entries = analysis.pattern().1.len();
        let (mut lower, mut upper) = (vec![0.0; entries], vec![0.0; entries]);
        tangent.write(&model, &mut lower, &mut upper);
        if tangent.symmetric() {
            upper.copy_from_slice(&lower);
        }
        let mut free = vec![0.0; n];
        supports.free().iter().for_each(|d| free[*d as usize] = direction[*d as usize]);
        tangent.times(&model, &free, &mut product);
        let x: Vec<f64> = supports.free().iter().map(|d| direction[*d as usize]).collect();
        let (start, row) = analysis.pattern();
        for c in 0..x.len() {
            for k in start[c]..start[c + 1] {
                equations[row[k]] += lower[k] * x[c];
                if row[k] != c {
                    equations[c] += upper[k] * x[row[k]];
                }
            }
        }
        for (e, d) in equations.iter().zip(supports.free()) {
            assert!((e - product[*d as usize]).abs() < 1e-12 * size, "{}", kind.name());
        }
    }
}

#[test]
fn force_operator_is_strain_transpose() {
    for kind in ElementKind::ALL {
        let model = model(kind, SOIL.into(), AssumedStrain::default());
        let mut random = Random(5);
        let w: Vec<f64> = (0..model.dof_count()).map(|_| 1e-3 * random.next()).collect();
        let old = model.new_points();
        let mut force = InternalForce::new(&model);
        assert!(force.evaluate(&model, &old, &w).is_ok());
        let mut elastic = vec![0.0; w.len()];
        model.stiffness_times(&w, &mut elastic);
        let size = elastic.iter().fold(0.0, |m: f64, p| m.max(p.abs()));
        let other = crate::energy::force_of_points(&model, &force.points);
        for d in 0..w.len() {
            assert!((force.force[d] - elastic[d]).abs() < 1e-11 * size, "{}", kind.name());
            assert!((other[d] - elastic[d]).abs() < 1e-11 * size, "{}", kind.name());
        }
        let work: f64 = 0.5 * w.iter().zip(&elastic).map(|(w, f)| w * f).sum::<f64>();
        assert!(
            (crate::energy::of_points(&model, &force.points) / work - 1.0).abs() < 1e-11,
            "{}",
            kind.name()
        );
    }
}
