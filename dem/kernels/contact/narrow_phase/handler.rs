//! Search and forces of all pair types.

use super::pair::{ContactView, Manifold, PairContactPoint, ShapePair, View, Visited, share};
use super::scene::{BodyAccess, Configuration, Search};
use super::sheet::{self, SurfaceContactRef};
use super::side::{First, Renumbering, Second, Side, grown};
use crate::base::Vec3;
use crate::base::balance_terms::Impulse;
use crate::base::failure::Failure;
use crate::bodies::sums::WallSum;
use crate::contact::scalar::{self, StepContext};
use crate::lanes::vec4::Vec4;
use crate::law::scarring::Scar;
use crate::law::{ContactGeometry, Laws};
use crate::pairs::cross::SurfaceTotals;
use crate::pairs::list::{ContactHistory, PairList, PairName};
use std::ops::Range;

/// Contact results other than slots.
pub struct ContactTotals<'a> {
    /// Per pair: force on the first partner, both torques.
    pub slots: &'a mut [Vec4],
    /// Dashpot and sliding loss [J].
    pub dashpot: &'a mut f64,
    pub friction: &'a mut f64,
    /// Work [J] and impulse of planes.
    pub work_walls: &'a mut f64,
    pub walls: &'a mut Impulse,
    /// Force sums by wall.
    pub wall_sums: &'a mut Vec<WallSum>,
    /// Angular impulse of periodic contacts about the origin.
    pub couple: &'a mut Vec3,
    pub surface: &'a mut SurfaceTotals,
    pub failure: &'a mut Option<Failure>,
}

pub trait PairHandler: Sync {
    /// Pairs of the block's first partners possibly within `reach` [m], ascending.
    fn candidates(
        &self,
        search: &Search<'_>,
        b: usize,
        reach: f64,
        row: &mut Vec<u32>,
        out: &mut Vec<PairName>,
    );

    /// Lists the candidates within `reach` [m].
    fn refresh(
        &self,
        now: &Configuration<'_>,
        b: usize,
        reach: f64,
        candidates: &[PairName],
        list: &mut PairList,
    );

    fn forces(
        &self,
        setting: &StepContext<'_>,
        now: &Configuration<'_>,
        b: usize,
        list: &mut PairList,
        books: &mut ContactTotals<'_>,
    );

