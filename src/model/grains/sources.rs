//! Sources of the models that grains use, for the summary and the log.

use super::GrainsPart;
use trackbed_dem::{Material, PairOverride};

const LINEAR: &str =
    "contact: linear spring-dashpot with Coulomb friction, Cundall & Strack, Geotechnique 29(1), 1979";
const HERTZ: &str = "contact: elastic spheres, Hertz, J. reine angew. Math. 92, 1882; tangential stiffness with Coulomb friction, \
     Mindlin, J. Appl. Mech. 16, 1949";
const HERTZ_DASHPOT: &str = "dashpot of elastic spheres: Tsuji, Tanaka & Ishida, Powder Technology 71, 1992";
const RESTITUTION: &str = "restitution of the clipped dashpot: Schwager & Poschel, Granular Matter 9, 2007";
const ADHESION: &str = "adhesion: Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53, 1975";
const INTEGRATION: &str = "integration: leapfrog (velocity Verlet), Verlet, Phys. Rev. 159, 1967";

impl GrainsPart {
    /// Sources of the laws of contact and of the integration in time.
    pub fn sources(&self) -> Vec<&'static str> {
        of(&self.materials, &self.contacts)
    }
}

fn of(materials: &[Material], pairs: &[PairOverride]) -> Vec<&'static str> {
    let hertz = materials.iter().any(|m| m.young.is_some());
    let adhesion = pairs.iter().any(|pair| pair.adhesion.is_some());
    let mut sources = if hertz { vec![HERTZ, HERTZ_DASHPOT] } else { vec![LINEAR] };
    sources.push(RESTITUTION);
    sources.extend(adhesion.then_some(ADHESION));
    sources.push(INTEGRATION);
    sources
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_law_of_the_materials_is_the_one_that_is_named() {
        let linear = Material { stiffness: 1e6, ..Material::RIGID };
        let hertz = Material { young: Some(5e10), ..Material::RIGID };
        let sticky = PairOverride { adhesion: Some(0.1), ..PairOverride::default() };
        assert_eq!(of(&[linear, Material::RIGID], &[]), [LINEAR, RESTITUTION, INTEGRATION]);
        assert_eq!(of(&[hertz, Material::RIGID], &[]), [HERTZ, HERTZ_DASHPOT, RESTITUTION, INTEGRATION]);
        assert_eq!(of(&[linear], &[sticky]), [LINEAR, RESTITUTION, ADHESION, INTEGRATION]);
    }
}
