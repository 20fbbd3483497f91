//! Bond types; a new one needs a file and a line in [`kinds!`].

use super::contact_point::ContactPoint;
use super::direct::DirectBond;
use super::face::FaceBond;
use super::parallel::ParallelBond;
use super::springs::BondKind;

macro_rules! kinds {
    ($($(#[$doc:meta])+ $name:ident($kind:ty);)+) => {
        /// Bond type.
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

            /// Returns the bond with infinite strength.
            pub fn unbreakable(&self) -> Bond {
                match self {
                    $(Bond::$name(kind) => Bond::$name(kind.unbreakable()),)+
                }
            }
        }
    };
}

kinds! {
    /// Cement disk between spheres: force and moment.
    Parallel(ParallelBond);
    /// Spring at the contact point: force only.
    ContactPoint(ContactPoint);
    /// Given stiffness and strength, independent of length and radius.
    Direct(DirectBond);
    /// Face between bodies of any shape: force and moment.
    Face(FaceBond);
}

impl Bond {
    /// Returns true for bodies of any shape, else single spheres.
    pub fn fills_faces(&self) -> bool {
        self.kind().fills_faces()
    }
}
