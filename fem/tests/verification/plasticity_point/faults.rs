//! Errors of invalid constants.

use super::*;

#[test]
fn faults_of_strength_constants() {
    let base = || mohr_coulomb(20e3, 30.0, 10.0, None);
    let constant = Hardening::Constant;
    let fault = |law: MohrCoulomb| Material::plastic(SOIL, law).invalid_constant().expect("a fault");
    assert_eq!(Material::plastic(SOIL, base()).invalid_constant(), None);
    assert_eq!(fault(MohrCoulomb { friction: constant(30.0), ..base() }).0, "friction angle");
    assert_eq!(fault(MohrCoulomb { friction: constant(rad(90.0)), ..base() }).0, "friction angle");
    assert_eq!(
        fault(MohrCoulomb { friction: constant(-0.1), ..base() }),
        ("friction angle", -0.1, "0 or above")
    );
    assert_eq!(fault(MohrCoulomb { friction: constant(f64::NAN), ..base() }).0, "friction angle");
    assert_eq!(fault(MohrCoulomb { dilation: rad(31.0), ..base() }).0, "dilation angle");
    assert_eq!(fault(MohrCoulomb { dilation: -1e-3, ..base() }).0, "dilation angle");
    assert_eq!(fault(MohrCoulomb { dilation: f64::NAN, ..base() }).0, "dilation angle");
    assert_eq!(fault(MohrCoulomb { cohesion: constant(-1.0), ..base() }), ("cohesion", -1.0, "0 or above"));
    assert_eq!(fault(mohr_coulomb(0.0, 0.0, 0.0, None)).0, "cohesion");
    assert_eq!(fault(MohrCoulomb { tension: Some(-1.0), ..base() }).0, "tension cut-off");
    assert_eq!(fault(MohrCoulomb { tension: Some(34.7e3), ..base() }).0, "tension cut-off");
    assert_eq!(
        Material::plastic(SOIL, MohrCoulomb { tension: Some(34.6e3), ..base() }).invalid_constant(),
        None
    );
    let falling = Hardening::Table(vec![(0.0, 2e4), (0.2, 1e4), (0.1, 5e3)]);
    assert_eq!(fault(MohrCoulomb { cohesion: falling, ..base() }).0, "cohesion");
    let angle = Hardening::Table(vec![(0.0, rad(30.0)), (0.1, rad(5.0))]);
    assert_eq!(fault(MohrCoulomb { friction: angle, ..base() }).0, "dilation angle");
    assert_eq!(
        Material::from(Elastic { young: -1.0, ..SOIL }).invalid_constant().unwrap().0,
        "Young's modulus"
    );
}

/// On the plane the limit is exact: `-n.D.m / (2 cos(phi) sqrt(2/3) |m|)`.
#[test]
fn softening_limit() {
    let soft = |slope: f64| Hardening::Linear { initial: 20e3, modulus: slope, limit: Some(1e3) };
    for tension in [None, Some(5e3)] {
        let base = mohr_coulomb(20e3, 30.0, 10.0, tension);
        let limit = base.softening_limit(&SOIL);
        let (lambda, mu) = SOIL.lame();
        let (phi, psi) = (rad(30.0), rad(10.0));
        let (n, m) = ([1.0 + phi.sin(), 0.0, phi.sin() - 1.0], [1.0 + psi.sin(), 0.0, psi.sin() - 1.0]);
        let (trace_n, trace_m) = (n[0] + n[2], m[0] + m[2]);
        let product = lambda * trace_n * trace_m + 2.0 * mu * (n[0] * m[0] + n[2] * m[2]);
        let size = (m[0] * m[0] + m[2] * m[2]).sqrt();
        let plane = -product / (2.0 * phi.cos() * (2.0_f64 / 3.0).sqrt() * size);
        println!("softening limit dc/dkappa = {limit:.4e} Pa (plane alone {plane:.4e})");
        assert!(limit >= plane * (1.0 + 1e-12) && limit < 0.1 * plane);
        let law = |slope| MohrCoulomb { cohesion: soft(slope), ..base.clone() };
        assert!(
            Material::plastic(SOIL, law(1.001 * limit)).invalid_constant().unwrap().2.contains("snaps back")
        );
        let material = Material::plastic(SOIL, law(0.98 * limit));
        assert_eq!(material.invalid_constant(), None);
        let mut random = Random(7);
        for _ in 0..3000 {
            step(&material, &PointState::default(), &random_strain(&mut random, 3e-3, 4e-3));
        }
    }
    for tension in [None, Some(5e3)] {
        let base = drucker_prager(20e3, 30.0, 10.0, Cone::Compression, tension);
        let limit = base.softening_limit(&SOIL);
        let law = |slope| DruckerPrager { cohesion: soft(slope), ..base.clone() };
        assert!(
            Material::plastic(SOIL, law(1.001 * limit)).invalid_constant().unwrap().2.contains("snaps back")
        );
        let material = Material::plastic(SOIL, law(0.98 * limit));
        assert_eq!(material.invalid_constant(), None);
        let mut random = Random(7);
        for _ in 0..3000 {
            step(&material, &PointState::default(), &random_strain(&mut random, 3e-3, 4e-3));
        }
    }
    // Beyond the plane's own limit the return reports it.
    let steep = MohrCoulomb { cohesion: soft(-5e8), ..mohr_coulomb(20e3, 30.0, 10.0, None) };
    let result = update(
        &Material::plastic(SOIL, steep),
        &PointState::default(),
        &[1e-3, 0.0, -1e-3, 0.0, 0.0, 0.0],
        false,
    );
    assert!(matches!(result, Err(trackbed_fem::ReturnError::Softening { .. })), "{result:?}");
}
