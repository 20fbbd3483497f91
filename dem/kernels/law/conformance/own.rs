//! Shipped laws written as formulas: the same forces to the last bit.

use super::{GLASS, History, MASS, Path, SOFT, law};
use crate::law::composed::Composed;
use crate::law::contact_law::ContactLaw;
use crate::law::formula::{Formula, MEMORY, MODULUS, STIFFNESS, Texts};
use crate::law::formula_check::verify;
use crate::law::formula_law::FormulaLaw;
use crate::law::material::{Material, Pair};
use crate::law::mindlin::Mindlin;
use crate::law::spring::Spring;
use crate::law::table::{HertzLaw, LinearLaw};
use crate::law::walton_braun::WaltonBraun;
use std::collections::BTreeMap;

const LINEAR: Texts<'_> = Texts {
    force: "K*d",
    damping: Some("c = 2*zeta*sqrt(K); x = 0.5*c*dt*sqrt(w); c*(4 + x)/(sqrt(w)*(4 + 3*x))"),
    energy: Some("0.5*K*d*d"),
    loss: None,
};
const HERTZ: Texts<'_> = Texts {
    force: "t = 2*E*sqrt(R*d); 2/3*t*d",
    damping: Some(
        "t = 2*E*sqrt(R*d); c = 1.8257418583505538*zeta*sqrt(t*w); x = 0.5*dt*c; c*(4 + x)/(w*(4 + 3*x))",
    ),
    energy: None,
    loss: None,
};
const WALTON_BRAUN: Texts<'_> = Texts {
    force: "K*D - K/(e*e)*(D - d)",
    damping: None,
    energy: Some("f = max(K*D - K/(e*e)*(D - d), 0); 0.5*f*f/(K/(e*e))"),
    loss: Some("0.5*K*(1 - e*e)*(D*D - D0*D0)"),
};

fn formula(texts: &Texts<'_>) -> Formula {
    Formula::parse("own", texts, &BTreeMap::new()).unwrap()
}

fn material(texts: &Texts<'_>, like: Material) -> Material {
    Material { formula: Some(formula(texts).kept()), ..like }
}

pub(super) fn linear() -> Material {
    material(&LINEAR, SOFT)
}

pub(super) fn hertz() -> Material {
    material(&HERTZ, GLASS)
}

pub(super) fn memory() -> Material {
    material(&WALTON_BRAUN, SOFT)
}

/// Formulas of a row of laws, if it has any.
pub(super) fn of_row(normal: &str) -> Option<&'static Formula> {
    [linear(), hertz(), memory()].into_iter().filter_map(|m| m.formula).find(|f| f.law() == normal)
}

fn same<Shipped: ContactLaw, Own: ContactLaw>(own: &Material) {
    let (shipped, own) = (law::<Shipped>(own), law::<Own>(own));
    let dt = Path::USUAL.dt();
    let (mut a, mut b) = (History::NONE, History::NONE);
    for moment in Path::USUAL.moments() {
        let forces = (moment.evaluate(&shipped, &mut a, dt), moment.evaluate(&own, &mut b, dt));
        assert_eq!(forces.0, forces.1, "overlap {}", moment.geometry.overlap);
        assert_eq!(a, b);
        let (overlap, radius) = (moment.geometry.overlap, moment.geometry.radius);
        let energies = (shipped.stored(overlap, radius, &a).0, own.stored(overlap, radius, &b).0);
        assert!((energies.0 - energies.1).abs() <= 1e-10 * energies.0, "{energies:?}");
        let springs = (shipped.springs(overlap, radius, &a), own.springs(overlap, radius, &b));
        assert!((springs.0.0 - springs.1.0).abs() <= 1e-14 * springs.0.0.abs(), "{springs:?}");
    }
    assert!(MASS > 0.0 && !a.is_new());
}

#[test]
fn shipped_laws_as_formulas_have_their_bits() {
    same::<LinearLaw, Composed<FormulaLaw<STIFFNESS>, Spring>>(&linear());
    same::<HertzLaw, Composed<FormulaLaw<MODULUS>, Mindlin>>(&hertz());
    same::<Composed<WaltonBraun, Spring>, Composed<FormulaLaw<MEMORY>, Spring>>(&memory());
}

#[test]
fn expected_overlaps_match_hertz() {
    use crate::law::normal::Expected;
    let expected = Expected { density: 2600.0, speed: 1.0, gravity: 9.81, height: 0.3 };
    let shipped = law::<HertzLaw>(&hertz()).expected_overlap(&expected);
    let own = law::<Composed<FormulaLaw<MODULUS>, Mindlin>>(&hertz()).expected_overlap(&expected);
    assert!((own / shipped - 1.0).abs() < 1e-6, "{own} {shipped}");
}

#[test]
fn laws_are_verified() {
    for (texts, like, restitution) in [(LINEAR, SOFT, 0.5), (HERTZ, GLASS, 0.5), (WALTON_BRAUN, SOFT, 0.5)] {
        let material = Material { restitution, ..material(&texts, like) };
        let pair = Pair { a: &material, b: &material, exception: None };
        let verdict = verify(&formula(&texts), &pair).unwrap();
        println!("{verdict}");
        assert!((verdict.restitution - restitution).abs() < 0.01, "{verdict}");
    }
    for (texts, key, expected) in [
        (Texts { force: "K*d + 1", ..LINEAR }, "force", "at zero overlap"),
        (Texts { force: "K*d - 100*K*d*d/R", energy: None, ..LINEAR }, "force", "in first loading"),
        (Texts { energy: Some("0.6*K*d*d"), ..LINEAR }, "energy", "where loading takes"),
        (Texts { damping: Some("-0.1*sqrt(K/w)"), ..LINEAR }, "damping", "a closed cycle that gains"),
        (Texts { damping: Some("1e6"), ..LINEAR }, "damping", "a restitution of"),
        (Texts { loss: Some("0.1*K*(D*D - D0*D0)"), ..WALTON_BRAUN }, "loss", "are stated as dissipated"),
        (Texts { energy: Some("K*D*D"), ..WALTON_BRAUN }, "energy", "where loading takes"),
    ] {
        let material = material(&texts, SOFT);
        let pair = Pair { a: &material, b: &material, exception: None };
        let found = verify(&formula(&texts), &pair).unwrap_err();
        assert!(
            found.key == key && found.problem.contains(expected),
            "{found:?}\nexpected: {key}: {expected}"
        );
    }
}

#[test]
fn kinks_pass_without_energy() {
    let texts = Texts { force: "K*below(d, 1e-5, d, 2*d - 1e-5)", energy: None, ..LINEAR };
    let material = material(&texts, SOFT);
    verify(&formula(&texts), &Pair { a: &material, b: &material, exception: None }).unwrap();
}

#[test]
fn kinds_reject_formulas_without_use() {
    for (texts, key, expected) in [
        (Texts { force: "K*d + E*d", ..LINEAR }, "force", "found `K` and `E`"),
        (Texts { damping: Some("1"), ..WALTON_BRAUN }, "damping", "laws with `D` have no dashpot"),
        (Texts { energy: None, ..WALTON_BRAUN }, "energy", "found none"),
        (Texts { loss: None, ..WALTON_BRAUN }, "loss", "found none"),
        (Texts { loss: Some("D"), ..LINEAR }, "loss", "keeps no deformation"),
        (Texts { force: "dt*d", ..LINEAR }, "force", "unknown name `dt`"),
    ] {
        let error = Formula::parse("own", &texts, &BTreeMap::new()).unwrap_err();
        assert!(error.key == key && error.to_string().contains(expected), "{error:?}");
    }
}
