//! A solid that runs alone: static, quasi-static, dynamic, or brought to failure.

use super::checkpoint::Loaded;
use super::main_stage::RUN;
use super::plastic::{PlasticDynamics, QuasiStaticSystem};
use super::summary::{NewtonRecord, Summary};
use super::system::{SolidSystem, System};
use super::{Stage, failure_factor, statics};
use crate::failure::Failure;
use crate::model::solid::{Analysis, SolidPart};

impl Stage<'_> {
    /// Runs a solid without grains.
    pub(super) fn solid_alone(&self, solid: &SolidPart, summary: &mut Summary) -> Result<(), Failure> {
        match &solid.analysis {
            Analysis::Static => statics::run(self.job, solid, self.dir, || self.prepare(), summary),
            Analysis::Dynamic(method) if solid.is_linear() => {
                let dt = self.job.solid_step.expect("a dynamic solid has a step");
                let mut resumed = self.resumed(RUN);
                let mut system = match &mut resumed {
                    Some(loaded) => SolidSystem::resume(solid, *method, dt, loaded)?,
                    None => SolidSystem::new(solid, *method, dt).map_err(|e| solid.failure(&e))?,
                };
                self.march(solid, &mut system, resumed, summary)
            }
            Analysis::QuasiStatic(plan) => {
                let step = self.job.solid_step.expect("a quasi-static solid has a step");
                let mut resumed = self.resumed(RUN);
                let mut system = match &mut resumed {
                    Some(loaded) => QuasiStaticSystem::resume(solid, plan, step, loaded)?,
                    None => QuasiStaticSystem::new(solid, plan, step)?,
                };
                let outcome = self.march(solid, &mut system, resumed, summary);
                summary.newton = Some(NewtonRecord::of(&system.statistics()));
                outcome
            }
            Analysis::StrengthReduction(plan) => failure_factor::run(self, solid, plan, summary),
            Analysis::Dynamic(method) => {
                let dt = self.job.solid_step.expect("a dynamic solid has a step");
                let mut resumed = self.resumed(RUN);
                let mut system = match &mut resumed {
                    Some(loaded) => PlasticDynamics::resume(solid, *method, dt, loaded)?,
                    None => PlasticDynamics::new(solid, *method, dt)?,
                };
                let outcome = self.march(solid, &mut system, resumed, summary);
                summary.newton = Some(NewtonRecord::of(&system.statistics()));
                outcome
            }
        }
    }

    /// Advances a system to the end of the run and writes its last state.
    fn march<S: System>(
        &self,
        solid: &SolidPart,
        system: &mut S,
        resumed: Option<Loaded>,
        summary: &mut Summary,
    ) -> Result<(), Failure> {
        summary.model.solid_step = self.job.solid_step;
        self.prepare()?;
        let outcome = self.main_stage(system, None, resumed, summary);
        // A step without equilibrium leaves the last state that had one.
        match &outcome {
            Ok(()) => {}
            Err(Failure::Numerical(_)) if system.keeps_its_state() => {}
            Err(_) => return outcome,
        }
        let reactions = system.reactions().unwrap_or_default();
        summary.reactions = solid
            .named_sums(&reactions)
            .map(|(name, force)| super::summary::ReactionRecord { name: name.to_string(), force })
            .collect();
        if self.job.output.tables {
            let state = system.solid().expect("a system with a solid").state;
            statics::write_tables(&solid.model, state, &reactions, self.dir)?;
        }
        outcome
    }
}
