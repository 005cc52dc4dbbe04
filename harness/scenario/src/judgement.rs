//! The `[judgement]` table: which camera models photographs are judged with.

use calibench_calibrate::MODELS;
use calibench_calibrate::choice::{HALF, ModelChoice, ModelError};
use calibench_diagnostics::Problem;
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::section::Section;
use super::wire::bounded;

bounded! {
    /// A length, object units.
    Length(f64), f64 "f64", 1e-9, 1e9;
    /// A pixel pitch, um.
    Pitch(f64), f64 "f64", 0.01, 1e4;
    /// How many times.
    Splits(u64), i64 "i64", 1, 1000;
}

/// Splits where the file gives no number.
const SPLITS: u64 = 10;

/// Calibrates with every method and every model, and judges both without truth: hold-out reprojection, halves, straight lines.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JudgementWire {
    /// Camera models, as in "opencv5" or, with only some of their parameters, "opencv4:fx,fy,cx,cy".
    #[schemars(with = "Vec<String>")]
    pub models: Spanned<Vec<String>>,
    /// Side of the chessboard's squares, object units.
    pub side: Length,
    /// The object unit, for the report. Default mm.
    pub unit: Option<String>,
    /// Pixel pitch, um, for models in mm; no figure in px depends on it. Default 10.
    pub pitch: Option<Pitch>,
    /// How often the photographs are split into two halves. Default 10.
    pub splits: Option<Splits>,
    /// A camera file beside the photographs: a calibration that somebody published of them.
    #[schemars(with = "Option<String>")]
    pub published: Option<Spanned<String>>,
    /// The camera model that `calibench league` asks whole calibration systems for: each calibrates halves of the photographs, and its camera predicts the others.
    #[schemars(with = "Option<String>")]
    pub league: Option<Spanned<String>>,
}

/// How photographs are judged.
#[derive(Clone, Debug)]
pub struct JudgementPlan {
    /// The camera models.
    pub models: Vec<ModelChoice>,
    /// Side of the squares, object units.
    pub side: f64,
    /// The object unit.
    pub unit: String,
    /// Pixel pitch, um.
    pub pitch_um: Option<f64>,
    /// How many splits.
    pub splits: u64,
    /// The published camera's file name.
    pub published: Option<String>,
    /// The camera model that whole calibration systems are asked for; `None` where they are not.
    pub league: Option<String>,
}

/// Reads the table, for so many photographs.
pub fn read(section: Section<'_>, photographs: usize, problems: &mut Vec<Problem>) -> Option<JudgementPlan> {
    let span = section.span.clone();
    let wire: JudgementWire = section.read(&[], problems)?;
    if photographs < 2 * HALF {
        let message = format!("[judgement] of {photographs} photographs: expected at least {}, {HALF} in each half", 2 * HALF);
        problems.push(Problem::new(span, message));
    }
    let models_span = wire.models.span();
    let models = match ModelChoice::parse_all(wire.models.get_ref()) {
        Ok(models) if models.is_empty() => {
            problems.push(Problem::new(models_span, "`models` is empty: expected at least one camera model").help("as in [\"opencv5\"]"));
            return None;
        }
        Ok(models) => models,
        Err((_, error)) => {
            let near = match &error {
                ModelError::Unknown(calibench_calibrate::CalibrationError::UnknownModel { near: Some(near), .. }) => Some(near.clone()),
                _ => None,
            };
            let problem = Problem::new(models_span, error.to_string());
            problems.push(match near {
                Some(near) => problem.help(format!("did you mean `{near}`?")),
                None => problem,
            });
            return None;
        }
    };
    if let Some(file) = &wire.published {
        let name = std::path::Path::new(file.get_ref());
        if name.file_name().is_none_or(|plain| plain != name.as_os_str()) {
            let problem = Problem::new(file.span(), format!("`{}` is no plain file name", file.get_ref()));
            problems.push(problem.help("the file lies beside the photographs"));
        }
    }
    if let Some(model) = wire.league.as_ref().filter(|model| !MODELS.contains(&model.get_ref().as_str())) {
        let message = format!("`{}` is no camera model: expected one of {}", model.get_ref(), MODELS.join(", "));
        problems.push(Problem::new(model.span(), message).nearest(model.get_ref(), MODELS));
    }
    Some(JudgementPlan {
        models,
        side: wire.side.0,
        unit: wire.unit.unwrap_or_else(|| "mm".into()),
        pitch_um: wire.pitch.map(|pitch| pitch.0),
        splits: wire.splits.map_or(SPLITS, |splits| splits.0),
        published: wire.published.map(Spanned::into_inner),
        league: wire.league.map(Spanned::into_inner),
    })
}
