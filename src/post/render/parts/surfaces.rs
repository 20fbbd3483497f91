//! Solid, walls, sleepers and rails.

use super::super::colours;
use super::super::draw::{Colour, Line, Look, Paint, Triangle, V3};
use super::super::labels;
use super::super::options::{Clip, Part};
use super::super::run::{Moment, of_elements};
use super::super::sheet::{Key, Legend};
use super::Parts;
use super::plain;
use crate::water;
use std::collections::{BTreeMap, BTreeSet};
use trackbed_io::results::section::{Point, outlines, section};
use trackbed_io::write::WallKind;

/// Default colours, as in the viewer.
const GROUND: &str = "9aa7b3";
const BOUNDARY: &str = "7d8fa3";
const SLEEPER: &str = "8f959c";
const RAIL: &str = "5b4a3f";
const STONE: &str = "a89f91";
/// Shading strength of contours, which must match their legend.
const CONTOUR: f32 = 0.38;
/// Most triangles of a wall with visible edges.
const MOST_EDGES: usize = 400;
const SOLID_BODY: u32 = 0;
const WATER: u32 = u32::MAX;

struct Looks {
    first: u16,
    groups: BTreeMap<usize, u16>,
}

impl Looks {
    fn of(&self, value: Option<f64>) -> u16 {
        value.and_then(|v| self.groups.get(&(v as usize)).copied()).unwrap_or(self.first)
    }
}

