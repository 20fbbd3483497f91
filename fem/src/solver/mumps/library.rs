//! Bindings to MUMPS.

use super::{Coordinates, MumpsError, Settings};
use std::ffi::{CString, c_char, c_int, c_longlong};
use std::ptr::{NonNull, null_mut};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// MUMPS structure, with a layout known to C only.
#[repr(C)]
struct Structure {
    private: [u8; 0],
}

unsafe extern "C" {
    fn trackbed_mumps_start() -> *mut Structure;
    fn trackbed_mumps_end(id: *mut Structure);
    fn trackbed_mumps_set(id: *mut Structure, index: c_int, value: c_int);
    fn trackbed_mumps_set_real(id: *mut Structure, index: c_int, value: f64);
    fn trackbed_mumps_folder(id: *mut Structure, folder: *const c_char) -> c_int;
    fn trackbed_mumps_matrix(
        id: *mut Structure,
        n: c_int,
        nnz: c_longlong,
        row: *mut c_int,
        column: *mut c_int,
        value: *mut f64,
        place: *mut c_int,
    );
    fn trackbed_mumps_side(id: *mut Structure, x: *mut f64);
    fn trackbed_mumps_run(id: *mut Structure, job: c_int) -> c_int;
    fn trackbed_mumps_info(id: *const Structure, index: c_int) -> c_int;
    fn trackbed_mumps_null_pivot(id: *const Structure) -> c_int;
}

/// Serialises MUMPS calls: its instances share variables.
static LIBRARY_LOCK: Mutex<()> = Mutex::new(());

fn lock_library() -> MutexGuard<'static, ()> {
    // Panics cannot interrupt MUMPS calls, so poisoning is harmless.
    LIBRARY_LOCK.lock().unwrap_or_else(PoisonError::into_inner)
}

const ANALYSE: c_int = 1;
const FACTOR: c_int = 2;
const SOLVE: c_int = 3;

/// Memory margin over the estimate, initial and maximum [%].
const EXTRA_WORKSPACE: c_int = 20;
const MAX_EXTRA_WORKSPACE: c_int = 320;

/// Relative exchange threshold, never reached by positive definite matrices.
const PIVOTING: f64 = 1e-14;

impl Coordinates {
    fn memory(&self) -> usize {
        (2 * size_of::<i32>() + size_of::<f64>()) * self.row.len()
    }
}

/// Memory predicted by MUMPS [bytes].
///
/// # Errors
/// As [`Factor::new`], without numerical errors.
pub fn demand(matrix: Coordinates, settings: Settings) -> Result<usize, MumpsError> {
    if matrix.place.is_empty() {
        return Ok(0);
    }
    let mut matrix = matrix;
    let entries = matrix.memory();
    let instance = Instance::analysed(&mut matrix, settings)?;
    let estimate = if settings.out_of_core { 27 } else { 17 };
    Ok(1_000_000 * instance.info(estimate).unsigned_abs() as usize + entries)
}

/// MUMPS factor.
pub struct Factor {
    size: usize,
    instance: Option<Instance>,
    memory: usize,
}

impl Factor {
    /// Analyses and factors a matrix.
    ///
    /// # Errors
    /// [`MumpsError::Pivot`], [`MumpsError::NotPositive`]; out of memory, I/O errors, values not finite.
    ///
    /// # Panics
    /// Inconsistent lengths; row, column or position out of range.
    pub fn new(mut matrix: Coordinates, settings: Settings) -> Result<Factor, MumpsError> {
        let size = matrix.place.len();
        if size == 0 {
            return Ok(Factor { size, instance: None, memory: 0 });
        }
        let mut instance = Instance::analysed(&mut matrix, settings)?;
        let mut room = EXTRA_WORKSPACE;
        loop {
            instance.set(14, room);
            match instance.run(FACTOR) {
                Err(MumpsError::Room) if room < MAX_EXTRA_WORKSPACE => room *= 2,
                Err(other) => return Err(other),
                Ok(()) => break,
            }
        }
        if instance.info(28) > 0 {
            return Err(MumpsError::Pivot { equation: instance.null_pivot() });
        }
        if instance.info(12) > 0 {
            return Err(MumpsError::NotPositive { pivots: instance.info(12).unsigned_abs() });
        }
        instance.release_matrix(size);
        let memory = 1_000_000 * instance.info(22).unsigned_abs() as usize + matrix.memory();
        Ok(Factor { size, instance: Some(instance), memory })
    }