    fn visit(
        &self,
        laws: &Laws,
        scene: &dyn BodyAccess,
        b: usize,
        list: &PairList,
        f: &mut dyn FnMut(&Visited<'_>),
    );

    /// Visits pairs with scarred ground.
    fn visit_scarred_ground(
        &self,
        now: &Configuration<'_>,
        b: usize,
        list: &PairList,
        f: &mut dyn FnMut(&OnGround),
    );

    /// Visits the bodies of each pair: pair index, block and place, whether first.
    fn for_each_body(
        &self,
        now: &Configuration<'_>,
        b: usize,
        list: &PairList,
        share: &mut dyn FnMut(usize, [u32; 2], bool),
    );

    fn of_bodies(&self) -> bool;

    /// Visits each pair after re-sorting: block, name, points.
    fn renumber(
        &self,
        names: &dyn Renumbering,
        b: usize,
        list: &PairList,
        put: &mut dyn FnMut(usize, PairName, &[ContactHistory]),
    );
}

pub struct OnGround {
    pub place: usize,
    pub patch: u32,
    /// Contact in the last step, with lowered ground.
    pub touches: bool,
    /// Intersects the patch at its original position.
    pub cuts: bool,
}

pub struct Handler<K>(pub K);

/// Both partners, the second as nearest image, and its shift [m].
type Partners<'a, K> = (View<'a, <K as ShapePair>::First>, View<'a, <K as ShapePair>::Second>, Vec3);

impl<K: ShapePair> Handler<K> {
    #[inline(always)]
    fn partners<'a>(
        scene: &'a (impl BodyAccess + ?Sized),
        b: usize,
        [i, other, j]: PairName,
    ) -> Partners<'a, K> {
        let first = K::First::view(scene, b, i);
        let mut second = K::Second::view(scene, other as usize, j);
        let mut way = Vec3::zeros();
        if let Some(periodic) = scene.borders().filter(|_| K::Second::IMAGES) {
            way = periodic.nearest(&K::First::middle(&first), &K::Second::middle(&second));
            K::Second::image(&mut second, &way);
        }
        if let Some(scar) = Self::scar(scene, b, [i, other, j]) {
            // Displaced soil: contact with a lowered image.
            way += scar.sunk;
            K::Second::image(&mut second, &way);
        }
        (first, second, way)
    }

    /// Scar, if the second partner is scarred ground.
    #[inline(always)]
    fn scar(scene: &(impl BodyAccess + ?Sized), b: usize, [i, _, j]: PairName) -> Option<&Scar> {
        let scars = scene.scars();
        if scars.is_empty() {
            return None;
        }
        K::Second::wall(scene, j).filter(|w| scene.walls().walls[*w].scarred)?;
        K::First::body(scene, b, i).map(|k| &scars[scene.block(b).bodies[k] as usize])
    }

    /// Within `reach` [m], ground lowered or not.
    fn may_touch(&self, scene: &Configuration<'_>, b: usize, name: PairName, reach: f64) -> bool {
        let (first, second, _) = Self::partners(scene, b, name);
        self.0.may_touch(&first, &second, reach)
            || Self::scar(scene, b, name).is_some_and(|s| s.inside) && self.cuts(scene, b, name, reach)
    }

    /// Within `reach` [m], ground not lowered.
    fn cuts(&self, scene: &Configuration<'_>, b: usize, name: PairName, reach: f64) -> bool {
        self.0.may_touch(&K::First::view(scene, b, name[0]), &K::Second::view(scene, b, name[2]), reach)
    }

    fn joined(scene: &(impl BodyAccess + ?Sized), one: PairName, other: PairName) -> bool {
        let wall = |j: u32| K::Second::wall(scene, j);
        K::JOINED && one[0] == other[0] && wall(one[2]) == wall(other[2])
    }

    fn last(scene: &(impl BodyAccess + ?Sized), list: &PairList, k: usize) -> usize {
        let more = (k + 1..list.len()).take_while(|m| Self::joined(scene, list.name(k), list.name(*m)));
        k + 1 + more.count()
    }
}

impl<K: ShapePair> PairHandler for Handler<K> {
    fn candidates(
        &self,
        search: &Search<'_>,
        b: usize,
        reach: f64,
        row: &mut Vec<u32>,
        out: &mut Vec<PairName>,
    ) {
        out.clear();
        let now = &search.now;
        K::First::own(search, b, |i| {
            let first = K::First::view(now, b, i);
            let still = K::First::still(now, b, i);
            let scar = |k| now.scars.get(now.block(b).bodies[k] as usize);
            let deep = K::First::body(now, b, i).and_then(scar).map_or(0.0, |s| s.sunk.norm());
            let bounds = grown(K::First::bounds(&first), reach + deep);
            K::Second::around(search, b, bounds, row, |other, j| {
                let turned = K::Second::body(now, other as usize, j).is_some() && [other, j] <= [b as u32, i];
                if turned || still && K::Second::still(now, other as usize, j) {
                    return;
                }
                if self.may_touch(now, b, [i, other, j], reach) {
                    out.push([i, other, j]);
                }
            });
        });
    }

    fn refresh(
        &self,
        now: &Configuration<'_>,
        b: usize,
        reach: f64,
        candidates: &[PairName],
        list: &mut PairList,
    ) {
        let near = candidates.iter().copied().filter(|name| self.may_touch(now, b, *name, reach));
        list.replace(near);
    }

