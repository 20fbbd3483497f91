use super::*;
use crate::write::sample;
use trackbed_fem::mesh::Mesh;

#[path = "../../../tests/suite/tecplot_zone.rs"]
mod zone;
use zone::{Zone, read};

fn written(mesh: &Mesh, choice: Choice<'_>) -> Zone {
    let n = mesh.node_count();
    let u: Vec<f64> = mesh.coordinates.iter().flat_map(|[x, y, z]| [y * z, x * x, x + y]).collect();
    let stress: Vec<[f64; 6]> =
        mesh.coordinates.iter().map(|[x, y, z]| [*x, *y, *z, 1.0, 2.0, x * y]).collect();
    let von_mises = stress.iter().map(stress::von_mises).collect();
    let tensors = ["strain", "plastic_strain", "other"].into_iter().zip(1_u32..).map(|(name, k)| {
        (name, NodalValues::Tensors(stress.iter().map(|s| s.map(|v| f64::from(k) * v)).collect()))
    });
    let scalar = vec![0.5; n];
    let mut frame = sample::with(
        &sample::solid(mesh, &u, &stress, &scalar),
        "von_mises",
        NodalValues::Numbers(von_mises),
    );
    frame.fields.extend(tensors);
    let dir = sample::folder(&format!("tecplot_{n}_{}", choice.0.is_some()));
    let file = dir.join("solid.dat");
    write_solid(&file, &frame, choice, ("track \"A\"", 0.25, 1)).unwrap();
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::remove_dir_all(&dir).unwrap();
    assert!(text.lines().all(|l| l.len() < 32_000));
    read(&text)
}

