//! User materials: constitutive laws of shared libraries by the interface UMAT of Abaqus.
//!
//! Inelastic strain is the increment without its part of reference elasticity, `d eps - C^-1 d sigma`, so that
//! the energy balance closes for any law. Source: Abaqus User Subroutines Reference Guide, section UMAT.
//! Limits: small strain, no temperature, COORDS is 0 and CELENT is 1.
//!
//! Theory manual: section 4.8 of `docs/theory/solid.md`.

mod call;
mod library;

pub use library::{LibraryError, Routine};

use super::call_error::CallError;
use super::elastic::{Elastic, InvalidConstant};
use super::law::{ConstitutiveLaw, Response, ReturnError, StateValue};
use super::point::{Point, PointState, ReturnRegion};
use call::{Data, Input};
use library::NAME_LENGTH;
use std::borrow::Cow;
use std::sync::{Arc, Mutex, PoisonError};

/// Largest number of constants and of state variables.
pub const MOST_VALUES: usize = 1000;
/// Step of central differences over the strain increment.
const DIFFERENCE: f64 = 1e-6;
/// Least strain increment for the step of differences.
const LEAST: f64 = 1e-5;
/// Inelastic strain over the increment that counts as rounding.
const ROUNDING: f64 = 1e-10;
/// Serialises the routines that are not thread safe, across libraries: they may share their runtime.
static ONE_CALL: Mutex<()> = Mutex::new(());

/// Source of the tangent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UserTangent {
    /// DDSDDE; central differences of the stress if it is left at zero.
    #[default]
    Library,
    /// Central differences of the stress.
    Differences,
}

/// Source of stored and dissipated energy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UserEnergy {
    /// Elastic energy of the stress by the reference elasticity, work on the inelastic strain.
    #[default]
    Reference,
    /// SSE, and the sum of SPD and SCD.
    Library,
}

/// Options of a user material.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UserOptions {
    /// Name passed as CMNAME, at most 80 characters.
    pub name: String,
    /// PROPS.
    pub constants: Vec<f64>,
    /// STATEV with initial values.
    pub states: Vec<(StateValue, f64)>,
    /// Source of the tangent.
    pub tangent: UserTangent,
    /// Source of the energies.
    pub energy: UserEnergy,
    /// Whether several threads may call the routine simultaneously.
    pub thread_safe: bool,
}

#[derive(Debug, PartialEq)]
struct Definition {
    routine: Routine,
    options: UserOptions,
    name: [u8; NAME_LENGTH],
    /// State variables, total strain, number of increments, energies.
    values: Vec<StateValue>,
}

/// Law of a shared library; copies share it.
#[derive(Clone, Debug, PartialEq)]
pub struct UserMaterial(Arc<Definition>);

impl UserMaterial {
    /// Law of a loaded routine.
    ///
    /// # Errors
    /// Numbers of constants and state variables other than declared by the library.
    pub fn new(routine: Routine, options: UserOptions) -> Result<UserMaterial, LibraryError> {
        routine.check_counts(options.constants.len(), options.states.len())?;
        let mut name = [b' '; NAME_LENGTH];
        for (at, byte) in name.iter_mut().zip(options.name.to_ascii_uppercase().bytes()) {
            *at = byte;
        }
        let value =
            |name: &'static str, unit: &'static str| StateValue { name: name.into(), unit: unit.into() };
        let mut values: Vec<StateValue> = options.states.iter().map(|(value, _)| value.clone()).collect();
        values.extend(
            ["xx", "yy", "zz", "xy", "yz", "zx"].map(|k| StateValue {
                name: Cow::Owned(format!("total_strain_{k}")),
                unit: Cow::Borrowed(""),
            }),
        );
        values.push(value("increments", ""));
        if options.energy == UserEnergy::Library {
            let names = ["elastic_energy", "plastic_dissipation", "creep_dissipation"];
            values.extend(names.map(|name| value(name, "J/m3")));
        }
        Ok(UserMaterial(Arc::new(Definition { routine, options, name, values })))
    }

