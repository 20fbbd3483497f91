//! Identity of a checkpoint: program, scene, files, CPU.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;
use trackbed_input::scene::Document;

/// Origin of a checkpoint.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Origin {
    /// Program version.
    pub version: String,
    /// Hash of scene, overrides and files.
    pub scene_hash: String,
    /// Scene text.
    pub scene: String,
    /// Command-line overrides, key=value.
    pub overrides: Vec<String>,
    /// Named files with hashes.
    pub files: Vec<(PathBuf, String)>,
    /// CPU features that affect rounding in the solid.
    pub processor: String,
}

/// Returns architecture and instruction sets of solid kernels: SIMD width and FMA change rounding. Grains are
/// bitwise identical on all.
pub fn processor() -> String {
    let mut words = vec![std::env::consts::ARCH];
    #[cfg(target_arch = "x86_64")]
    {
        let found = [
            ("avx2", is_x86_feature_detected!("avx2")),
            ("fma", is_x86_feature_detected!("fma")),
            ("avx512f", is_x86_feature_detected!("avx512f")),
        ];
        words.extend(found.iter().filter(|(_, there)| *there).map(|(name, _)| *name));
    }
    words.join(" ")
}

impl Origin {
    /// Describes a CPU difference to `old`, if relevant.
    pub fn other_processor(&self, old: &Origin) -> Option<String> {
        (self.processor != old.processor).then(|| {
            format!(
                "checkpoint of a CPU with {}, this CPU has {}: grains continue bitwise identically, the last digits of a solid may differ",
                old.processor, self.processor
            )
        })
    }

    /// Describes how this scene differs from `old`, if it does.
    pub fn difference(&self, old: &Origin, document: &Document) -> Option<String> {
        if old.version != self.version {
            return Some(format!("found program version {}, expected {}", old.version, self.version));
        }
        if old.scene_hash == self.scene_hash {
            return None;
        }
        let wrong = "the scene has changed since the checkpoint";
        let before = Document::parse(document.file(), old.scene.clone()).ok().and_then(|mut d| {
            d.set_all(&old.overrides).ok()?;
            Some(d.keys())
        });
        if let Some(before) = before {
            let now = document.keys();
            let changed = before.keys().chain(now.keys()).find(|k| before.get(*k) != now.get(*k));
            if let Some(key) = changed {
                let text =
                    |keys: &BTreeMap<String, String>| keys.get(key).map_or("absent", |v| v).to_string();
                return Some(format!("{wrong}: {key} was {}, now {}", text(&before), text(&now)));
            }
        }
        let changed = self.files.iter().find(|f| !old.files.contains(f));
        Some(match changed {
            Some((file, _)) => format!("{wrong}: {} has changed", file.display()),
            None => format!("{wrong}: its text, overrides or --from have changed, but no key"),
        })
    }
}
