//! Frames of a running system.

use super::runout;
use super::system::{GrainsView, SolidView};
use super::wall_output;
use std::path::Path;
use trackbed_dem as dem;
use trackbed_dem::bond::{Break, BreakMode};
use trackbed_dem::shape::Shape;
use trackbed_fem::stress;
use trackbed_input::model::OutputPlan;
use trackbed_input::model::grains::{GrainsPart, MaterialsPart};
use trackbed_io::failure::Failure;
use trackbed_io::write::{
    BODY_FIELDS, ChainFrame, Frame, FrameField, GrainFrame, NO_BODY, NodalValues, Part, SOLID_FIELDS,
    STONE_BODY, STONE_CENTRE, SolidFrame, Values, WallFrame, WallKind, Writers,
};

/// Elastic material: inside by definition.
const NO_YIELD_SURFACE: f64 = -1.0;

fn solid_frame<'a>(view: SolidView<'a>, extra: &[&'static str]) -> SolidFrame<'a> {
    let SolidView { model, state } = view;
    let stress = if state.points.is_empty() {
        stress::nodal(model, &state.u)
    } else {
        stress::nodal_of_points(model, state)
    };
    let wanted = |field: &&FrameField| field.written.needs().is_none() || extra.contains(&field.name);
    let fields = SOLID_FIELDS.iter().filter(wanted);
    let fields = fields.map(|field| (field.name, solid_values(view, field.name, &stress))).collect();
    SolidFrame { mesh: model.mesh(), fields }
}

/// Without Gauss points the solid is elastic.
fn solid_values<'a>(view: SolidView<'a>, name: &str, stress: &[[f64; 6]]) -> NodalValues<'a> {
    use NodalValues::{Numbers, Tensors, Vectors};
    let SolidView { model, state } = view;
    let (elastic, nodes) = (state.points.is_empty(), model.mesh().node_count());
    match name {
        "displacement" => Vectors((&state.u).into()),
        "velocity" => Vectors((&state.v).into()),
        "stress" => Tensors(stress.to_vec().into()),
        "von_mises" => Numbers(stress.iter().map(stress::von_mises).collect()),
        "equivalent_plastic_strain" if elastic => Numbers(vec![0.0; nodes].into()),
        "equivalent_plastic_strain" => Numbers(stress::nodal_kappa(model, state).into()),
        "yield_function" if elastic => Numbers(vec![NO_YIELD_SURFACE; nodes].into()),
        "yield_function" => Numbers(finite_yield_function(stress::nodal_yield_function(model, state)).into()),
        "strain" => {
            let at = |element, p| stress::strain_at_point(model, &state.u, element, p);
            Tensors(stress::nodal_from_points(model, at).into())
        }
        "plastic_strain" if elastic => Tensors(vec![[0.0; 6]; nodes].into()),
        "plastic_strain" => {
            let at = |_, p: usize| stress::tensor(state.points[p].plastic_strain);
            Tensors(stress::nodal_from_points(model, at).into())
        }
        other => unreachable!("the field {other} of the solid has no values"),
    }
}

/// Grains of a frame with display options.
pub struct Shown<'a> {
    /// Grains.
    pub view: GrainsView<'a>,
    /// Resolved grains.
    pub part: &'a GrainsPart,
    /// Whether only contacts above the mean force are shown.
    pub strong_only: bool,
    /// Additional grain fields.
    pub extra: &'a [&'static str],
    /// Draws further objects with the walls.
    pub draw: &'a dyn Fn(&mut WallFrame),
}

/// Writes frame `number` at `time` [s], computing only displayed fields.
///
/// # Errors
/// I/O errors, or a non-finite field.
pub fn write(
    writers: &mut Writers,
    (number, time): (usize, f64),
    (solid, solid_extra): (Option<SolidView<'_>>, &[&'static str]),
    grains: Option<Shown<'_>>,
) -> Result<(), Failure> {
    let solid = solid.filter(|_| writers.show(Part::Solid)).map(|view| solid_frame(view, solid_extra));
    let frame = Frame { number, time, solid: solid.as_ref(), ..Frame::default() };
    let Some(Shown { view, part, strong_only, extra, draw }) = grains else {
        return Ok(writers.frame(&frame)?);
    };
    // Computed once for all uses.
    let stones = writers.show(Part::Walls) && view.model.has_faces();
    let any = stones || writers.show(Part::Grains) || writers.show(Part::Chains);
    let contacts = if any { dem::measure::contacts(view.model, view.state) } else { Vec::new() };
    let bodies = (stones || writers.show(Part::Grains))
        .then(|| BodyFields::of(view, &contacts, (&part.materials, extra)));
    let spheres = bodies.as_ref().filter(|_| writers.show(Part::Grains)).map(BodyFields::spheres);
    let chains = writers.show(Part::Chains).then(|| chains(view, &contacts, strong_only));
    let walls = writers.show(Part::Walls).then(|| {
        let (mut walls, of) = walls(view, part);
        draw(&mut walls);
        if let Some(fields) = bodies.as_ref().filter(|_| stones) {
            walls.grains = fields.of_polygons(&of, walls.polygons.len());
        }
        walls
    });
    Ok(writers.frame(&Frame {
        grains: spheres.as_ref(),
        chains: chains.as_ref(),
        walls: walls.as_ref(),
        ..frame
    })?)
}

