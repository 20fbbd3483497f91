//! JSON schema of scene files, for editors.

use super::Scene;
use super::coupling::{SpreadTable, Substeps, TransferTable};
use super::include;
use super::units::{Dimension, Quantity};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Value, json};
use std::borrow::Cow;

/// Describes tables and keys by their types and comments.
pub fn keys() -> Value {
    schemars::schema_for!(Scene).to_value()
}

/// Returns the schema of a scene.
pub fn schema() -> Value {
    let mut schema = keys();
    schema["title"] = json!("Scene of trackbed");
    schema["properties"][include::KEY] = json!({
        "description": "Files with tables used where the scene has none; paths relative to it.",
        "type": "array",
        "items": { "type": "string", "format": "path" },
    });
    // Other keys of a material may come from an included material of that name.
    let required = std::mem::replace(&mut schema["$defs"]["GrainMaterial"]["required"], json!(["name"]));
    schema["if"] = json!({ "not": { "required": [include::KEY] } });
    schema["then"] = json!({ "properties": { "material": { "items": { "required": required } } } });
    schema
}

impl<D: Dimension> JsonSchema for Quantity<D> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Quantity".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let units: Vec<&str> = D::UNITS.iter().map(|(unit, _)| *unit).collect();
        let number = r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?";
        json_schema!({
            "description": D::EXPECTED,
            "anyOf": [
                { "type": "number" },
                { "type": "string", "pattern": format!(r"^\s*{number}\s*({})?\s*$", units.join("|")) },
            ],
        })
    }
}

impl JsonSchema for Substeps {
    fn schema_name() -> Cow<'static, str> {
        "Substeps".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "integer", "minimum": 1, "maximum": 1000 }, { "const": "auto" }] })
    }
}

impl JsonSchema for TransferTable {
    fn schema_name() -> Cow<'static, str> {
        "Transfer".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let spread = generator.subschema_for::<SpreadTable>();
        json_schema!({ "anyOf": [{ "const": "point" }, spread] })
    }
}
