//! Size classes of the search cells.

/// Upper limit; all smaller spheres share the last class.
const CLASSES: usize = 8;

/// Returns the number of size classes between two radii [m]; each spans a factor of two.
pub(super) fn classes((least, most): (f64, f64)) -> usize {
    let wide = most > 3.0 * least;
    (1..CLASSES).take_while(|k| wide && least <= largest(most, *k)).count() + 1
}

/// Returns the largest radius of a class [m].
pub(super) fn largest(most: f64, class: usize) -> f64 {
    most / f64::from(1_u32 << class)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_halve() {
        assert_eq!([(1.0, 1.0), (0.4, 1.0), (0.25, 1.0), (0.2, 1.0)].map(classes), [1, 1, 3, 3]);
        assert_eq!(classes((1e-9, 1.0)), CLASSES);
    }
}
