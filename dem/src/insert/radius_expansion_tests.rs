use super::*;
use crate::insert::closed::ClosedSurface;
use crate::insert::random_placement::scatter;
use crate::insert::sizes::SizeLaw;
use crate::measure::{BoxRegion, porosity};
use crate::shape::clump::Clump;

fn material() -> Material {
    Material {
        density: 2600.0,
        stiffness: 1e6,
        tangential_ratio: 0.5,
        tangential_damping_ratio: 0.0,
        friction: 0.5,
        restitution: 0.5,
        ..Material::default()
    }
}

fn bodies(
    container: &Container,
    shape: &Shape,
    law: SizeLaw,
    count: usize,
    target: f64,
    start: f64,
) -> Vec<BodyInput> {
    let (unit, reach) = match shape {
        Shape::Sphere { radius } => (4.0 / 3.0 * PI * radius.powi(3), *radius),
        Shape::Clump(clump) => (clump.volume, clump.bounding_radius()),
        Shape::Box { .. } | Shape::Polyhedron(_) => panic!("spheres only"),
    };
    let sizes = law.sample(count, 3);
    let solid: f64 = sizes.iter().map(|s| unit * s.powi(3)).sum();
    let factor = ((1.0 - target) * container.volume() / solid).cbrt();
    let radii: Vec<f64> = sizes.iter().map(|s| s * factor * reach * start).collect();
    let places = scatter(container, &radii, 5).unwrap();
    let body = |(position, size): (&Vec3, &f64)| BodyInput {
        position: *position,
        scale: size * factor,
        ..BodyInput::default()
    };
    places.iter().zip(&sizes).map(body).collect()
}

/// Jammed at 0.4 (small-box walls loosen it), no contacts at 0.5.
#[test]
fn spheres_grow_to_the_porosity() {
    let container = Container::Box { low: Vec3::new(-0.1, 0.0, 0.3), high: Vec3::new(0.1, 0.2, 0.5) };
    let shape = Shape::Sphere { radius: 0.5 };
    for target in [0.4, 0.5] {
        let law = SizeLaw::ByNumber { low: 0.8, high: 1.2 };
        let bodies = bodies(&container, &shape, law, 500, target, 0.5);
        let grown =
            grow(&container, std::slice::from_ref(&shape), &bodies, material(), &Growth::default()).unwrap();
        assert!((grown.porosity - target).abs() < 0.005, "{target}: {grown:.4?}", grown = grown.porosity);
        assert!(grown.overlap < 0.15, "{}", grown.overlap);
        let model = Model::new(ModelInput {
            materials: vec![material()],
            shapes: vec![shape.clone()],
            bodies: grown.bodies.clone(),
            ..ModelInput::default()
        })
        .unwrap();
        let (low, high) = container.bounds();
        let found = porosity(&model, &State::new(&model), &BoxRegion { low, high });
        assert!((found - target).abs() < 0.005, "{target}: {found}");
        if target == 0.5 {
            assert!(grown.overlap < 1e-3, "{}", grown.overlap);
        } else {
            assert!(
                grown.unbalanced < 1e-3 && grown.overlap > 1e-4,
                "{} {}",
                grown.unbalanced,
                grown.overlap
            );
        }
    }
}

#[test]
fn clumps_grow_in_funnels_and_surfaces() {
    let clump = Clump::from_spheres(&[([0.0; 3], 0.4), ([0.3, 0.0, 0.0], 0.3)]).unwrap();
    let shape = Shape::Clump(clump);
    let o = |x: f64, y: f64, z: f64| Vec3::new(x, y, z) * 0.2;
    let octahedron =
        [o(1., 0., 0.), o(-1., 0., 0.), o(0., 1., 0.), o(0., -1., 0.), o(0., 0., 1.), o(0., 0., -1.)];
    let faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    let surface = ClosedSurface::new(&octahedron, &faces).unwrap();
    assert!((surface.volume() - 4.0 / 3.0 * 0.008).abs() < 1e-15);
    for container in [
        Container::Cone { from: Vec3::zeros(), to: Vec3::z() * 0.3, from_radius: 0.05, to_radius: 0.15 },
        Container::Surface(surface),
    ] {
        let how = Growth { start: 0.4, rounds: 25, ..Growth::default() };
        let bodies = bodies(&container, &shape, SizeLaw::Equal(1.0), 150, 0.5, how.start);
        let grown = grow(&container, std::slice::from_ref(&shape), &bodies, material(), &how).unwrap();
        assert!((grown.porosity - 0.5).abs() < 0.005, "{}", grown.porosity);
        assert!(grown.bodies.iter().zip(&bodies).all(|(a, b)| a.scale == b.scale));
        assert!(grown.bodies.iter().any(|b| b.orientation.angle() > 0.1));
    }
}

#[test]
fn elastic_grains_grow() {
    let container = Container::Box { low: Vec3::zeros(), high: Vec3::repeat(0.2) };
    let shape = Shape::Sphere { radius: 0.5 };
    let bodies = bodies(&container, &shape, SizeLaw::ByNumber { low: 0.8, high: 1.2 }, 300, 0.4, 0.5);
    let of = |material| {
        grow(&container, std::slice::from_ref(&shape), &bodies, material, &Growth::default()).unwrap()
    };
    let elastic = Material {
        stiffness: f64::INFINITY,
        young: Some(2e10),
        poisson: 0.2,
        corner_strength: 2e8,
        corner_angle: 1.4,
        ..material()
    };
    let (grown, springs) = (of(elastic), of(material()));
    assert!((grown.porosity - springs.porosity).abs() < 1e-3, "{} {}", grown.porosity, springs.porosity);
    assert!((grown.overlap / springs.overlap - 1.0).abs() < 0.1, "{} {}", grown.overlap, springs.overlap);
}

#[test]
fn rejects_too_few_rounds() {
    let container = Container::Box { low: Vec3::zeros(), high: Vec3::repeat(0.2) };
    let shape = Shape::Sphere { radius: 0.5 };
    let bodies = bodies(&container, &shape, SizeLaw::Equal(1.0), 200, 0.1, 0.3);
    let how = Growth { start: 0.3, rounds: 1, ..Growth::default() };
    let error = grow(&container, std::slice::from_ref(&shape), &bodies, material(), &how).unwrap_err();
    assert!(matches!(error, GrowError::Step { round: 1, .. } | GrowError::Escaped(_)), "{error}");
}
