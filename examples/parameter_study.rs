//! Contacts of settled spheres over friction.
//!
//! ```sh
//! cargo run --release --example parameter_study
//! ```

use std::path::Path;
use trackbed::run::{Options, Outcome, Verbosity, run};

/// Returns contacts per sphere for each friction coefficient.
pub fn study(frictions: &[f64]) -> Result<Vec<f64>, Box<dyn std::error::Error>> {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("inputs/grains/box.toml");
    let out = std::env::temp_dir().join(format!("trackbed_parameter_study_{}", std::process::id()));
    let mut found = Vec::new();
    for friction in frictions {
        // One frame, because only the summary is used.
        let set = vec![format!("contact.0.friction={friction}"), "output.frames=1".into()];
        // Overwrites the previous run.
        let options = Options {
            out: Some(out.clone()),
            set,
            verbosity: Verbosity::Quiet,
            force: true,
            ..Options::default()
        };
        if let Outcome::Done(summary) = run(&scene, &options)? {
            found.push(summary.bed.packing.ok_or("a run without grains")?.coordination);
        }
    }
    std::fs::remove_dir_all(&out)?;
    Ok(found)
}

/// Higher friction needs fewer contacts.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let frictions = [0.1, 0.3, 0.5];
    for (friction, contacts) in frictions.iter().zip(study(&frictions)?) {
        println!("friction {friction}: {contacts:.2} contacts per sphere");
    }
    Ok(())
}
