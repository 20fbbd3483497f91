//! Mesh of a solid: from files, or generated.

use crate::scene::solid::{Axis, Block, Order, Solid};
use crate::scene::units::vector;
use crate::scene::{SceneError, Table};
use std::collections::BTreeMap;
use std::path::PathBuf;
use trackbed_fem::mesh::{Constraint, Mesh};
use trackbed_io::failure::Failure;
use trackbed_io::read::{self, MeshFile, ReadError};
use trackbed_io::system;

/// Mesh with data of its file.
#[derive(Debug, Default)]
pub struct Geometry {
    /// The mesh.
    pub mesh: Mesh,
    /// Constraints.
    pub constraints: Vec<Constraint>,
    /// Node sets: node indices, ascending.
    pub node_sets: BTreeMap<String, Vec<u32>>,
    /// Face sets: element, face number, ascending.
    pub face_sets: BTreeMap<String, Vec<[u32; 2]>>,
    /// Element types of the file, with counts.
    pub element_types: Vec<(String, usize)>,
    /// Element file, for messages.
    pub element_file: PathBuf,
    /// Constraint file, for messages.
    pub constraint_file: PathBuf,
    /// Reader warnings.
    pub warnings: Vec<String>,
}

/// Reads or generates the mesh.
///
/// # Errors
/// Input errors.
pub fn geometry(solid: &Table<Solid>) -> Result<Geometry, Failure> {
    let of_lists = [("layout", solid.layout.is_some()), ("constraints", solid.constraints.is_some())];
    let lists = "`nodes` and `elements`";
    let mut geometry = match (&solid.mesh, &solid.nodes, &solid.elements, &solid.block) {
        (Some(file), None, None, None) => {
            solid.reject_without(of_lists, lists)?;
            let path = solid.locate(file);
            let read = read::read_mesh_file(&path)?;
            check_unit(solid, &read)?;
            from_file(read, path.clone(), path)
        }
        (None, Some(nodes), Some(elements), None) => {
            let constraints = solid.constraints.as_ref().map(|c| solid.locate(c));
            let element_file = solid.locate(elements);
            let layout = solid.layout.unwrap_or_default();
            let lists =
                read::read_lists(&solid.locate(nodes), &element_file, constraints.as_deref(), &layout)?;
            let constraint_file = constraints.unwrap_or_else(|| element_file.clone());
            let read = MeshFile::from(lists);
            check_unit(solid, &read)?;
            from_file(read, element_file, constraint_file)
        }
        (None, None, None, Some(b)) => {
            solid.reject_without(of_lists, lists)?;
            solid.reject_with([("scale", solid.scale.is_some())], "[solid.block]")?;
            let file = solid.scene_file().to_path_buf();
            Geometry {
                mesh: block(&solid.below("block", b), solid.order)?,
                element_file: file.clone(),
                constraint_file: file,
                ..Geometry::default()
            }
        }
        (None, Some(_), None, None) => {
            return Err(solid.requirement("nodes", "`elements`").into());
        }
        (None, None, Some(_), None) => {
            return Err(solid.requirement("elements", "`nodes`").into());
        }
        (mesh, nodes, elements, block) => {
            let lists = nodes.is_some() || elements.is_some();
            let sources = [("mesh", mesh.is_some()), ("nodes", lists), ("block", block.is_some())];
            return Err(solid.one_of(&sources).into());
        }
    };
    if let Some(factor) = solid.scale {
        solid.check("scale", factor, |v| v > 0.0, "above 0, such as 0.001 for millimetres")?;
        geometry.mesh.coordinates.iter_mut().flatten().for_each(|x| *x *= factor);
        geometry.constraints.iter_mut().for_each(|c| c.value *= factor);
        let largest = geometry.mesh.coordinates.as_flattened().iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        if largest > read::FARTHEST {
            let found = format!("{factor:e}, coordinates up to {largest:e} m");
            return Err(solid.error("scale", found, "coordinates up to 1e15 m").into());
        }
    }
    if !solid.support.is_empty() && solid.constraints.is_none() && geometry.constraints.is_empty() {
        geometry.constraint_file = solid.scene_file().to_path_buf();
    }
    assign_regions(solid, &mut geometry.mesh)?;
    match solid.order {
        Some(Order::Linear) => reorder(&mut geometry, Mesh::to_linear),
        Some(Order::Quadratic) => {
            reorder(&mut geometry, Mesh::to_quadratic);
            if !geometry.constraints.is_empty() {
                let note = "order = \"quadratic\": constraints of the file hold its own nodes only; hold the new mid-side \
                            nodes with [[solid.support]]";
                geometry.warnings.push(note.into());
            }
        }
        None => {}
    }
    Ok(geometry)
}