    fn forces(
        &self,
        setting: &StepContext<'_>,
        now: &Configuration<'_>,
        b: usize,
        list: &mut PairList,
        books: &mut ContactTotals<'_>,
    ) {
        if list.len() == 0 {
            return;
        }
        if K::JOINED {
            books.wall_sums.resize(now.walls.walls.len(), WallSum::default());
        }
        let (mut found, mut memory, mut parts) = (Manifold::new(), Vec::new(), Vec::new());
        let mut k = 0;
        while k < list.len() {
            let end = Self::last(now, list, k);
            found.clear();
            parts.clear();
            for m in k..end {
                let name = list.name(m);
                let again = |a: &_, b: &_, found: &mut Manifold| {
                    self.0.contact_points_from_hint(a, b, list.hint_mut(m), found);
                };
                parts.push(Self::detect(setting.laws, now, (b, name), &mut found, again));
            }
            if K::SHARED {
                share(setting.laws, &mut found);
            }
            for (m, (part, way)) in (k..end).zip(&parts) {
                self.pair(setting, now, (b, m), (&found[part.clone()], way), list, &mut memory, books);
            }
            k = end;
        }
    }

    fn visit(
        &self,
        laws: &Laws,
        scene: &dyn BodyAccess,
        b: usize,
        list: &PairList,
        f: &mut dyn FnMut(&Visited<'_>),
    ) {
        let (mut found, mut parts, mut at, mut end) = (Manifold::new(), Vec::new(), 0, 0);
        for k in 0..list.len() {
            if k == end {
                (at, end) = (k, Self::last(scene, list, k));
                found.clear();
                parts.clear();
                for m in k..end {
                    let contact_points =
                        |a: &_, b: &_, found: &mut Manifold| self.0.contact_points(a, b, found);
                    parts.push(Self::detect(laws, scene, (b, list.name(m)), &mut found, contact_points));
                }
                if K::SHARED {
                    share(laws, &mut found);
                }
            }
            let [i, other, j] = list.name(k);
            let other = other as usize;
            let Some(body) = K::First::body(scene, b, i) else { continue };
            let (part, way) = &parts[k - at];
            for touch in &found[part.clone()] {
                let point = &touch.geometry.point;
                let own = K::First::motion(scene, b, i, point);
                let its = K::Second::motion(scene, other, j, &(point - way));
                let memory = list.points(k).iter().find(|p| p.feature == touch.feature);
                f(&Visited {
                    body: scene.block(b).bodies[body],
                    partner: K::Second::partner(scene, other, j),
                    shift: *way,
                    contact: ContactView {
                        geometry: touch.geometry,
                        weight: touch.weight,
                        velocity: own.at_point() - its.at_point(),
                        inverse_mass: (own.inverse_mass() + its.inverse_mass()) * touch.share,
                        history: &memory.unwrap_or(&ContactHistory::FRESH).history,
                        spin: own.spin() - its.spin(),
                        materials: touch.materials,
                        friction: Self::scar(scene, b, list.name(k)).map(|s| s.friction),
                    },
                });
            }
        }
    }

    fn visit_scarred_ground(
        &self,
        now: &Configuration<'_>,
        b: usize,
        list: &PairList,
        f: &mut dyn FnMut(&OnGround),
    ) {
        for k in 0..list.len() {
            let name @ [i, _, patch] = list.name(k);
            if Self::scar(now, b, name).is_none() {
                continue;
            }
            let Some(place) = K::First::body(now, b, i) else { continue };
            let touches = !list.points(k).is_empty();
            f(&OnGround { place, patch, touches, cuts: self.cuts(now, b, name, 0.0) });
        }
    }

    fn for_each_body(
        &self,
        now: &Configuration<'_>,
        b: usize,
        list: &PairList,
        share: &mut dyn FnMut(usize, [u32; 2], bool),
    ) {
        for k in 0..list.len() {
            let [i, other, j] = list.name(k);
            if let Some(place) = K::First::body(now, b, i) {
                share(k, [b as u32, place as u32], true);
            }
            if let Some(place) = K::Second::body(now, other as usize, j) {
                share(k, [other, place as u32], false);
            }
        }
    }

    fn of_bodies(&self) -> bool {
        K::Second::BODY
    }

    fn renumber(
        &self,
        names: &dyn Renumbering,
        b: usize,
        list: &PairList,
        put: &mut dyn FnMut(usize, PairName, &[ContactHistory]),
    ) {
        for k in 0..list.len() {
            let [i, other, j] = list.name(k);
            let Some(first) = K::First::renamed(names, b, i) else { continue };
            if !K::Second::BODY {
                put(first[0] as usize, [first[1], first[0], j], list.points(k));
                continue;
            }
            let Some(second) = K::Second::renamed(names, other as usize, j) else { continue };
            if first < second {
                put(first[0] as usize, [first[1], second[0], second[1]], list.points(k));
            } else {
                let turned: Vec<ContactHistory> = list.points(k).iter().map(ContactHistory::turned).collect();
                put(second[0] as usize, [second[1], first[0], first[1]], &turned);
            }
        }
    }
}

/// Contact points, and image shift [m].
type Found<'a> = (&'a [PairContactPoint], &'a Vec3);

impl<K: ShapePair> Handler<K> {
    fn materials(scene: &(impl BodyAccess + ?Sized), b: usize, [i, other, j]: PairName) -> [u32; 2] {
        [K::First::material(scene, b, i), K::Second::material(scene, other as usize, j)]
    }

