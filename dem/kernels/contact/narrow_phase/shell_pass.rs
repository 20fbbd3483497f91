//! Forces of wall–wall contacts (`shell.rs`).

use super::dilated::DEEPEST;
use super::handler::combine;
use super::pair::{ContactView, share};
use super::shell::WallContactList;
use crate::base::Vec3;
use crate::base::balance_terms::BalanceTerms;
use crate::bodies::block::PointMotion;
use crate::bodies::sums::WallSum;
use crate::contact::scalar;
use crate::law::Laws;
use crate::pairs::list::ContactHistory;
use crate::pairs::wall_history::WallContactHistory;
use crate::spatial::patchwork::WallView;

/// Two walls: first triangulated, second numbered.
pub struct Two<'a> {
    pub walls: [&'a WallView; 2],
    pub other: u32,
}

impl Two<'_> {
    fn materials(&self) -> [u32; 2] {
        self.walls.map(|w| w.material)
    }

    /// Assigns laws to contacts.
    fn settle(&self, laws: &Laws, found: &mut WallContactList) {
        let materials = self.materials();
        found.touches.iter_mut().for_each(|t| t.under(laws, materials));
        share(laws, &mut found.touches);
    }

    fn motions(&self, point: &Vec3) -> [PointMotion; 2] {
        self.walls.map(|w| PointMotion::of_whole(&w.velocity, &w.spin, point - w.centre, w.inverse_mass))
    }

    /// Forces on others over `dt` [s]; returns excessive overlap and its limit [m].
    pub fn forces(
        &self,
        (laws, dt): (&Laws, f64),
        found: &mut WallContactList,
        (old, new): (&[WallContactHistory], &mut Vec<WallContactHistory>),
        [first, second]: [&mut WallSum; 2],
        balance: &mut BalanceTerms,
    ) -> Option<[f64; 2]> {
        self.settle(laws, found);
        let mut deep = None;
        for travel_since_search in old.iter().filter(|m| found.names.binary_search(&m.name).is_err()) {
            let own = self.materials();
            let materials = laws.edges(own).filter(|_| travel_since_search.memory.edge).unwrap_or(own);
            let mut history = travel_since_search.memory.history;
            balance.dissipated_friction +=
                travel_since_search.memory.weight * scalar::end(laws, materials, &mut history);
        }
        for (name, touch) in found.names.iter().zip(&found.touches) {
            let g = &touch.geometry;
            let mut memory = known(old, name).copied().unwrap_or(ContactHistory::FRESH);
            memory.edge = touch.edge > 0.0;
            balance.dissipated_friction += combine(laws, touch.materials, g, &mut memory, touch.weight);
            let [own, its] = self.motions(&g.point);
            let ends = (&own, &its);
            let before = memory.history;
            let f =
                scalar::between(laws, touch.materials, None, g, ends, touch.share, &mut memory.history, dt);
            let (w, force) = (touch.weight, f.force * touch.weight);
            let couple = touch.couple * force.dot(&g.normal);
            first.force -= force;
            first.moment -= f.torque_a * w + couple;
            second.force += force;
            second.moment -= f.torque_b * w - couple;
            balance.dissipated_dashpot += f.dashpot * w;
            balance.dissipated_friction += f.friction * w;
            if self.walls[1].driven {
                let [a, b] = touch.materials;
                let stiffness = w * laws.stiffness(a, b, g.overlap, g.radius);
                second.stiffness += stiffness;
                second.damping += w.signum() * (stiffness.abs() / own.inverse_mass()).sqrt();
                let memory = [&before, &memory.history];
                scalar::add_dashpot(&mut second.dashpots, laws, touch.materials, g, memory, &f.force, w);
            }
            if g.overlap > touch.bound && w > 0.0 && deep.is_none() {
                deep = Some([g.overlap.min(touch.bound / DEEPEST), touch.bound]);
            }
            new.push(WallContactHistory { other: self.other, name: *name, memory });
        }
        deep
    }

    pub fn visit(
        &self,
        laws: &Laws,
        found: &mut WallContactList,
        memory: &[WallContactHistory],
        f: &mut dyn FnMut(&ContactView<'_>),
    ) {
        self.settle(laws, found);
        for (name, touch) in found.names.iter().zip(&found.touches) {
            let [own, its] = self.motions(&touch.geometry.point);
            f(&ContactView {
                geometry: touch.geometry,
                weight: touch.weight,
                velocity: own.at_point() - its.at_point(),
                inverse_mass: (own.inverse_mass() + its.inverse_mass()) * touch.share,
                history: &known(memory, name).unwrap_or(&ContactHistory::FRESH).history,
                spin: own.spin() - its.spin(),
                materials: touch.materials,
                friction: None,
            });
        }
    }
}

fn known<'a>(of: &'a [WallContactHistory], name: &[u32; 2]) -> Option<&'a ContactHistory> {
    let at = of.binary_search_by_key(name, |m| m.name).ok()?;
    Some(&of[at].memory)
}