    /// Equation count.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Peak memory of the factorisation [bytes].
    pub fn memory(&self) -> usize {
        self.memory
    }

    /// Solves in place. Shape `[equations]`.
    ///
    /// # Errors
    /// I/O errors; out of memory.
    ///
    /// # Panics
    /// If the length of `x` differs.
    pub fn solve_in_place(&mut self, x: &mut [f64]) -> Result<(), MumpsError> {
        assert_eq!(x.len(), self.size, "one value for every equation");
        match &mut self.instance {
            None => Ok(()),
            Some(instance) => instance.solve(x),
        }
    }
}

/// MUMPS instance; holds no foreign pointers between calls.
struct Instance(NonNull<Structure>);

// SAFETY: an instance has one owner and no thread affinity; shared variables change only under `LIBRARY_LOCK`.
unsafe impl Send for Instance {}
// SAFETY: a shared `Instance` only returns integers, which change only through `&mut`.
unsafe impl Sync for Instance {}

impl Drop for Instance {
    fn drop(&mut self) {
        let _turn = lock_library();
        // SAFETY: the pointer comes from `trackbed_mumps_start`; this is its last use.
        unsafe { trackbed_mumps_end(self.0.as_ptr()) }
    }
}

impl Instance {
    /// Analyses the pattern; points to `matrix` until [`Instance::release_matrix`].
    fn analysed(matrix: &mut Coordinates, settings: Settings) -> Result<Instance, MumpsError> {
        let Coordinates { row, column, value, place } = matrix;
        let n = c_int::try_from(place.len()).map_err(|_| MumpsError::Memory)?;
        assert!(
            row.len() == column.len() && row.len() == value.len(),
            "one row, column and value for every entry"
        );
        let inside = |i: &i32| (1..=n).contains(i);
        assert!(
            row.iter().chain(&*column).chain(&*place).all(inside),
            "rows, columns and places from 1 to {n}"
        );
        let raw = {
            let _turn = lock_library();
            // SAFETY: no arguments.
            unsafe { trackbed_mumps_start() }
        };
        let mut instance = Instance(NonNull::new(raw).ok_or(MumpsError::Memory)?);
        let (nnz, id) = (row.len() as c_longlong, instance.0.as_ptr());
        // SAFETY: `nnz`, `nnz`, `nnz` and `n` values, read only by analysis and factorisation, while the
        // caller owns them.
        unsafe {
            trackbed_mumps_matrix(
                id,
                n,
                nnz,
                row.as_mut_ptr(),
                column.as_mut_ptr(),
                value.as_mut_ptr(),
                place.as_mut_ptr(),
            );
        }
        instance.configure(settings)?;
        instance.run(ANALYSE)?;
        Ok(instance)
    }

    fn configure(&mut self, settings: Settings) -> Result<(), MumpsError> {
        // No column permutation, scaling, parallel analysis or refinement; given order.
        for (index, value) in [(6, 0), (8, 0), (7, 1), (10, 0), (12, 1), (28, 1)] {
            self.set(index, value);
        }
        // No exchanges, but null pivot detection, which a threshold of 0 would disable.
        self.set(24, 1);
        self.set_real(1, PIVOTING);
        self.set_real(3, -settings.null_pivot);
        if settings.out_of_core {
            self.set(22, 1);
            let folder = std::env::temp_dir();
            let text = folder.to_str().and_then(|f| CString::new(f).ok()).ok_or(MumpsError::Files)?;
            // SAFETY: null-terminated text, copied by the callee.
            if unsafe { trackbed_mumps_folder(self.0.as_ptr(), text.as_ptr()) } == 0 {
                return Err(MumpsError::Files);
            }
        }
        Ok(())
    }

