//! What a kind of bond is to the rest of the engine, and the list of kinds: a new one is a file and a line of [`kinds!`].

use super::contact_point::ContactPoint;
use super::direct::DirectBond;
use super::face::FaceBond;
use super::parallel::ParallelBond;
use super::springs::{BondDamping, Criterion, Joint, Problem, Springs};

/// A kind of bond.
pub(super) trait BondKind {
    /// What is wrong with its numbers.
    fn problem(&self) -> Problem;

    /// Its springs between two bodies, and what breaks them.
    fn springs(&self, joint: &Joint) -> Springs;

    /// Its dashpots.
    fn damping(&self) -> BondDamping;

    /// When it breaks.
    fn criterion(&self) -> Criterion;

    /// Whether the contact of the pair acts beside it.
    fn contact(&self) -> bool;

    /// Whether it fills a face between bodies of any shape; else it joins single spheres.
    fn fills_faces(&self) -> bool {
        false
    }

    /// The same bond without a limit of strength.
    fn unbreakable(&self) -> Bond;
}

macro_rules! kinds {
    ($($(#[$doc:meta])+ $name:ident($kind:ty);)+) => {
        /// A kind of bond.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Bond {
            $($(#[$doc])+ $name($kind),)+
        }

        impl Bond {
            pub(super) fn kind(&self) -> &dyn BondKind {
                match self {
                    $(Bond::$name(kind) => kind,)+
                }
            }
        }
    };
}

kinds! {
    /// A cemented disk between the spheres: force and moment.
    Parallel(ParallelBond);
    /// A spring at the contact point: force only.
    ContactPoint(ContactPoint);
    /// Stiffnesses and strengths of the bond itself, the same for every length and radius.
    Direct(DirectBond);
    /// What fills the face between two bodies of any shape: force and moment.
    Face(FaceBond);
}

impl Bond {
    /// The same bond without a limit of strength.
    pub fn unbreakable(&self) -> Bond {
        self.kind().unbreakable()
    }

    /// Whether it fills a face between bodies of any shape; else it joins single spheres.
    pub fn fills_faces(&self) -> bool {
        self.kind().fills_faces()
    }
}
