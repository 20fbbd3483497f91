//! Closed forms: uniaxial hardening, plane-strain cone, simple shear, strength reduction.

use super::*;

/// Linear hardening `sigma_y = Y + H kappa`: `kappa` is the plastic axial strain, slope `E H / (E + H)`
/// (Hill, The Mathematical Theory of Plasticity, 1950, section 2.3).
#[test]
fn uniaxial_hardening_slope() {
    let (yield_stress, modulus) = (40e3, 8e6);
    let cohesion = Hardening::Linear { initial: 0.5 * yield_stress, modulus: 0.5 * modulus, limit: None };
    let mises = DruckerPrager { cohesion: cohesion.clone(), ..DruckerPrager::von_mises(yield_stress) };
    let tresca = MohrCoulomb { cohesion, ..MohrCoulomb::tresca(yield_stress) };
    let slope = SOIL.young * modulus / (SOIL.young + modulus);
    for material in [Material::plastic(SOIL, mises), Material::plastic(SOIL, tresca)] {
        for sign in [1.0, -1.0] {
            let mut state = PointState::default();
            let mut total = 0.0;
            for _ in 0..30 {
                let guess = [sign * 1e-4, -sign * 3e-5, -sign * 3e-5];
                let (response, ..) = mixed_step(&material, &state, guess, [None, Some(0.0), Some(0.0)], 1e-8);
                state = response.state;
                total += 1e-4;
                let yield_strain = yield_stress / SOIL.young;
                let want = if total <= yield_strain {
                    SOIL.young * total
                } else {
                    yield_stress + slope * (total - yield_strain)
                };
                assert!((state.stress[0] - sign * want).abs() <= 1e-9 * want, "{} {want}", state.stress[0]);
            }
            let plastic = total - state.stress[0].abs() / SOIL.young;
            assert!((state.kappa - plastic).abs() < 1e-11 && state.plastic_strain[0] * sign > 1e-3);
        }
    }
}

/// Tresca yields at c, von Mises at `Y / sqrt(3)`, the plane-strain cone at `c cos(phi) - p sin(phi)` as
/// Mohr–Coulomb (Chen and Mizuno, Nonlinear Analysis in Soil Mechanics, 1990).
#[test]
fn shear_and_meridian_strengths_match_theory() {
    let c = COHESION;
    let shear = [0.0, 0.0, 0.0, 5e-3, 0.0, 0.0];
    let tresca = step(&Material::plastic(SOIL, MohrCoulomb::tresca(2.0 * c)), &PointState::default(), &shear);
    assert!((tresca.state.stress[3] - c).abs() < 1e-9 * c);
    let mises =
        step(&Material::plastic(SOIL, DruckerPrager::von_mises(2.0 * c)), &PointState::default(), &shear);
    assert!((mises.state.stress[3] - 2.0 * c / 3.0_f64.sqrt()).abs() < 1e-9 * c);

    // Until the elastic strain is constant.
    let law = drucker_prager(c, 30.0, 30.0, Cone::PlaneStrain, None);
    let material = Material::plastic(SOIL, law);
    let mut state = PointState { stress: [-1e5, -1e5, -1e5, 0.0, 0.0, 0.0], ..PointState::default() };
    for _ in 0..400 {
        // Constant sy, no out-of-plane strain.
        let guess = [0.0, 1e-4, 0.0];
        let (response, ..) = mixed_step_shear(&material, &state, guess, 1e-4);
        state = response.state;
    }
    let s = state.stress;
    let (mean, radius) = ((s[0] + s[1]) / 2.0, ((s[0] - s[1]).powi(2) / 4.0 + s[3] * s[3]).sqrt());
    let want = c * rad(30.0).cos() - mean * rad(30.0).sin();
    println!("plane-strain cone: radius {radius:.6e}, Mohr-Coulomb {want:.6e}");
    assert!((radius - want).abs() <= 1e-7 * want);

    let angle = rad(25.0);
    let (sin, cos) = angle.sin_cos();
    let k = (1.0 + sin) / (1.0 - sin);
    let (lateral, strength) = (-50e3, 2.0 * c * k.sqrt());
    for (cone, s) in [
        (Cone::Compression, [lateral, lateral, k * lateral - strength]),
        (Cone::Extension, [lateral, k * lateral - strength, k * lateral - strength]),
    ] {
        let [eta, xi, ..] = cone.coefficients(angle);
        let p = (s[0] + s[1] + s[2]) / 3.0;
        let q = (s.iter().map(|s| (s - p) * (s - p)).sum::<f64>() / 2.0).sqrt();
        assert!((q + eta * p - xi * c).abs() < 1e-9 * c && cos > 0.0);
    }
    for cone in [Cone::Compression, Cone::Extension, Cone::PlaneStrain] {
        let [_, _, eta_slope, xi_slope] = cone.coefficients(angle);
        let (up, down) = (cone.coefficients(angle + 1e-5), cone.coefficients(angle - 1e-5));
        assert!(((up[0] - down[0]) / 2e-5 - eta_slope).abs() < 1e-8);
        assert!(((up[1] - down[1]) / 2e-5 - xi_slope).abs() < 1e-8);
        let apex = cone.coefficients(angle)[1] / cone.coefficients(angle)[0];
        assert!((apex - cos / sin).abs() < 1e-12);
    }
}

