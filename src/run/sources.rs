//! Literature sources of a run.

use trackbed_fem::{Method, Regime};
use trackbed_input::model::solid::{Analysis, SolidPart, TimeMethod};

/// Returns the sources of a solid.
pub fn solid(part: &SolidPart, coupled: bool) -> Vec<&'static str> {
    let mut sources = vec![
        "elements: serendipity and linear kinds with mean dilatation, Zienkiewicz & Taylor, The Finite Element Method; Hughes \
         1980",
    ];
    if part.equations.takes_factor() {
        sources.push(Method::Direct.source(Regime::Statics));
    }
    for source in part.equations.used().map(|(regime, method)| method.source(regime)) {
        if !sources.contains(&source) {
            sources.push(source);
        }
    }
    match &part.analysis {
        _ if coupled => {
            sources.push("time integration of a window: mid-point form, Simo & Tarnow, ZAMP 43, 1992")
        }
        Analysis::Dynamic(TimeMethod::Hht(_)) => {
            sources.push("time integration: Hilber, Hughes & Taylor, Earthq. Eng. Struct. Dyn. 5, 1977");
        }
        Analysis::Dynamic(TimeMethod::Newmark(_)) => {
            sources.push("time integration: Newmark, J. Eng. Mech. Div. ASCE 85(3), 1959");
        }
        Analysis::StrengthReduction(_) => {
            sources.push("strength reduction: Griffiths & Lane, Geotechnique 49(3), 1999");
        }
        Analysis::Static | Analysis::QuasiStatic(_) => {}
    }
    if !part.model.is_linear() {
        sources.extend(part.model.law_sources());
    }
    if !part.model.matrices().dashpots().is_empty() {
        sources.push("absorbing boundaries: Lysmer & Kuhlemeyer, J. Eng. Mech. Div. ASCE 95, 1969");
    }
    sources
}

/// Sources of rails with mass.
pub const RAIL: [&str; 2] = [
    "rail: Euler-Bernoulli beam of cubic elements, Przemieniecki, Theory of Matrix Structural Analysis, 1968",
    "rail in time: average acceleration, Newmark, J. Eng. Mech. Div. ASCE 85(3), 1959",
];

/// Sources of bonds.
pub const BONDS: [&str; 1] =
    ["bonds: Potyondy & Cundall, Int. J. Rock Mech. Min. Sci. 41, 2004; Wang, Acta Geotechnica 4, 2009"];
