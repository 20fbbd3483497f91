//! Final report, also in `log.txt`.

use super::{CouplingRecord, Summary};
use crate::events::EventRecord;
use crate::flow::FlowRecord;
use crate::hazard::HazardRecord;
use crate::packing;
use crate::runout::RunoutRecord;
use crate::specimen::SpecimenRecord;
use crate::validity;
use trackbed_coupling::scheme::Scheme;

impl Summary {
    /// Formats the results; `details`: with stability numbers and factorizations.
    pub fn report(&self, details: bool) -> String {
        let mut lines = Vec::new();
        self.report_settlement(&mut lines, details);
        self.report_track(&mut lines);
        self.report_solid(&mut lines, details);
        self.report_floating(&mut lines);
        self.report_loads(&mut lines);
        lines.extend(self.bed.flow.iter().flat_map(FlowRecord::report));
        let bed = &self.bed;
        lines.extend(packing::report(
            &bed.beds,
            &bed.growth,
            (bed.earlier, &bed.compaction),
            &bed.tamping,
            bed.packing.as_ref(),
        ));
        lines.extend(self.bed.runout.iter().flat_map(RunoutRecord::report));
        lines.extend(self.bed.specimen.iter().flat_map(SpecimenRecord::report));
        self.report_stages(&mut lines);
        self.report_accounts(&mut lines, details);
        self.report_coupling(&mut lines, details);
        lines.extend(self.verdict.report());
        lines.extend(validity::report(&self.validity));
        lines.extend(self.warnings.iter().map(|warning| format!("warning: {warning}")));
        lines.join("\n") + "\n"
    }

    fn report_stages(&self, lines: &mut Vec<String>) {
        if let Some(r) = &self.model.reduction {
            lines.push(format!("solid reduced: {r}"));
        }
        for stage in &self.stages {
            let counts = [(stage.grain_steps, "DEM"), (stage.solid_steps, "FEM")];
            let counts = counts.iter().filter(|(count, _)| *count > 0);
            let steps: String = counts.map(|(count, kind)| format!(", {count} {kind} steps")).collect();
            lines.push(format!("{}: {:.1} s{steps}", stage.name, stage.seconds));
        }
    }

    fn report_solid(&self, lines: &mut Vec<String>, details: bool) {
        if let Some(s) = &self.solid.statics {
            let (u, node) = s.largest_displacement;
            lines.push(format!("largest displacement {u:.3e} m at node {node}"));
            lines.push(format!(
                "equilibrium error of loads and reactions: {:.1e} (relative)",
                s.equilibrium_error
            ));
        }
        if let Some(n) = self.solid.newton.as_ref().filter(|_| details) {
            lines.push(format!(
                "Newton: {} steps ({} halved), {} iterations",
                n.steps, n.halvings, n.iterations
            ));
            lines.push(format!(
                "  factorizations: {} symmetric, {} unsymmetric; time: assembly {:.1} s, factorization {:.1} s, solves {:.1} s",
                n.factorizations_symmetric,
                n.factorizations_unsymmetric,
                n.assembly_seconds,
                n.factor_seconds,
                n.solve_seconds
            ));
        }
        if let Some(p) = &self.solid.plastic {
            let [x, y, z] = p.place;
            lines.push(format!(
                "solid: {:.1} % of the integration points have yielded, largest plastic strain {:.3e} in element {} at ({x:.3}, \
                 {y:.3}, {z:.3}) m",
                100.0 * p.yielded_share,
                p.largest_plastic_strain,
                p.element
            ));
        }
        for r in &self.solid.reactions {
            let (factor, unit) =
                if r.force.iter().any(|f| f.abs() >= 1e3) { (1e-3, "kN") } else { (1.0, "N") };
            let [x, y, z] = r.force.map(|f| factor * f);
            lines.push(format!("reaction of {}: ({x:.3}, {y:.3}, {z:.3}) {unit}", r.name));
        }
        if let Some(s) = &self.solid.safety {
            lines.push(format!(
                "factor of safety: stable at {:.4}, unstable at {:.4} ({} trials)",
                s.stable_at,
                s.unstable_at,
                s.trials.len()
            ));
        }
    }

