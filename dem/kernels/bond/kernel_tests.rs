use super::*;
use crate::base::Vec3;
use nalgebra::{Rotation3, Unit, UnitQuaternion};

fn v3(v: Vec3) -> V3<f64> {
    V3::from_vec(&v)
}

/// Rotation about a skew outside axis: ten turns of 0.01 rad steps store nothing.
#[test]
fn rigid_rotation_stores_no_energy() {
    let axis = Unit::new_normalize(Vec3::new(0.3, -0.8, 0.5));
    let (xa, xb) = (Vec3::new(0.1, 0.02, -0.03), Vec3::new(0.09, 0.035, -0.02));
    let n = (xa - xb).normalize();
    let helper = n.cross(&Vec3::x()).normalize();
    for (u0, t0) in
        [(Vec3::zeros(), Vec3::zeros()), (helper * 1e-5, n * 2e-4 + helper.cross(&n) * 1e-4 + helper * 3e-4)]
    {
        let mut memory = BondHistory { shear: v3(u0), turn: v3(t0) };
        let (steps, step, dt) = (6283, 0.01, 1e-5);
        let mut last = UnitQuaternion::identity();
        for k in 1..=steps {
            let now = UnitQuaternion::from_axis_angle(&axis, step * f64::from(k));
            let of = |x: Vec3| Motion {
                x: v3(now * x),
                v: v3((now * x - last * x) / dt),
                w: v3(axis.into_inner() * (step / dt)),
            };
            update_frame(0.002, &of(xa), &of(xb), &mut memory, dt);
            last = now;
        }
        let turn = Rotation3::from_axis_angle(&axis, step * f64::from(steps));
        let (du, dt) = (memory.shear.to_vec() - turn * u0, memory.turn.to_vec() - turn * t0);
        // Measured: 4e-15 m and 7e-14 rad.
        assert!(du.norm() < 1e-13, "{:e}", du.norm());
        assert!(dt.norm() < 1e-12, "{:e}", dt.norm());
    }
}

/// ½ k q² in twelve directions; work equals energy loss.
#[test]
fn forces_follow_from_the_energy() {
    let mut k = [0.0; COUNT];
    k[..6].copy_from_slice(&[0.019, 0.003, 1.3e7, 0.6e7, 410.0, 290.0]);
    let n = Vec3::new(0.6, -0.3, 0.7).normalize();
    let (xa, xb) = (n * 0.019, Vec3::zeros());
    for direction in 0..12 {
        let mut unit = [Vec3::zeros(); 4];
        // Sphere-scale lengths balance translational and rotational energy.
        unit[direction / 3][direction % 3] = if direction < 6 { 1e-2 } else { 1.0 };
        let [va, vb, wa, wb] = unit;
        let h = 1e-6;
        let mut memory = BondHistory { shear: V3::zero(), turn: V3::zero() };
        let mut work = 0.0;
        let mut last = 0.0;
        for s in 1..=4 {
            let q = h * f64::from(s);
            let a = Motion { x: v3(xa + va * q), v: v3(va), w: v3(wa) };
            let b = Motion { x: v3(xb + vb * q), v: v3(vb), w: v3(wb) };
            let frame = update_frame(k[OFFSET], &a, &b, &mut memory, h);
            let r = respond(&k, &a, &b, &frame, &memory);
            let power = r.force.to_vec().dot(&(va - vb))
                + r.torque_a.to_vec().dot(&wa)
                + r.torque_b.to_vec().dot(&wb);
            work += 0.5 * (power + last) * h;
            last = power;
            let e = energy(&k, &frame, &memory);
            assert!((e + work).abs() < 1e-4 * e, "direction {direction}: energy {e:e}, work {work:e}");
        }
    }
}

#[test]
fn pure_motions() {
    let mut k = [0.0; COUNT];
    k[..6].copy_from_slice(&[0.02, 0.0, 2e7, 1e7, 500.0, 300.0]);
    let still = |x: Vec3| Motion { x: v3(x), v: V3::zero(), w: V3::zero() };
    let run = |a: Motion<f64>, b: Motion<f64>| {
        let mut memory = BondHistory { shear: V3::zero(), turn: V3::zero() };
        let frame = update_frame(0.0, &a, &b, &mut memory, 1e-6);
        respond(&k, &a, &b, &frame, &memory)
    };
    let near = |x: Vec3, y: Vec3| assert!((x - y).norm() < 1e-6 * y.norm(), "{x} {y}");
    let z = Vec3::z() * 0.02;
    // Tension 1e-6 m.
    let r = run(Motion { v: v3(Vec3::z()), ..still(z * (1.0 + 5e-5)) }, still(Vec3::zeros()));
    near(r.force.to_vec(), -Vec3::z() * 20.0);
    let r = run(Motion { v: v3(Vec3::x()), ..still(z + Vec3::x() * 1e-6) }, still(Vec3::zeros()));
    near(r.force.to_vec(), -Vec3::x() * 10.0);
    near(r.torque_a.to_vec(), Vec3::y() * 0.1);
    near(r.torque_b.to_vec(), Vec3::y() * 0.1);
    // Bending 2e-6 rad, no slip.
    let turned = |x, w| Motion { w: v3(w), ..still(x) };
    let r = run(turned(z, Vec3::x()), turned(Vec3::zeros(), -Vec3::x()));
    near(r.torque_a.to_vec(), -Vec3::x() * 1e-3);
    near(r.torque_b.to_vec(), Vec3::x() * 1e-3);
    assert!(r.force.to_vec().norm() < 1e-9);
    // Twist 1e-6 rad.
    let r = run(turned(z, Vec3::z()), still(Vec3::zeros()));
    near(r.torque_a.to_vec(), -Vec3::z() * 3e-4);
    near(r.torque_b.to_vec(), Vec3::z() * 3e-4);
}
