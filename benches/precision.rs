//! Upper bound of the gain of single precision in the contact loop, and its error.
//!
//! `cargo bench --bench precision`
//!
//! Separate loop with the linear law (overlap, dashpot, Coulomb slider) and the engine's memory layout, in
//! f64 (eight pairs) and f32 (sixteen). Force errors with f32 positions, for box test and track widths.

use std::hint::black_box;
use std::time::Instant;

const EDGE: usize = 22;
const ROUNDS: usize = 400;

macro_rules! kernel {
    ($real:ident, $name:ident, $lanes:expr, $features:literal) => {
        #[cfg_attr(target_arch = "x86_64", target_feature(enable = $features))]
        fn $name(
            pairs: &[[u32; 2]],
            centre: &[[$real; 4]],
            velocity: &[[$real; 4]],
            memory: &mut [[$real; $lanes]],
            force: &mut [[$real; 4]],
        ) {
            const L: usize = $lanes;
            let (k, kt, c, mu, dt): ($real, $real, $real, $real, $real) = (1e5, 5e4, 0.4, 0.5, 2e-5);
            for (group, chunk) in pairs.chunks_exact(L).enumerate() {
                let (mut x, mut v) = ([[0.0; L]; 3], [[0.0; L]; 3]);
                let mut reach = [0.0; L];
                for l in 0..L {
                    let [a, b] = chunk[l].map(|i| i as usize);
                    for d in 0..3 {
                        x[d][l] = centre[a][d] - centre[b][d];
                        v[d][l] = velocity[a][d] - velocity[b][d];
                    }
                    reach[l] = centre[a][3] + centre[b][3];
                }
                let springs = &mut memory[3 * group..3 * group + 3];
                let mut out = [[0.0; L]; 3];
                for l in 0..L {
                    let far2 = x[0][l] * x[0][l] + x[1][l] * x[1][l] + x[2][l] * x[2][l];
                    let far = far2.sqrt();
                    let n = [x[0][l] / far, x[1][l] / far, x[2][l] / far];
                    let overlap = reach[l] - far;
                    let along = v[0][l] * n[0] + v[1][l] * n[1] + v[2][l] * n[2];
                    let normal = k * overlap - c * along;
                    let normal = if overlap > 0.0 { normal } else { 0.0 };
                    let mut s = [springs[0][l], springs[1][l], springs[2][l]];
                    let turned = s[0] * n[0] + s[1] * n[1] + s[2] * n[2];
                    for d in 0..3 {
                        s[d] = s[d] - turned * n[d] + (v[d][l] - along * n[d]) * dt;
                    }
                    let size = (s[0] * s[0] + s[1] * s[1] + s[2] * s[2]).sqrt();
                    let most = mu * normal.abs() / kt;
                    let share = if size > most { most / size } else { 1.0 };
                    for d in 0..3 {
                        s[d] = if overlap > 0.0 { s[d] * share } else { 0.0 };
                        springs[d][l] = s[d];
                        out[d][l] = normal * n[d] - kt * s[d];
                    }
                }
                for l in 0..L {
                    let [a, b] = chunk[l].map(|i| i as usize);
                    for d in 0..3 {
                        force[a][d] += out[d][l];
                        force[b][d] -= out[d][l];
                    }
                }
            }
        }
    };
}

kernel!(f64, double, 8, "avx2,fma");
kernel!(f32, single, 16, "avx2,fma");

/// FCC lattice with contacts, coordinates perturbed by up to 0.01 radii, and its pairs.
fn bed(radius: f64) -> (Vec<[f64; 4]>, Vec<[u32; 2]>) {
    let mut random = 1_u64;
    let mut noise = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let side = 2.0 * radius * std::f64::consts::FRAC_1_SQRT_2;
    let mut spheres = Vec::new();
    for i in 0..EDGE {
        for j in 0..EDGE {
            for k in (0..2 * EDGE).filter(|k| (i + j + k) % 2 == 0) {
                let [x, y, z] = [i, j, k].map(|n| n as f64 * side * 0.999 + 0.02 * radius * noise());
                spheres.push([x, y, z, radius]);
            }
        }
    }
    let mut pairs = Vec::new();
    for a in 0..spheres.len() {
        for b in a + 1..spheres.len() {
            let way: f64 = (0..3).map(|d| (spheres[a][d] - spheres[b][d]).powi(2)).sum();
            if way < (2.05 * radius).powi(2) {
                pairs.push([a as u32, b as u32]);
            }
        }
    }
    (spheres, pairs)
}

fn main() {
    #[cfg(target_arch = "x86_64")]
    if std::is_x86_feature_detected!("avx2") && std::is_x86_feature_detected!("fma") {
        speed();
    }
    accuracy();
}

/// Seconds per pair, best of nine.
#[cfg(target_arch = "x86_64")]
fn speed() {
    let (spheres, pairs) = bed(0.01);
    let count = pairs.len() / 16 * 16;
    let pairs = &pairs[..count];
    let narrow: Vec<[f32; 4]> = spheres.iter().map(|s| s.map(|x| x as f32)).collect();
    let mut best = [f64::INFINITY; 2];
    for _ in 0..9 {
        let (mut memory, mut force) = (vec![[0.0; 8]; 3 * count / 8], vec![[0.0; 4]; spheres.len()]);
        let still = vec![[0.0; 4]; spheres.len()];
        let start = Instant::now();
        for _ in 0..ROUNDS {
            // SAFETY: CPU support was checked before the call.
            unsafe { double(black_box(pairs), &spheres, &still, &mut memory, &mut force) };
        }
        best[0] = best[0].min(start.elapsed().as_secs_f64() / (ROUNDS * count) as f64);
        black_box(&force);
        let (mut memory, mut force) = (vec![[0.0; 16]; 3 * count / 16], vec![[0.0; 4]; spheres.len()]);
        let still = vec![[0.0; 4]; spheres.len()];
        let start = Instant::now();
        for _ in 0..ROUNDS {
            // SAFETY: as above.
            unsafe { single(black_box(pairs), &narrow, &still, &mut memory, &mut force) };
        }
        best[1] = best[1].min(start.elapsed().as_secs_f64() / (ROUNDS * count) as f64);
        black_box(&force);
    }
    println!(
        "{} spheres, {count} pairs: {:.2} ns a pair with 64 bits, {:.2} ns with 32 bits: {:.2} times as fast",
        spheres.len(),
        1e9 * best[0],
        1e9 * best[1],
        best[0] / best[1]
    );
}

/// Normal-force error with f32 positions.
fn accuracy() {
    for (bed, width, stiffness, load) in [
        ("box test", 0.8, 50e6, 1000.0),
        ("box test, a stone's weight", 0.8, 50e6, 10.0),
        ("track of 20 m", 20.0, 50e6, 1000.0),
    ] {
        let overlap = load / stiffness;
        let mut worst = 0.0_f64;
        let mut sum = 0.0;
        for n in 0..10_000 {
            let x = width * (n as f64 + 0.5) / 10_000.0;
            let y = x + 0.04 - overlap;
            let found = 0.04 - (f64::from(y as f32) - f64::from(x as f32));
            let error = (found - overlap).abs() / overlap;
            worst = worst.max(error);
            sum += error / 10_000.0;
        }
        println!(
            "{bed}: contacts of {load} N with {stiffness:e} N/m err by {sum:.1e} in the mean, {worst:.1e} at most"
        );
    }
}
