//! Modified Cam clay at a point, against closed forms of triaxial compression.
//!
//! `eta = q/p`, `Lambda = (lambda - kappa)/lambda`, `R` the overconsolidation ratio, `v = 1 + e0`:
//!
//! Wood, Soil Behaviour and Critical State Soil Mechanics (1990), chapters 4 and 5. Pressures and volumes are
//! exact: 1e-9. Shear strain is first order in the step: 0.5 %.

use trackbed_fem::material::{Consolidation, ModifiedCamClay, Shear};
use trackbed_fem::{Material, Point, PointState};

const P0: f64 = 207e3;
/// Weald clay: Schofield and Wroth, Critical State Soil Mechanics (1968), table of chapter 6.
const CLAY: ModifiedCamClay = ModifiedCamClay {
    lambda: 0.093,
    kappa: 0.035,
    critical_ratio: 0.95,
    void_ratio: 0.60,
    shear: Shear::Poisson(0.3),
    consolidation: Consolidation::Ratio(1.0),
    minimum_pressure: 1e3,
};
const M: f64 = CLAY.critical_ratio;
const V: f64 = 1.0 + CLAY.void_ratio;
/// `G / K` at Poisson's ratio 0.3.
const SHEAR_RATIO: f64 = 1.5 * 0.4 / 1.3;
const LAMBDA: f64 = (CLAY.lambda - CLAY.kappa) / CLAY.lambda;

struct Sample {
    material: Material,
    state: PointState,
    pc: f64,
    /// Axial and radial strain, positive in compression.
    strain: [f64; 2],
}

impl Sample {
    fn new(ratio: f64) -> Sample {
        let law = ModifiedCamClay { consolidation: Consolidation::Ratio(ratio), ..CLAY };
        let state = PointState { stress: [-P0, -P0, -P0, 0.0, 0.0, 0.0], ..PointState::default() };
        let material = Material::plastic(law.reference(1900.0), law);
        let mut pc = [0.0];
        material.law.initial_values(&material.elastic, &state.stress, &mut pc);
        Sample { material, state, pc: pc[0], strain: [0.0; 2] }
    }

    fn step(&mut self, axial: f64, radial: f64) {
        let (response, pc) = self.trial(axial, radial);
        (self.state, self.pc) = (response.state, pc);
        self.strain = [self.strain[0] + axial, self.strain[1] + radial];
    }

    fn trial(&self, axial: f64, radial: f64) -> (trackbed_fem::Response, f64) {
        let (values, mut pc) = ([self.pc], [0.0]);
        let old = Point::new(&self.state, &values);
        let increment = [-radial, -radial, -axial, 0.0, 0.0, 0.0];
        let (law, elastic) = (&self.material.law, &self.material.elastic);
        (law.update(elastic, old, &increment, true, &mut pc).unwrap(), pc[0])
    }

    /// Axial compression at constant radial stress.
    fn drained(&mut self, axial: f64) {
        let mut radial = 0.0;
        for _ in 0..50 {
            let (response, _) = self.trial(axial, radial);
            let miss = -response.state.stress[0] - P0;
            if miss.abs() < 1e-9 * P0 {
                break;
            }
            radial -= miss / (response.tangent[0][0] + response.tangent[0][1]);
        }
        self.step(axial, radial);
    }

    fn p(&self) -> f64 {
        -(self.state.stress[0] + self.state.stress[1] + self.state.stress[2]) / 3.0
    }

    fn eta(&self) -> f64 {
        (self.state.stress[0] - self.state.stress[2]) / self.p()
    }

    fn volume(&self) -> f64 {
        self.strain[0] + 2.0 * self.strain[1]
    }

    fn shear(&self) -> f64 {
        2.0 / 3.0 * (self.strain[0] - self.strain[1])
    }
}

/// Undrained shear strain of normally consolidated clay.
fn undrained_shear(eta: f64) -> f64 {
    let elastic = CLAY.kappa / (3.0 * SHEAR_RATIO * V);
    let turn = (eta / M).atan();
    let plastic = CLAY.kappa * LAMBDA / V / M * (((M + eta) / (M - eta)).ln() - 2.0 * turn);
    plastic + elastic * (eta - 2.0 * LAMBDA * (eta - M * turn))
}

