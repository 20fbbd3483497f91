use super::*;
use crate::write::sample;

fn written(mesh: &Mesh) -> (Vec<String>, Vec<Vec<f64>>, Vec<[usize; 8]>) {
    let n = mesh.node_count();
    let u: Vec<f64> = mesh.coordinates.iter().flat_map(|[x, y, z]| [y * z, x * x, x + y]).collect();
    let stress: Vec<[f64; 6]> =
        mesh.coordinates.iter().map(|[x, y, z]| [*x, *y, *z, 1.0, 2.0, x * y]).collect();
    let scalar = vec![0.5; n];
    let frame = SolidFrame {
        mesh,
        displacement: &u,
        velocity: &u,
        stress: &stress,
        von_mises: &scalar,
        equivalent_plastic_strain: &scalar,
        yield_function: &scalar,
        tensors: &[],
    };
    let dir = sample::folder(&format!("tecplot_{n}"));
    let file = dir.join("solid.dat");
    write_solid(&file, &frame, "track \"A\"", 0.25, 1).unwrap();
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::remove_dir_all(&dir).unwrap();
    let header: Vec<String> = text.lines().take(7).map(String::from).collect();
    let rows: Vec<Vec<f64>> =
        text.lines().skip(7).map(|r| r.split(' ').map(|v| v.parse().unwrap()).collect()).collect();
    let split = rows.iter().position(|r| r.len() == 8).unwrap();
    let bricks = rows[split..].iter().map(|r| std::array::from_fn(|i| r[i] as usize - 1)).collect();
    (header, rows[..split].to_vec(), bricks)
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
    let (header, points, bricks) = written(&mesh);
    // 32 nodes, 11 faces, 2 bodies.
    assert_eq!((mesh.node_count(), points.len(), bricks.len()), (32, 45, 16));
    assert_eq!(header[3], "TITLE = \"track 'A'\"");
    assert_eq!(header[4], format!("VARIABLES = {VARIABLES}"));
    assert_eq!(header[5], "ZONE T=\"track 'A'\", N=45, E=16,");
    assert_eq!(header[6], "DATAPACKING=POINT, ZONETYPE=FEBRICK, STRANDID=1, SOLUTIONTIME=2.5e-1");
    assert!(points.iter().all(|p| p.len() == VARIABLES.split(' ').filter(|v| !v.is_empty()).count()));
}

#[test]
fn bricks_fill_straight_mesh() {
    let mesh = sample::straight_block([2, 3, 2]);
    let (_, points, bricks) = written(&mesh);
    for brick in &bricks {
        let corners = brick.map(|p| [points[p][0], points[p][1], points[p][2]]);
        assert!((brick_volume(corners) - 0.125).abs() < 1e-8);
    }
    assert_eq!(bricks.len(), 12 * 8);
}

#[test]
fn interpolation_reproduces_linear_fields() {
    let mesh = sample::block([2, 2, 1]);
    let (_, points, _) = written(&mesh);
    for p in &points[mesh.node_count()..] {
        let close = |a: f64, b: f64| (a - b).abs() < 1e-7 * (1.0 + a.abs());
        assert!(close(p[5], p[0] + p[1]), "uz = x + y");
        assert!(close(p[7], p[0]) && close(p[8], p[1]) && close(p[9], p[2]) && close(p[10], 1.0));
        assert!(close(p[6], (p[3] * p[3] + p[4] * p[4] + p[5] * p[5]).sqrt()));
        let (d1, d2, d3) = (p[7] - p[8], p[8] - p[9], p[9] - p[7]);
        let shear = p[10] * p[10] + p[11] * p[11] + p[12] * p[12];
        assert!(close(p[13], (0.5 * (d1 * d1 + d2 * d2 + d3 * d3) + 3.0 * shear).sqrt()));
        assert!(close(p[14], 0.5));
    }
}

#[test]
fn rejects_nonfinite_value() {
    let mesh = sample::block([1, 1, 1]);
    let n = mesh.node_count();
    let (u, mut stress, scalar) = (vec![0.0; 3 * n], vec![[0.0; 6]; n], vec![0.0; n]);
    stress[2][1] = f64::NAN;
    let frame = SolidFrame {
        mesh: &mesh,
        displacement: &u,
        velocity: &u,
        stress: &stress,
        von_mises: &scalar,
        equivalent_plastic_strain: &scalar,
        yield_function: &scalar,
        tensors: &[],
    };
    let dir = sample::folder("tecplot_nan");
    let error = write_solid(&dir.join("solid.dat"), &frame, "a", 0.0, 1).unwrap_err();
    assert!(error.to_string().contains("stress at index 2 is NaN"), "{error}");
    assert_eq!(std::fs::read_dir(&dir).unwrap().count(), 0);
    std::fs::remove_dir_all(&dir).unwrap();
}