    fn report_accounts(&self, lines: &mut Vec<String>, details: bool) {
        if let Some(e) = &self.energy {
            lines.push(format!(
                "external work {:.4} J, energy error {:.2e} J ({:.3} % of the reference energy)",
                e.work,
                e.error,
                100.0 * e.relative_error
            ));
        }
        if let Some(m) = self.momentum.as_ref().filter(|_| details) {
            lines.push(format!(
                "momentum error {:.1e}, angular {:.1e} (relative to the impulses)",
                m.linear, m.angular
            ));
        }
    }

    fn report_floating(&self, lines: &mut Vec<String>) {
        for f in &self.floating {
            let [x, y, z] = f.mean_contact_force;
            lines.push(format!(
                "{}: mean speed {:.3} m/s, heading {:.2} degrees; mean contact force of the recorded rows {x:.3e} N along x, {y:.3e} N along y, {z:.3e} N along z",
                f.name,
                f.mean_speed,
                f.rotation[2].to_degrees()
            ));
            if let Some(p) = &f.propulsion {
                lines.push(format!(
                    "propulsion of {}: thrust requested {:.3e} N, applied {:.3e} N (means); rudder: largest angle {:.1} degrees, largest force {:.3e} N",
                    f.name,
                    p.mean_requested,
                    p.mean_applied,
                    p.largest_rudder_angle.to_degrees(),
                    p.largest_rudder_force
                ));
            }
        }
    }

    fn report_loads(&self, lines: &mut Vec<String>) {
        for s in &self.structures {
            lines.push(format!(
                "load on {}: maximum {:.3e} N at {:.3} s, mean {:.3e} N along x, {:.3e} N along y",
                s.name, s.largest, s.time, s.mean[0], s.mean[1]
            ));
            if let Some(m) = &s.motion {
                lines.push(format!(
                    "motion of {}: maximum {:.3e} m, mean {:.3e} m along x, {:.3e} m along y; acceleration: maximum {:.3e} m/s2, r.m.s. {:.3e} m/s2",
                    s.name,
                    m.largest_displacement,
                    m.mean_displacement[0],
                    m.mean_displacement[1],
                    m.largest_acceleration,
                    m.rms_acceleration
                ));
            }
            let hazard = s.hazard.iter().flat_map(HazardRecord::text);
            lines.extend(hazard.map(|text| format!("load on {}: {text}", s.name)));
        }
        if let Some(b) = &self.bonds {
            lines.push(format!(
                "bonds: {} of {} broken ({} in tension, {} in shear), {:.3e} J released; {} fragments, largest of {} bodies",
                b.broken_by_tension + b.broken_by_shear,
                b.made,
                b.broken_by_tension,
                b.broken_by_shear,
                b.energy_of_breaks,
                b.fragments,
                b.largest_fragment
            ));
            lines.extend(b.events.iter().map(EventRecord::report));
            if let Some(b) = &b.breakage {
                let index =
                    b.ballast_index.map_or(String::new(), |i| format!(", ballast breakage index {i:.3}"));
                lines.push(format!("breakage of bonded stones: Marsal {:.1} %{index}", 100.0 * b.marsal));
            }
        }
    }

    fn report_coupling(&self, lines: &mut Vec<String>, details: bool) {
        if let Some(c) = &self.coupling {
            lines.push(format!(
                "interface: force error {:.1e}, moment error {:.1e} (relative)",
                c.transfer.force, c.transfer.moment
            ));
            if details {
                lines.push(format!(
                    "  scheme {}, {} DEM sub-steps, transfer {}",
                    c.scheme, c.substeps, c.transfer_kind
                ));
                lines.extend(c.stability_lines());
            }
            if let Some(found) = &c.reduction {
                lines.push(format!(
                    "reduced solid: error of displacements {:.2e}, of the stress {:.2e} (of their largest, {} windows)",
                    found.displacement, found.stress, found.windows
                ));
            }
            if matches!(c.scheme, Scheme::Iterated { .. }) && c.passes.windows > 0 {
                lines.push(format!(
                    "  {:.2} passes per window, {} windows not converged",
                    c.passes.passes as f64 / c.passes.windows as f64,
                    c.passes.unconverged
                ));
            }
        }
    }