/// Writes a static solid.
///
/// # Errors
/// As [`write`].
pub fn write_state(dir: &Path, output: &OutputPlan, view: SolidView<'_>) -> Result<(), Failure> {
    let mut writers = Writers::begin(dir, &output.formats)?.only(&output.fields);
    write(&mut writers, (0, 0.0), (Some(view), &output.solid_extra), None)?;
    Ok(writers.end()?)
}

/// Elastic elements count as inside.
fn finite_yield_function(values: Vec<f64>) -> Vec<f64> {
    values.into_iter().map(|f| if f == f64::NEG_INFINITY { NO_YIELD_SURFACE } else { f }).collect()
}

fn kind(partner: &dem::Partner) -> u32 {
    match partner {
        dem::Partner::Body(_) => 0,
        dem::Partner::Plane(_) => 1,
        dem::Partner::Triangle(_) => 2,
        dem::Partner::Patch(_) => 3,
        dem::Partner::Wall(_) => 4,
    }
}

/// Tension is negative.
const BOND: u32 = 5;

struct BodyFields<'a> {
    view: GrainsView<'a>,
    stress: Vec<[f64; 6]>,
    neighbours: Vec<u32>,
    force: Vec<dem::Vec3>,
    fragments: Vec<u32>,
    more: &'a [&'static str],
    materials: &'a MaterialsPart,
}

struct Item {
    body: u32,
    sphere: Option<(dem::Vec3, f64)>,
}