/// Gives the elements of each region its material; later regions count.
fn assign_regions(solid: &Table<Solid>, mesh: &mut Mesh) -> Result<(), SceneError> {
    for region in solid.rows("region", &solid.region) {
        let [low, high] = region.bounds.map(|corner| vector(&corner));
        if (0..3).any(|d| low[d] >= high[d]) {
            return Err(region.error("box", format!("{low:?} to {high:?}"), "low below high"));
        }
        if solid.material.iter().all(|m| m.id != region.material) {
            let ids: Vec<String> = solid.material.iter().map(|m| m.id.to_string()).collect();
            let expected = format!("the `id` of a [[solid.material]]: {}", ids.join(", "));
            return Err(region.error("material", region.material.to_string(), expected));
        }
        let is_inside = |mesh: &Mesh, e: usize| {
            let centre = mesh.element_centre(e);
            (0..3).all(|d| low[d] <= centre[d] && centre[d] <= high[d])
        };
        let inside: Vec<usize> = (0..mesh.element_count()).filter(|e| is_inside(mesh, *e)).collect();
        if inside.is_empty() {
            return Err(region.error("box", "no element", "the centre of at least one element"));
        }
        inside.into_iter().for_each(|e| mesh.materials[e] = region.material);
    }
    Ok(())
}

/// Lengths in another stated unit need `scale`.
fn check_unit(solid: &Table<Solid>, read: &MeshFile) -> Result<(), ReadError> {
    match &read.unit {
        Some(error) if solid.scale.is_none() => Err(ReadError::clone(error)),
        _ => Ok(()),
    }
}

fn from_file(read: MeshFile, element_file: PathBuf, constraint_file: PathBuf) -> Geometry {
    let MeshFile { mesh, constraints, node_sets, face_sets, element_types, warnings, .. } = read;
    Geometry {
        mesh,
        constraints,
        node_sets,
        face_sets,
        element_types,
        element_file,
        constraint_file,
        warnings,
    }
}

/// Constraints and sets keep remaining nodes.
fn reorder(geometry: &mut Geometry, change: impl Fn(&Mesh) -> Mesh) {
    let old = std::mem::take(&mut geometry.mesh);
    geometry.mesh = change(&old);
    let index: BTreeMap<u32, u32> =
        geometry.mesh.node_ids.iter().enumerate().map(|(i, &id)| (id, i as u32)).collect();
    let moved = |n: u32| index.get(&old.node_ids[n as usize]).copied();
    geometry.constraints = geometry
        .constraints
        .iter()
        .filter_map(|c| moved(c.node).map(|node| Constraint { node, ..*c }))
        .collect();
    let of_faces = &geometry.face_sets;
    for (name, set) in &mut geometry.node_sets {
        *set = set.iter().filter_map(|n| moved(*n)).collect();
        // New mid-side nodes of same-named face sets.
        for [element, side] in of_faces.get(name).into_iter().flatten() {
            set.extend(geometry.mesh.face(*element as usize, *side as usize).nodes());
        }
        set.sort_unstable();
        set.dedup();
    }
}

const MOST_ELEMENTS: u64 = 20_000_000;
/// Least memory per quadratic and linear brick [bytes].
const ELEMENT_BYTES: [u64; 2] = [30_000, 2_500];

/// Checked before generation.
fn check_counts(block: &Table<Block>, order: Option<Order>) -> Result<(), SceneError> {
    let bytes = ELEMENT_BYTES[usize::from(matches!(order, Some(Order::Linear)))];
    let along = |axis: &Axis| axis.counts.iter().fold(0_u64, |n, &c| n.saturating_add(c as u64));
    let [x, y, z] = [along(&block.x), along(&block.y), along(&block.z)];
    let elements = x.saturating_mul(y).saturating_mul(z);
    let found = format!("{x} x {y} x {z} elements");
    if elements > MOST_ELEMENTS {
        return Err(block.here(found, format!("at most {MOST_ELEMENTS}")));
    }
    match system::available() {
        Some(free) if elements * bytes > free => {
            let expected = format!("at most {}, for whose model the free memory may do", free / bytes);
            Err(block.here(found, expected))
        }
        _ => Ok(()),
    }
}

