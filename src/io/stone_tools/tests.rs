use super::*;
use nalgebra::Vector3;
use std::f64::consts::PI;
use trackbed_dem::insert::library::StoneLibrary;
use trackbed_dem::shape::polyhedron::{Surface, convex_hull};

/// Hull of 600 points on the unit sphere.
fn ball() -> Polyhedron {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let point = |i: usize| {
        let z: f64 = 1.0 - (2 * i + 1) as f64 / 600.0;
        let (rim, a) = ((1.0 - z * z).sqrt(), golden * i as f64);
        [rim * a.cos(), rim * a.sin(), z]
    };
    Polyhedron::new(&convex_hull(&(0..600).map(point).collect::<Vec<_>>()).unwrap()).unwrap()
}

fn brick(half: [f64; 3]) -> Surface {
    let corner = |i: usize| std::array::from_fn(|k| if i >> k & 1 == 0 { -half[k] } else { half[k] });
    convex_hull(&(0..8).map(corner).collect::<Vec<_>>()).unwrap()
}

fn source(body: Polyhedron) -> Vec<Source> {
    vec![Source { name: "stone".into(), body }]
}

fn clump_kind(spheres: usize, overhang: f64) -> Kind {
    Kind::Clump(fill::Options { spheres, overhang })
}

fn bonded_kind(spheres: usize, seed: u64) -> Kind {
    Kind::Bonded(grow::Options { spheres, seed, spread: 0.2, gap: 0.2 })
}

const FORM: random::Form =
    random::Form { elongation: [0.7, 0.8], flatness: [0.7, 0.8], angularity: [0.6, 0.8] };

fn stones() -> Vec<Source> {
    let make = |i| Source { name: format!("random \"{i}\""), body: random::stone(7, i, &FORM) };
    (0..2).map(make).collect()
}

fn library_text(name: &str, source: &str, made: &[Made]) -> String {
    let rows: Vec<(&Stone, String)> = made.iter().map(|m| (&m.stone, m.report.to_string())).collect();
    library_file::text(name, source, library_file::OF_SURFACES, &rows)
}

#[test]
fn sphere_in_cube_matches_closed_form() {
    let body = Polyhedron::new(&brick([0.5; 3])).unwrap();
    let distance = SurfaceDistance::new(&body);
    let spheres = [([0.0; 3], 0.5)];
    let clump = Clump::from_spheres(&spheres).unwrap();
    let report = measure::clump(&body, &distance, &spheres, &clump);
    let near = |value: f64, exact: f64, tolerance: f64| {
        assert!((value - exact).abs() < tolerance, "{value} {exact}")
    };
    near(report.volume_ratio, PI / 6.0, 1e-9);
    // 2/5 m r² over m a²/6 with the volumes as masses.
    near(report.inertia_ratio[0], 0.4 * (PI / 6.0) * 0.25 * 6.0, 1e-9);
    near(report.max_distance, 0.75_f64.sqrt() - 0.5, 5e-3);
    near(report.mean_distance, 0.5 * 1.280_789 - 0.5, 1e-3);
    near(report.sphericity.unwrap(), 1.0, 1e-9);
    near(report.surface_sphericity, (PI / 6.0).cbrt(), 1e-9);
    near(report.overhang, 0.0, 1e-12);
    near(report.centroid_offset, 0.0, 1e-9);
    // Moved by 0.1, it protrudes by 0.1.
    let moved = [([0.1, 0.0, 0.0], 0.5)];
    let report = measure::clump(&body, &distance, &moved, &Clump::from_spheres(&moved).unwrap());
    // Sample points lie up to a few degrees off the pole.
    near(report.overhang, 0.1, 3e-3);
    near(report.centroid_offset, 0.1, 1e-9);
}

