//! Scene table of a user material: a routine UMAT of a shared library.

use crate::Problem;
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use trackbed_fem::material::StateValue;
use trackbed_fem::material::umat::{
    LibraryError, MOST_VALUES, Routine, UserEnergy, UserMaterial, UserOptions, UserTangent,
};
use trackbed_io::system;

/// Invalid key within a material, and its problem.
type KeyFault = (&'static str, Problem);

/// `[solid.material.umat]`: routine of a shared library by the interface UMAT of Abaqus.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UserTable {
    /// Shared library.
    pub library: PathBuf,
    /// Symbol of the routine; default `"umat_"`.
    #[serde(default = "routine")]
    pub routine: String,
    /// PROPS [SI units]; default none; at most 1000.
    #[serde(default)]
    pub constants: Vec<f64>,
    /// STATEV; default none; at most 1000.
    #[serde(default)]
    pub states: Vec<UserState>,
    /// Tangent of the law; default `"library"`.
    #[serde(default)]
    pub tangent: TangentSource,
    /// Stored and dissipated energy; default `"reference"`.
    #[serde(default)]
    pub energy: EnergySource,
    /// Threads that call the routine simultaneously; default `"one"`.
    #[serde(default)]
    pub threads: RoutineThreads,
}

fn routine() -> String {
    "umat_".into()
}

/// State variable of a routine.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UserState {
    /// Name; `state_NAME` in `gauss.csv`.
    pub name: String,
    /// Initial value; default 0.
    #[serde(default)]
    pub initial: f64,
    /// Unit of the column; default none.
    #[serde(default)]
    pub unit: String,
}

/// Source of the tangent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TangentSource {
    /// DDSDDE, differences if it is 0.
    #[default]
    Library,
    /// Central differences of the stress.
    Differences,
}

/// Source of the energies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EnergySource {
    /// `young` and `poisson`, work on the remaining strain.
    #[default]
    Reference,
    /// SSE, SPD and SCD.
    Library,
}

/// Threads of a routine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RoutineThreads {
    /// One call at a time.
    #[default]
    One,
    /// Thread-safe routine.
    All,
}

impl UserTable {
    /// Loads the library, located by `locate`; `name` is passed as CMNAME.
    ///
    /// # Errors
    /// Unusable library, constants or state variables.
    pub fn law(&self, name: &str, locate: impl Fn(&Path) -> PathBuf) -> Result<UserMaterial, KeyFault> {
        self.check_values()?;
        self.check_names()?;
        let routine = self.load(&locate(&self.library))?;
        let value = |state: &UserState| {
            let (name, unit) = (format!("state_{}", state.name).into(), state.unit.clone().into());
            (StateValue { name, unit }, state.initial)
        };
        let options = UserOptions {
            name: name.into(),
            constants: self.constants.clone(),
            states: self.states.iter().map(value).collect(),
            tangent: match self.tangent {
                TangentSource::Library => UserTangent::Library,
                TangentSource::Differences => UserTangent::Differences,
            },
            energy: match self.energy {
                EnergySource::Reference => UserEnergy::Reference,
                EnergySource::Library => UserEnergy::Library,
            },
            thread_safe: self.threads == RoutineThreads::All,
        };
        UserMaterial::new(routine, options).map_err(|e| fault_of(&e))
    }

    fn check_values(&self) -> Result<(), KeyFault> {
        let counts = [("umat.constants", self.constants.len()), ("umat.states", self.states.len())];
        if let Some((key, count)) = counts.into_iter().find(|(_, count)| *count > MOST_VALUES) {
            return Err((
                key,
                Problem::value(format!("{count} values"), format!("at most {MOST_VALUES} values")),
            ));
        }
        let initial = self.states.iter().map(|state| ("umat.states", state.initial));
        let values = self.constants.iter().map(|value| ("umat.constants", *value)).chain(initial);
        match values.into_iter().find(|(_, value)| !value.is_finite()) {
            Some((key, value)) => Err((key, Problem::value(value.to_string(), "finite numbers"))),
            None => Ok(()),
        }
    }

    fn check_names(&self) -> Result<(), KeyFault> {
        for (k, UserState { name, .. }) in self.states.iter().enumerate() {
            let letters = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
            if name.is_empty() || !name.chars().all(letters) {
                let expected = "a name of lower-case letters, digits and underscores";
                return Err(("umat.states", Problem::value(format!("the name \"{name}\""), expected)));
            }
            if self.states[..k].iter().any(|other| other.name == *name) {
                let found = format!("the name \"{name}\" twice");
                return Err(("umat.states", Problem::value(found, "distinct names")));
            }
        }
        Ok(())
    }

    fn load(&self, path: &Path) -> Result<Routine, KeyFault> {
        let shown = self.library.display();
        let path = path.canonicalize().map_err(|e| {
            ("umat.library", Problem::value(format!("{shown} ({e})"), "an existing shared library"))
        })?;
        let library = system::open_library(&path).map_err(|reason| {
            let system = format!("{} {}", std::env::consts::ARCH, std::env::consts::OS);
            let expected = format!("a shared library for {system} without undefined symbols");
            ("umat.library", Problem::value(reason, expected))
        })?;
        Routine::new(library, &path, &self.routine).map_err(|e| fault_of(&e))
    }
}

fn fault_of(error: &LibraryError) -> KeyFault {
    let (key, expected) = match error {
        LibraryError::NoRoutine { .. } => {
            ("umat.routine", "an exported symbol, in Fortran lower case with `_`".into())
        }
        LibraryError::Constants { expected, .. } => ("umat.constants", format!("{expected} values")),
        LibraryError::States { expected, .. } => ("umat.states", format!("{expected} variables")),
    };
    (key, Problem::value(error.to_string(), expected))
}
