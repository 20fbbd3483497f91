//! Wall motion: prescribed, servo-controlled, or rigid-body.

use super::afloat;
use super::shape::direction;
use crate::scene::track::HeldMotion;
use crate::scene::units::vector;
use crate::scene::walls::{Body, Pulses, Wall, WallKind};
use crate::scene::water::Water;
use crate::scene::{SceneError, Table, kinds};
use trackbed_dem::{Motion, Mount, Oscillation, RigidBody, Servo, Vec3, WallShape};

pub(super) fn motion(wall: &Table<Wall>) -> Result<Motion, SceneError> {
    let mut motion = Motion {
        velocity: wall.velocity.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v))),
        angular_velocity: wall.angular_velocity.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v))),
        centre: wall.centre.map(|v| Vec3::from(vector(&v))),
        oscillation: None,
    };
    if motion.centre.is_some() && wall.angular_velocity.is_none() {
        return Err(wall.no_effect("centre", "`angular_velocity`"));
    }
    if let (WallKind::Plane, Some(normal)) = (wall.kind, wall.normal) {
        let (spin, normal) = (motion.angular_velocity, Vec3::from(normal));
        if spin.cross(&normal).norm() > 1e-12 * spin.norm() * normal.norm() {
            let expected =
                "an angular velocity along the plane's normal, or triangles for a floor that tilts";
            let found = format!("({}, {}, {}) rad/s", spin.x, spin.y, spin.z);
            return Err(wall.error("angular_velocity", found, expected));
        }
    }
    if let Some(o) = wall.optional("oscillation", &wall.oscillation) {
        o.check("frequency", o.frequency, |f| f > 0.0, "above 0")?;
        o.check("amplitude", o.amplitude, |a| a > 0.0, "a length above 0")?;
        let along = direction(&o, "direction", o.direction)?;
        motion.oscillation = Some(Oscillation {
            amplitude: along * o.amplitude.si,
            frequency: o.frequency.si,
            phase: o.phase.map_or(0.0, |p| p.si),
        });
    }
    let moves = [
        ("velocity", wall.velocity.is_some()),
        ("angular_velocity", wall.angular_velocity.is_some()),
        ("oscillation", wall.oscillation.is_some()),
    ];
    for (owner, there) in [("servo", wall.servo.is_some()), ("body", wall.body.is_some())] {
        let idle = moves.map(|(k, given)| (k, there && given));
        wall.reject_with(idle, &format!("`{owner}`"))?;
    }
    if wall.servo.is_some() && wall.body.is_some() {
        return Err(wall.conflict("servo", "`body`"));
    }
    Ok(motion)
}

pub(super) fn servo(wall: &Table<Wall>) -> Result<Option<Servo>, SceneError> {
    let Some(s) = wall.optional("servo", &wall.servo) else { return Ok(None) };
    let along = match (s.direction, wall.normal) {
        (Some(d), _) => direction(&s, "direction", d)?,
        (None, Some(n)) => direction(&s, "direction", n)?,
        _ => {
            return Err(s.missing("direction", "the direction in which the wall presses"));
        }
    };
    let force = match (s.force, s.pressure, s.area) {
        (Some(f), None, None) => f.si,
        (None, Some(p), Some(area)) => {
            s.check("area", area, |a| a > 0.0, "an area above 0")?;
            p.si * area
        }
        (None, Some(_), None) => {
            return Err(s.missing("area", "the area that the pressure acts on"));
        }
        (Some(_), None, Some(_)) => {
            return Err(s.no_effect("area", "`pressure`"));
        }
        (force, ..) => return Err(s.choice(["force", "pressure"], force.is_some())),
    };
    s.check("max_speed", s.max_speed, |v| v > 0.0, "a speed above 0")?;
    let gain = s.gain.unwrap_or(0.5);
    s.check("gain", gain, |g| g > 0.0 && g <= 1.0, "above 0, at most 1")?;
    let points = match (&s.history, s.optional("pulses", &s.pulses)) {
        (Some(_), Some(_)) => return Err(s.conflict("pulses", "`history`")),
        (None, None) => vec![[0.0, force]],
        (Some(points), None) => points.iter().map(|(t, f)| [t.si, f * force]).collect(),
        (None, Some(pulses)) => haversines(&pulses, force)?,
    };
    if points.is_empty()
        || !points.is_sorted_by(|a, b| a[0] < b[0])
        || !points.iter().flatten().all(|x| x.is_finite())
    {
        return Err(s.error("history", "times that do not rise", "points with rising times"));
    }
    let driven = s.optional("displacement_control", &s.displacement_control);
    if let Some(d) = &driven {
        d.check("from", d.from, |t| t >= 0.0, "0 or more")?;
    }
    let driven = driven.map(|d| [d.from.si, d.speed.si]);
    Ok(Some(Servo { direction: along, force: points, max_speed: s.max_speed.si, gain, driven }))
}

