//! Formulas compiled by the system's C compiler: the same bits as interpreted, without the interpretation.

use super::Formula;
use super::program::{Program, VARIABLES, Values};
use crate::lanes::Real;
use libloading::Library;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{env, fs, io};

/// Results of a step: force, and dashpot coefficient or loss.
const RESULTS: usize = 2;
/// Numbers per variable of the compiled functions.
const WIDTHS: [usize; 3] = [1, 4, 8];
/// Compared evaluations.
const SAMPLES: usize = 200;
/// No contraction to fused multiply-add, no reordering: IEEE 754 operations as written.
const FLAGS: [&str; 6] =
    ["-O3", "-shared", "-fPIC", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math"];
const NATIVE: &str = if cfg!(target_arch = "x86_64") { "-march=native" } else { "-mcpu=native" };

type Function = unsafe extern "C" fn(values: *const f64, results: *mut f64);

/// Compiled functions, once there are any.
#[derive(Clone, Debug, Default)]
pub(super) struct Compiled(OnceLock<[Function; WIDTHS.len()]>);

/// Formulas are equal whether or not they are compiled.
impl PartialEq for Compiled {
    fn eq(&self, _: &Compiled) -> bool {
        true
    }
}

/// Why a formula stays interpreted.
#[derive(Debug, thiserror::Error)]
pub enum NotCompiled {
    /// The compiler did not start, or files could not be written.
    #[error("{compiler}: {error}")]
    Io {
        /// Command.
        compiler: String,
        /// Cause.
        error: io::Error,
    },
    /// Failure of the compiler.
    #[error("{0} reports an error")]
    Compiler(String),
    /// The library does not load.
    #[error(transparent)]
    Library(#[from] libloading::Error),
    /// Other bits than the interpreter's.
    #[error("results of {0} differ from the interpreted ones")]
    Differs(String),
}

impl Formula {
    /// Compiles the formulas of a step with `$CC`, else `cc`; returns the compiler.
    ///
    /// # Errors
    /// The formula then stays interpreted.
    pub fn compile(&self) -> Result<String, NotCompiled> {
        let compiler = env::var("CC").ok().filter(|c| !c.trim().is_empty()).unwrap_or_else(|| "cc".into());
        if self.compiled.0.get().is_none() {
            let functions = functions(&compiler, &text(&self.step))?;
            if differs(&self.step, &functions) {
                return Err(NotCompiled::Differs(compiler));
            }
            self.compiled.0.get_or_init(|| functions);
        }
        Ok(compiler)
    }

    /// Results of a step, compiled if possible.
    #[inline(always)]
    pub(in crate::law) fn stepped<R: Real>(&self, values: &Values<R>) -> [R; RESULTS] {
        match (self.compiled.0.get(), const { column(R::NUMBERS) }) {
            (Some(functions), Some(column)) => {
                const { assert!(size_of::<R>() == R::NUMBERS * size_of::<f64>() || R::NUMBERS == 0) };
                let mut results = [R::zero(); RESULTS];
                // SAFETY: an `R` is `NUMBERS` numbers; the function reads and writes these arrays of them.
                unsafe { functions[column](values.as_ptr().cast(), results.as_mut_ptr().cast()) };
                results
            }
            _ => self.step.evaluate(values),
        }
    }
}

/// Place of a width in [`WIDTHS`].
const fn column(numbers: usize) -> Option<usize> {
    let mut k = 0;
    while k < WIDTHS.len() {
        if WIDTHS[k] == numbers {
            return Some(k);
        }
        k += 1;
    }
    None
}

fn text(program: &Program) -> String {
    let mut text = String::new();
    for width in WIDTHS {
        let _ = writeln!(text, "void step{width}(const double *restrict v, double *restrict r) {{");
        let _ = writeln!(text, "for (int l = 0; l < {width}; l++) {{");
        program.in_c(&mut text, width, RESULTS);
        text.push_str("}\n}\n");
    }
    text
}

fn functions(compiler: &str, text: &str) -> Result<[Function; WIDTHS.len()], NotCompiled> {
    let io = |error| NotCompiled::Io { compiler: compiler.to_string(), error };
    let folder = folder().map_err(io)?;
    let found = built(compiler, text, &folder);
    let _ = fs::remove_dir_all(&folder);
    found
}

/// New folder of this process alone. Each path serves once: a path that was loaded gives the same library again.
fn folder() -> io::Result<PathBuf> {
    static NUMBER: AtomicUsize = AtomicUsize::new(0);
    #[cfg_attr(not(unix), allow(unused_mut))]
    let mut builder = fs::DirBuilder::new();
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    let process = std::process::id();
    loop {
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let folder = env::temp_dir().join(format!("trackbed-law-{process}-{number}"));
        match builder.create(&folder) {
            Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {}
            other => return other.map(|()| folder),
        }
    }
}

fn built(compiler: &str, text: &str, folder: &Path) -> Result<[Function; WIDTHS.len()], NotCompiled> {
    let io = |error| NotCompiled::Io { compiler: compiler.to_string(), error };
    let [source, library] = ["law.c", "law.so"].map(|name| folder.join(name));
    fs::write(&source, text).map_err(io)?;
    let mut words = compiler.split_whitespace();
    let mut command = Command::new(words.next().unwrap_or("cc"));
    command.args(words).args(FLAGS).arg(NATIVE).arg("-o").arg(&library).arg(&source);
    let status = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status();
    if !status.map_err(io)?.success() {
        return Err(NotCompiled::Compiler(compiler.to_string()));
    }
    // SAFETY: the library has no initializers; it stays loaded for the life of the process.
    let library: &'static Library = Box::leak(Box::new(unsafe { Library::new(&library)? }));
    let mut found = Vec::new();
    for width in WIDTHS {
        // SAFETY: the signature is that of `text`.
        found.push(unsafe { *library.get::<Function>(format!("step{width}"))? });
    }
    Ok([found[0], found[1], found[2]])
}

/// Whether compiled results have other bits than interpreted ones.
fn differs(program: &Program, functions: &[Function; WIDTHS.len()]) -> bool {
    let mut state = 1_u64;
    // Magnitudes from 1e-9 to 1e9, and zeros.
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let share = (state >> 11) as f64 / (1_u64 << 53) as f64;
        if share < 0.02 { 0.0 } else { libm::pow(10.0, 18.0 * share - 9.0) }
    };
    (0..SAMPLES).any(|_| {
        let values: [[f64; 8]; VARIABLES.len()] = std::array::from_fn(|_| std::array::from_fn(|_| random()));
        WIDTHS.iter().zip(functions).any(|(&width, function)| {
            let given: Vec<f64> = values.iter().flat_map(|v| &v[..width]).copied().collect();
            let mut results = vec![0.0; RESULTS * width];
            // SAFETY: arrays of the widths that the function reads and writes.
            unsafe { function(given.as_ptr(), results.as_mut_ptr()) };
            (0..width).any(|lane| {
                let expected: [f64; RESULTS] = program.evaluate(&values.map(|v| v[lane]));
                (0..RESULTS).any(|k| {
                    let found = results[k * width + lane];
                    found.to_bits() != expected[k].to_bits() && !(found.is_nan() && expected[k].is_nan())
                })
            })
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::formula::Texts;
    use std::collections::BTreeMap;

    fn formula(force: &str, damping: &str) -> Formula {
        let texts = Texts { force, damping: Some(damping), energy: None, loss: None };
        Formula::parse("own", &texts, &BTreeMap::new()).unwrap()
    }

    #[test]
    fn compiled_formulas_have_the_interpreted_bits() {
        let laws = [
            formula("K*d", "2*zeta*sqrt(K/w)"),
            formula("below(d, 1e-3*R, E*d*sqrt(R*d), abs(E*d - 3)^1.75)", "max(min(d/R, dt), -1e-300)*-w"),
            formula("K*d/1e-300/1e-300", "0.1*K*dt - d/3"),
        ];
        for law in &laws {
            let compiler = law.compile().unwrap();
            assert!(law.compiled.0.get().is_some() && !compiler.is_empty());
        }
        // Other operations, and contracted ones, are found.
        let functions = laws[0].compiled.0.get().unwrap();
        assert!(differs(&laws[1].step, functions));
        let contracted = text(&laws[2].step).replace("const double", "const long double");
        assert!(differs(&laws[2].step, &super::functions("cc", &contracted).unwrap()));
    }

    #[test]
    fn formulas_stay_interpreted_without_a_compiler() {
        for (compiler, expected) in
            [("no-such-compiler", "no-such-compiler: "), ("false", "false reports an error")]
        {
            let error = functions(compiler, "").unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