    /// Routine and library.
    pub fn routine(&self) -> &Routine {
        &self.0.routine
    }

    /// Formats routine and library for messages.
    pub fn label(&self) -> String {
        format!("user material `{}` of {}", self.0.routine.name(), self.0.routine.path().display())
    }

    /// Index of the total strain in the state values.
    fn strain_index(&self) -> usize {
        self.0.options.states.len()
    }

    fn energies(&self, values: &[f64]) -> [f64; 3] {
        values[self.strain_index() + 7..].first_chunk().copied().unwrap_or_default()
    }

    fn call(&self, old: Point<'_>, increment: &[f64; 6]) -> Result<Data, CallError> {
        let Definition { routine, options, name, .. } = &*self.0;
        let at = self.strain_index();
        let input = Input {
            name,
            constants: &options.constants,
            context: old.context,
            number: old.values[at + 6] + 1.0,
            strain: &std::array::from_fn(|k| old.values[at + k]),
            increment,
        };
        let mut data = Data {
            stress: old.state.stress,
            states: old.values[..at].to_vec(),
            energies: self.energies(old.values),
            tangent: [[0.0; 6]; 6],
        };
        let _lock = (!options.thread_safe).then(|| ONE_CALL.lock().unwrap_or_else(PoisonError::into_inner));
        routine.call(&input, &mut data)?;
        Ok(data)
    }

    fn differences(&self, old: Point<'_>, increment: &[f64; 6]) -> Result<[[f64; 6]; 6], CallError> {
        let size = increment.iter().fold(LEAST, |most, e| most.max(e.abs()));
        let step = DIFFERENCE * size;
        let mut tangent = [[0.0; 6]; 6];
        for j in 0..6 {
            let side = |change: f64| {
                let mut strain = *increment;
                strain[j] += change;
                self.call(old, &strain).map(|data| data.stress)
            };
            let (ahead, behind) = (side(step)?, side(-step)?);
            for i in 0..6 {
                tangent[i][j] = (ahead[i] - behind[i]) / (2.0 * step);
            }
        }
        Ok(tangent)
    }

    fn tangent(&self, old: Point<'_>, increment: &[f64; 6], data: &Data) -> Result<[[f64; 6]; 6], CallError> {
        let absent = data.tangent.as_flattened().iter().all(|d| *d == 0.0);
        match self.0.options.tangent {
            UserTangent::Library if !absent => Ok(data.tangent),
            _ => self.differences(old, increment),
        }
    }
}