    /// Adds contact points under their law, and image shift.
    #[inline(always)]
    fn detect<'a>(
        laws: &Laws,
        scene: &'a (impl BodyAccess + ?Sized),
        (b, name): (usize, PairName),
        found: &mut Manifold,
        contact_points: impl FnOnce(&View<'a, K::First>, &View<'a, K::Second>, &mut Manifold),
    ) -> (Range<usize>, Vec3) {
        let (first, second, way) = Self::partners(scene, b, name);
        let from = found.len();
        contact_points(&first, &second, found);
        let materials = Self::materials(scene, b, name);
        found[from..].iter_mut().for_each(|t| t.under(laws, materials));
        (from..found.len(), way)
    }

    fn pair(
        &self,
        setting: &StepContext<'_>,
        now: &Configuration<'_>,
        (b, k): (usize, usize),
        (found, way): Found<'_>,
        list: &mut PairList,
        memory: &mut Vec<ContactHistory>,
        books: &mut ContactTotals<'_>,
    ) {
        let name = list.name(k);
        books.slots[3 * k..][..3].fill(Vec4::default());
        let points = list.points(k);
        if found.is_empty() && points.is_empty() {
            return;
        }
        let same =
            found.len() == points.len() && found.iter().zip(points).all(|(t, p)| t.feature == p.feature);
        for p in points.iter().filter(|_| !same) {
            if !found.iter().any(|t| t.feature == p.feature) {
                let own = Self::materials(now, b, name);
                let materials = setting.laws.edges(own).filter(|_| p.edge).unwrap_or(own);
                *books.friction += p.weight * scalar::end(setting.laws, materials, &mut { p.history });
            }
        }
        let mut sums = [Vec3::zeros(); 3];
        memory.clear();
        for (n, touch) in found.iter().enumerate() {
            let known = if same { points.get(n) } else { points.iter().find(|p| p.feature == touch.feature) };
            let mut point = *known.unwrap_or(&ContactHistory::FRESH);
            (point.feature, point.edge) = (touch.feature, touch.edge > 0.0);
            self.force(setting, now, (b, name), (touch, way), &mut point, &mut sums, books);
            memory.push(point);
        }
        list.set(k, memory);
        if !found.is_empty() {
            for (record, sum) in books.slots[3 * k..][..3].iter_mut().zip(&sums) {
                *record = Vec4::of(sum, 0.0);
            }
        }
    }