fn block(block: &Table<Block>, order: Option<Order>) -> Result<Mesh, SceneError> {
    check_counts(block, order)?;
    let planes = [
        planes(&block.below("x", &block.x))?,
        planes(&block.below("y", &block.y))?,
        planes(&block.below("z", &block.z))?,
    ];
    let mut mesh = Mesh::grid(&planes);
    let ends = |p: &[f64]| (p[0], p[p.len() - 1]);
    let (bottom, top) = ends(&planes[2]);
    let mut from = bottom;
    for (i, layer) in block.rows("layer", &block.layer).enumerate() {
        let last = i + 1 == block.layer.len();
        let to = match layer.top {
            Some(t) => t.si,
            None if last => top,
            None => return Err(layer.missing("top", "the top of a layer below others")),
        };
        if !(to > from && to <= top * (1.0 + 1e-12)) && to != top {
            let expected = format!("above {from} m, at most {top} m");
            return Err(layer.error("top", format!("{to} m"), expected));
        }
        if last && to < top {
            let expected = format!("{top} m: the last layer ends at the top");
            return Err(layer.error("top", format!("{to} m"), expected));
        }
        for e in 0..mesh.element_count() {
            let height = mesh.element_centre(e)[2];
            if height > from && height < to {
                mesh.materials[e] = layer.material;
            }
        }
        from = to;
    }
    if let Some([from, to]) = block.crest.map(|c| c.map(|x| x.si)) {
        let (low, high) = ends(&planes[0]);
        block.check("crest", to, |to| to > from, "an end beyond its beginning")?;
        for x in &mut mesh.coordinates {
            let (up, along) = ((x[2] - bottom) / (top - bottom), (x[0] - low) / (high - low));
            x[0] += up * (from + along * (to - from) - x[0]);
        }
    }
    Ok(mesh)
}

fn planes(axis: &Table<Axis>) -> Result<Vec<f64>, SceneError> {
    let lines: Vec<f64> = axis.lines.iter().map(|l| l.si).collect();
    if lines.len() < 2 || lines.windows(2).any(|w| w[1] <= w[0]) {
        return Err(axis.error("lines", format!("{lines:?}"), "two or more ascending coordinates"));
    }
    let intervals = lines.len() - 1;
    if axis.counts.len() != intervals || axis.counts.contains(&0) {
        let expected = format!("{intervals} numbers of 1 or more, one for each interval of `lines`");
        return Err(axis.error("counts", format!("{:?}", axis.counts), expected));
    }
    let ratios = axis.ratios.clone().unwrap_or_else(|| vec![1.0; intervals]);
    if ratios.len() != intervals || ratios.iter().any(|r| !(r.is_finite() && *r > 0.0)) {
        let expected = format!("{intervals} numbers above 0, one for each interval of `lines`");
        return Err(axis.error("ratios", format!("{ratios:?}"), expected));
    }
    let mut planes = vec![lines[0]];
    for i in 0..intervals {
        let (low, high, count) = (lines[i], lines[i + 1], axis.counts[i]);
        // The last length is `ratio` times the first.
        let growth = if count > 1 { libm::pow(ratios[i], 1.0 / (count - 1) as f64) } else { 1.0 };
        let total: f64 = (0..count).map(|k| growth.powi(k as i32)).sum();
        let mut sum = 0.0;
        for k in 0..count - 1 {
            sum += growth.powi(k as i32);
            planes.push(low + (high - low) * sum / total);
        }
        planes.push(high);
    }
    Ok(planes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Document;
    use crate::scene::units::Quantity;

    #[test]
    fn graded_axis_keeps_lines_and_ratios() {
        let document = Document::parse(std::path::Path::new("x.toml"), String::new()).unwrap();
        let axis = Axis {
            lines: [0.0, 1.0, 4.0].map(Quantity::new).to_vec(),
            counts: vec![2, 3],
            ratios: Some(vec![1.0, 4.0]),
        };
        let p = planes(&Table::root(&document, &axis)).unwrap();
        assert_eq!((p.len(), p[0], p[2], p[5]), (6, 0.0, 1.0, 4.0));
        assert!(((p[5] - p[4]) / (p[3] - p[2]) - 4.0).abs() < 1e-12);
        assert_eq!(p[1], 0.5);
    }
}