impl ConstitutiveLaw for UserMaterial {
    fn source(&self) -> &'static str {
        "user material: interface UMAT, Abaqus User Subroutines Reference Guide"
    }

    /// The routine checks its own constants.
    fn invalid_constant(&self, _: &Elastic) -> Option<InvalidConstant> {
        None
    }

    fn has_constant_elasticity(&self) -> bool {
        false
    }

    fn is_associated(&self) -> bool {
        false
    }

    fn has_plastic_strain(&self) -> bool {
        false
    }

    /// Unknown: state variables may be tensors, which a rotation of the stress leaves.
    fn is_isotropic(&self) -> bool {
        false
    }

    fn has_symmetric_tangent(&self) -> bool {
        false
    }

    fn state_values(&self) -> &[StateValue] {
        &self.0.values
    }

    fn initial_values(&self, elastic: &Elastic, stress: &[f64; 6], values: &mut [f64]) {
        let (states, own) = values.split_at_mut(self.strain_index());
        states.iter_mut().zip(&self.0.options.states).for_each(|(v, (_, initial))| *v = *initial);
        own.fill(0.0);
        if let Some(energy) = own.get_mut(7) {
            *energy = elastic.stored_energy(stress);
        }
    }

    fn update(
        &self,
        elastic: &Elastic,
        old: Point<'_>,
        increment: &[f64; 6],
        want_tangent: bool,
        values: &mut [f64],
    ) -> Result<Response, ReturnError> {
        let data = self.call(old, increment)?;
        let tangent = if want_tangent { self.tangent(old, increment, &data)? } else { [[0.0; 6]; 6] };
        let at = self.strain_index();
        values[..at].copy_from_slice(&data.states);
        (0..6).for_each(|k| values[at + k] = old.values[at + k] + increment[k]);
        values[at + 6] = old.values[at + 6] + 1.0;
        if let Some(energies) = values[at + 7..].first_chunk_mut() {
            *energies = data.energies;
        }
        let mut state = PointState { stress: data.stress, ..*old.state };
        let inelastic = inelastic(elastic, &old.state.stress, &data.stress, increment);
        if let Some(strain) = inelastic {
            (0..6).for_each(|k| state.plastic_strain[k] += strain[k]);
            let square: f64 = (0..6).map(|k| if k < 3 { 1.0 } else { 0.5 } * strain[k] * strain[k]).sum();
            state.kappa += (2.0 / 3.0 * square).sqrt();
        }
        let region = inelastic.map_or(ReturnRegion::Elastic, |_| ReturnRegion::Named("inelastic"));
        Ok(Response { state, region, tangent })
    }

    fn stored_energy(&self, elastic: &Elastic, point: Point<'_>) -> f64 {
        match self.0.options.energy {
            UserEnergy::Reference => elastic.stored_energy(&point.state.stress),
            UserEnergy::Library => self.energies(point.values)[0],
        }
    }

    fn dissipation(&self, old: Point<'_>, new: Point<'_>) -> Option<f64> {
        let spent = |point: Point<'_>| self.energies(point.values)[1..].iter().sum::<f64>();
        (self.0.options.energy == UserEnergy::Library).then(|| spent(new) - spent(old))
    }

    fn yield_function(&self, _: Point<'_>) -> f64 {
        f64::NEG_INFINITY
    }

    /// The strength is unknown: unchanged.
    fn with_strength_divided_by(&self, _: f64) -> UserMaterial {
        self.clone()
    }
}

/// Strain increment without its elastic part, `d eps - C^-1 d sigma`; none within rounding.
fn inelastic(elastic: &Elastic, old: &[f64; 6], new: &[f64; 6], increment: &[f64; 6]) -> Option<[f64; 6]> {
    let largest = |v: &[f64; 6]| v.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let change: [f64; 6] = std::array::from_fn(|k| new[k] - old[k]);
    let (trace, shear) = (change[0] + change[1] + change[2], 2.0 * (1.0 + elastic.poisson));
    let strain: [f64; 6] = std::array::from_fn(|k| {
        let elastic = if k < 3 {
            ((1.0 + elastic.poisson) * change[k] - elastic.poisson * trace) / elastic.young
        } else {
            shear * change[k] / elastic.young
        };
        increment[k] - elastic
    });
    let rounding = 4.0 * f64::EPSILON * (largest(old) + largest(new)) / elastic.young;
    (largest(&strain) > ROUNDING * largest(increment) + rounding).then_some(strain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elastic_increments_leave_no_inelastic_strain() {
        let elastic = Elastic { young: 20e6, poisson: 0.3, density: 0.0 };
        let old = [-1e5, -1.2e5, -0.9e5, 1e3, -2e3, 3e3];
        let increment = [1e-5, -2e-5, 3e-6, 4e-6, -5e-6, 6e-6];
        let step = elastic.stress(&increment);
        let new: [f64; 6] = std::array::from_fn(|k| old[k] + step[k]);
        assert_eq!(inelastic(&elastic, &old, &new, &increment), None);
        let strain = inelastic(&elastic, &old, &old, &increment).expect("no stress, no elastic strain");
        assert_eq!(strain, increment);
    }
}