/// Drained shear strain of normally consolidated clay.
fn drained_shear(eta: f64, p: f64) -> f64 {
    let at = |eta: f64| {
        let by_pressure =
            -(M - eta).ln() / (3.0 - M) - (M + eta).ln() / (3.0 + M) - 6.0 / (M * M - 9.0) * (3.0 - eta).ln();
        by_pressure + (((M + eta) / (M - eta)).ln() - 2.0 * (eta / M).atan()) / M
    };
    (CLAY.lambda - CLAY.kappa) / V * (at(eta) - at(0.0)) + CLAY.kappa / (SHEAR_RATIO * V) * (p / P0).ln()
}

#[test]
fn undrained_stress_path_matches_closed_form() {
    for ratio in [1.0_f64, 1.5, 3.0, 8.0] {
        let mut sample = Sample::new(ratio);
        for _ in 0..400 {
            sample.step(5e-4, -2.5e-4);
            let eta = sample.eta();
            let yields = M * (ratio - 1.0).sqrt();
            let expected = if eta < yields && sample.state.kappa == 0.0 {
                1.0
            } else {
                (ratio * M * M / (M * M + eta * eta)).powf(LAMBDA)
            };
            let miss = sample.p() / P0 / expected - 1.0;
            assert!(miss.abs() < 1e-9, "R = {ratio}, eta = {eta}: {miss:e}");
        }
        // Critical state: M, and p0 (R/2)^Lambda, approached exponentially.
        let end = P0 * (0.5 * ratio).powf(LAMBDA);
        assert!(
            (sample.eta() / M - 1.0).abs() < 1e-3 && (sample.p() / end - 1.0).abs() < 1e-3,
            "R = {ratio}"
        );
    }
}

#[test]
fn undrained_shear_strain_converges() {
    let miss = |steps: usize| {
        let mut sample = Sample::new(1.0);
        let part = 0.02 / steps as f64;
        (0..steps).for_each(|_| sample.step(part, -0.5 * part));
        undrained_shear(sample.eta()) / sample.shear() - 1.0
    };
    let (coarse, fine) = (miss(500), miss(1000));
    assert!(fine.abs() < 5e-3, "{fine:e}");
    let order = (coarse / fine).log2();
    assert!((order - 1.0).abs() < 0.1, "order {order}");
}

#[test]
fn drained_volumetric_strain_matches_closed_form() {
    let mut sample = Sample::new(1.0);
    for _ in 0..400 {
        sample.drained(1e-3);
        let (p, eta) = (sample.p(), sample.eta());
        assert!((eta / (3.0 * (1.0 - P0 / p)) - 1.0).abs() < 1e-6, "the path is q = 3 (p - p0)");
        let pc = p * (1.0 + eta * eta / (M * M));
        let expected = CLAY.kappa / V * (p / P0).ln() + (CLAY.lambda - CLAY.kappa) / V * (pc / P0).ln();
        let miss = sample.volume() / expected - 1.0;
        assert!(miss.abs() < 1e-7, "eta = {eta}: {miss:e}");
        assert!((sample.pc / pc - 1.0).abs() < 1e-9);
    }
    // Critical state: p = 3 p0 / (3 - M).
    assert!((sample.p() * (3.0 - M) / (3.0 * P0) - 1.0).abs() < 0.02, "p = {}", sample.p());
}

#[test]
fn drained_shear_strain_converges() {
    let miss = |steps: usize| {
        let mut sample = Sample::new(1.0);
        (0..steps).for_each(|_| sample.drained(0.08 / steps as f64));
        drained_shear(sample.eta(), sample.p()) / sample.shear() - 1.0
    };
    let (coarse, fine) = (miss(400), miss(800));
    assert!(fine.abs() < 5e-3, "{fine:e}");
    let order = (coarse / fine).log2();
    assert!((order - 1.0).abs() < 0.1, "order {order}");
}

/// Normal compression line, then swelling line.
#[test]
fn isotropic_compression_follows_both_lines() {
    let mut sample = Sample::new(1.0);
    for (part, slope, end) in [(1e-3, CLAY.lambda, 2.0_f64), (-1e-3, CLAY.kappa, 0.5)] {
        let (p, volume) = (sample.p(), sample.volume());
        let strain = slope / V * end.ln();
        let steps = (strain / (3.0 * part)).round();
        (0..steps as usize).for_each(|_| sample.step(strain / (3.0 * steps), strain / (3.0 * steps)));
        assert!((sample.p() / p / end - 1.0).abs() < 1e-9, "{}", sample.p() / p);
        assert!((sample.volume() - volume - strain).abs() < 1e-12);
    }
}

