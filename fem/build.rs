//! With the feature `mumps`: compiles the C part of the binding to MUMPS against the installed header, and
//! links its library.
//!
//! | variable | what | default |
//! |---|---|---|
//! | `MUMPS_INCLUDE_DIR` | folder of `dmumps_c.h` | where the C compiler looks |
//! | `MUMPS_LIB_DIR` | folder of the libraries | where the linker looks |
//! | `MUMPS_LIBS` | their names, separated by commas or blanks | `dmumps_seq` |

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    #[cfg(feature = "mumps")]
    mumps();
}

#[cfg(feature = "mumps")]
fn mumps() {
    const SOURCE: &str = "src/solver/mumps/mumps.c";
    println!("cargo:rerun-if-changed={SOURCE}");
    let variable = |name: &str| {
        println!("cargo:rerun-if-env-changed={name}");
        std::env::var(name).ok().filter(|value| !value.trim().is_empty())
    };
    let mut compiler = cc::Build::new();
    compiler.file(SOURCE).std("c11");
    if let Some(folder) = variable("MUMPS_INCLUDE_DIR") {
        compiler.include(folder);
    }
    compiler.compile("trackbed_mumps");
    if let Some(folder) = variable("MUMPS_LIB_DIR") {
        println!("cargo:rustc-link-search=native={folder}");
    }
    let names = variable("MUMPS_LIBS").unwrap_or_else(|| "dmumps_seq".into());
    for name in names.split([',', ' ']).filter(|name| !name.is_empty()) {
        println!("cargo:rustc-link-lib={name}");
    }
}