impl Parts<'_> {
    pub(super) fn solid(&mut self, moment: &Moment) {
        let (Some(skin), Some(u), Some(field)) = (&self.run.skin, &moment.displacement, &self.wanted.solid)
        else {
            return;
        };
        let cells = of_elements(field);
        let places: Vec<f64> = skin
            .mesh
            .coordinates
            .as_flattened()
            .iter()
            .zip(u)
            .map(|(x, u)| x + self.options.deform * u)
            .collect();
        let range = self.limits.solid.unwrap_or([0.0, 1.0]);
        let paint = match moment.solid_values {
            None => Paint::Own(plain(GROUND)),
            Some(_) => Paint::Map {
                table: self.table(Part::Solid),
                range: range.map(|v| v as f32),
                bands: self.options.bands,
            },
        };
        let relief = if moment.solid_values.is_some() { CONTOUR } else { 1.0 };
        let look = self.scene.look(Look { paint, opacity: self.opacity(Part::Solid, 1.0), relief });
        let points = skin.shown_places(&places);
        let values = moment.solid_values.as_ref().map(|v| skin.shown(v, cells));
        let value = |node: u32, triangle: usize| {
            values.as_ref().map_or(0.0, |v| v[if cells { triangle } else { node as usize }] as f32)
        };
        let at = |n: u32| self.near(&points[3 * n as usize..3 * n as usize + 3]);
        let mut triangles: Vec<Triangle> = skin
            .triangles
            .chunks_exact(3)
            .enumerate()
            .map(|(t, n)| {
                let n = [n[0], n[1], n[2]];
                Triangle { corners: n.map(at), values: n.map(|n| value(n, t)), look, body: SOLID_BODY }
            })
            .collect();
        let mut lines = Vec::new();
        if self.options.shows(Part::Edges, true) {
            let edges = skin.edges.chunks_exact(2);
            lines.extend(edges.map(|e| Line { ends: [at(e[0]), at(e[1])], look }));
        }
        let (inside, around) = self.sections(&places, moment, cells, look);
        triangles.extend(inside);
        if self.options.shows(Part::Edges, true) {
            lines.extend(around);
        }
        self.cut(Part::Solid, triangles, lines);
        if moment.solid_values.is_some() {
            let (label, unit) = labels::solid(field);
            let title = match self.wanted.since {
                Some(k) => format!("{label}, change since frame {k}"),
                None => label,
            };
            let key = Key::Scale { unit, range, table: self.table(Part::Solid), bands: self.options.bands };
            self.legends.push(Legend { title, key });
        }
    }

    fn sections(
        &self,
        places: &[f64],
        moment: &Moment,
        cells: bool,
        look: u16,
    ) -> (Vec<Triangle>, Vec<Line>) {
        let (mut out, mut lines) = (Vec::new(), Vec::new());
        let Some(skin) = &self.run.skin else { return (out, lines) };
        let values = moment.solid_values.as_deref();
        let nodes: Vec<Point> = places
            .chunks_exact(3)
            .enumerate()
            .map(|(n, x)| [x[0], x[1], x[2], values.filter(|_| !cells).map_or(0.0, |v| v[n])])
            .collect();
        for clip in self.options.clips_of(Part::Solid) {
            for end in clip.range.into_iter().filter(|e| e.abs() < 1e29) {
                let mut normal = [0.0; 3];
                normal[clip.axis] = 1.0;
                // The cutting plane itself is not clipped.
                let on = (end - self.origin[clip.axis]) as f32;
                let at = |x: &[f64]| {
                    let mut place = self.near(x);
                    place[clip.axis] = on;
                    place
                };
                let found = section(&skin.mesh, &nodes, values.filter(|_| cells), normal, end);
                out.extend(found.iter().map(|t| {
                    let corners = t.map(|p| at(&p[..3]));
                    Triangle { corners, values: t.map(|p| p[3] as f32), look, body: SOLID_BODY }
                }));
                let found = outlines(&skin.mesh, &nodes, normal, end);
                lines.extend(found.iter().map(|l| Line { ends: l.map(|p| at(&p)), look }));
            }
        }
        (out, lines)
    }

    fn cut(&mut self, part: Part, mut triangles: Vec<Triangle>, mut lines: Vec<Line>) {
        let clips: Vec<Clip> = self.options.clips_of(part).copied().collect();
        for Clip { axis, range, .. } in clips {
            let [low, high] = range.map(|r| (r - self.origin[axis]) as f32);
            let cut = |all: Vec<Triangle>, side: &dyn Fn(&V3) -> f32| -> Vec<Triangle> {
                all.iter().flat_map(|t| t.cut(side)).collect()
            };
            triangles = cut(triangles, &|x| x[axis] - low);
            triangles = cut(triangles, &|x| high - x[axis]);
            lines = lines.into_iter().filter_map(|l| l.cut(|x| x[axis] - low)).collect();
            lines = lines.into_iter().filter_map(|l| l.cut(|x| high - x[axis])).collect();
        }
        let (mut low, mut high) = (V3::repeat(f32::INFINITY), V3::repeat(f32::NEG_INFINITY));
        for corner in triangles.iter().flat_map(|t| &t.corners) {
            (low, high) = (low.inf(corner), high.sup(corner));
        }
        if part != Part::Boundary && part != Part::Water {
            self.boxed(low, high);
        }
        self.scene.triangles.extend(triangles);
        self.scene.lines.extend(lines);
    }

    fn looks(&mut self, values: Option<impl Iterator<Item = f64>>, colour: Colour, opacity: f32) -> Looks {
        let (range, table) = (self.limits.grains.unwrap_or([0.0, 1.0]), self.table(Part::Grains));
        let mut add = |paint| self.scene.look(Look { paint, opacity, relief: 1.0 });
        let alike = |first| Looks { first, groups: BTreeMap::new() };
        let by_group = self.wanted.grains.as_deref() == Some("part");
        match values {
            None => alike(add(Paint::Own(colour))),
            Some(values) if by_group => {
                let numbers: BTreeSet<usize> = values.map(|v| v as usize).collect();
                let one = |g: usize| (g, add(Paint::Own(colours::group(g))));
                let groups: BTreeMap<usize, u16> = numbers.into_iter().map(one).collect();
                Looks { first: groups.first_key_value().map_or(0, |(_, look)| *look), groups }
            }
            Some(_) => alike(add(Paint::Map { table, range: range.map(|v| v as f32), bands: 0 })),
        }
    }

    pub(super) fn water(&mut self, moment: &Moment) {
        let Some(surface) = self.run.water.filter(|_| self.options.shows(Part::Water, true)) else { return };
        let opacity = self.opacity(Part::Water, water::OPACITY);
        let look = self.scene.look(Look { paint: Paint::Own(plain(water::COLOUR)), opacity, relief: 1.0 });
        let points = surface.points(moment.time);
        let at = |n: u32| self.near(&points[n as usize]);
        let triangle = |n: [u32; 3]| Triangle { corners: n.map(at), values: [0.0; 3], look, body: WATER };
        let triangles = surface.triangles().into_iter().map(triangle).collect();
        let border = surface.border().into_iter().map(|n| Line { ends: n.map(at), look });
        let lines = if self.options.shows(Part::Edges, true) { border.collect() } else { Vec::new() };
        self.cut(Part::Water, triangles, lines);
    }

    pub(super) fn walls(&mut self, moment: &Moment) {
        let Some(walls) = &moment.walls else { return };
        let is = |kind: u8, of: WallKind| kind == of as u8;
        let has_solid = self.wanted.solid.is_some() && self.run.skin.is_some();
        let boundary = self.options.shows(Part::Boundary, !has_solid);
        let track = self.options.shows(Part::Track, true);
        let stones = self.options.shows(Part::Grains, true);
        for (kinds, part, shown, colour, opacity) in [
            (&[WallKind::Plane, WallKind::Wall][..], Part::Boundary, boundary, BOUNDARY, 0.25),
            (&[WallKind::Box][..], Part::Track, track, SLEEPER, 1.0),
            (&[WallKind::Rail][..], Part::Track, track, RAIL, 1.0),
            (&[WallKind::Stone][..], Part::Grains, stones, STONE, 1.0),
        ] {
            let of_kind = |t: &usize| kinds.iter().any(|k| is(walls.kind[*t], *k));
            let chosen: Vec<usize> = (0..walls.kind.len()).filter(of_kind).collect();
            if !shown || chosen.is_empty() {
                continue;
            }
            let opacity = self.opacity(part, opacity);
            let values = moment.stone_values.as_ref().filter(|_| part == Part::Grains);
            let looks = self.looks(values.map(|v| chosen.iter().map(|t| v[*t])), plain(colour), opacity);
            let look_of = |t: usize| looks.of(values.map(|v| v[t]));
            let at = |n: u32| self.near(&walls.points[3 * n as usize..3 * n as usize + 3]);
            let mut own = vec![false; walls.points.len() / 3];
            let triangles: Vec<Triangle> = chosen
                .iter()
                .map(|t| {
                    let n = [0, 1, 2].map(|c| walls.triangles[3 * t + c]);
                    n.iter().for_each(|n| own[*n as usize] = true);
                    let value = values.map_or(0.0, |v| v[*t] as f32);
                    Triangle {
                        corners: n.map(at),
                        values: [value; 3],
                        look: look_of(*t),
                        body: 1 + walls.id[*t],
                    }
                })
                .collect();
            let edges = walls.edges.chunks_exact(2).filter(|e| own[e[0] as usize]);
            let few = triangles.len() <= MOST_EDGES || part == Part::Track;
            let look = looks.first;
            let lines = edges.filter(|_| few).map(|e| Line { ends: [at(e[0]), at(e[1])], look }).collect();
            self.cut(part, triangles, lines);
        }
    }
}
