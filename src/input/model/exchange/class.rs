//! Contact classes (material pairs) and the stability of their coupling.

use serde::{Deserialize, Serialize};
use trackbed_coupling::interface_stability::InterfaceStabilityNumbers;
use trackbed_coupling::scheme::Scheme;
use trackbed_coupling::stability::{ContactStabilityNumbers, EffectiveMasses, largest_stable_d};

/// Default θ with meshed sleepers. At 0.5 stiff unresolved oscillations are undamped, and dashpots that lag
/// by one window amplify them.
pub(super) const WITH_SLEEPERS: f64 = 0.6;

/// Contacts between a grain material and a material of the solid.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ContactClass {
    /// Grain material.
    pub grains: String,
    /// Material of the solid.
    pub solid: String,
    /// Contact stiffness Kₙ [N/m].
    pub stiffness: f64,
    /// Damping ratio ζ with the grain mass only.
    pub damping_ratio: f64,
    /// Effective nodal masses at the surface [kg].
    pub masses: EffectiveMasses,
    /// Smallest and largest grain mass [kg].
    pub stones: [f64; 2],
    /// Damping ratio ζ' of the lightest and heaviest grain at the lightest point.
    pub pair_damping: [f64; 2],
    /// W at the lightest point.
    pub w: f64,
    /// Limit of W.
    pub w_limit: f64,
    /// D of the heaviest grain at the lightest point.
    pub d: f64,
    /// Limit of D, if any.
    pub d_limit: Option<f64>,
    /// W and D of a dense grain layer, Ω of its lightest grain.
    pub numbers: InterfaceStabilityNumbers,
}

impl ContactClass {
    /// Returns W or D over its limit; unstable above 1.
    pub fn excess(&self) -> f64 {
        (self.w / self.w_limit).max(self.d_limit.map_or(0.0, |limit| self.d / limit))
    }

    /// Returns a one-line description.
    pub fn line(&self) -> String {
        let limit = |v: f64| if v < 1e-12 { "0".into() } else { format!("{v:.2}") };
        // A mesh may lack corner or mid-side nodes.
        let mass = |v: f64| if v.is_finite() { format!("{v:.3e}") } else { "none".into() };
        format!(
            "{} on {}: K = {:.3e} N/m, zeta = {:.2}; effective nodal mass {} kg at a corner, {} at a \
             side, {} in the middle, {} at the border; stones {:.3e} to {:.3e} kg{}; W = {:.3} (at most {}), D = \
             {:.3}{}; dense layer: W = {:.3}, D = {:.3}; phase of undamped contacts {:.3}",
            self.grains,
            self.solid,
            self.stiffness,
            self.damping_ratio,
            mass(self.masses.corner),
            mass(self.masses.side),
            mass(self.masses.middle),
            mass(self.masses.border),
            self.stones[0],
            self.stones[1],
            if self.stones[0] < 0.3 * self.masses.least() {
                " (some below 0.3 of the nodal mass)"
            } else {
                ""
            },
            self.w,
            limit(self.w_limit),
            self.d,
            self.d_limit.map_or(String::new(), |l| format!(" (limit {l})")),
            self.numbers.stiffness,
            self.numbers.damping,
            self.numbers.phase,
        )
    }
}

impl ContactClass {
    /// Scales from windows of 1 s to `window` [s].
    pub fn at(&self, window: f64) -> ContactClass {
        ContactClass {
            w: window * self.w,
            d: window * self.d,
            numbers: self.numbers.at(window),
            ..self.clone()
        }
    }
}

/// Returns the largest W and D of all classes.
pub fn stability(classes: &[ContactClass]) -> ContactStabilityNumbers {
    ContactStabilityNumbers {
        stiffness: classes.iter().map(|c| c.w).fold(0.0, f64::max),
        damping: classes.iter().map(|c| c.d).fold(0.0, f64::max),
    }
}

/// Ratio of grain mass to effective nodal mass above which deflected faces cause several contacts without a
/// potential. Impacts at 0.5 to 5 m/s within all limits err by up to 25 % above 220, at most 3 % below
/// (predicted scheme).
const HEAVY: f64 = 200.0;

fn heavy(c: &ContactClass) -> Option<String> {
    let ratio = c.stones[1] / c.masses.least();
    (ratio > HEAVY).then(|| {
        format!(
            "{} on {}: grain mass {:.3e} kg is {ratio:.0} times the smallest effective nodal mass (limit {HEAVY}). Hard impacts may contact several faces at once; the energy error grows. Use larger elements or a wider transfer.spread.",
            c.grains, c.solid, c.stones[1]
        )
    })
}

/// Returns warnings about classes beyond their limits.
pub fn remarks(classes: &[ContactClass], scheme: Scheme, substeps: u32) -> Vec<String> {
    let beyond = classes.iter().filter(|c| c.excess() > 1.0);
    let heavy = classes.iter().filter_map(heavy);
    beyond
        .map(|c| {
            let fitting = (f64::from(substeps) / c.excess()) as u32;
            // Only meshed sleepers have a lower limit.
            let lax = c.d > c.d_limit.unwrap_or(f64::INFINITY) && c.d <= largest_stable_d(scheme);
            let fewer = match fitting {
                _ if lax => {
                    let theta = (20.0 * (0.5 + 0.25 * c.d)).ceil() / 20.0;
                    format!("Set coupling.theta = {:.2}", theta.max(WITH_SLEEPERS))
                }
                0 => "coupling.substeps = 1 is not sufficient".into(),
                1.. => format!("Set coupling.substeps = {fitting} (or \"auto\")"),
            };
            let other = match scheme {
                Scheme::Lagged => ", scheme = \"predicted\"",
                Scheme::Predicted => ", scheme = \"stiffened\" or \"iterated\", a wider transfer.spread",
                Scheme::Stiffened => ", scheme = \"iterated\"",
                Scheme::Iterated { .. } => "",
            };
            let damping = c.d_limit.map_or(String::new(), |limit| format!(", D = {:.2} (limit {limit})", c.d));
            let may = if scheme == Scheme::Lagged { "unstable or inaccurate in energy" } else { "unstable" };
            format!(
                "{} on {}: coupling may be {may}: W = {:.2} (limit {:.2}){damping}. {fewer}{other}, or softer contacts.",
                c.grains, c.solid, c.w, c.w_limit
            )
        })
        .chain(heavy)
        .chain(undamped(classes, scheme))
        .collect()
}

/// The staggered scheme adds energy to undamped contacts at rest, whatever the window.
fn undamped(classes: &[ContactClass], scheme: Scheme) -> Option<String> {
    let found = classes.iter().find(|c| scheme == Scheme::Lagged && c.numbers.phase > 0.0)?;
    Some(format!(
        "{} on {}: undamped tangential contacts at rest gain energy in every window under coupling.scheme = \"lagged\". Set scheme = \"predicted\", or tangential_damping_ratio = 0.1.",
        found.grains, found.solid
    ))
}
