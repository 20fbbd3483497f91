//! Uplift and recovery of contact; interface consistency of the iterated scheme.

use crate::support::*;
use trackbed_coupling::scheme::Scheme;
use trackbed_coupling::step;
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_fem as fem;
use trackbed_fem::nonlinear::{NewtonOptions, Variant};
use trackbed_fem::theta::{NonlinearTheta, ThetaMethod};

const RADIUS: f64 = 0.05;

fn resting(solid: &fem::Model, substeps: u32, scheme: Scheme, restitution: f64) -> Coupled<'_> {
    let mut c = Coupled::new(
        solid,
        dem::ModelInput {
            materials: vec![material(2650.0, 1e5, 0.3, restitution)],
            shapes: vec![dem::Shape::Sphere { radius: RADIUS }],
            bodies: vec![dem::BodyInput { position: Vec3::new(0.47, 0.52, RADIUS), ..Default::default() }],
            surface_material: Some(0),
            time_step: dem::TimeStep::Fixed(4e-5),
            ..Default::default()
        },
        substeps,
    );
    c.model.scheme = scheme;
    c
}

fn soft() -> fem::Model {
    block(
        [2, 2, 1],
        [1.0, 1.0, 0.5],
        5e6,
        0.3,
        2000.0,
        Held::Base,
        fem::Rayleigh { alpha_m: 100.0, beta_k: 1e-3 },
    )
}

#[test]
fn iterated_windows_restore_plastic_stresses() {
    let law = fem::MohrCoulomb { cohesion: 500.0.into(), friction: 0.3.into(), dilation: 0.1, tension: None };
    let elastic = fem::Elastic { young: 5e6, poisson: 0.3, density: 2000.0 };
    let mut mesh = fem::Mesh::block([2, 2, 1], [1.0, 1.0, 0.5]);
    mesh.coordinates.iter_mut().for_each(|x| x[2] -= 0.5);
    let base = mesh.coordinates.iter().enumerate().filter(|(_, x)| x[2] < -0.49).map(|(n, _)| n as u32);
    let constraints = base
        .flat_map(|node| (0..3).map(move |direction| fem::Constraint { node, direction, value: 0.0 }))
        .collect();
    let solid = fem::Model::new(fem::ModelInput {
        mesh,
        materials: [(1, fem::Material::plastic(elastic, law))].into(),
        quadrature: fem::Quadrature::Gauss2,
        constraints,
        gravity: [0.0; 3],
        ..Default::default()
    })
    .unwrap();
    let newton = NewtonOptions { force_tolerance: 1e-9, ..NewtonOptions::new(Variant::Full) };
    let mut c = resting(&solid, 5, Scheme::Iterated { tolerance: 1e-8, passes: 20 }, 0.5);
    c.model.newton = newton;
    c.work = step::Work::new(&c.model, &c.state, top(&solid)).unwrap();
    let window = c.model.window();
    let mut alone = NonlinearTheta::new(&solid, c.model.theta, window, newton).unwrap();
    for k in 0..60 {
        let mut again = c.state.solid.clone();
        c.step(&[(0, [0.0, 0.0, -50.0 * f64::from(k)])]);
        alone.step(&solid, &mut again, c.work.load()).unwrap();
        let (now, largest) = (&c.state.solid, |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs())));
        let apart = now.u.iter().zip(&again.u).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(apart <= 1e-6 * largest(&now.u), "window {k}: {apart} of {}", largest(&now.u));
    }
    let plastic = step::work_and_dissipation(&c.state).plastic;
    println!("{:?}, {plastic} J plastic", c.state.passes);
    assert!(c.state.passes.passes > 2 * c.state.passes.windows && plastic > 1e-3);
}

#[test]
fn lifted_body_recovers_contact() {
    let solid = soft();
    let iterated = Scheme::Iterated { tolerance: 1e-8, passes: 20 };
    for scheme in [Scheme::Predicted, Scheme::Stiffened, iterated] {
        let mut c = resting(&solid, 5, scheme, 0.5);
        let weight = c.model.grains.mass(0) * 9.81;
        let window = c.model.window();
        let run = |c: &mut Coupled, time: f64, pull: f64| {
            let mut seen = (f64::INFINITY, 0.0_f64, 0);
            for _ in 0..(time / window).round() as usize {
                c.step(&[(0, [0.0, 0.0, pull])]);
                let force = -c.work.mean_contact_force(window)[2];
                seen = (seen.0.min(force), seen.1.max(force), seen.2 + i32::from(force == 0.0));
            }
            seen
        };
        run(&mut c, 0.4, 0.0);
        let rest = -c.work.mean_contact_force(window)[2];
        assert!((rest / weight - 1.0).abs() < 1e-3, "{scheme:?}: rests with {rest} N of {weight}");
        let (start, spent) =
            (step::stored_energy(&c.model, &c.state).total(), step::work_and_dissipation(&c.state));
        run(&mut c, 0.03, 3.0 * weight);
        let flying = run(&mut c, 0.06, 0.0);
        assert_eq!((flying.0, flying.1), (0.0, 0.0), "{scheme:?}: no force in flight");
        assert!(c.state.grains.position(0).z > RADIUS + 0.01);
        let landing = run(&mut c, 0.4, 0.0);
        assert!(landing.1 > 3.0 * weight, "{scheme:?}: lands with {} N", landing.1);
        let end = run(&mut c, 0.3, 0.0);
        let now = step::work_and_dissipation(&c.state);
        let work = now.work() - spent.work();
        let error = step::stored_energy(&c.model, &c.state).total() - start + now.dissipated()
            - spent.dissipated()
            - work;
        println!(
            "{scheme:?}: landing {:.1} weights, in the end {:.6} to {:.6}, account {:.1e} of the work, {:?}",
            landing.1 / weight,
            end.0 / weight,
            end.1 / weight,
            error / work,
            c.state.passes
        );
        assert!(error.abs() < 5e-3 * work);
        let last = -c.work.mean_contact_force(window)[2];
        assert!((last / weight - 1.0).abs() < 0.01);
    }
}

#[test]
fn iterated_windows_agree_on_the_interface() {
    let solid = soft();
    let mut errors = Vec::new();
    for scheme in [Scheme::Iterated { tolerance: 1e-8, passes: 30 }, Scheme::Predicted] {
        let mut c = resting(&solid, 20, scheme, 0.7);
        let mut body = c.state.grains.velocity(0);
        body.z = -1.0;
        c.state.grains.set_velocity(&c.model.grains, 0, body, Vec3::zeros());
        let kinetic = 0.5 * c.model.grains.mass(0);
        let start = step::stored_energy(&c.model, &c.state).total();
        for _ in 0..60 {
            c.step(&[]);
        }
        let spent = step::work_and_dissipation(&c.state);
        let error = (step::stored_energy(&c.model, &c.state).total() - start + spent.dissipated()
            - spent.work())
            / kinetic;
        let interface = spent.interface() / kinetic;
        println!("{scheme:?}: interface {interface:.1e}, account {error:.1e}, {:?}", c.state.passes);
        assert!(spent.dashpot > 0.1 * kinetic, "they met");
        assert_eq!(c.state.passes.unconverged, 0);
        errors.push((interface.abs(), error.abs()));
    }
    assert!(errors[0].0 < 1e-6 && errors[0].1 < 5e-3, "{errors:?}");
    assert!(errors[1].0 > 100.0 * errors[0].0, "{errors:?}");
}
