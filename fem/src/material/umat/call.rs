//! One call of a routine: order of components, arguments, checks of the results.

use super::library::{NAME_LENGTH, Routine};
use crate::material::call_error::CallError;
use crate::material::point::UpdateContext;
use std::ffi::c_int;

/// Index in xx, yy, zz, xy, yz, zx of the components 11, 22, 33, 12, 13, 23 of Abaqus; its own inverse.
const ORDER: [usize; 6] = [0, 1, 2, 3, 5, 4];
/// Guard cells behind the state variables.
const GUARDS: usize = 8;
/// Content of a guard cell.
const GUARD: u64 = 0x7ff8_5a5a_a5a5_5a5a;
const UNIT: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// Input of a call, in the order of this program.
pub(super) struct Input<'a> {
    pub name: &'a [u8; NAME_LENGTH],
    pub constants: &'a [f64],
    pub context: UpdateContext,
    /// Number of the increment of the point, from 1.
    pub number: f64,
    pub strain: &'a [f64; 6],
    pub increment: &'a [f64; 6],
}

/// Stress, state variables and energies: old values, then results.
#[derive(Clone, Debug)]
pub(super) struct Data {
    pub stress: [f64; 6],
    pub states: Vec<f64>,
    /// SSE, SPD and SCD [J/m³].
    pub energies: [f64; 3],
    /// `d stress[i] / d strain[j]`; zero if the routine sets none.
    pub tangent: [[f64; 6]; 6],
}

fn permuted(v: &[f64; 6]) -> [f64; 6] {
    ORDER.map(|k| v[k])
}

impl Routine {
    /// Calls the routine.
    ///
    /// # Errors
    /// [`CallError`].
    pub(super) fn call(&self, input: &Input<'_>, data: &mut Data) -> Result<(), CallError> {
        let states = data.states.len();
        let mut tangent = [0.0; 36];
        let mut stress = permuted(&data.stress);
        data.states.resize(states + GUARDS, f64::from_bits(GUARD));
        let pnewdt = self.invoke(input, [&mut stress, &mut tangent], data, states);
        let guards = data.states.split_off(states);
        if guards.iter().any(|g| g.to_bits() != GUARD) {
            return Err(CallError::Overrun { states });
        }
        if pnewdt < 1.0 {
            return Err(CallError::ShorterStep { pnewdt });
        }
        let finite = |what, values: &[f64]| match values.iter().all(|v| v.is_finite()) {
            true => Ok(()),
            false => Err(CallError::NotFinite { what }),
        };
        finite("STRESS", &stress)?;
        finite("STATEV", &data.states)?;
        finite("DDSDDE", &tangent)?;
        finite("energy", &data.energies)?;
        data.stress = permuted(&stress);
        // Columns first.
        data.tangent = ORDER.map(|row| ORDER.map(|column| tangent[6 * column + row]));
        Ok(())
    }

    /// Returns PNEWDT.
    fn invoke(
        &self,
        input: &Input<'_>,
        [stress, tangent]: [&mut [f64]; 2],
        data: &mut Data,
        states: usize,
    ) -> f64 {
        let integer = |n: usize| n as c_int;
        let [sse, spd, scd] = &mut data.energies;
        let (mut strain, mut increment) = (permuted(input.strain), permuted(input.increment));
        let mut constants = input.constants.to_vec();
        let (mut name, mut pnewdt) = (*input.name, 1.0);
        let UpdateContext { time, mut time_step, element, point } = input.context;
        // Equilibrium before the start has negative times.
        let mut times = [time.max(0.0); 2];
        let [mut rpl, mut drpldt, mut temperature, mut change, mut length] = [0.0, 0.0, 0.0, 0.0, 1.0];
        let [mut by_temperature, mut heat] = [[0.0; 6]; 2];
        let [mut fields, mut field_changes] = [[0.0; 1]; 2];
        let (mut position, [mut rotation, mut before, mut after]) = ([0.0; 3], [UNIT; 3]);
        let [mut ndi, mut nshr, mut ntens] = [3, 3, 6];
        let (mut nstatv, mut nprops) = (integer(states), integer(constants.len()));
        let (mut noel, mut npt) = (element as c_int, point as c_int);
        let [mut layer, mut kspt] = [1, 1];
        let (mut step, mut number) = ([1, 0, 0, 0], input.number as c_int);
        // SAFETY: the arguments are those of UMAT; all arrays live until the return and have its lengths.
        unsafe {
            (self.umat)(
                stress.as_mut_ptr(),
                data.states.as_mut_ptr(),
                tangent.as_mut_ptr(),
                sse,
                spd,
                scd,
                &mut rpl,
                by_temperature.as_mut_ptr(),
                heat.as_mut_ptr(),
                &mut drpldt,
                strain.as_mut_ptr(),
                increment.as_mut_ptr(),
                times.as_mut_ptr(),
                &mut time_step,
                &mut temperature,
                &mut change,
                fields.as_mut_ptr(),
                field_changes.as_mut_ptr(),
                name.as_mut_ptr(),
                &mut ndi,
                &mut nshr,
                &mut ntens,
                &mut nstatv,
                constants.as_mut_ptr(),
                &mut nprops,
                position.as_mut_ptr(),
                rotation.as_mut_ptr(),
                &mut pnewdt,
                &mut length,
                before.as_mut_ptr(),
                after.as_mut_ptr(),
                &mut noel,
                &mut npt,
                &mut layer,
                &mut kspt,
                step.as_mut_ptr(),
                &mut number,
                NAME_LENGTH,
            );
        }
        pnewdt
    }
}
