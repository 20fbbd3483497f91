//! Grains queued at an inlet.

use super::part::GroupsPart;
use super::shapes::{Sampled, sampled};
use crate::scene::Table;
use crate::scene::grains::Grains;
use trackbed_dem::BodyInput;
use trackbed_dem::random::Random;
use trackbed_io::failure::Failure;

/// Random stream of the insertion order.
const ORDER: u64 = 8;

pub(super) fn waiting(
    group: &Table<Grains>,
    model: &BodyInput,
    part: &mut GroupsPart,
) -> Result<(), Failure> {
    let idle = [("velocity", group.velocity.is_some()), ("spin", group.spin.is_some())];
    group.reject_with(idle, "`inlet`").map_err(|e| e.remedy("Use `inlet.velocity`"))?;
    let grains = sampled(group, part, "the number of grains to insert")?;
    // Otherwise small grains would come first.
    let order = Random::new(group.seed, ORDER).permutation(grains.len());
    part.bodies.extend(order.into_iter().map(|i| {
        let Sampled { shape, scale } = grains[i];
        BodyInput { shape, scale, absent: true, ..model.clone() }
    }));
    Ok(())
}
