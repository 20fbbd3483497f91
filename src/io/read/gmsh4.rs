//! Sections of Gmsh format 4.1.

use super::error::ReadError;
use super::gmsh::{Sections, Shape, one_element, shape};
use super::mesh_file::Builder;
use super::tokens::Tokens;

/// `$Entities`: physical groups of points, curves, surfaces, volumes.
pub(super) fn entities(tokens: &mut Tokens, sections: &mut Sections) -> Result<(), ReadError> {
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = tokens.count("number of entities")?;
    }
    for (dimension, count) in counts.into_iter().enumerate() {
        for _ in 0..count {
            let number = tokens.int("entity number")?;
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                tokens.real("bounds of an entity")?;
            }
            let groups = tokens.count("number of physical groups")?;
            let mut physical = Vec::new();
            for _ in 0..groups {
                physical.push(tokens.int("physical group")?.unsigned_abs());
            }
            sections.entities.insert((dimension, number), physical);
            if dimension > 0 {
                for _ in 0..tokens.count("number of bounding entities")? {
                    tokens.int("bounding entity")?;
                }
            }
        }
    }
    Ok(())
}

/// `$Nodes`: blocks by entity, each all ids, then all coordinates.
pub(super) fn nodes(tokens: &mut Tokens, builder: &mut Builder) -> Result<(), ReadError> {
    let blocks = tokens.count("number of blocks of nodes")?;
    for key in ["number of nodes", "least node number", "greatest node number"] {
        tokens.size(key)?;
    }
    for _ in 0..blocks {
        let dimension = tokens.int("dimension of an entity")?;
        tokens.int("entity number")?;
        let parametric = tokens.int("parametric")?;
        if !(0..=3).contains(&dimension) || !(0..=1).contains(&parametric) {
            let found = format!("dimension {dimension}, parametric {parametric}");
            return Err(tokens.fault("block of nodes", found, "0 to 3, and 0 or 1"));
        }
        let count = tokens.count("number of nodes of a block")?;
        let ids: Vec<u32> = (0..count).map(|_| tokens.id("node number")).collect::<Result<_, _>>()?;
        let more = if parametric == 1 { dimension } else { 0 };
        for id in ids {
            let line = tokens.line();
            let mut point = [0.0; 3];
            for x in &mut point {
                *x = tokens.real("coordinate of a node")?;
            }
            for _ in 0..more {
                tokens.real("parametric coordinate of a node")?;
            }
            builder.node(line, id, point)?;
        }
    }
    Ok(())
}

/// `$Elements`: blocks by entity and type.
pub(super) fn elements(tokens: &mut Tokens, sections: &mut Sections) -> Result<(), ReadError> {
    let blocks = tokens.count("number of blocks of elements")?;
    for key in ["number of elements", "least element number", "greatest element number"] {
        tokens.size(key)?;
    }
    for _ in 0..blocks {
        let dimension = tokens.int("dimension of an entity")?;
        let entity = tokens.int("entity number")?;
        let kind = tokens.int("element type")?;
        let shape = shape(tokens, kind)?;
        let own = match shape {
            Shape::Volume(_) => 3,
            Shape::Lower { dimension, .. } => dimension,
        };
        if usize::try_from(dimension) != Ok(own) {
            let found = format!("elements of type {kind} in an entity of dimension {dimension}");
            return Err(tokens.fault("block of elements", found, own.to_string()));
        }
        let groups = sections.entities.get(&(own, entity)).cloned().unwrap_or_default();
        let count = tokens.count("number of elements of a block")?;
        for _ in 0..count {
            let line = tokens.line();
            let id = tokens.id("element number")?;
            let place = (line, id, entity.unsigned_abs());
            one_element(tokens, sections, place, &shape, groups.clone(), Tokens::id)?;
        }
    }
    Ok(())
}