    fn force(
        &self,
        setting: &StepContext<'_>,
        now: &Configuration<'_>,
        (b, [i, other, j]): (usize, PairName),
        (touch, way): (&PairContactPoint, &Vec3),
        memory: &mut ContactHistory,
        sums: &mut [Vec3; 3],
        books: &mut ContactTotals<'_>,
    ) {
        let &PairContactPoint { geometry: ref g, weight, materials, share, .. } = touch;
        let other = other as usize;
        let (own, its) =
            (K::First::motion(now, b, i, &g.point), K::Second::motion(now, other, j, &(g.point - way)));
        *books.friction += combine(setting.laws, materials, g, memory, weight);
        if let Some(displacement) = K::Second::correction(now, j, &g.point) {
            memory.history.displace(&displacement, &g.normal);
        }
        let ends = (&own, &its);
        let friction = Self::scar(now, b, [i, other as u32, j]).map(|s| s.friction);
        let (before, history) = (memory.history, &mut memory.history);
        let f = scalar::between(setting.laws, materials, friction, g, ends, share, history, setting.dt);
        let force = f.force * weight;
        sums[0] += force;
        let couple = touch.couple * force.dot(&g.normal);
        sums[1] += f.torque_a * weight + couple;
        sums[2] += f.torque_b * weight - couple;
        *books.dashpot += f.dashpot * weight;
        *books.friction += f.friction * weight;
        if K::Second::IMAGES {
            *books.couple += way.cross(&force) * setting.dt;
        }
        if K::Second::EXTERNAL {
            let body = now.block(b).bodies[K::First::body(now, b, i).unwrap_or_default()];
            let (facet, history) = (&now.sheet.facets[j as usize], &memory.history);
            sheet::add_force(
                setting,
                &SurfaceContactRef { body, patch: j, facet, touch, history },
                &f,
                books,
            );
        } else if let Some(wall) = K::Second::wall(now, j) {
            let sum = &mut books.wall_sums[wall];
            sum.force += force;
            sum.moment += its.arm.cross(&force) + couple + f.moment * weight;
            if now.walls.walls[wall].driven {
                let stiffness =
                    weight * setting.laws.stiffness(materials[0], materials[1], g.overlap, g.radius);
                let mass = 1.0 / (own.inverse_mass() + its.inverse_mass());
                sum.stiffness += stiffness;
                sum.damping += weight.signum() * (stiffness.abs() * mass).sqrt();
                let (sum, memory) = (&mut sum.dashpots, [&before, &*history]);
                scalar::add_dashpot(sum, setting.laws, materials, g, memory, &f.force, weight);
            }
        } else if !K::Second::BODY {
            let impulse = force * setting.dt;
            *books.work_walls += force.dot(&its.at_point()) * setting.dt;
            books.walls.add(&g.point, &impulse);
            books.walls.angular += f.moment * (weight * setting.dt);
        }
        if g.overlap > touch.bound && weight > 0.0 && books.failure.is_none() {
            *books.failure = Some(Failure::Overlap {
                body: now.block(b).bodies[K::First::body(now, b, i).unwrap_or_default()],
                partner: K::Second::partner(now, other, j),
                overlap: g.overlap,
                bound: touch.bound,
            });
        }
    }
}

/// Changes a weight at constant spring force; returns the energy lost [J].
pub(super) fn combine(
    laws: &Laws,
    [a, b]: [u32; 2],
    g: &ContactGeometry,
    memory: &mut ContactHistory,
    weight: f64,
) -> f64 {
    let before = std::mem::replace(&mut memory.weight, weight);
    let history = &mut memory.history;
    if weight == before || history.is_new() {
        return 0.0;
    }
    let (_, stored) = laws.stored(a, b, g.overlap, g.radius, history);
    if weight.abs() < before.abs() {
        return stored * (before - weight);
    }
    let share = before / weight;
    history.spring *= share;
    history.turn.iter_mut().for_each(|x| *x *= share);
    stored * before * (1.0 - share)
}
