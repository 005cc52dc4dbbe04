//! The JSON Schema of scenario files, for editors.

use calibench_measure::Registry;
use calibench_measure::parameter::Domain;
use schemars::{JsonSchema, schema_for};
use serde_json::{Map, Value, json};

use super::wire::{Head, PhotographsWire, PointingWire, PolygonWire, SceneWire, TargetWire};

/// The schema, with the methods of `registry` and their parameters.
pub fn schema(registry: &Registry) -> Value {
    let mut root = table::<Head>();
    root["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    root["title"] = json!("calibench scenario");
    let mut scene = table::<SceneWire>();
    scene["properties"]["polygon"] = list(&table::<PolygonWire>());
    scene["properties"]["target"] = list(&table::<TargetWire>());
    scene["properties"]["pointing"] = table::<PointingWire>();
    require(&mut scene, &["polygon", "target"]);
    root["properties"]["scene"] = scene;
    root["properties"]["photographs"] = table::<PhotographsWire>();
    root["properties"]["method"] = list(&json!({ "oneOf": registry.methods().iter().map(method).collect::<Vec<_>>() }));
    require(&mut root, &["method"]);
    root["oneOf"] = json!([{ "required": ["scene"] }, { "required": ["photographs"] }]);
    root
}

fn table<T: JsonSchema>() -> Value {
    let mut schema = schema_for!(T).to_value();
    if let Some(map) = schema.as_object_mut() {
        map.remove("$schema");
        map.remove("title");
    }
    schema
}

fn list(items: &Value) -> Value {
    json!({ "type": "array", "minItems": 1, "items": items })
}

fn require(schema: &mut Value, keys: &[&str]) {
    if let Some(required) = schema["required"].as_array_mut() {
        required.extend(keys.iter().map(|key| json!(key)));
    }
}

fn method(method: &calibench_measure::Method) -> Value {
    let mut properties = Map::new();
    properties.insert("name".into(), json!({ "const": method.name }));
    for parameter in method.parameters {
        let (min, max) = parameter.domain.range();
        let form = if matches!(parameter.domain, Domain::Real { .. }) { "number" } else { "integer" };
        let mut schema =
            json!({ "description": parameter.about, "type": form, "minimum": min, "maximum": max, "default": parameter.default });
        if matches!(parameter.domain, Domain::Odd { .. }) {
            schema["not"] = json!({ "multipleOf": 2 });
        }
        properties.insert(parameter.name.into(), schema);
    }
    json!({ "type": "object", "description": method.about, "properties": properties, "required": ["name"], "additionalProperties": false })
}