/// Volume of a trilinear brick by 2x2x2 Gauss points (exact).
fn brick_volume(x: [[f64; 3]; 8]) -> f64 {
    const SIGN: [[f64; 3]; 8] = [
        [-1.0, -1.0, -1.0],
        [1.0, -1.0, -1.0],
        [1.0, 1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, 1.0, 1.0],
        [-1.0, 1.0, 1.0],
    ];
    let g = 1.0 / 3.0_f64.sqrt();
    SIGN.iter()
        .map(|at| {
            let mut j = [[0.0; 3]; 3];
            for (s, p) in SIGN.iter().zip(x) {
                for a in 0..3 {
                    let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                    let d = 0.125 * s[a] * (1.0 + s[b] * g * at[b]) * (1.0 + s[c] * g * at[c]);
                    (0..3).for_each(|i| j[a][i] += d * p[i]);
                }
            }
            let cross = |a: [f64; 3], b: [f64; 3]| {
                [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
            };
            let c = cross(j[1], j[2]);
            j[0][0] * c[0] + j[0][1] * c[1] + j[0][2] * c[2]
        })
        .sum()
}

#[test]
fn header_counts_match_content() {
    let mesh = sample::block([2, 1, 1]);
    let zone = written(&mesh, Choice::default());
    // 32 nodes, 11 faces, 2 bodies.
    assert_eq!((mesh.node_count(), zone.points["x"].len(), zone.bricks.len()), (32, 45, 16));
    assert_eq!(zone.header[0], "TITLE = \"track 'A'\"");
    assert_eq!(zone.header[2], "ZONE T=\"track 'A'\", N=45, E=16,");
    assert_eq!(zone.header[3], "DATAPACKING=BLOCK, ZONETYPE=FEBRICK, STRANDID=1, SOLUTIONTIME=2.5e-1,");
    let ids: Vec<f64> = mesh.node_ids.iter().map(|id| f64::from(*id)).collect();
    assert_eq!(zone.points["node_id"][..32], ids[..]);
    assert_eq!(zone.points["node_id"][32..], [0.0; 13]);
    for (name, of) in [("material", &mesh.materials), ("element_id", &mesh.element_ids)] {
        let expected: Vec<f64> = of.iter().flat_map(|v| [f64::from(*v); 8]).collect();
        assert_eq!(zone.cells[name], expected, "{name}");
    }
}

#[test]
fn choice_selects_variables() {
    let mesh = sample::block([1, 1, 1]);
    let names = |zone: Zone| {
        let line = zone.header.iter().find_map(|l| l.strip_prefix("VARIABLES = ")).unwrap();
        line.replace('"', "")
    };
    let strains = "exx eyy ezz exy eyz ezx epxx epyy epzz epxy epyz epzx other_xx other_yy other_zz other_xy other_yz other_zx";
    assert_eq!(
        names(written(&mesh, Choice::default())),
        format!(
            "x y z ux uy uz u vx vy vz sxx syy szz sxy syz szx von_mises eps_p yield_function {strains} node_id \
             material element_id"
        )
    );
    let few = ["von_mises".to_string()];
    let selected = written(&mesh, Choice(Some(&few)));
    assert_eq!(selected.points["von_mises"], written(&mesh, Choice::default()).points["von_mises"]);
    assert_eq!(names(selected), format!("x y z ux uy uz u von_mises {strains} node_id material element_id"));
}

#[test]
fn bricks_fill_straight_mesh() {
    let mesh = sample::straight_block([2, 3, 2]);
    let zone = written(&mesh, Choice::default());
    for brick in &zone.bricks {
        let corners = brick.map(|p| ["x", "y", "z"].map(|axis| zone.points[axis][p]));
        assert!((brick_volume(corners) - 0.125).abs() < 1e-8);
    }
    assert_eq!(zone.bricks.len(), 12 * 8);
}

#[test]
fn interpolation_reproduces_linear_fields() {
    let mesh = sample::block([2, 2, 1]);
    let zone = written(&mesh, Choice::default());
    let close = |a: f64, b: f64| (a - b).abs() < 1e-7 * (1.0 + a.abs());
    for p in mesh.node_count()..zone.points["x"].len() {
        let [x, y, z, ux, uy, uz] = ["x", "y", "z", "ux", "uy", "uz"].map(|name| zone.points[name][p]);
        assert!(close(uz, x + y), "uz = x + y");
        assert!(close(zone.points["vz"][p], x + y));
        assert!(close(zone.points["u"][p], (ux * ux + uy * uy + uz * uz).sqrt()));
        let s = COMPONENTS.map(|c| zone.points[&format!("s{c}")][p]);
        assert!(close(s[0], x) && close(s[1], y) && close(s[2], z) && close(s[3], 1.0));
        let (d1, d2, d3) = (s[0] - s[1], s[1] - s[2], s[2] - s[0]);
        let shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
        let expected = (0.5 * (d1 * d1 + d2 * d2 + d3 * d3) + 3.0 * shear).sqrt();
        assert!(close(zone.points["von_mises"][p], expected));
        assert!(close(zone.points["eps_p"][p], 0.5) && close(zone.points["yield_function"][p], 0.5));
        for (stem, factor) in [("e", 1.0), ("ep", 2.0), ("other_", 3.0)] {
            for (c, value) in COMPONENTS.iter().zip(s) {
                assert!(close(zone.points[&format!("{stem}{c}")][p], factor * value), "{stem}{c}");
            }
        }
    }
}

#[test]
fn rejects_nonfinite_value() {
    let mesh = sample::block([1, 1, 1]);
    let n = mesh.node_count();
    let (u, mut stress, scalar) = (vec![0.0; 3 * n], vec![[0.0; 6]; n], vec![0.0; n]);
    let good = stress.clone();
    stress[2][1] = f64::NAN;
    let frame = sample::solid(&mesh, &u, &stress, &scalar);
    let dir = sample::folder("tecplot_nan");
    let write = |frame: &SolidFrame<'_>| {
        let file = dir.join("solid.dat");
        write_solid(&file, frame, Choice::default(), ("a", 0.0, 1)).unwrap_err().to_string()
    };
    let error = write(&frame);
    assert!(error.contains("stress at index 2 is NaN"), "{error}");
    let frame = sample::solid(&mesh, &u, &good, &scalar);
    let error = write(&sample::with(&frame, "strain", NodalValues::Tensors(stress.into())));
    assert!(error.contains("strain at index 2 is NaN"), "{error}");
    assert_eq!(std::fs::read_dir(&dir).unwrap().count(), 0);
    std::fs::remove_dir_all(&dir).unwrap();
}
