//! `trackbed convert`: files of legacy programs.

use super::output::print;
use crate::cli::ConvertArgs;
use trackbed_io::failure::Failure;
use trackbed_post::convert::{self, Options};

pub(super) fn convert(args: &ConvertArgs) -> Result<(), Failure> {
    let region = match args.region.as_deref() {
        None => None,
        Some(&[x, y, z]) if [x, y, z].iter().all(|l| *l > 0.0 && l.is_finite()) => Some([x, y, z]),
        Some(other) => {
            let found = other.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
            return Err(Failure::Input(format!("--box: found {found}, expected three lengths above 0")));
        }
    };
    let options = Options {
        packing: args.packing.clone(),
        terrain: args.terrain.clone(),
        region,
        grains: args.grains.clone(),
        format: args.format.clone(),
        force: args.force,
    };
    let mut text = String::new();
    for line in convert::convert(&args.input, &args.output, &options)? {
        text.push_str(&line);
        text.push('\n');
    }
    print(&format!("{text}{} written\n", args.output.display()))
}
