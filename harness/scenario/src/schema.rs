//! The JSON Schema of scenario files, for editors.

use calibench_measure::Registry;
use calibench_measure::parameter::Domain;
use calibench_measure::registry::KINDS;
use calibench_model::TargetKind;
use schemars::{JsonSchema, schema_for};
use serde_json::{Map, Value, json};

use super::camera::{CameraWire, LocalWire};
use super::figure::FigureWire;
use super::judgement::JudgementWire;
use super::optics::OpticsWire;
use super::pointing::{BoardPointingWire, HarrisWire};
use super::sensor::SensorWire;
use super::stations::wire::{ArcWire, BoardWire, CommonWire, ConvergentWire, RandomWire, StandWire, StationWire};
use super::studies::acceptance::wire::{ClassesWire, LengthsWire};
use super::studies::blocks::wire::{BlockWire, BlocksWire, ResidualsWire};
use super::studies::calibrators::wire::{CalibratorWire, CalibratorsWire, FaultsWire};
use super::studies::network::wire::{CalibrationWire, CheckWire};
use super::studies::networks::wire::{DistanceWire, FreeNetworkWire, MountWire, RigWire};
use super::studies::printed::wire as printed_wire;
use super::studies::recognition::wire::{ImagesWire, RecognitionWire};
use super::studies::tasks::wire::TasksWire;
use super::studies::transfer::wire::{BoardWire as TransferBoardWire, CaseWire, DecompositionWire, MethodWire, TransferWire};
use super::sweep::wire::SweepWire;
use super::testfield::boards::wire::{
    AprilGridWire, BoardWire as BoardFieldWire, CharucoWire, CirclesWire, DottedWire, GridBoardWire, PuzzleWire, RingsWire, SheetWire,
    TagWire, TagsWire,
};
use super::testfield::wire::{ChessboardWire, CodedWire, FillWire, HouseWire, PanelsWire, PlateWire, WallTargetWire, WallWire};
use super::wire::{Head, PhotographsWire, PointingWire, PolygonWire, SceneWire, TargetWire};

