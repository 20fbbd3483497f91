//! Kinds of bonds: stiffness, strength, damping.

use crate::model::grains::check::check;
use crate::scene::bonds::{BondTable, CriterionName, Parallel};
use crate::scene::{Document, SceneError};
use trackbed_dem::bond::{
    Bond, BondDamping, ContactPoint, Criterion, DirectBond, ParallelBond, ParallelStiffness, ShearStrength,
};

/// The kind of bond that table `i` describes.
pub(super) fn kind(document: &Document, i: usize, table: &BondTable) -> Result<Bond, SceneError> {
    let key = |k: &str| format!("bond.{i}.{k}");
    let damping = match (table.damping, table.damping_coefficients) {
        (Some(f), None) => {
            check(document, &key("damping"), Some(f), |f| f >= 0.0, "0 or more")?;
            BondDamping::Fraction(f)
        }
        (None, Some(c)) => {
            for x in c {
                check(document, &key("damping_coefficients"), Some(x), |c| c >= 0.0, "0 or more each")?;
            }
            BondDamping::Coefficients(c)
        }
        (None, None) => BondDamping::None,
        _ => {
            let expected = "`damping` or `damping_coefficients`, not both";
            return Err(document.error(&key("damping"), "two kinds of damping", expected));
        }
    };
    let contact = table.contact;
    let criterion = |c| match c {
        CriterionName::Stress => Criterion::Stress,
        CriterionName::Sum => Criterion::Sum,
    };
    match (&table.parallel, &table.contact_point, &table.direct) {
        (Some(p), None, None) => {
            let bond = parallel(document, &key("parallel"), p)?;
            Ok(Bond::Parallel(ParallelBond { criterion: criterion(p.criterion), damping, contact, ..bond }))
        }
        (None, Some(p), None) => {
            let positive = |k: &str, x: Option<f64>| {
                check(document, &key(&format!("contact_point.{k}")), x, |x| x > 0.0, "above 0")
            };
            positive("normal_stiffness", Some(p.normal_stiffness.si))?;
            let shear = Some(p.shear_stiffness.si);
            check(document, &key("contact_point.shear_stiffness"), shear, |k| k >= 0.0, "0 or more")?;
            positive("tension_limit", p.tension_limit.map(|f| f.si))?;
            positive("shear_limit", p.shear_limit.map(|f| f.si))?;
            Ok(Bond::ContactPoint(ContactPoint {
                normal: p.normal_stiffness.si,
                shear: p.shear_stiffness.si,
                tension_limit: p.tension_limit.map_or(f64::INFINITY, |f| f.si),
                shear_limit: p.shear_limit.map_or(f64::INFINITY, |f| f.si),
                damping,
                contact,
            }))
        }
        (None, None, Some(d)) => {
            let stiffness = key("direct.stiffness");
            check(document, &stiffness, Some(d.stiffness[0]), |k| k > 0.0, "a first number above 0")?;
            for k in d.stiffness {
                check(document, &stiffness, Some(k), |k| k >= 0.0, "0 or more each")?;
            }
            for s in d.strength.iter().flatten() {
                check(document, &key("direct.strength"), Some(*s), |s| s > 0.0, "above 0 each")?;
            }
            Ok(Bond::Direct(DirectBond {
                stiffness: d.stiffness,
                strength: d.strength.unwrap_or([f64::INFINITY; 4]),
                criterion: criterion(d.criterion),
                damping,
                contact,
            }))
        }
        _ => Err(document.error(
            &format!("bond.{i}"),
            "another number of kinds",
            "exactly one of `parallel`, `contact_point` and `direct`",
        )),
    }
}

fn parallel(document: &Document, table: &str, p: &Parallel) -> Result<ParallelBond, SceneError> {
    let key = |k: &str| format!("{table}.{k}");
    let positive = |k: &str, x: Option<f64>| check(document, &key(k), x, |x| x > 0.0, "above 0");
    positive("radius_factor", p.radius_factor)?;
    positive("young", p.young.map(|x| x.si))?;
    positive("stiffness_ratio", p.stiffness_ratio)?;
    positive("normal_stiffness", p.normal_stiffness)?;
    check(document, &key("shear_stiffness"), p.shear_stiffness, |k| k >= 0.0, "0 or more")?;
    positive("tensile_strength", p.tensile_strength.map(|x| x.si))?;
    positive("shear_strength", p.shear_strength.map(|x| x.si))?;
    let angle = p.friction_angle.map(|a| a.si);
    check(
        document,
        &key("friction_angle"),
        angle,
        |a| (0.0..std::f64::consts::FRAC_PI_2).contains(&a),
        "0 or more, below 90 deg",
    )?;
    check(document, &key("moment_factor"), p.moment_factor, |b| (0.0..=1.0).contains(&b), "0 to 1")?;
    let stiffness = match (p.young, p.stiffness_ratio, p.normal_stiffness, p.shear_stiffness) {
        (Some(young), ratio, None, None) => {
            ParallelStiffness::Modulus { young: young.si, ratio: ratio.unwrap_or(1.0) }
        }
        (None, None, Some(normal), Some(shear)) => ParallelStiffness::PerArea { normal, shear },
        _ => {
            let expected = "`young` (with `stiffness_ratio`), or `normal_stiffness` and `shear_stiffness`";
            return Err(document.error(&key("young"), "another set of stiffnesses", expected));
        }
    };
    let shear = p.shear_strength.map_or(f64::INFINITY, |s| s.si);
    let shear_strength = match angle {
        Some(a) if p.shear_strength.is_some() => {
            ShearStrength::MohrCoulomb { cohesion: shear, friction: a.tan() }
        }
        Some(_) => {
            return Err(document.error(&key("friction_angle"), "a value", "a `shear_strength` beside it"));
        }
        None => ShearStrength::Constant(shear),
    };
    Ok(ParallelBond {
        radius_factor: p.radius_factor.unwrap_or(1.0),
        stiffness,
        tensile_strength: p.tensile_strength.map_or(f64::INFINITY, |s| s.si),
        shear_strength,
        moment_factor: p.moment_factor.unwrap_or(1.0),
        criterion: Criterion::Stress,
        damping: BondDamping::None,
        contact: false,
    })
}
