//! Literature sources of the models in use.

use trackbed_dem::{Material, PairOverride, law};

const INTEGRATION: &str = "integration: leapfrog (velocity Verlet), Verlet, Phys. Rev. 159, 1967";

pub(super) fn of(materials: &[Material], pairs: &[PairOverride]) -> Vec<&'static str> {
    let mut sources = law::sources(materials, pairs);
    sources.push(INTEGRATION);
    sources
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_law_of_materials() {
        let linear = Material { stiffness: 1e6, ..Material::RIGID };
        let hertz = Material { young: Some(5e10), ..Material::RIGID };
        let sticky = PairOverride { adhesion: Some(0.1), ..PairOverride::default() };
        for (materials, pairs, names) in [
            (vec![linear, Material::RIGID], vec![], vec!["Cundall", "Schwager", "Verlet"]),
            (vec![hertz, Material::RIGID], vec![], vec!["Hertz", "Mindlin", "Schwager", "Verlet"]),
            (vec![linear], vec![sticky], vec!["Cundall", "Schwager", "Derjaguin", "Verlet"]),
        ] {
            let found = of(&materials, &pairs);
            assert_eq!(found.len(), names.len(), "{found:?}");
            assert!(found.iter().zip(names).all(|(source, name)| source.contains(name)), "{found:?}");
        }
    }
}
