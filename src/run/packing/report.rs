//! Packing lines of the report.

use super::bed_stage::BedStage;
use super::records::{CompactionRecord, GrowthRecord, PackingRecord, TampingRecord};

/// Formats packing lines.
pub fn report(
    beds: &[BedStage],
    growth: &[GrowthRecord],
    (earlier, compaction): (usize, &[CompactionRecord]),
    tamping: &[TampingRecord],
    packing: Option<&PackingRecord>,
) -> Vec<String> {
    let mut lines = Vec::new();
    for g in growth {
        lines.push(format!(
            "radius expansion of {}: porosity {:.4}, largest overlap {:.2e} of the radius, unbalanced force {:.1e}",
            g.group, g.porosity, g.largest_overlap, g.unbalanced_ratio
        ));
    }
    for (i, c) in compaction.iter().enumerate() {
        let force = c.wall_force.map_or(String::new(), |f| format!(", force on the plane {f:.3e} N"));
        lines.push(format!(
            "compaction {} ({}): porosity {:.4} to {:.4}{force}",
            earlier + i + 1,
            c.kind,
            c.porosity_before,
            c.porosity_after
        ));
    }
    for t in tamping {
        lines.push(format!(
            "sleeper {} tamped: raised {:.2} mm; force of a blade {:.2} kN entering, {:.2} kN closing by {:.0} mm; work {:.0} J",
            t.sleeper,
            1e3 * t.raised,
            1e-3 * t.insertion_force,
            1e-3 * t.squeeze_force,
            1e3 * t.travel,
            t.work
        ));
    }
    lines.extend(beds.iter().flat_map(BedStage::lines));
    let Some(p) = packing else { return lines };
    lines.push(format!(
        "grains: {:.2} neighbours, {:.2} without rattlers ({:.1} % of the grains); {:.0} % of the contacts carry {:.0} % of \
         the normal forces",
        p.coordination,
        p.mechanical_coordination,
        100.0 * p.rattlers,
        100.0 * p.strong_contacts,
        100.0 * p.strong_load
    ));
    for m in &p.measures {
        let pressure = -(m.stress[0] + m.stress[1] + m.stress[2]) / 3.0;
        lines.push(format!(
            "{}: porosity {:.4}, {} grains, {:.2} neighbours, mean pressure {:.3} kPa",
            m.name,
            m.porosity,
            m.grains,
            m.coordination,
            1e-3 * pressure
        ));
    }
    if let Some(f) = &p.fouling {
        let boxes: Vec<String> = f
            .boxes
            .iter()
            .map(|(name, _, share)| format!(", {:.1} % of the voids of {name}", 100.0 * share))
            .collect();
        lines.push(format!("fines: {:.2} % of the mass{}", 100.0 * f.fouling_index, boxes.concat()));
    }
    for g in &p.gradations {
        lines.push(format!(
            "sieve curve of {}: {} stones, within {:.2} % passing of the target curve",
            g.group,
            g.stones,
            100.0 * g.largest_deviation
        ));
    }
    lines
}