#[test]
fn extreme_strains_return() {
    for start in [0.0, 1e2, 1e5] {
        for e in [1e-8, 1e-4, 1e-2, 0.1] {
            for direction in [[1.0, 1.0, 1.0], [-1.0, -1.0, -1.0], [-1.0, 0.5, 0.5], [1.0, 0.0, 0.3]] {
                let mut sample = Sample::new(1.5);
                sample.state.stress = [-start, -start, -start, 0.0, 0.0, 0.0];
                let mut pc = [0.0];
                sample.material.law.initial_values(&sample.material.elastic, &sample.state.stress, &mut pc);
                let old = Point::new(&sample.state, &pc);
                let increment: [f64; 6] =
                    std::array::from_fn(|k| if k < 3 { e * direction[k] } else { 0.4 * e });
                let mut new = [0.0];
                let (law, elastic) = (&sample.material.law, &sample.material.elastic);
                let response = law.update(elastic, old, &increment, true, &mut new);
                let response = response.unwrap_or_else(|e| panic!("start {start}, {e} {increment:?}"));
                let f = law.yield_function(Point::new(&response.state, &new));
                let size = new[0].max(start);
                assert!(f <= 1e-9 * size && new[0] > 0.0, "start {start}, {e} {direction:?}: {f:e}");
            }
        }
    }
}

#[test]
fn equivalent_strain_of_isotropic_compression() {
    let mut sample = Sample::new(1.0);
    (0..20).for_each(|_| sample.step(1e-3, 1e-3));
    let volume = (CLAY.lambda - CLAY.kappa) / V * (sample.p() / P0).ln();
    let exact = 2.0_f64.sqrt() / 3.0 * volume;
    assert!((sample.state.kappa / exact - 1.0).abs() < 1e-9, "{} against {exact}", sample.state.kappa);
}

/// pc = R (p + q²/(M² p)).
#[test]
fn overconsolidation_includes_initial_shear() {
    let (p, q) = (100e3, 60e3);
    // Triaxial compression along z.
    let stress = [-(p - q / 3.0), -(p - q / 3.0), -(p + 2.0 * q / 3.0), 0.0, 0.0, 0.0];
    for ratio in [1.0, 2.5] {
        let mut pc = [0.0];
        {
            let material = Sample::new(ratio).material;
            material.law.initial_values(&material.elastic, &stress, &mut pc);
        }
        let exact = ratio * (p + q * q / (M * M * p));
        assert!((pc[0] / exact - 1.0).abs() < 1e-12, "{} against {exact}", pc[0]);
    }
}

#[test]
fn small_preconsolidation_pressure_is_kept() {
    let law = ModifiedCamClay { consolidation: Consolidation::Pressure(400.0), ..CLAY };
    let material = Material::plastic(law.reference(1900.0), law);
    let state = PointState { stress: [-399.0, -399.0, -399.0, 0.0, 0.0, 0.0], ..PointState::default() };
    let mut pc = [0.0];
    let old = Point::new(&state, &[400.0]);
    let (part, slope) = (2e-4, (CLAY.lambda - CLAY.kappa) / V);
    let r =
        material.law.update(&material.elastic, old, &[-part, -part, -part, 0.0, 0.0, 0.0], false, &mut pc);
    let r = r.unwrap().state;
    let plastic = -(r.plastic_strain[0] + r.plastic_strain[1] + r.plastic_strain[2]);
    assert!(plastic > 0.0 && pc[0] < law.minimum_pressure, "{plastic} {}", pc[0]);
    assert!((pc[0] / (400.0 * (plastic / slope).exp()) - 1.0).abs() < 1e-9, "{}", pc[0]);
}

#[test]
fn strength_reduction_divides_friction_tangent() {
    use trackbed_fem::ConstitutiveLaw;
    let tangent = |m: f64| (3.0 * m / (6.0 + m)).asin().tan();
    for factor in [1.0, 1.3, 2.0] {
        let reduced = CLAY.with_strength_divided_by(factor).critical_ratio;
        assert!((tangent(reduced) * factor / tangent(M) - 1.0).abs() < 1e-12, "{factor}: {reduced}");
    }
}