impl<'a> BodyFields<'a> {
    fn of(
        view: GrainsView<'a>,
        contacts: &[dem::measure::ContactRecord],
        (materials, more): (&'a MaterialsPart, &'a [&'static str]),
    ) -> BodyFields<'a> {
        BodyFields {
            view,
            stress: dem::measure::mean_stress_of(view.model, view.state, contacts),
            neighbours: dem::measure::neighbours(view.model, contacts),
            force: dem::measure::contact_forces_of(view.model, view.state, contacts),
            fragments: dem::measure::fragments(view.model, view.state).of,
            more,
            materials,
        }
    }

    fn all(&self, items: &[Item], without: &[&str]) -> Vec<(&'static str, Values)> {
        let wanted = |field: &&FrameField| match field.written.needs() {
            Some(_) => self.more.contains(&field.name),
            None => !without.contains(&field.name),
        };
        BODY_FIELDS.iter().filter(wanted).map(|field| (field.name, self.values(field.name, items))).collect()
    }

    /// Zero without a body.
    fn values(&self, name: &str, items: &[Item]) -> Values {
        let GrainsView { model, state } = self.view;
        let body = |item: &Item| (item.body != NO_BODY).then_some(item.body as usize);
        let vectors = |of: &dyn Fn(usize) -> dem::Vec3| {
            Values::Vectors(items.iter().map(|i| body(i).map_or([0.0; 3], |b| of(b).into())).collect())
        };
        let numbers = |of: &dyn Fn(usize) -> f64| {
            Values::Numbers(items.iter().map(|i| body(i).map_or(0.0, of)).collect())
        };
        let counts =
            |of: &dyn Fn(usize) -> u32| Values::Counts(items.iter().map(|i| body(i).map_or(0, of)).collect());
        let broken = |which: &dyn Fn(&Break) -> bool| {
            let mut count = vec![0; model.body_count()];
            let breaks = state.breaks().iter().filter(|b| which(b));
            breaks.flat_map(|b| b.bodies).for_each(|b| count[b as usize] += 1);
            counts(&|b| count[b])
        };
        match name {
            "radius" => Values::Numbers(items.iter().map(|i| i.sphere.map_or(0.0, |(_, r)| r)).collect()),
            "velocity" => {
                let of = |item: &Item| {
                    let Some(b) = body(item) else { return [0.0; 3] };
                    let v = state.velocity(b);
                    item.sphere.map_or(v, |(x, _)| v + state.spin(b).cross(&(x - state.position(b)))).into()
                };
                Values::Vectors(items.iter().map(of).collect())
            }
            "spin" => vectors(&|b| state.spin(b)),
            "orientation" => {
                let of = |item: &Item| {
                    let q = body(item).map(|b| state.orientation(model, b)).unwrap_or_default();
                    [q.w, q.i, q.j, q.k]
                };
                Values::Quaternions(items.iter().map(of).collect())
            }
            "id" => Values::Counts(items.iter().map(|i| i.body).collect()),
            "part" => counts(&|b| model.part(b)),
            "mean_stress" => numbers(&|b| (self.stress[b][0] + self.stress[b][1] + self.stress[b][2]) / 3.0),
            "force" => vectors(&|b| self.force[b]),
            "coordination" => counts(&|b| self.neighbours[b]),
            "fragment" => counts(&|b| self.fragments[b]),
            "displacement" => {
                let from = runout::origins(model);
                vectors(&|b| state.position(b) - from[b])
            }
            "initial_position" => {
                let from = runout::origins(model);
                vectors(&|b| from[b])
            }
            "acceleration" => vectors(&|b| self.force[b] / model.mass(b) + model.gravity()),
            "stiffness_factor" => numbers(&|b| self.materials.stiffness_factor(model.material(b))),
            "broken_by_shear" => broken(&|b| b.mode == BreakMode::Shear),
            "broken_bonds" => broken(&|_| true),
            other => unreachable!("the field {other} of bodies has no values"),
        }
    }

    fn spheres(&self) -> GrainFrame {
        let GrainsView { model, state } = self.view;
        let (mut position, mut items) = (Vec::new(), Vec::new());
        for body in (0..model.body_count()).filter(|&b| state.present(b)) {
            let back = into_box(self.view, body);
            for (centre, radius) in state.spheres(model, body) {
                position.push(moved(centre, back).into());
                items.push(Item { body: body as u32, sphere: Some((centre, radius)) });
            }
        }
        let fields = self.all(&items, &[]);
        GrainFrame { position, fields }
    }

    /// The first polygons belong to bodies `of`.
    fn of_polygons(&self, of: &[u32], count: usize) -> Vec<(&'static str, Values)> {
        let bodies = of.iter().copied().chain(std::iter::repeat(NO_BODY)).take(count);
        let items: Vec<Item> = bodies.map(|body| Item { body, sphere: None }).collect();
        // `id` is the wall's; a vertex mean is no centre of mass.
        let centre = |item: &Item| {
            if item.body == NO_BODY {
                return [0.0; 3];
            }
            let body = item.body as usize;
            moved(self.view.state.position(body), into_box(self.view, body)).into()
        };
        let mut fields = vec![
            (STONE_BODY, Values::Counts(items.iter().map(|item| item.body).collect())),
            (STONE_CENTRE, Values::Vectors(items.iter().map(centre).collect())),
        ];
        fields.extend(self.all(&items, &["radius", "orientation", "id"]));
        fields
    }
}

/// `None` without periodic borders.
fn into_box(view: GrainsView<'_>, body: usize) -> Option<dem::Vec3> {
    let x = view.state.position(body);
    let periodic = view.model.periodic().iter().any(Option::is_some);
    periodic.then(|| view.model.wrap(&x) - x)
}

/// Unmoved points stay bitwise identical.
fn moved(x: dem::Vec3, way: Option<dem::Vec3>) -> dem::Vec3 {
    match way {
        Some(way) if way != dem::Vec3::zeros() => x + way,
        _ => x,
    }
}

fn chains(view: GrainsView<'_>, contacts: &[dem::measure::ContactRecord], strong_only: bool) -> ChainFrame {
    let mut frame = ChainFrame::default();
    let mean = dem::measure::strong_network(contacts).mean_force;
    for c in contacts {
        let strong = c.normal_force > mean;
        if strong_only && !strong {
            continue;
        }
        frame.strong.push(u32::from(strong));
        // A line to the distant centre of a sleeper would cross unloaded grains.
        let end = |body: usize, shift: Option<dem::Vec3>| match view.model.shape(body) {
            Shape::Box { .. } => c.point,
            _ => moved(view.state.position(body), shift),
        };
        let first = end(c.a, None);
        let second = match c.b {
            dem::Partner::Body(b) => end(b, Some(c.shift)),
            _ => c.point,
        };
        let back = into_box(view, c.a);
        let (first, second) = (moved(first, back), moved(second, back));
        let tangential = c.force - c.normal * c.force.dot(&c.normal);
        frame.ends.push([first.into(), second.into()]);
        frame.normal_force.push(c.normal_force);
        frame.tangential_force.push(tangential.norm());
        frame.kind.push(kind(&c.b));
        let partner = if let dem::Partner::Body(b) = c.b { b as u32 } else { NO_BODY };
        frame.partners.push([c.a as u32, partner]);
    }
    if !strong_only {
        for b in dem::measure::bond_records(view.model, view.state) {
            frame.ends.push([view.state.position(b.a).into(), view.state.position(b.b).into()]);
            frame.normal_force.push(-b.tension);
            frame.tangential_force.push(b.shear.norm());
            frame.kind.push(BOND);
            frame.strong.push(0);
            frame.partners.push([b.a as u32, b.b as u32]);
        }
    }
    frame
}

/// With the bodies of faceted grains.
fn walls(view: GrainsView<'_>, part: &GrainsPart) -> (WallFrame, Vec<u32>) {
    let (mut frame, mut of) = (WallFrame::default(), Vec::new());
    let mut add = |id, points: &[dem::Vec3], polygons: &[&[u32]]| {
        push(&mut frame, (id, WallKind::Plane), points, polygons);
    };
    let extent = extent(view);
    let mut id = 0;
    for (i, plane) in part.walls.planes.iter().enumerate() {
        let point = view.state.plane_point(view.model, i);
        let (points, polygons) = dem::wall::square(&point, &plane.normal.normalize(), extent);
        add(id, &points, &polygons.iter().map(Vec::as_slice).collect::<Vec<_>>());
        id += 1;
    }
    id = wall_output::polygons(view, part, extent, id, &mut frame);
    for body in 0..view.model.body_count() {
        let shape = view.model.shape(body);
        if shape.query(|s| s.sphere_count()) > 0 {
            continue;
        }
        let outline = view.state.present(body).then(|| shape.query(|s| s.outline())).flatten();
        if let Some((points, polygons)) = outline {
            let (x, q) = (view.state.position(body), view.state.orientation(view.model, body));
            let scale = view.model.scale(body);
            let back = into_box(view, body);
            let points: Vec<dem::Vec3> = points.iter().map(|p| moved(x + q * (p * scale), back)).collect();
            let polygons: Vec<&[u32]> = polygons.iter().map(Vec::as_slice).collect();
            if matches!(shape, Shape::Box { .. }) {
                push(&mut frame, (id, WallKind::Box), &points, &polygons);
            } else {
                of.resize(frame.polygons.len(), NO_BODY);
                push(&mut frame, (id, WallKind::Stone), &points, &polygons);
                of.resize(frame.polygons.len(), body as u32);
            }
        }
        // Ids are stable under insertion and removal.
        id += 1;
    }
    (frame, of)
}

fn push(frame: &mut WallFrame, (id, kind): (u32, WallKind), points: &[dem::Vec3], polygons: &[&[u32]]) {
    let first = frame.points.len() as u32;
    frame.points.extend(points.iter().map(|p| <[f64; 3]>::from(*p)));
    for polygon in polygons {
        frame.polygons.push(polygon.iter().map(|v| v + first).collect());
        frame.id.push(id);
        frame.kind.push(kind as u32);
    }
}

/// Centre and half the largest side [m].
fn extent(view: GrainsView<'_>) -> (dem::Vec3, f64) {
    let mut low = dem::Vec3::repeat(f64::INFINITY);
    let mut high = dem::Vec3::repeat(f64::NEG_INFINITY);
    if view.state.present_count() == 0 {
        return (dem::Vec3::zeros(), 1.0);
    }
    for body in (0..view.model.body_count()).filter(|&b| view.state.present(b)) {
        let x = view.state.position(body);
        let r = dem::Vec3::repeat(view.model.radius(body));
        low = low.inf(&(x - r));
        high = high.sup(&(x + r));
    }
    (0.5 * (low + high), 0.5 * (high - low).max())
}

#[cfg(test)]
mod tests {
    use super::*;
    use trackbed_dem::Partner;

    #[test]
    fn chain_kinds_are_distinct() {
        let partners =
            [Partner::Body(0), Partner::Plane(0), Partner::Triangle(0), Partner::Patch(0), Partner::Wall(0)];
        let mut kinds: Vec<u32> = partners.iter().map(kind).chain([BOND]).collect();
        kinds.dedup();
        assert_eq!(kinds, [0, 1, 2, 3, 4, 5]);
    }
}