    fn release_matrix(&mut self, size: usize) {
        let (id, n) = (self.0.as_ptr(), size as c_int);
        // SAFETY: empty matrix; solves without refinement do not read it.
        unsafe { trackbed_mumps_matrix(id, n, 0, null_mut(), null_mut(), null_mut(), null_mut()) }
    }

    fn solve(&mut self, x: &mut [f64]) -> Result<(), MumpsError> {
        // SAFETY: `x` has the checked length and is read by the next job only.
        unsafe { trackbed_mumps_side(self.0.as_ptr(), x.as_mut_ptr()) };
        let result = self.run(SOLVE);
        // SAFETY: no right-hand side.
        unsafe { trackbed_mumps_side(self.0.as_ptr(), null_mut()) };
        result
    }

    fn set(&mut self, index: c_int, value: c_int) {
        // SAFETY: all indices here are valid settings.
        unsafe { trackbed_mumps_set(self.0.as_ptr(), index, value) }
    }

    fn set_real(&mut self, index: c_int, value: f64) {
        // SAFETY: all indices here are valid settings.
        unsafe { trackbed_mumps_set_real(self.0.as_ptr(), index, value) }
    }

    fn info(&self, index: c_int) -> c_int {
        // SAFETY: all indices here are valid results.
        unsafe { trackbed_mumps_info(self.0.as_ptr(), index) }
    }

    fn null_pivot(&self) -> usize {
        // SAFETY: reads the null pivot list, valid after factorisation.
        let equation = unsafe { trackbed_mumps_null_pivot(self.0.as_ptr()) };
        usize::try_from(equation - 1).unwrap_or(0)
    }

    fn run(&mut self, job: c_int) -> Result<(), MumpsError> {
        let code = {
            let _turn = lock_library();
            // SAFETY: callers have set the data of the job.
            unsafe { trackbed_mumps_run(self.0.as_ptr(), job) }
        };
        match code {
            0.. => Ok(()),
            -8 | -9 | -14 | -15 | -17 | -20 => Err(MumpsError::Room),
            -5 | -7 | -13 | -19 => Err(MumpsError::Memory),
            -90 => Err(MumpsError::Files),
            -10 => Err(MumpsError::NotPositive { pivots: 1 }),
            code => Err(MumpsError::Code { code, detail: self.info(2) }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(off: f64, last: f64) -> Coordinates {
        Coordinates {
            row: vec![1, 2, 2, 3],
            column: vec![1, 1, 2, 3],
            value: vec![1.0, off, last, 1.0],
            place: vec![1, 2, 3],
        }
    }

    fn factor(off: f64, last: f64) -> Result<Factor, MumpsError> {
        Factor::new(matrix(off, last), Settings { null_pivot: 1e-11, ..Settings::default() })
    }

    #[test]
    fn the_solution_meets_the_equations() {
        let mut factor = factor(0.5, 1.0).unwrap();
        let mut x = [2.0, 2.5, 3.0];
        factor.solve_in_place(&mut x).unwrap();
        assert!(x.iter().zip([1.0, 2.0, 3.0]).all(|(x, e)| (x - e).abs() < 1e-14), "{x:?}");
        assert_eq!(factor.size(), 3);
    }

    #[test]
    fn rejects_zero_and_negative_pivots() {
        let error = factor(1.0, 1.0 + 1e-13).err().unwrap();
        assert!(matches!(error, MumpsError::Pivot { equation: 0 | 1 }), "{error}");
        assert_eq!(factor(2.0, 1.0).err(), Some(MumpsError::NotPositive { pivots: 1 }));
        assert!(factor(1.0, 1.0 + 1e-9).is_ok());
    }

    #[test]
    fn no_equations_are_no_work() {
        let mut factor = Factor::new(Coordinates::default(), Settings::default()).unwrap();
        factor.solve_in_place(&mut []).unwrap();
        assert_eq!((factor.size(), factor.memory()), (0, 0));
        assert_eq!(demand(Coordinates::default(), Settings::default()), Ok(0));
    }

    #[test]
    #[should_panic(expected = "rows, columns and places from 1 to 3")]
    fn rejects_row_out_of_range() {
        let mut wrong = matrix(0.5, 1.0);
        wrong.row[1] = 4;
        let _ = Factor::new(wrong, Settings::default());
    }
}
