//! The list of kinds of bonds: a new one is a file and a line of [`kinds!`].

use super::contact_point::ContactPoint;
use super::direct::DirectBond;
use super::face::FaceBond;
use super::parallel::ParallelBond;
use super::springs::BondKind;

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

            /// The same bond without a limit of strength.
            pub fn unbreakable(&self) -> Bond {
                match self {
                    $(Bond::$name(kind) => Bond::$name(kind.unbreakable()),)+
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
    /// Whether it fills a face between bodies of any shape; else it joins single spheres.
    pub fn fills_faces(&self) -> bool {
        self.kind().fills_faces()
    }
}