#[test]
fn ball_gives_exact_volume_and_inertia() {
    let made = make(&source(ball()), clump_kind(1, 0.1)).unwrap();
    let report = &made[0].report;
    // The hull is 1.0 % smaller than the ball.
    assert!((report.volume_ratio - 1.0).abs() < 3e-3, "{report}");
    assert!(report.inertia_ratio.iter().all(|i| (i - 1.0).abs() < 5e-3), "{report}");
    assert!(report.mean_distance < 2e-3, "{report}");
}

#[test]
fn error_falls_with_sphere_count() {
    let sources = stones();
    let error = |n: usize| -> Vec<StoneReport> {
        make(&sources, clump_kind(n, 0.1)).unwrap().into_iter().map(|m| m.report).collect()
    };
    let reports: Vec<Vec<StoneReport>> = [1, 4, 20].into_iter().map(error).collect();
    for pair in reports.windows(2) {
        for (few, many) in pair[0].iter().zip(&pair[1]) {
            assert!(many.mean_distance < 0.8 * few.mean_distance, "{few}\n{many}");
            assert!(many.max_distance < few.max_distance, "{few}\n{many}");
        }
    }
    for report in &reports[2] {
        assert!((report.volume_ratio - 1.0).abs() < 0.01, "{report}");
        assert!(report.inertia_ratio.iter().all(|i| (i - 1.0).abs() < 0.02), "{report}");
        assert!(report.mean_distance < 0.012 && report.centroid_offset < 0.005, "{report}");
    }
}

#[test]
fn spheres_respect_overhang() {
    for source in stones() {
        let body = source.body;
        let distance = SurfaceDistance::new(&body);
        for overhang in [0.0, 0.05, 0.2] {
            let spheres = fill::fill(&body, &distance, &fill::Options { spheres: 8, overhang }).unwrap();
            assert_eq!(spheres.len(), 8);
            // Half the sieve size bounds the largest inscribed radius.
            for (c, r) in &spheres {
                assert!(r - distance.depth(*c) <= overhang * 0.5 + 1e-12);
            }
            let out = spheres.iter().map(|(c, r)| r - distance.depth(*c)).fold(f64::NEG_INFINITY, f64::max);
            assert!(overhang == 0.0 || out > 0.3 * overhang * 0.4, "the overhang {overhang} is used: {out}");
        }
    }
}

#[test]
fn bonded_spheres_are_inside_and_connected() {
    let mut l: Vec<[f64; 3]> = Vec::new();
    for z in [0.0, 1.0] {
        l.extend(
            [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]].map(|[x, y]| [x, y, z]),
        );
    }
    let mut triangles: Vec<[u32; 3]> = vec![[0, 2, 1], [0, 3, 2], [0, 4, 3], [0, 5, 4]];
    triangles.extend(triangles.clone().iter().map(|[a, b, c]| [a + 6, c + 6, b + 6]));
    for i in 0..6 {
        let j = (i + 1) % 6;
        triangles.extend([[i, j, j + 6], [i, j + 6, i + 6]]);
    }
    let l = Polyhedron::new(&Surface { vertices: l, triangles }).unwrap();
    assert!((l.moments().volume - 5.0).abs() < 1e-12);
    for (body, n) in [(random::stone(7, 1, &FORM), 60), (l, 40)] {
        let distance = SurfaceDistance::new(&body);
        let options = grow::Options { spheres: n, seed: 3, spread: 0.2, gap: 0.2 };
        let grown = grow::grow(&body, &distance, &options);
        assert_eq!(grown.spheres.len(), n);
        let mut bonded = 0;
        for (i, a) in grown.spheres.iter().enumerate() {
            assert!(a.1 > 0.0 && distance.depth(a.0) >= a.1 - 1e-12, "sphere {i} stands out");
            for (j, b) in grown.spheres.iter().enumerate().skip(i + 1) {
                let gap = grow::gap(a, b);
                assert!(gap >= -1e-12, "spheres {i} and {j} overlap by {gap}");
                let near = gap <= 0.2 * 0.5 * (a.1 + b.1);
                assert_eq!(grown.bonds.contains(&[i as u32, j as u32]), near);
                bonded += usize::from(near);
            }
        }
        assert_eq!(bonded, grown.bonds.len());
        let volume: f64 = grown.spheres.iter().map(|s| 4.0 / 3.0 * PI * s.1.powi(3)).sum();
        let exact = body.moments().volume;
        assert!((volume * grown.density_factor / exact - 1.0).abs() < 1e-12);
        assert!((0.4..0.65).contains(&(volume / exact)), "{}", volume / exact);
        // Fails unless the bonds connect it.
        let cluster = Cluster::new(&grown.spheres, &grown.bonds, grown.density_factor).unwrap();
        assert!((cluster.volume / exact - 1.0).abs() < 1e-12);
    }
}

