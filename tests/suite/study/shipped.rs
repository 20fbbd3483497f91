//! Studies of `inputs/studies`.

use super::{numbers, table};
use crate::suite::support::{Folder, repository, trackbed};
use std::cell::RefCell;
use std::fs;
use trackbed::failure::Failure;
use trackbed::study::{Options, execute};

#[test]
fn every_setting_is_valid() {
    let folder = Folder::new("study_shipped");
    let (mut studies, mut settings) = (0, 0);
    for entry in fs::read_dir(repository().join("inputs/studies")).unwrap() {
        let file = entry.unwrap().path();
        let name = file.display().to_string();
        let refused = RefCell::new(Vec::new());
        let checked = RefCell::new(0);
        let check = |scene: &std::path::Path, set: &[String]| {
            let mut arguments = vec!["check".to_string(), scene.display().to_string()];
            arguments.extend(set.iter().map(|s| format!("--set={s}")));
            let outcome = trackbed(arguments);
            *checked.borrow_mut() += 1;
            if outcome.code != 0 {
                refused.borrow_mut().push(outcome.stderr);
            }
            Err(Failure::Input("not to be run".into()))
        };
        let options = Options { out: Some(folder.join("out")), quiet: true, ..Options::default() };
        let text = execute(&file, &options, &check).unwrap_err().to_string();
        assert!(text.ends_with(": not to be run"), "{name}: {text}");
        let (refused, checked) = (refused.into_inner(), checked.into_inner());
        assert!(refused.is_empty() && checked > 0, "{name}: {checked} settings, refused {refused:?}");
        assert!(!folder.join("out").exists(), "{name}");
        studies += 1;
        settings += checked;
    }
    assert!(studies >= 15 && settings > 2 * studies, "{settings} settings of {studies} studies");
}

/// Newmark is second order.
#[test]
fn solid_step_is_second_order() {
    let (folder, study) = (Folder::new("study_solid"), repository().join("inputs/studies/solid_step.toml"));
    let (study, out) = (study.display().to_string(), folder.join("out"));
    trackbed(["study", &study, "--out", &out.display().to_string(), "--quiet"]).good();
    let rows = table(&out.join("study.csv"));
    for alpha in ["-0.01", "-0.1", "-0.3"] {
        let of_alpha: Vec<_> = rows.iter().filter(|r| r["alpha"] == alpha).cloned().collect();
        let errors = numbers(&of_alpha, "surface error");
        println!("alpha {alpha}: {errors:?}");
        for pair in errors.windows(2) {
            // Reference error, and a longest step outside the asymptotic range.
            assert!((3.3..4.6).contains(&(pair[0] / pair[1])), "alpha {alpha}: {errors:?}");
        }
    }
}
