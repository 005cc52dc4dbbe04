//! The JSON Schemas of answers.

use calibench_exchange::MeasuredRow;
use schemars::schema_for;
use serde_json::{Value, json};

use super::{
    AcceptanceAnswer, Answer, CalibrationAnswer, CameraFileAnswer, ConversionAnswer, DifferenceAnswer, JudgementAnswer, ListAnswer,
    MeasurementAnswer, RigAnswer, RigStandsAnswer, SplinedAnswer, TaskAnswer, TwinAnswer,
};

/// Commands that answer with `--json`.
pub const COMMANDS: [&str; 13] = [
    CalibrationAnswer::COMMAND,
    RigAnswer::COMMAND,
    SplinedAnswer::COMMAND,
    JudgementAnswer::COMMAND,
    RigStandsAnswer::COMMAND,
    ConversionAnswer::COMMAND,
    CameraFileAnswer::COMMAND,
    DifferenceAnswer::COMMAND,
    ListAnswer::COMMAND,
    Measured::COMMAND,
    AcceptanceAnswer::COMMAND,
    TaskAnswer::COMMAND,
    TwinAnswer::COMMAND,
];

/// What `measure` answers: the schema is the same for any rows.
type Measured = MeasurementAnswer<'static, std::iter::Empty<MeasuredRow<'static>>>;

/// The schema of a command's answer; `None` for a command that answers in words alone.
pub fn schema_of(command: &str) -> Option<Value> {
    Some(match command {
        CalibrationAnswer::COMMAND => of::<CalibrationAnswer>(),
        RigAnswer::COMMAND => of::<RigAnswer>(),
        SplinedAnswer::COMMAND => of::<SplinedAnswer>(),
        JudgementAnswer::COMMAND => of::<JudgementAnswer>(),
        RigStandsAnswer::COMMAND => of::<RigStandsAnswer>(),
        ConversionAnswer::COMMAND => of::<ConversionAnswer>(),
        CameraFileAnswer::COMMAND => of::<CameraFileAnswer>(),
        DifferenceAnswer::COMMAND => of::<DifferenceAnswer>(),
        ListAnswer::COMMAND => of::<ListAnswer>(),
        Measured::COMMAND => of::<Measured>(),
        AcceptanceAnswer::COMMAND => of::<AcceptanceAnswer>(),
        TaskAnswer::COMMAND => of::<TaskAnswer>(),
        TwinAnswer::COMMAND => of::<TwinAnswer>(),
        _ => return None,
    })
}

fn of<A: Answer>() -> Value {
    let mut root = schema_for!(A).to_value();
    root["title"] = json!(format!("calibench {} --json, version {}", A::COMMAND, A::SCHEMA));
    root["properties"]["command"] = json!({ "const": A::COMMAND, "description": "The command that answered." });
    root["properties"]["schema"] = json!({
        "const": A::SCHEMA,
        "description": "Version of this schema: it grows when a key goes or comes to mean something else, and not when one is added."
    });
    root["properties"]["calibench"] = json!({ "type": "string", "description": "Version of the program." });
    if let Some(required) = root["required"].as_array_mut() {
        required.extend(["command", "schema", "calibench"].map(Value::from));
    }
    root
}