    fn report_settlement(&self, lines: &mut Vec<String>, details: bool) {
        if let Some(s) = &self.track.settlement {
            if let Some(seating) = s.seating {
                lines.push(format!("settlement during seating, not counted [mm]: {:.3}", 1e3 * seating));
            }
            let list: Vec<String> = s.per_cycle.iter().map(|s| format!("{:.3}", 1e3 * s)).collect();
            if list.len() <= 20 {
                lines.push(format!("settlement after each cycle [mm]: {}", list.join(" ")));
            } else {
                let last = list.len() - 1;
                lines.push(format!(
                    "settlement [mm]: {} after the first cycle, {} after the last",
                    list[0], list[last]
                ));
            }
            if let Some(b) = &s.bed_stiffness {
                let [low, high] = b.between.map(|f| 1e-3 * f);
                lines.push(format!(
                    "bed stiffness between {low:.1} and {high:.1} kN: {:.1} kN/mm",
                    1e-6 * b.mean_of_last_ten
                ));
            }
            let best = s.fits.iter().max_by(|a, b| a.r2.total_cmp(&b.r2));
            for fit in s.fits.iter().filter(|fit| details || best.is_some_and(|best| best.law == fit.law)) {
                let p: Vec<String> = fit.parameters.iter().map(|(n, v)| format!("{n} = {v:.3e}")).collect();
                let (law, form) = (&fit.law, &fit.form);
                lines.push(format!("{law}: s [m] = {form}, {}, R2 = {:.3}", p.join(", "), fit.r2));
            }
            if let Some(j) = &s.jump {
                lines.push(format!(
                    "cycle jumps ({}): {} cycles simulated, {} skipped; estimated settlement error {:.3} mm ({:.1} %)",
                    j.method,
                    j.simulated,
                    j.skipped,
                    1e3 * j.error_estimate,
                    100.0 * j.relative_error_estimate
                ));
                lines.extend(j.forecasts.iter().map(|f| {
                    format!(
                        "settlement of simulated cycle {:.0} forecast from cycle {:.0} [mm]: {:.3} +/- {:.3}, found {:.3}",
                        f.cycle,
                        f.from,
                        1e3 * f.predicted,
                        1e3 * f.error_estimate,
                        1e3 * f.settlement
                    )
                }));
            }
        }
    }

    fn report_track(&self, lines: &mut Vec<String>) {
        if let Some(p) = &self.track.push {
            let at_two =
                p.resistance_at_2_mm.map_or(String::new(), |f| format!("{:.3} kN at 2 mm, ", 1e-3 * f));
            lines.push(format!(
                "lateral resistance: {at_two}peak {:.3} kN at {:.2} mm, vertical force {:.3} kN",
                1e-3 * p.peak,
                1e3 * p.displacement_at_peak,
                1e-3 * p.vertical_force
            ));
        }
        for (k, s) in self.track.sleepers.iter().flat_map(|t| t.sleepers.iter().enumerate()) {
            let share =
                s.load_share.map_or(String::new(), |p| format!(" ({:.1} % of the axle load)", 100.0 * p));
            let factor =
                s.dynamic_amplification.map_or(String::new(), |f| format!(", dynamic factor {f:.3}"));
            let bend = s.bend.map_or(String::new(), |[low, high]| {
                format!(", ends {:.4} to {:.4} mm above the middle", 1e3 * low, 1e3 * high)
            });
            lines.push(format!(
                "sleeper {}: force {:.2} to {:.2} kN{share}{factor}, largest downward displacement {:.3} mm{bend}",
                k + 1,
                1e-3 * s.smallest_force,
                1e-3 * s.largest_force,
                1e3 * s.lowering
            ));
        }
    }
}

impl CouplingRecord {
    fn stability_lines(&self) -> Vec<String> {
        let (s, n) = (&self.stability, &self.interface);
        let mut lines = vec![format!("  stability: W = {:.2}, D = {:.2}", s.stiffness, s.damping)];
        lines.extend(self.classes.iter().map(|class| format!("  {}", class.line())));
        lines.push(format!(
            "  all contacts, maximum of the run: W = {:.3}, D = {:.3}, phase of undamped contacts {:.3}; theta = {:.4}, windows divided by {}",
            n.stiffness, n.damping, n.phase, self.theta, self.division
        ));
        lines
    }
}
