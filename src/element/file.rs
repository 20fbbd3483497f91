//! File of element tests: TOML; unknown keys are errors.

use serde::de::{self, Deserializer, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::PathBuf;
use trackbed_input::scene::solid::SolidMaterial;
use trackbed_input::scene::units::{Quantity, Stress};

/// Element tests.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ElementFile {
    /// Heading of the results; default: file name.
    #[serde(default)]
    pub name: String,
    /// Materials, as in `[[solid.material]]`.
    #[serde(default)]
    pub material: Vec<SolidMaterial>,
    /// Scene with further materials, relative to this file.
    pub scene: Option<PathBuf>,
    /// Tests.
    #[serde(default)]
    pub test: Vec<TestTable>,
}

/// Test of one stress point.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TestTable {
    /// Name; default `kind`.
    pub name: Option<String>,
    /// Names of materials; default all.
    pub material: Option<Names>,
    /// Kind.
    pub kind: Kind,
    /// Initial isotropic stress [Pa], compression positive; default 0; ≥ 0.
    pub stress: Option<Quantity<Stress>>,
    /// Strain at the end, with `cycles` of each loading; not with `"path"`.
    pub strain: Option<f64>,
    /// Strain after each unloading; default 0; with `cycles`.
    pub least: Option<f64>,
    /// Steps of each loading, unloading, or path segment; default 200.
    pub steps: Option<usize>,
    /// Number of cycles; default: one loading.
    pub cycles: Option<usize>,
    /// Prescribed quantity of xx, yy, zz, xy, yz, zx; with `"path"`.
    pub controls: Option<[Controlled; 6]>,
    /// Values of xx, yy, zz, xy, yz, zx at the end of each segment, compression positive; with `"path"`.
    pub points: Option<Vec<[toml::Value; 6]>>,
}

/// Kind of a test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Axial strain at constant lateral stress.
    Triaxial,
    /// Axial strain at constant volume.
    Undrained,
    /// Axial strain without lateral strain.
    Oedometer,
    /// Shear strain at constant vertical stress.
    SimpleShear,
    /// Prescribed components.
    Path,
}

impl Kind {
    /// Name in files.
    pub fn word(self) -> &'static str {
        match self {
            Kind::Triaxial => "triaxial",
            Kind::Undrained => "undrained",
            Kind::Oedometer => "oedometer",
            Kind::SimpleShear => "simple_shear",
            Kind::Path => "path",
        }
    }
}

/// Prescribed quantity of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Controlled {
    /// Strain.
    Strain,
    /// Stress.
    Stress,
}

/// One name, or a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Names {
    /// Names.
    pub list: Vec<String>,
    /// Whether a list was given.
    pub is_list: bool,
}

impl<'de> Deserialize<'de> for Names {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Names, D::Error> {
        struct NamesVisitor;
        impl<'de> Visitor<'de> for NamesVisitor {
            type Value = Names;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("the name of a material, or a list of names")
            }

            fn visit_str<E: de::Error>(self, name: &str) -> Result<Names, E> {
                Ok(Names { list: vec![name.into()], is_list: false })
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut names: A) -> Result<Names, A::Error> {
                let mut list = Vec::new();
                while let Some(name) = names.next_element()? {
                    list.push(name);
                }
                Ok(Names { list, is_list: true })
            }
        }
        deserializer.deserialize_any(NamesVisitor)
    }
}
