//! Coordination numbers and fabric.
//!
//! Theory manual: equation (3.14) of `docs/theory/motion.md`.

use super::contacts::ContactRecord;
use crate::base::error::Partner;
use crate::engine::model::Model;
use crate::engine::state::State;

/// Coordination from loaded contacts; a clump, wall or surface is one neighbour.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coordination {
    /// Mean number of neighbours of free bodies.
    pub mean: f64,
    /// Mechanical coordination number (Thornton 2000), without rattlers and their contacts.
    pub mechanical: f64,
    /// Fraction of free bodies with at most one neighbour.
    pub rattlers: f64,
    /// Number of free bodies with 0, 1, 2, … neighbours.
    pub distribution: Vec<usize>,
}

/// Number of neighbours of each body. Shape `[bodies]`.
pub fn neighbours(model: &Model, contacts: &[ContactRecord]) -> Vec<u32> {
    let mut pairs: Vec<(usize, u8, usize)> = Vec::with_capacity(2 * contacts.len());
    for c in contacts.iter().filter(|c| c.normal_force > 0.0) {
        match c.b {
            Partner::Body(b) => pairs.extend([(c.a, 0, b), (b, 0, c.a)]),
            Partner::Plane(k) => pairs.push((c.a, 1, k)),
            Partner::Triangle(k) => pairs.push((c.a, 2, k as usize)),
            Partner::Wall(k) => pairs.push((c.a, 3, k as usize)),
            Partner::Patch(k) => pairs.push((c.a, 4, k as usize)),
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    let mut count = vec![0; model.body_count()];
    pairs.iter().for_each(|p| count[p.0] += 1);
    count
}

/// Coordination of selected bodies; all count as neighbours.
pub fn coordination_of(
    model: &Model,
    state: &State,
    contacts: &[ContactRecord],
    counted: impl Fn(usize) -> bool,
) -> Coordination {
    let counts = neighbours(model, contacts);
    let free = |&body: &usize| state.present(body) && model.body(body).inverse_mass > 0.0 && counted(body);
    let mut distribution = Vec::new();
    for n in (0..model.body_count()).filter(free).map(|body| counts[body] as usize) {
        if distribution.len() <= n {
            distribution.resize(n + 1, 0);
        }
        distribution[n] += 1;
    }
    let bodies: usize = distribution.iter().sum();
    let total: usize = distribution.iter().enumerate().map(|(n, count)| n * count).sum();
    let idle: usize = distribution.iter().take(2).sum();
    let single = distribution.get(1).copied().unwrap_or(0);
    let ratio = |a: usize, b: usize| if b > 0 { a as f64 / b as f64 } else { 0.0 };
    Coordination {
        mean: ratio(total, bodies),
        mechanical: ratio(total - single, bodies - idle),
        rattlers: ratio(idle, bodies),
        distribution,
    }
}

/// Fabric tensor (Satake 1982): mean n ⊗ n of loaded, selected contacts, as xx, yy, zz, xy, yz, zx [-]. Trace
/// 1, or zero without contacts.
pub fn fabric(contacts: &[ContactRecord], counted: impl Fn(&ContactRecord) -> bool) -> [f64; 6] {
    let mut sum = [0.0; 6];
    let mut count = 0;
    for c in contacts.iter().filter(|c| c.normal_force > 0.0 && counted(c)) {
        let n = &c.normal;
        let products = [n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.y * n.z, n.z * n.x];
        sum.iter_mut().zip(products).for_each(|(s, p)| *s += p);
        count += 1;
    }
    sum.map(|s| if count > 0 { s / f64::from(count) } else { 0.0 })
}

/// Contacts of above-mean normal force (Radjai, Wolf, Jean & Moreau 1998).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StrongNetwork {
    /// Mean normal force of loaded contacts [N].
    pub mean_force: f64,
    /// Fraction of contacts above the mean [-].
    pub contacts: f64,
    /// Their fraction of the total normal force [-].
    pub load: f64,
}

/// Returns the strong force network.
pub fn strong_network(contacts: &[ContactRecord]) -> StrongNetwork {
    let forces = || contacts.iter().map(|c| c.normal_force).filter(|f| *f > 0.0);
    let (count, sum) = forces().fold((0_usize, 0.0), |(n, s), f| (n + 1, s + f));
    if count == 0 {
        return StrongNetwork::default();
    }
    let mean_force = sum / count as f64;
    let (strong, carried) =
        forces().filter(|f| *f > mean_force).fold((0_usize, 0.0), |(n, s), f| (n + 1, s + f));
    StrongNetwork { mean_force, contacts: strong as f64 / count as f64, load: carried / sum }
}

/// Unbalanced-force ratio [-]: mean |contact forces + weight| of free bodies over mean |contact force|.
/// Infinite without contacts.
pub fn unbalanced_ratio(model: &Model, state: &State, contacts: &[ContactRecord]) -> f64 {
    let mut net: Vec<crate::Vec3> =
        (0..model.body_count()).map(|b| model.gravity() * model.mass(b)).collect();
    let mut carried = 0.0;
    for c in contacts {
        net[c.a] += c.force;
        if let Partner::Body(b) = c.b {
            net[b] -= c.force;
        }
        carried += c.force.norm();
    }
    if carried <= 0.0 {
        return f64::INFINITY;
    }
    let mut sum = 0.0;
    let mut free = 0;
    for (b, (force, body)) in net.iter().zip(model.bodies.iter()).enumerate() {
        if state.present(b) && body.inverse_mass > 0.0 {
            // The support balances fixed directions.
            let d = |k: usize| if body.fixed >> k & 1 == 1 { 0.0 } else { force[k] * force[k] };
            sum += (d(0) + d(1) + d(2)).sqrt();
            free += 1;
        }
    }
    if free == 0 { 0.0 } else { (sum / f64::from(free)) / (carried / contacts.len() as f64) }
}