/// Each pulse uses [`POINTS`] table points.
const MOST_PULSES: u32 = 1_000_000;
/// Linear interpolation errs by at most 0.5 % of the amplitude.
const POINTS: u32 = 32;

fn haversines(pulses: &Table<Pulses>, force: f64) -> Result<Vec<[f64; 2]>, SceneError> {
    pulses.check("peak", pulses.peak, |v| v >= 0.0 && v.is_finite(), "0 or more")?;
    pulses.check("frequency", pulses.frequency, |f| f > 0.0, "above 0")?;
    let expected = format!("1 to {MOST_PULSES}");
    pulses.check(
        "count",
        f64::from(pulses.count),
        |n| (1.0..=f64::from(MOST_PULSES)).contains(&n),
        &expected,
    )?;
    let start = pulses.start.map_or(0.0, |t| t.si);
    pulses.check("start", start, |t| t >= 0.0, "0 or more")?;
    let point = |k: u32| {
        let phase = f64::from(k) / f64::from(POINTS);
        let height = 0.5 * (1.0 - libm::cos(std::f64::consts::TAU * phase));
        [start + phase / pulses.frequency.si, force * (1.0 + (pulses.peak - 1.0) * height)]
    };
    Ok((0..=pulses.count * POINTS).map(point).collect())
}

pub(super) fn body(
    wall: &Table<Wall>,
    shape: &WallShape,
    water: Option<&Water>,
) -> Result<Option<RigidBody>, SceneError> {
    let Some(b) = wall.optional("body", &wall.body) else { return Ok(None) };
    if wall.kind == WallKind::Plane {
        return Err(wall.conflict("body", kinds(&[WallKind::Plane])));
    }
    let round = !matches!(wall.kind, WallKind::Triangles | WallKind::Mesh);
    let idle = round && b.inertia.is_none() && b.spin.is_some();
    let idle_rounding = [("rounding", round && b.rounding.is_some())];
    b.reject_without(idle_rounding, &kinds(&[WallKind::Triangles, WallKind::Mesh]))?;
    b.check("rounding", b.rounding, |r| r > 0.0, "a radius above 0")?;
    b.reject_without([("spin", idle)], "`inertia`")?;
    b.check("mass", b.mass, |m| m > 0.0, "a mass above 0")?;
    let mut fixed = [false; 6];
    for motion in &b.hold {
        let k = match motion {
            HeldMotion::X => 0,
            HeldMotion::Y => 1,
            HeldMotion::Z => 2,
            HeldMotion::Rx => 3,
            HeldMotion::Ry => 4,
            HeldMotion::Rz => 5,
        };
        fixed[k] = true;
    }
    Ok(Some(RigidBody {
        mass: b.mass.si,
        centre: b.centre.map(|c| Vec3::from(vector(&c))),
        inertia: b.inertia,
        velocity: b.velocity.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v))),
        spin: b.spin.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v))),
        fixed,
        mount: mount(&b, fixed)?,
        rounding: b.rounding.map(|r| r.si),
        water: afloat::water(wall, &b, shape, water)?,
        propulsion: afloat::propulsion(&b)?,
    }))
}

fn mount(body: &Table<Body>, fixed: [bool; 6]) -> Result<Option<Mount>, SceneError> {
    let Some(m) = body.optional("mount", &body.mount) else { return Ok(None) };
    let good = |x: f64| x >= 0.0 && x.is_finite();
    let three = |key: &'static str, given: Option<[f64; 3]>| {
        for (d, x) in given.into_iter().flatten().enumerate() {
            m.check(key, x, good, "0 or more")?;
            if fixed[d] && x != 0.0 {
                let expected = format!("0 along {}, which the body holds", ["x", "y", "z"][d]);
                return Err(m.error(key, x.to_string(), &expected));
            }
        }
        Ok(given.map(Vec3::from))
    };
    let mass = body.mass.si;
    let stiffness = match (
        three("stiffness", m.stiffness.map(|k| vector(&k)))?,
        three("frequency", m.frequency.map(|f| vector(&f)))?,
    ) {
        (Some(k), None) => k,
        (None, Some(f)) => f.map(|f| mass * (std::f64::consts::TAU * f).powi(2)),
        (None, None) => {
            return Err(m.missing("stiffness", "three stiffnesses, or three frequencies by `frequency`"));
        }
        _ => return Err(m.conflict("frequency", "`stiffness`")),
    };
    let damping =
        match (three("damping", m.damping.map(|c| vector(&c)))?, three("damping_ratio", m.damping_ratio)?) {
            (Some(c), None) => c,
            (None, Some(share)) => share.component_mul(&stiffness.map(|k| 2.0 * (k * mass).sqrt())),
            (None, None) => Vec3::zeros(),
            _ => return Err(m.conflict("damping_ratio", "`damping`")),
        };
    Ok(Some(Mount { stiffness, damping }))
}
