//! Cost of one update by region; run with `--ignored --nocapture`.

use super::*;
use std::time::Instant;

#[test]
#[ignore = "timing only, 2 s"]
fn nanoseconds_per_update() {
    let c = COHESION;
    let mc = Material::plastic(SOIL, mohr_coulomb(c, 30.0, 10.0, None));
    let cut = Material::plastic(SOIL, mohr_coulomb(c, 30.0, 10.0, Some(0.4 * c)));
    let dp = Material::plastic(SOIL, drucker_prager(c, 30.0, 10.0, Cone::Compression, None));
    let line = Hardening::Linear { initial: c, modulus: 100.0 * c, limit: None };
    let hard = Material::plastic(SOIL, MohrCoulomb { cohesion: line, ..mohr_coulomb(c, 30.0, 10.0, None) });
    let compressed = PointState { stress: [-8e4, -8e4, -8e4, 0.0, 0.0, 0.0], ..PointState::default() };
    let cases = [
        ("linear", &Material::from(SOIL), ReturnRegion::Elastic, [1e-4, 2e-4, -1e-4, 1e-4, 2e-4, 3e-4]),
        ("mc", &mc, ReturnRegion::Elastic, [1e-4, 2e-4, -1e-4, 1e-4, 2e-4, 3e-4]),
        ("mc near the surface", &mc, ReturnRegion::Elastic, [1.2e-3, 0.4e-3, -0.9e-3, 1e-5, 2e-4, 3e-4]),
        ("mc", &mc, ReturnRegion::Plane, [2e-3, 1e-4, -4e-3, 1e-3, 2e-3, 3e-3]),
        ("mc", &mc, ReturnRegion::EdgeCompression, [2.1e-3, 2e-3, -8e-3, 1e-4, 1e-4, 1e-4]),
        ("mc", &mc, ReturnRegion::EdgeExtension, [8e-3, -4.1e-3, -4e-3, 1e-4, 1e-4, 1e-4]),
        ("mc", &mc, ReturnRegion::Apex, [8e-3, 7e-3, 6e-3, 1e-4, 1e-4, 1e-4]),
        ("mc cut", &cut, ReturnRegion::TensionCorner, [8e-3, 7e-3, 6e-3, 1e-4, 1e-4, 1e-4]),
        ("mc hardening", &hard, ReturnRegion::Plane, [2e-3, 1e-4, -4e-3, 1e-3, 2e-3, 3e-3]),
        ("dp", &dp, ReturnRegion::Elastic, [1e-4, 2e-4, -1e-4, 1e-4, 2e-4, 3e-4]),
        ("dp", &dp, ReturnRegion::Cone, [2e-3, 1e-4, -4e-3, 1e-3, 2e-3, 3e-3]),
    ];
    for (name, material, region, strain) in cases {
        assert_eq!(step(material, &compressed, &strain).region, region, "{name}");
        let mut times = [f64::INFINITY; 2];
        for (time, want_tangent) in times.iter_mut().zip([false, true]) {
            for _ in 0..7 {
                let start = Instant::now();
                let count = 20_000;
                for k in 0..count {
                    let mut e = std::hint::black_box(strain);
                    e[0] += 1e-10 * f64::from(k);
                    std::hint::black_box(update(material, &compressed, &e, want_tangent).unwrap());
                }
                *time = time.min(start.elapsed().as_secs_f64() / f64::from(count) * 1e9);
            }
        }
        println!("{name} {region:?}: {:.0} ns, with tangent {:.0} ns", times[0], times[1]);
    }
}
