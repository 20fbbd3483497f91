//! Kinds of bonds: stiffness, strength, damping.

use crate::scene::bonds::{BondTable, CriterionName, FaceTable, Parallel};
use crate::scene::units::{Angle, Quantity, Stress};
use crate::scene::{SceneError, Table};
use trackbed_dem::bond::{
    Bond, BondDamping, ContactPoint, Criterion, DirectBond, FaceBond, ParallelBond, ParallelStiffness,
    ShearStrength,
};

pub(super) fn kind(table: &Table<BondTable>) -> Result<Bond, SceneError> {
    let damping = match (table.damping, table.damping_coefficients) {
        (Some(f), None) => {
            table.check("damping", f, |f| f >= 0.0, "0 or more")?;
            BondDamping::Fraction(f)
        }
        (None, Some(c)) => {
            for x in c {
                table.check("damping_coefficients", x, |c| c >= 0.0, "0 or more each")?;
            }
            BondDamping::Coefficients(c)
        }
        (None, None) => BondDamping::None,
        _ => {
            return Err(table.conflict("damping", "`damping_coefficients`"));
        }
    };
    let contact = table.contact;
    let criterion = |c| match c {
        CriterionName::Stress => Criterion::Stress,
        CriterionName::Sum => Criterion::Sum,
    };
    match (&table.parallel, &table.contact_point, &table.direct, &table.face) {
        (Some(p), None, None, None) => {
            let bond = parallel(&table.below("parallel", p))?;
            Ok(Bond::Parallel(ParallelBond { criterion: criterion(p.criterion), damping, contact, ..bond }))
        }
        (None, Some(p), None, None) => {
            let p = table.below("contact_point", p);
            p.check("normal_stiffness", p.normal_stiffness, above_zero, "above 0")?;
            p.check("shear_stiffness", p.shear_stiffness, |k| k >= 0.0, "0 or more")?;
            p.check("tension_limit", p.tension_limit, above_zero, "above 0")?;
            p.check("shear_limit", p.shear_limit, above_zero, "above 0")?;
            Ok(Bond::ContactPoint(ContactPoint {
                normal: p.normal_stiffness.si,
                shear: p.shear_stiffness.si,
                tension_limit: p.tension_limit.map_or(f64::INFINITY, |f| f.si),
                shear_limit: p.shear_limit.map_or(f64::INFINITY, |f| f.si),
                damping,
                contact,
            }))
        }
        (None, None, Some(d), None) => {
            let d = table.below("direct", d);
            d.check("stiffness", d.stiffness[0], above_zero, "a first number above 0")?;
            for k in d.stiffness {
                d.check("stiffness", k, |k| k >= 0.0, "0 or more each")?;
            }
            for s in d.strength.iter().flatten() {
                d.check("strength", *s, above_zero, "above 0 each")?;
            }
            Ok(Bond::Direct(DirectBond {
                stiffness: d.stiffness,
                strength: d.strength.unwrap_or([f64::INFINITY; 4]),
                criterion: criterion(d.criterion),
                damping,
                contact,
            }))
        }
        (None, None, None, Some(f)) => {
            let bond = face(&table.below("face", f))?;
            Ok(Bond::Face(FaceBond { criterion: criterion(f.criterion), damping, ..bond }))
        }
        _ => Err(table.one_of(&[
            ("parallel", table.parallel.is_some()),
            ("contact_point", table.contact_point.is_some()),
            ("direct", table.direct.is_some()),
            ("face", table.face.is_some()),
        ])),
    }
}

/// Zero strength: the bond breaks at the first load [Pa].
const NO_STRENGTH: f64 = 1e-9;

fn above_zero(x: f64) -> bool {
    x > 0.0
}

fn parallel(p: &Table<Parallel>) -> Result<ParallelBond, SceneError> {
    p.check("radius_factor", p.radius_factor, above_zero, "above 0")?;
    p.check("young", p.young, above_zero, "above 0")?;
    p.check("stiffness_ratio", p.stiffness_ratio, above_zero, "above 0")?;
    p.check("normal_stiffness", p.normal_stiffness, above_zero, "above 0")?;
    p.check("shear_stiffness", p.shear_stiffness, |k| k >= 0.0, "0 or more")?;
    p.check("tensile_strength", p.tensile_strength, |s| s >= 0.0, "0 or more")?;
    p.check("moment_factor", p.moment_factor, |b| (0.0..=1.0).contains(&b), "0 to 1")?;
    let stiffness = match (p.young, p.stiffness_ratio, p.normal_stiffness, p.shear_stiffness) {
        (Some(young), ratio, None, None) => {
            ParallelStiffness::Modulus { young: young.si, ratio: ratio.unwrap_or(1.0) }
        }
        (None, None, Some(normal), Some(shear)) => ParallelStiffness::PerArea { normal, shear },
        _ => {
            let expected = "`young` (with `stiffness_ratio`), or `normal_stiffness` and `shear_stiffness`";
            return Err(p.error("young", "another set of stiffnesses", expected));
        }
    };
    let shear_strength = shear_strength(p, p.shear_strength, p.friction_angle)?;
    Ok(ParallelBond {
        radius_factor: p.radius_factor.unwrap_or(1.0),
        stiffness,
        tensile_strength: strength(p.tensile_strength),
        shear_strength,
        moment_factor: p.moment_factor.unwrap_or(1.0),
        criterion: Criterion::Stress,
        damping: BondDamping::None,
        contact: false,
    })
}

fn face(f: &Table<FaceTable>) -> Result<FaceBond, SceneError> {
    f.check("young", f.young, above_zero, "above 0")?;
    f.check("stiffness_ratio", f.stiffness_ratio, above_zero, "above 0")?;
    f.check("tensile_strength", f.tensile_strength, |s| s >= 0.0, "0 or more")?;
    Ok(FaceBond {
        young: f.young.si,
        ratio: f.stiffness_ratio.unwrap_or(2.5),
        tensile_strength: strength(f.tensile_strength),
        shear_strength: shear_strength(f, f.shear_strength, f.friction_angle)?,
        criterion: Criterion::Stress,
        damping: BondDamping::None,
    })
}

fn strength(given: Option<Quantity<Stress>>) -> f64 {
    given.map_or(f64::INFINITY, |s| s.si.max(NO_STRENGTH))
}

fn shear_strength<T>(
    table: &Table<T>,
    given: Option<Quantity<Stress>>,
    friction_angle: Option<Quantity<Angle>>,
) -> Result<ShearStrength, SceneError> {
    table.check("shear_strength", given, |s| s >= 0.0, "0 or more")?;
    let angle = friction_angle.map(|a| a.si);
    let usual = |a| (0.0..std::f64::consts::FRAC_PI_2).contains(&a);
    table.check("friction_angle", angle, usual, "0 or more, below 90 deg")?;
    let shear = strength(given);
    match angle {
        Some(a) if given.is_some() => {
            Ok(ShearStrength::MohrCoulomb { cohesion: shear, friction: libm::tan(a) })
        }
        Some(_) => Err(table.requirement("friction_angle", "`shear_strength`")),
        None => Ok(ShearStrength::Constant(shear)),
    }
}
