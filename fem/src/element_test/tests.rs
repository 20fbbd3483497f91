use super::checks::Increment;
use super::*;
use crate::material::{
    Cone, Consolidation, DruckerPrager, Elastic, Hardening, ModifiedCamClay, MohrCoulomb, Point, PointState,
    Shear,
};

const SOIL: Elastic = Elastic { young: 80e6, poisson: 0.3, density: 1950.0 };
const CELL: f64 = 100e3;
const COHESION: f64 = 25e3;
const PHI: f64 = 0.5;
const PSI: f64 = 0.1;

const TRIAXIAL: [Control; 6] = {
    let mut controls = [Control::Strain; 6];
    controls[0] = Control::Stress;
    controls[1] = Control::Stress;
    controls
};

fn triaxial(strain: f64, steps: usize) -> Segment {
    Segment { controls: TRIAXIAL, target: [-CELL, -CELL, -strain, 0.0, 0.0, 0.0], steps }
}

fn strains(target: [f64; 6], steps: usize) -> Segment {
    Segment { controls: [Control::Strain; 6], target, steps }
}

fn test(material: &Material, cell: f64, segment: Segment) -> Curve {
    let curve = run(material, &[-cell, -cell, -cell, 0.0, 0.0, 0.0], &[segment]).unwrap();
    let Checks { tangent, negative_work, objectivity, .. } = &curve.checks;
    println!("{tangent:?} work {negative_work:?} objectivity {objectivity:?}");
    assert!(tangent.largest < TANGENT_LIMIT && tangent.compared > 5 * tangent.skipped);
    assert!(negative_work.unwrap() < WORK_LIMIT && objectivity.unwrap() < OBJECTIVITY_LIMIT);
    curve
}

fn last(curve: &Curve) -> &Sample {
    curve.samples.last().unwrap()
}

fn q(sample: &Sample) -> f64 {
    let s = sample.state.stress;
    0.5 * (s[0] + s[1]) - s[2]
}

/// Volumetric over axial strain increment of the last step.
fn dilation(curve: &Curve) -> f64 {
    let [before, end] = curve.samples.last_chunk().unwrap();
    let change: [f64; 3] = std::array::from_fn(|k| end.strain[k] - before.strain[k]);
    change.iter().sum::<f64>() / change[2]
}

#[track_caller]
fn near(name: &str, found: f64, expected: f64, tolerance: f64) {
    println!("{name}: {found} of {expected}, {:.1e}", found / expected - 1.0);
    assert!((found / expected - 1.0).abs() < tolerance, "{name}: {found}, expected {expected}");
}

fn coulomb(phi: f64, psi: f64) -> Material {
    let law = MohrCoulomb { cohesion: COHESION.into(), friction: phi.into(), dilation: psi, tension: None };
    Material::plastic(SOIL, law)
}

fn cone(cone: Cone) -> Material {
    let (cohesion, friction) = (COHESION.into(), PHI.into());
    Material::plastic(SOIL, DruckerPrager { cohesion, friction, dilation: PSI, cone, tension: None })
}

/// `2 sin φ/(1 − sin φ) (σ₃ + c cot φ)`.
fn coulomb_strength() -> f64 {
    2.0 * PHI.sin() / (1.0 - PHI.sin()) * (CELL + COHESION / PHI.tan())
}

#[test]
fn elastic_triaxial_has_young_and_poisson() {
    let curve = test(&SOIL.into(), CELL, triaxial(1e-3, 10));
    let end = last(&curve);
    near("E", q(end) / -end.strain[2], SOIL.young, 1e-12);
    near("nu", -end.strain[0] / end.strain[2], SOIL.poisson, 1e-12);
    assert_eq!((curve.checks.plastic, end.plastic_work), (0, 0.0));
}