/// The schema, with the methods of `registry` and their parameters.
pub fn schema(registry: &Registry) -> Value {
    let mut root = table::<Head>();
    root["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    root["title"] = json!("calibench scenario");
    let mut scene = table::<SceneWire>();
    scene["properties"]["polygon"] = list(&table::<PolygonWire>());
    scene["properties"]["target"] = list(&table::<TargetWire>());
    scene["properties"]["pointing"] = pointing();
    require(&mut scene, &["polygon", "target"]);
    root["properties"]["scene"] = scene;
    root["properties"]["photographs"] = table::<PhotographsWire>();
    root["properties"]["judgement"] = table::<JudgementWire>();
    root["properties"]["method"] = list(&json!({ "oneOf": registry.methods().iter().map(method).collect::<Vec<_>>() }));
    root["properties"]["sweep"] = table::<SweepWire>();
    root["properties"]["figure"] = table::<FigureWire>();
    root["properties"]["figure"]["properties"]["pointing"] = pointing();
    root["properties"]["camera"] = table::<CameraWire>();
    root["properties"]["camera"]["properties"]["local"] = table::<LocalWire>();
    root["properties"]["testfield"] = testfield();
    root["properties"]["stations"] = stations();
    root["properties"]["station"] = list(&table::<StationWire>());
    root["properties"]["optics"] = table::<OpticsWire>();
    root["properties"]["sensor"] = table::<SensorWire>();
    root["properties"]["calibration"] = table::<CalibrationWire>();
    root["properties"]["calibration"]["properties"]["check"] = table::<CheckWire>();
    root["properties"]["blocks"] = table::<BlocksWire>();
    root["properties"]["blocks"]["properties"]["residuals"] = table::<ResidualsWire>();
    root["properties"]["block"] = list(&table::<BlockWire>());
    root["properties"]["calibrators"] = table::<CalibratorsWire>();
    root["properties"]["calibrators"]["properties"]["faults"] = table::<FaultsWire>();
    root["properties"]["calibrator"] = list(&table::<CalibratorWire>());
    root["properties"]["free_network"] = table::<FreeNetworkWire>();
    root["properties"]["distance"] = list(&table::<DistanceWire>());
    root["properties"]["acceptance"] = json!({ "oneOf": [table::<LengthsWire>(), table::<ClassesWire>()] });
    root["properties"]["rig"] = table::<RigWire>();
    root["properties"]["mount"] = list(&table::<MountWire>());
    root["properties"]["tasks"] = table::<TasksWire>();
    root["properties"]["recognition"] = table::<RecognitionWire>();
    root["properties"]["recognition"]["properties"]["images"] = list(&table::<ImagesWire>());
    root["properties"]["transfer"] = transfer();
    root["properties"]["printed"] = printed();
    root["properties"]["pointing"] = pointing();
    let subjects = [
        vec!["scene", "method"],
        vec!["figure", "method"],
        vec!["camera", "testfield", "pointing", "method"],
        vec!["photographs", "method"],
        vec!["transfer"],
        vec!["printed"],
    ];
    root["oneOf"] = subjects.iter().map(|keys| json!({ "required": keys })).collect();
    root
}

/// A hand, or one of the detectors.
fn pointing() -> Value {
    json!({ "oneOf": [table::<PointingWire>(), table::<HarrisWire>(), table::<BoardPointingWire>()] })
}

fn transfer() -> Value {
    let mut transfer = table::<TransferWire>();
    transfer["properties"]["board"] = table::<TransferBoardWire>();
    transfer["properties"]["method"] = list(&table::<MethodWire>());
    transfer["properties"]["case"] = list(&table::<CaseWire>());
    transfer["properties"]["decomposition"] = list(&table::<DecompositionWire>());
    require(&mut transfer, &["method", "case"]);
    transfer
}

fn printed() -> Value {
    let mut all = table::<printed_wire::PrintedWire>();
    all["properties"]["pixel"] = list(&table::<printed_wire::PixelWire>());
    all["properties"]["camera"] = list(&table::<printed_wire::CameraWire>());
    all["properties"]["grid"] = list(&table::<printed_wire::GridWire>());
    all["properties"]["point"] = list(&table::<printed_wire::PointWire>());
    all["properties"]["network"] = table::<printed_wire::NetworkWire>();
    all["properties"]["variant"] = list(&table::<printed_wire::VariantWire>());
    require(&mut all, &["camera"]);
    all
}

fn testfield() -> Value {
    let mut wall = table::<WallWire>();
    for (key, schema) in [
        ("plate", list(&table::<PlateWire>())),
        ("target", list(&table::<WallTargetWire>())),
        ("panels", table::<PanelsWire>()),
        ("fill", table::<FillWire>()),
    ] {
        wall["properties"][key] = schema;
    }
    let unit = json!({ "description": "The object unit. Default mm.", "enum": ["mm", "m"] });
    let mut tags = table::<TagsWire>();
    tags["properties"]["tag"] = list(&table::<TagWire>());
    let kinds = [
        ("chessboard", table::<ChessboardWire>()),
        ("wall", wall),
        ("coded", table::<CodedWire>()),
        ("house", table::<HouseWire>()),
        ("board", with(table::<BoardFieldWire>(), &table::<SheetWire>())),
        ("charuco", with(table::<CharucoWire>(), &table::<SheetWire>())),
        ("aprilgrid", with(table::<AprilGridWire>(), &table::<SheetWire>())),
        ("gridboard", with(table::<GridBoardWire>(), &table::<SheetWire>())),
        ("circles", with(table::<CirclesWire>(), &table::<SheetWire>())),
        ("rings", with(table::<RingsWire>(), &table::<SheetWire>())),
        ("dotted", with(table::<DottedWire>(), &table::<SheetWire>())),
        ("puzzle", with(table::<PuzzleWire>(), &table::<SheetWire>())),
        ("tags", tags),
    ];
    one_of(kinds.into_iter().map(|(kind, mut schema)| {
        schema["properties"]["unit"] = unit.clone();
        (kind, schema)
    }))
}

fn stations() -> Value {
    let common = table::<CommonWire>();
    let kinds = [
        ("convergent", table::<ConvergentWire>()),
        ("arc", table::<ArcWire>()),
        ("board", table::<BoardWire>()),
        ("random", table::<RandomWire>()),
        ("stand", table::<StandWire>()),
    ];
    one_of(kinds.into_iter().map(|(kind, schema)| (kind, with(schema, &common))))
}

/// A table with the keys of another.
fn with(mut table: Value, common: &Value) -> Value {
    for (key, property) in common["properties"].as_object().into_iter().flatten() {
        table["properties"][key] = property.clone();
    }
    table
}

/// Tables that their key `kind` tells apart.
fn one_of(kinds: impl Iterator<Item = (&'static str, Value)>) -> Value {
    let tables = kinds.map(|(kind, mut schema)| {
        schema["properties"]["kind"] = json!({ "const": kind });
        match schema["required"].as_array_mut() {
            Some(required) => required.push(json!("kind")),
            None => schema["required"] = json!(["kind"]),
        }
        schema
    });
    json!({ "oneOf": tables.collect::<Vec<_>>() })
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

/// The kinds of targets that a method is limited to.
fn kinds() -> Value {
    let description = "The kinds of targets that it is limited to. Default: all.";
    let names = TargetKind::ALL.map(TargetKind::name);
    json!({ "description": description, "type": "array", "minItems": 1, "uniqueItems": true, "items": { "enum": names } })
}

fn method(method: &calibench_measure::Method) -> Value {
    let mut properties = Map::new();
    properties.insert("name".into(), json!({ "const": method.name }));
    properties.insert(KINDS.into(), kinds());
    for parameter in method.parameters {
        let (min, max) = parameter.domain.range();
        let form = if matches!(parameter.domain, Domain::Real { .. }) { "number" } else { "integer" };
        let mut schema =
            json!({ "description": parameter.about, "type": form, "minimum": min, "maximum": max, "default": parameter.default });
        if matches!(parameter.domain, Domain::Odd { .. }) {
            schema["not"] = json!({ "multipleOf": 2 });
        }
        if let Domain::Choice(choices) = parameter.domain {
            schema["enum"] = json!(choices);
        }
        if let Domain::Named(names) = parameter.domain {
            // Numbers were written before there were names.
            let values: Vec<Value> = names.iter().map(|name| json!(name)).chain((0..names.len()).map(|place| json!(place))).collect();
            schema = json!({ "description": parameter.about, "enum": values, "default": parameter.domain.setting(parameter.default).to_string() });
        }
        properties.insert(parameter.name.into(), schema);
    }
    json!({ "type": "object", "description": method.about, "properties": properties, "required": ["name"], "additionalProperties": false })
}
