//! `[output]`: what a run writes. Beside the keys listed here it takes the key of every format of frames that the program
//! has ([`crate::write::FORMATS`]).

use super::units::{Quantity, Time};
use crate::write::FORMATS;
use schemars::JsonSchema;
use serde::de::{self, Deserialize, Deserializer, MapAccess, Visitor};
use std::collections::BTreeMap;
use std::fmt;
use std::sync::LazyLock;

/// What a run writes.
#[derive(Clone, Debug, Default, JsonSchema)]
#[schemars(deny_unknown_fields, transform = super::schema::formats)]
pub struct Output {
    /// Number of frames of the animation over the run proper, 0–100000; default 20. The start is one more.
    pub frames: Option<u32>,
    /// Time between rows of `history.csv` [s]; default a thousandth of the run proper. Rows fall on steps of the
    /// solid (coupled and solid runs) or of the grains.
    pub history_interval: Option<Quantity<Time>>,
    /// Steps between two frames, in place of `frames`: as `time.steps` counts them.
    pub frame_steps: Option<u64>,
    /// Steps between two rows of `history.csv`, in place of `history_interval`.
    pub history_steps: Option<u64>,
    /// Time by the clock after which the state of the run is kept anew for `--resume` [s]; default 10 minutes. The state is
    /// kept too when settling ends and when the run is interrupted.
    pub checkpoint: Option<Quantity<Time>>,
    /// Write nodal displacements, reactions and Gauss-point stresses of the last state as CSV; default false.
    pub tables: Option<bool>,
    /// Write the grains at the end as `packing.csv`, which `[[grains]] packing` reads; default false.
    pub packing: Option<bool>,
    /// Keep the state at the end, from which another run can go on (`run NEXT --from DIR`); default true.
    pub state: Option<bool>,
    /// Force chains of the frames: all contacts (default), or those above the mean normal force.
    pub chains: Option<Chains>,
    /// Fields of solid and grains that frames hold beside what they need to be drawn; default all.
    pub fields: Option<Vec<String>>,
    /// Last part of the run, with frames of its own.
    pub last: Option<Last>,
    /// Formats of the frames by key: switched on or off.
    #[schemars(skip)]
    pub formats: BTreeMap<&'static str, bool>,
}

/// Last part of a run, with frames of its own.
#[derive(Clone, Copy, Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Last {
    /// How long it is [s].
    pub time: Quantity<Time>,
    /// Frames in it.
    pub frames: u32,
}

/// Contacts that the frames show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Chains {
    /// All of them.
    #[default]
    All,
    /// Those with more than the mean normal force.
    Strong,
}

/// Every key of the table: its own, then those of the formats.
static KEYS: LazyLock<Vec<&'static str>> = LazyLock::new(|| {
    let own = [
        "frames",
        "history_interval",
        "frame_steps",
        "history_steps",
        "checkpoint",
        "tables",
        "packing",
        "state",
        "chains",
        "fields",
        "last",
    ];
    own.into_iter().chain(FORMATS.iter().map(|format| format.key)).collect()
});

/// One of [`KEYS`]. Refused here, an unknown key is named with its line.
struct Key(&'static str);

impl<'de> Deserialize<'de> for Key {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct KeyVisitor;
        impl Visitor<'_> for KeyVisitor {
            type Value = Key;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a key")
            }
            fn visit_str<E: de::Error>(self, text: &str) -> Result<Key, E> {
                let known = KEYS.iter().find(|key| **key == text);
                known.map(|key| Key(key)).ok_or_else(|| E::unknown_field(text, &KEYS))
            }
        }
        deserializer.deserialize_identifier(KeyVisitor)
    }
}

impl<'de> Deserialize<'de> for Output {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OutputVisitor;
        impl<'de> Visitor<'de> for OutputVisitor {
            type Value = Output;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Output, A::Error> {
                let mut output = Output::default();
                while let Some(Key(key)) = map.next_key()? {
                    match key {
                        "frames" => output.frames = Some(map.next_value()?),
                        "history_interval" => output.history_interval = Some(map.next_value()?),
                        "frame_steps" => output.frame_steps = Some(map.next_value()?),
                        "history_steps" => output.history_steps = Some(map.next_value()?),
                        "checkpoint" => output.checkpoint = Some(map.next_value()?),
                        "tables" => output.tables = Some(map.next_value()?),
                        "packing" => output.packing = Some(map.next_value()?),
                        "state" => output.state = Some(map.next_value()?),
                        "chains" => output.chains = Some(map.next_value()?),
                        "last" => output.last = Some(map.next_value()?),
                        "fields" => output.fields = Some(map.next_value()?),
                        format => {
                            output.formats.insert(format, map.next_value()?);
                        }
                    }
                }
                Ok(output)
            }
        }
        deserializer.deserialize_map(OutputVisitor)
    }
}