#[test]
fn elastic_oedometer_has_constrained_modulus() {
    let end = test(&SOIL.into(), 0.0, strains([0.0, 0.0, -1e-3, 0.0, 0.0, 0.0], 10));
    let nu = SOIL.poisson;
    let modulus = SOIL.young * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
    near("M", last(&end).state.stress[2] / -1e-3, modulus, 1e-12);
}

#[test]
fn coulomb_triaxial_has_strength_and_dilation() {
    let curve = test(&coulomb(PHI, PSI), CELL, triaxial(0.05, 200));
    near("q", q(last(&curve)), coulomb_strength(), 1e-8);
    near("dilation", dilation(&curve), -2.0 * PSI.sin() / (1.0 - PSI.sin()), 1e-8);
    assert!(last(&curve).plastic_work > 0.0 && curve.checks.plastic > 150);
}

#[test]
fn large_steps_reach_the_same_strength() {
    for steps in [1, 3] {
        near("q", q(last(&test(&coulomb(PHI, PSI), CELL, triaxial(0.2, steps)))), coulomb_strength(), 1e-8);
    }
}

#[test]
fn drucker_prager_triaxial_has_strength_and_dilation() {
    let outer = test(&cone(Cone::Compression), CELL, triaxial(0.05, 200));
    near("outer cone q", q(last(&outer)), coulomb_strength(), 1e-8);
    let plane = test(&cone(Cone::PlaneStrain), CELL, triaxial(0.05, 200));
    let [eta, xi, ..] = Cone::PlaneStrain.coefficients(PHI);
    let flow = Cone::PlaneStrain.coefficients(PSI)[0];
    let root = 1.0 / 3.0_f64.sqrt();
    near("q", q(last(&plane)), (xi * COHESION + eta * CELL) / (root - eta / 3.0), 1e-8);
    near("dilation", dilation(&plane), -flow / (root - flow / 3.0), 1e-8);
}

#[test]
fn undrained_tresca_has_twice_the_cohesion() {
    let curve = test(&coulomb(0.0, 0.0), CELL, strains([0.01, 0.01, -0.02, 0.0, 0.0, 0.0], 100));
    near("q", q(last(&curve)), 2.0 * COHESION, 1e-8);
}

#[test]
fn von_mises_simple_shear_has_shear_strength() {
    let metal = Material::plastic(SOIL, DruckerPrager::von_mises(50e3));
    let mut controls = [Control::Strain; 6];
    controls[2] = Control::Stress;
    let segment = Segment { controls, target: [0.0, 0.0, -CELL, 0.0, 0.0, -0.02], steps: 100 };
    let curve = test(&metal, CELL, segment);
    near("tau", -last(&curve).state.stress[5], 50e3 / 3.0_f64.sqrt(), 1e-8);
    near("sigma", -last(&curve).state.stress[2], CELL, 1e-10);
}

fn clay() -> Material {
    let law = ModifiedCamClay {
        lambda: 0.093,
        kappa: 0.035,
        critical_ratio: 0.95,
        void_ratio: 0.6,
        shear: Shear::Poisson(0.3),
        consolidation: Consolidation::Ratio(1.0),
        minimum_pressure: 1e3,
    };
    Material::plastic(law.reference(2000.0), law)
}

#[test]
fn cam_clay_reaches_critical_state() {
    let pressure = |s: &Sample| -(s.state.stress[0] + s.state.stress[1] + s.state.stress[2]) / 3.0;
    let drained = test(&clay(), CELL, triaxial(1.0, 500));
    near("drained q/p", q(last(&drained)) / pressure(last(&drained)), 0.95, 1e-6);
    near("drained q", q(last(&drained)), 3.0 * 0.95 * CELL / (3.0 - 0.95), 1e-6);
    let undrained = test(&clay(), CELL, strains([0.25, 0.25, -0.5, 0.0, 0.0, 0.0], 1000));
    near("undrained q/p", q(last(&undrained)) / pressure(last(&undrained)), 0.95, 1e-6);
    // p = p0 2^-(1 - kappa/lambda) at constant volume.
    let p = CELL * libm::pow(2.0, -(1.0 - 0.035 / 0.093));
    near("undrained p", pressure(last(&undrained)), p, 1e-8);
}