/// Simple shear in plane strain, sx and sy at -100 kPa.
fn mixed_step_shear(
    material: &Material,
    old: &PointState,
    mut e: [f64; 3],
    gamma: f64,
) -> (Response, [f64; 3], usize) {
    for iteration in 0..60 {
        let mut response = step(material, old, &[e[0], e[1], 0.0, gamma, 0.0, 0.0]);
        let r = [-1e5 - response.state.stress[0], -1e5 - response.state.stress[1]];
        if largest(&r) < 1e-6 {
            return (response, e, iteration);
        }
        regularise(&mut response.tangent, &material.elastic, 1e-6);
        let t = &response.tangent;
        let determinant = t[0][0] * t[1][1] - t[0][1] * t[1][0];
        e[0] += (t[1][1] * r[0] - t[0][1] * r[1]) / determinant;
        e[1] += (t[0][0] * r[1] - t[1][0] * r[0]) / determinant;
    }
    panic!("no convergence");
}

/// Isotropic extension ends at `c cot(phi)`.
#[test]
fn isotropic_extension_ends_at_the_apex() {
    let apex = 34641.016151377546;
    let mc = Material::plastic(SOIL, mohr_coulomb(COHESION, 30.0, 10.0, None));
    for material in [
        mc,
        Material::plastic(SOIL, drucker_prager(COHESION, 30.0, 10.0, Cone::Compression, None)),
        Material::plastic(SOIL, drucker_prager(COHESION, 30.0, 10.0, Cone::Extension, None)),
        Material::plastic(SOIL, drucker_prager(COHESION, 30.0, 10.0, Cone::PlaneStrain, None)),
    ] {
        let response = step(&material, &PointState::default(), &[2e-3, 2e-3, 2e-3, 0.0, 0.0, 0.0]);
        let s = response.state.stress;
        assert!((0..3).all(|k| (s[k] - apex).abs() < 1e-10 * apex) && largest(&s[3..]) < 1e-9 * apex);
        let volume = 6e-3 - apex / (SOIL.young / (3.0 * (1.0 - 2.0 * SOIL.poisson)));
        assert!((response.state.plastic_strain[..3].iter().sum::<f64>() - volume).abs() < 1e-15);
        assert!((response.state.kappa - 2.0_f64.sqrt() / 3.0 * volume).abs() < 1e-15);
    }
}

/// Softening moves the apex, `0.1 c cot(phi)`, below the cut-off of `0.4 c`.
#[test]
fn softened_apex_replaces_cut_off() {
    let c = COHESION;
    let soft = Hardening::Linear { initial: c, modulus: -20.0 * c, limit: Some(0.1 * c) };
    let mc = mohr_coulomb(c, 30.0, 10.0, Some(0.4 * c));
    let dp = drucker_prager(c, 30.0, 10.0, Cone::Compression, Some(0.4 * c));
    for (material, before, after) in [
        (
            Material::plastic(SOIL, MohrCoulomb { cohesion: soft.clone(), ..mc }),
            ReturnRegion::TensionCorner,
            ReturnRegion::Apex,
        ),
        (
            Material::plastic(SOIL, DruckerPrager { cohesion: soft, ..dp }),
            ReturnRegion::Cap,
            ReturnRegion::ConeApex,
        ),
    ] {
        assert_eq!(material.invalid_constant(), None);
        let mut state = PointState::default();
        let mut seen = Vec::new();
        for _ in 0..200 {
            let response = step(&material, &state, &[4e-4, 4e-4, 4e-4, 0.0, 0.0, 0.0]);
            state = response.state;
            if seen.last() != Some(&response.region) {
                seen.push(response.region);
            }
            let apex = (c - 20.0 * c * state.kappa).max(0.1 * c) / rad(30.0).tan();
            let want = apex.min(0.4 * c);
            assert!((0..3).all(|k| (state.stress[k] - want).abs() <= 1e-9 * c), "{:?} {want}", state.stress);
        }
        assert_eq!(seen, [before, after]);
    }
}

/// Reduced soil: `c/F` and `atan(tan(phi)/F)`.
#[test]
fn strength_reduction() {
    let factor = 1.4;
    let law = MohrCoulomb {
        cohesion: Hardening::Linear { initial: 20e3, modulus: 1e6, limit: Some(30e3) },
        friction: Hardening::Table(vec![(0.0, rad(30.0)), (0.1, rad(35.0))]),
        dilation: rad(25.0),
        tension: Some(10e3),
    };
    let trackbed_fem::Law::MohrCoulomb(reduced) =
        Material::plastic(SOIL, law.clone()).with_strength_divided_by(factor).law
    else {
        panic!("same law")
    };
    for kappa in [0.0, 0.005, 0.5] {
        assert!((reduced.cohesion.at(kappa).0 - law.cohesion.at(kappa).0 / factor).abs() < 1e-9);
    }
    let phi = |degrees: f64| (rad(degrees).tan() / factor).atan();
    assert_eq!(reduced.friction.at(0.0).0, phi(30.0));
    assert_eq!(reduced.friction.at(0.2).0, phi(35.0));
    assert_eq!((reduced.dilation, reduced.tension), (phi(30.0), Some(10e3 / factor)));
    assert!(Material::plastic(SOIL, reduced).invalid_constant().is_none());
    // psi below the reduced phi is kept.
    let kept = Material::plastic(SOIL, drucker_prager(1e4, 30.0, 5.0, Cone::Compression, None))
        .with_strength_divided_by(2.0);
    let trackbed_fem::Law::DruckerPrager(kept) = kept.law else { panic!("same law") };
    assert_eq!((kept.dilation, kept.cohesion), (rad(5.0), Hardening::Constant(5e3)));
    assert_eq!(Material::from(SOIL).with_strength_divided_by(2.0), Material::from(SOIL));
}