#[test]
fn stones_depend_on_seed_only() {
    let sources = stones();
    let with = |threads: usize, kind: Kind| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| make(&sources, kind).unwrap())
    };
    for kind in [clump_kind(5, 0.1), bonded_kind(20, 1)] {
        let text = |made: &[Made]| library_text("a", "b", made);
        let (one, two) = (with(1, kind), with(2, kind));
        assert_eq!(one, two);
        assert_eq!(text(&one), text(&two));
    }
    assert_ne!(with(1, bonded_kind(20, 1)), with(1, bonded_kind(20, 2)));
}

#[test]
fn random_stones_have_the_form_requested() {
    for i in 0..6 {
        let form = random::Form {
            elongation: [0.55, 0.65],
            flatness: [0.7; 2],
            angularity: [0.2 * i as f64 / 1.2; 2],
        };
        let body = random::stone(11, i, &form);
        let mut e = body.extents();
        e.sort_by(|a, b| b.total_cmp(a));
        assert!((0.55 - 1e-3..0.65 + 1e-3).contains(&(e[1] / e[0])), "{e:?}");
        assert!((e[2] / e[1] - 0.7).abs() < 1e-3 && (e[1] - 1.0).abs() < 1e-9, "{e:?}");
        let hull = convex_hull(&body.surface().vertices).unwrap();
        assert_eq!(hull.vertices.len(), body.surface().vertices.len(), "convex");
    }
    // Independent of the number of stones.
    assert_eq!(random::stone(11, 2, &FORM), random::stone(11, 2, &FORM));
    assert_ne!(random::stone(11, 2, &FORM), random::stone(12, 2, &FORM));
    let sphericity = |a: f64| {
        let form = random::Form { elongation: [0.9; 2], flatness: [0.9; 2], angularity: [a; 2] };
        (0..8).map(|i| random::stone(5, i, &form).sphericity()).sum::<f64>() / 8.0
    };
    let (blunt, middle, sharp) = (sphericity(0.0), sphericity(0.5), sphericity(1.0));
    assert!(blunt > middle + 0.005 && middle > sharp + 0.005, "{blunt} {middle} {sharp}");
}

#[test]
fn library_text_round_trip() {
    for kind in [clump_kind(5, 0.1), bonded_kind(20, 1)] {
        let made = make(&stones(), kind).unwrap();
        let text = library_text("a \"name\"", "here\\there", &made);
        let back: StoneLibrary = toml::from_str(&text).unwrap();
        assert_eq!((back.name.as_str(), back.source.as_str()), ("a \"name\"", "here\\there"));
        for (stone, made) in back.stones.iter().zip(&made) {
            assert_eq!((&stone.name, &stone.bonds), (&made.stone.name, &made.stone.bonds));
            for (a, b) in stone.spheres.iter().zip(&made.stone.spheres) {
                assert!((0..4).all(|k| (a[k] - b[k]).abs() < 1e-9));
            }
        }
        let sieves: Vec<f64> = match kind {
            Kind::Clump(_) => back.clumps().unwrap().iter().map(Clump::sieve_size).collect(),
            Kind::Bonded(_) => back.clusters().unwrap().iter().map(Cluster::sieve_size).collect(),
        };
        assert!(sieves.len() == 2 && sieves.iter().all(|s| (s - 1.0).abs() < 1e-7), "{sieves:?}");
    }
}

