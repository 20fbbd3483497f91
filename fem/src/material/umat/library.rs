//! Shared libraries with a routine of the interface UMAT.

use libloading::Library;
use std::ffi::c_int;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Number of characters of CMNAME.
pub(super) const NAME_LENGTH: usize = 80;

/// Arguments of UMAT in order, then the hidden length of CMNAME (GNU and Intel Fortran).
pub(super) type Umat = unsafe extern "C" fn(
    stress: *mut f64,
    statev: *mut f64,
    ddsdde: *mut f64,
    sse: *mut f64,
    spd: *mut f64,
    scd: *mut f64,
    rpl: *mut f64,
    ddsddt: *mut f64,
    drplde: *mut f64,
    drpldt: *mut f64,
    stran: *mut f64,
    dstran: *mut f64,
    time: *mut f64,
    dtime: *mut f64,
    temp: *mut f64,
    dtemp: *mut f64,
    predef: *mut f64,
    dpred: *mut f64,
    cmname: *mut u8,
    ndi: *mut c_int,
    nshr: *mut c_int,
    ntens: *mut c_int,
    nstatv: *mut c_int,
    props: *mut f64,
    nprops: *mut c_int,
    coords: *mut f64,
    drot: *mut f64,
    pnewdt: *mut f64,
    celent: *mut f64,
    dfgrd0: *mut f64,
    dfgrd1: *mut f64,
    noel: *mut c_int,
    npt: *mut c_int,
    layer: *mut c_int,
    kspt: *mut c_int,
    jstep: *mut c_int,
    kinc: *mut c_int,
    length: usize,
);

/// Unusable library.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum LibraryError {
    /// The library lacks the routine.
    #[error("no symbol `{routine}` in {}", path.display())]
    NoRoutine {
        /// File.
        path: PathBuf,
        /// Symbol.
        routine: String,
    },
    /// Another number of constants than the library declares.
    #[error("{found} values, but {} declares {expected}", path.display())]
    Constants {
        /// File.
        path: PathBuf,
        /// Given number.
        found: usize,
        /// Declared number.
        expected: usize,
    },
    /// Another number of state variables than the library declares.
    #[error("{found} variables, but {} declares {expected}", path.display())]
    States {
        /// File.
        path: PathBuf,
        /// Given number.
        found: usize,
        /// Declared number.
        expected: usize,
    },
}

/// Routine of a loaded library.
#[derive(Debug)]
pub struct Routine {
    path: PathBuf,
    name: String,
    pub(super) umat: Umat,
    /// Keeps the code of `umat` loaded.
    library: Library,
}

impl PartialEq for Routine {
    fn eq(&self, other: &Routine) -> bool {
        (&self.path, &self.name) == (&other.path, &other.name)
    }
}

impl Routine {
    /// Looks up the symbol `name` in a library loaded from `path`, absolute.
    ///
    /// # Errors
    /// [`LibraryError::NoRoutine`].
    pub fn new(library: Library, path: &Path, name: &str) -> Result<Routine, LibraryError> {
        // SAFETY: the symbol is declared to be a routine of this interface, as in Abaqus.
        match unsafe { library.get::<Umat>(name) }.map(|symbol| *symbol) {
            Ok(umat) => Ok(Routine { path: path.into(), name: name.into(), umat, library }),
            Err(_) => Err(LibraryError::NoRoutine { path: path.into(), routine: name.into() }),
        }
    }

    /// Absolute path of the library.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Symbol.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Compares numbers of constants and state variables with the integers `<routine>_nprops` and
    /// `<routine>_nstatv`, if the library exports them; `<routine>` without closing underscores.
    ///
    /// # Errors
    /// [`LibraryError::Constants`], [`LibraryError::States`].
    pub fn check_counts(&self, constants: usize, states: usize) -> Result<(), LibraryError> {
        let path = || self.path.clone();
        match self.declared("nprops") {
            Some(expected) if expected != constants => {
                return Err(LibraryError::Constants { path: path(), found: constants, expected });
            }
            _ => {}
        }
        match self.declared("nstatv") {
            Some(expected) if expected != states => {
                Err(LibraryError::States { path: path(), found: states, expected })
            }
            _ => Ok(()),
        }
    }

    fn declared(&self, what: &str) -> Option<usize> {
        let symbol = format!("{}_{what}", self.name.trim_end_matches('_'));
        // SAFETY: a symbol of this name is an integer by the interface.
        let value = unsafe { self.library.get::<*const c_int>(symbol.as_str()).ok().map(|v| **v) };
        value.and_then(|v| usize::try_from(v).ok())
    }
}