#[test]
fn softening_falls_to_the_limit() {
    let cohesion = Hardening::Linear { initial: COHESION, modulus: -0.5e6, limit: Some(5e3) };
    let law = MohrCoulomb { cohesion, friction: PHI.into(), dilation: PSI, tension: None };
    let curve = test(&Material::plastic(SOIL, law), CELL, triaxial(0.1, 400));
    let residual = 2.0 * PHI.sin() / (1.0 - PHI.sin()) * (CELL + 5e3 / PHI.tan());
    near("residual q", q(last(&curve)), residual, 1e-8);
    let peak = curve.samples.iter().map(q).fold(0.0, f64::max);
    assert!(peak > 0.95 * coulomb_strength() && peak <= coulomb_strength());
}

#[test]
fn load_above_strength_fails_with_residual() {
    let mut controls = TRIAXIAL;
    controls[2] = Control::Stress;
    let axial = CELL + 1.1 * coulomb_strength();
    let segment = Segment { controls, target: [-CELL, -CELL, -axial, 0.0, 0.0, 0.0], steps: 10 };
    let failure = run(&coulomb(PHI, PSI), &[-CELL, -CELL, -CELL, 0.0, 0.0, 0.0], &[segment]).unwrap_err();
    println!("{failure}");
    assert!(failure.step == 10 && failure.residual > TOLERANCE && failure.residual.is_finite());
    let text = failure.to_string();
    assert!(text.starts_with("step 10 not converged: residual ") && !text.contains("NaN"), "{text}");
}

#[test]
fn initial_state_is_compared_with_the_yield_surface() {
    let at = |p: f64| [-p, -p, -p, 0.0, 0.0, 0.0];
    assert!(initial_excess(&coulomb(PHI, PSI), &at(CELL)) < 0.0);
    let law = ModifiedCamClay {
        consolidation: Consolidation::Pressure(50e3),
        ..match clay().law {
            crate::Law::ModifiedCamClay(law) => law,
            _ => unreachable!(),
        }
    };
    assert!(initial_excess(&Material::plastic(law.reference(2000.0), law), &at(CELL)) > 0.1);
    assert!(initial_excess(&clay(), &at(CELL)).abs() < 1e-12);
}

/// The checks detect a wrong tangent, negative work and a stress that does not rotate.
#[test]
fn checks_detect_wrong_responses() {
    let soil = coulomb(PHI, PSI);
    let state = PointState { stress: [-CELL, -CELL, -CELL, 0.0, 0.0, 0.0], ..PointState::default() };
    let increment = [4e-3, 3e-3, -8e-3, 3e-4, 0.0, 0.0];
    let old = Point::new(&state, &[]);
    let right = soil.law.update(&soil.elastic, old, &increment, true, &mut []).unwrap();
    assert!(right.region.is_plastic());
    let checks = |change: fn(&mut crate::Response)| {
        let (mut response, mut checks) = (right, Checks::new(&soil));
        change(&mut response);
        checks.add(&Increment { step: 1, old, increment: &increment, response: &response });
        checks
    };
    let good = checks(|_| ());
    assert!(good.tangent.largest < TANGENT_LIMIT && good.negative_work == Some(0.0));
    assert!(good.objectivity.unwrap() < OBJECTIVITY_LIMIT && good.plastic == 1);
    assert!(checks(|r| r.tangent[0][1] *= 1.001).tangent.largest > TANGENT_LIMIT);
    let reversed = checks(|r| r.state.plastic_strain = r.state.plastic_strain.map(|x| -x));
    assert!(reversed.negative_work.unwrap() > WORK_LIMIT);
    assert!(checks(|r| r.state.stress[3] += 1.0).objectivity.unwrap() > OBJECTIVITY_LIMIT);
}
