//! Mapping of a distorted element.

use crate::common::Random;
use trackbed_fem::element::hex20;

/// `sum N = 1`, and `sum N_a x_a` reproduces a quadratic map (complete quadratics are in the serendipity
/// space).
#[test]
fn shape_functions_reproduce_quadratic_map() {
    let mut random = Random(1);
    let (linear, square): ([_; 3], [_; 3]) =
        (std::array::from_fn(|_| random.point()), std::array::from_fn(|_| [random.point(), random.point()]));
    let map = |x: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|k| {
            let quadratic: f64 =
                (0..3).map(|i| square[k][0][i] * x[i] * x[i] + square[k][1][i] * x[i] * x[(i + 1) % 3]).sum();
            2.0 * x[k] + 0.3 * (0..3).map(|i| linear[k][i] * x[i]).sum::<f64>() + 0.2 * quadratic
        })
    };
    let nodes = hex20::NATURAL.map(map);
    for _ in 0..1000 {
        let xi = random.point();
        let n = hex20::shape_functions(xi);
        assert!((n.iter().sum::<f64>() - 1.0).abs() < 1e-13);
        let exact = map(xi);
        for k in 0..3 {
            let x: f64 = n.iter().zip(&nodes).map(|(n, x)| n * x[k]).sum();
            assert!((x - exact[k]).abs() < 1e-13, "{xi:?}: {x} against {}", exact[k]);
        }
    }
}