#[test]
fn rejects_several_or_thin_bodies() {
    let one = brick([0.5; 3]);
    let mut two = one.clone();
    two.vertices.extend(one.vertices.iter().map(|v| [v[0] + 3.0, v[1], v[2]]));
    two.triangles.extend(one.triangles.iter().map(|t| t.map(|v| v + 8)));
    let error = make(&source(Polyhedron::new(&two).unwrap()), clump_kind(2, 0.1)).unwrap_err();
    assert_eq!(error, StoneError::Pieces { name: "stone".into(), pieces: 2 });
    // A box with walls of 0.1 mm.
    let mut shell = one.clone();
    shell.vertices.extend(one.vertices.iter().map(|v| v.map(|x| 0.9998 * x)));
    shell.triangles.extend(one.triangles.iter().map(|t| t.map(|v| v + 8)));
    for kind in [clump_kind(2, 0.1), bonded_kind(2, 1)] {
        let error = make(&source(Polyhedron::new(&shell).unwrap()), kind).unwrap_err();
        assert!(matches!(error, StoneError::Thin { .. }), "{error}");
    }
    // A plate of 1:40 is valid.
    let plate = Polyhedron::new(&brick([2.0, 2.0, 0.05])).unwrap();
    let made = make(&source(plate.mapped(&nalgebra::Matrix3::identity(), &Vector3::x())), clump_kind(6, 0.1))
        .unwrap();
    assert_eq!(made[0].stone.spheres.len(), 6);
}

/// Two equal spheres at centre distance d: V = 2 (4/3)πr³ − π(4r + d)(2r − d)²/12, S = 2·2πr(r + d/2); the
/// hull is a cylinder of length d with two hemispheres.
#[test]
fn two_spheres_match_closed_form() {
    let (r, d) = (1.0, 1.5);
    let clump = Clump::from_spheres(&[([0.0; 3], r), ([d, 0.0, 0.0], r)]).unwrap();
    let shape = measure::union_shape(&clump);
    let volume = 8.0 / 3.0 * PI * r * r * r - PI * (4.0 * r + d) * (2.0 * r - d).powi(2) / 12.0;
    let sphericity = PI.cbrt() * (6.0 * volume).powf(2.0 / 3.0) / (4.0 * PI * r * (r + d / 2.0));
    assert!((shape.sphericity / sphericity - 1.0).abs() < 5e-3, "{shape} {sphericity}");
    let convexity = volume / (4.0 / 3.0 * PI + PI * d);
    assert!((shape.convexity / convexity - 1.0).abs() < 0.02, "{shape} {convexity}");
}

#[test]
fn rough_stones_meet_specification() {
    let form =
        rough::Form { spheres: 5, overlap: 0.2, spread: 0.2, elongation: [0.7, 0.8], flatness: [0.6, 0.8] };
    let made = rough::stones(3, 6, &form).unwrap();
    for m in &made {
        assert!((0.7..=0.8).contains(&m.ratios[0]) && (0.6..=0.8).contains(&m.ratios[1]), "{m}");
        let s = &m.stone.spheres;
        let mut touching = 0;
        for (i, a) in s.iter().enumerate() {
            for b in &s[..i] {
                let distance = (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
                let overlap = 1.0 - distance / (a[3] + b[3]);
                assert!(overlap < 0.2 + 0.06, "{overlap}");
                touching += usize::from(overlap > 0.0);
            }
        }
        assert!(touching >= 4, "hangs together: {touching}");
        assert!(m.shape.convexity < 0.93 && m.shape.sphericity < 0.85, "{m}");
    }
    // Independent of the number of stones.
    assert_eq!(rough::stones(3, 2, &form).unwrap(), made[..2]);
    assert_ne!(rough::stones(4, 1, &form).unwrap()[0], made[0]);
    // Four equal spheres cannot form a needle.
    let needle = rough::Form { elongation: [0.05, 0.06], flatness: [0.9, 1.0], ..form };
    assert!(rough::stones(1, 1, &needle).is_err());
}
