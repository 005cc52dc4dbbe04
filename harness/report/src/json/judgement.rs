//! A judgement as JSON.

#![expect(clippy::struct_field_names, reason = "they are the keys of the document, each with its unit")]

use calibench_records::judgement::{Beside, BoardShare, Cell, Estimate, InUse, Standing, StillHolds, Summary, Trusted};
use schemars::JsonSchema;
use serde::Serialize;

use super::Answer;
use crate::judgement::verdict;

/// Which operator and which camera model to trust, and how far.
#[derive(Serialize, JsonSchema)]
pub struct JudgementAnswer {
    /// The operator to be trusted.
    operator: String,
    /// The camera model to be trusted.
    model: String,
    /// Why the verdict is in doubt, in words; empty where it is not. With any the exit code is 3, unless a camera in use was asked about.
    doubts: Vec<String>,
    /// The verdict in words, a paragraph each, as Markdown.
    words: Vec<String>,
    /// RMS with which that camera predicts points of photographs that took no part in the calibration.
    holdout: Option<Figure>,
    /// Below which the camera's error over the whole frame is in 95 of 100 cases, px RMS after the best rotation.
    limit_px: Option<f64>,
    /// Standard deviation of the image of a point far away in the centre of the frame, px.
    sigma_centre_px: Option<f64>,
    /// The same in its worst corner.
    sigma_corner_px: Option<f64>,
    /// By which sigmas must be multiplied, a number: 1 where nothing is to be said against them.
    inflation: f64,
    /// What of the error of predictions is the board's; null where its corners were not freed.
    board: Option<Board>,
    /// What halves of the photographs say of the sigmas.
    halves: Option<Halves>,
    /// The model with which operators are compared.
    compared_with: String,
    /// The operators, the best first.
    operators: Vec<Operator>,
    /// The models in the hands of the operator to be trusted, by what is lost with them.
    models: Vec<Model>,
    /// How many points each operator measured.
    measured: Vec<Measured>,
    /// The photographs.
    photographs: Vec<Photograph>,
    /// A camera that somebody published, beside ours.
    published: Option<Apart>,
    /// What is said of a camera in use: exit code 0 if it holds, 1 if it has moved, 3 if the photographs cannot tell.
    in_use: Option<Use>,
}

impl Answer for JudgementAnswer {
    const COMMAND: &'static str = "judge";
    const SCHEMA: u32 = 1;
}

/// A figure with its 95 % interval over photographs.
#[derive(Serialize, JsonSchema)]
struct Figure {
    /// The figure, px.
    value_px: f64,
    /// Lower end, px.
    low_px: f64,
    /// Upper end, px.
    high_px: f64,
}

impl From<Estimate> for Figure {
    fn from(Estimate { value, interval: (low, high) }: Estimate) -> Self {
        Self { value_px: value, low_px: low, high_px: high }
    }
}

/// The board beside operators and models: what each adds to the error of predictions is the root of a difference of squares.
#[derive(Serialize, JsonSchema)]
struct Board {
    /// RMS of points not seen with the corners of the board freed in the photographs that take part.
    freed: Figure,
    /// The chance of as much of an improvement if free corners predict no better.
    p: f64,
    /// What the board as it is said to be adds, px.
    board_px: f64,
    /// What separates the middle one of the other operators from the best, px; null of one alone.
    operators_px: Option<f64>,
    /// The same of the models.
    models_px: Option<f64>,
    /// Whether the board decides: measure it.
    decides: bool,
    /// How far its corners are off in its plane (RMS, 2D), object units, what their standard deviations explain taken out; null where that cannot be told.
    moved_in_plane: Option<f64>,
    /// The standard deviation of that.
    sigma_in_plane: Option<f64>,
    /// How far they are off along its normal.
    moved_across: Option<f64>,
    /// The standard deviation of that.
    sigma_across: Option<f64>,
    /// Of a board whose corners are those of a file; null of others.
    file: Option<BoardFile>,
}

#[derive(Serialize, JsonSchema)]
struct BoardFile {
    /// RMS of points not seen with nominal corners.
    nominal: Figure,
    /// The chance of as much of a loss with nominal corners if they predict no worse.
    p: f64,
    /// Whether the file decides: take it.
    decides: bool,
    /// Whether nominal corners predict better: the file is of another board, or of this one before it changed.
    misfits: bool,
}

fn board(share: &BoardShare, own: f64) -> Board {
    let moved = share.moved;
    Board {
        freed: share.freed.holdout.into(),
        p: share.freed.p_better,
        board_px: share.board_px,
        operators_px: share.operators_px,
        models_px: share.models_px,
        decides: share.decides(),
        moved_in_plane: moved.map(|moved| moved.in_plane),
        sigma_in_plane: moved.map(|moved| moved.sigma_in_plane),
        moved_across: moved.map(|moved| moved.across),
        sigma_across: moved.map(|moved| moved.sigma_across),
        file: share.nominal.map(|nominal| BoardFile {
            nominal: nominal.holdout.into(),
            p: nominal.p_worse,
            decides: share.file_decides(own),
            misfits: share.file_misfits(),
        }),
    }
}

#[derive(Serialize, JsonSchema)]
struct Halves {
    /// How many times the photographs were split.
    splits: usize,
    /// Empirical over predicted difference of two halves over the frame, a number: 1 if the sigmas are right.
    ratio: f64,
    /// The same mode by mode.
    ratio_of_modes: f64,
    /// The chance of as large differences if the sigmas are right.
    p: f64,
}

#[derive(Serialize, JsonSchema)]
struct Operator {
    /// The method.
    method: String,
    /// RMS of points not seen.
    holdout: Option<Figure>,
    /// Holm's p-value of its being no worse than the best one; null for that one.
    p: Option<f64>,
    /// Why it was not judged, if so.
    why_not: Option<String>,
}

#[derive(Serialize, JsonSchema)]
struct Model {
    /// The model.
    model: String,
    /// How many parameters it solves for.
    parameters: usize,
    /// RMS of points not seen.
    holdout: Option<Figure>,
    /// How often it predicts best when photographs are drawn again, 0 to 1.
    share: Option<f64>,
    /// How far its camera is expected to be from the one that predicts best, px RMS over the frame.
    loss_px: Option<f64>,
    /// Why it was not judged, if so.
    why_not: Option<String>,
}

#[derive(Serialize, JsonSchema)]
struct Measured {
    /// The method.
    method: String,
    /// Points measured.
    found: usize,
    /// Of how many.
    of: usize,
    /// Why it measured nothing, if so.
    why_not: Option<String>,
}

#[derive(Serialize, JsonSchema)]
struct Photograph {
    /// Its name.
    name: String,
    /// RMS residual in the adjustment of all photographs, px; null where the field was not found.
    rms_px: Option<f64>,
    /// RMS of its points when it took no part, px.
    holdout_px: Option<f64>,
    /// Holm's p-value of its being like the others.
    p: Option<f64>,
    /// Whether it is not like the others: look at it, and calibrate without it.
    outlying: bool,
    /// Why it is not judged, if so.
    why_not: Option<String>,
}

/// How far two cameras are apart.
#[derive(Serialize, JsonSchema)]
struct Apart {
    /// RMS over the frame after the best rotation, px.
    rms_px: f64,
    /// The largest, px.
    max_px: f64,
    /// RMS where points were measured, px.
    seen_px: Option<f64>,
    /// Standard deviation of our camera over the frame, px RMS.
    sigma_px: f64,
    /// That which the published camera states of itself, px RMS over the frame.
    stated_sigma_px: Option<f64>,
}

#[derive(Serialize, JsonSchema)]
struct Use {
    /// `holds`, `moved` or `cannot tell`.
    verdict: &'static str,
    /// RMS difference over the frame after the best rotation, px; null where they cannot be compared.
    apart_px: Option<f64>,
    /// Within which it is known in 99 of 100 cases, px; null where the photographs are in doubt.
    error_px: Option<f64>,
    /// Up to which the camera holds, px.
    margin_px: f64,
}

impl JudgementAnswer {
    /// Of a judgement whose camera can be trusted, with doubts about the photographs that others had before.
    pub fn new(summary: &Summary, trusted: &Trusted<'_>, in_use: Option<&InUse>, before: &[String]) -> Self {
        let cell = trusted.cell;
        let words = verdict(summary, trusted);
        let published = cell.published.map(|published| {
            let Beside { frame, most, seen } = published.beside;
            Apart { rms_px: frame, max_px: most, seen_px: seen, sigma_px: published.predicted, stated_sigma_px: published.stated }
        });
        Self {
            operator: cell.method.to_string(),
            model: cell.model.to_string(),
            doubts: before.iter().cloned().chain(trusted.doubt()).collect(),
            words: words.lines().map(|line| line.trim_start_matches("- ").to_owned()).collect(),
            holdout: cell.holdout.map(Figure::from),
            limit_px: trusted.limit,
            sigma_centre_px: cell.uncertainty.map(|(centre, _)| centre),
            sigma_corner_px: cell.uncertainty.map(|(_, corner)| corner),
            inflation: trusted.inflation(),
            board: trusted.board().map(|share| board(&share, cell.holdout.map_or(f64::NAN, |holdout| holdout.value))),
            halves: cell.split.map(|split| Halves { splits: split.count, ratio: split.ratio(), ratio_of_modes: split.modes, p: split.p }),
            compared_with: trusted.least.model.to_string(),
            operators: operators(trusted),
            models: models(trusted),
            measured: summary.methods.iter().map(measured).collect(),
            photographs: photographs(summary, cell),
            published,
            in_use: in_use.map(used),
        }
    }
}

fn operators(trusted: &Trusted<'_>) -> Vec<Operator> {
    let one = |cell: &Cell, p, why_not: Option<&str>| Operator {
        method: cell.method.to_string(),
        holdout: cell.holdout.map(Figure::from),
        p,
        why_not: why_not.map(str::to_owned),
    };
    let others = trusted.operators.iter().map(|(cell, p)| one(cell, Some(*p), None));
    let unjudged = trusted.unjudged.iter().map(|cell| one(cell, None, Some(why(cell))));
    std::iter::once(one(trusted.least, None, None)).chain(others).chain(unjudged).collect()
}

fn models(trusted: &Trusted<'_>) -> Vec<Model> {
    let one = |cell: &Cell, standing: Option<&Standing<'_>>| Model {
        model: cell.model.to_string(),
        parameters: cell.parameters,
        holdout: cell.holdout.map(Figure::from),
        share: standing.map(|standing| standing.share),
        loss_px: standing.and_then(|standing| standing.loss),
        why_not: standing.is_none().then(|| why(cell).to_owned()),
    };
    let left_out = trusted.left_out.iter().map(|cell| one(cell, None));
    trusted.models.iter().map(|standing| one(standing.cell, Some(standing))).chain(left_out).collect()
}

fn why(cell: &Cell) -> &str {
    cell.trouble.as_deref().unwrap_or("not all photographs are predicted")
}

fn measured(found: &calibench_records::judgement::Measured) -> Measured {
    Measured {
        method: found.method.to_string(),
        found: found.found,
        of: found.of,
        why_not: found.unavailable.as_deref().map(str::to_owned),
    }
}

fn photographs(summary: &Summary, cell: &Cell) -> Vec<Photograph> {
    let outlying: Vec<&str> = cell.outlying().iter().map(|view| &*view.name).collect();
    let judged = cell.views.iter().map(|view| Photograph {
        name: view.name.to_string(),
        rms_px: Some(view.residual.0),
        holdout_px: cell.held_out.get(&view.name).map(|(rms, _)| *rms),
        p: Some(view.p),
        outlying: outlying.contains(&&*view.name),
        why_not: None,
    });
    let missed = summary.missed.iter().map(|(name, why)| Photograph {
        name: name.to_string(),
        rms_px: None,
        holdout_px: None,
        p: None,
        outlying: false,
        why_not: Some(why.to_string()),
    });
    judged.chain(missed).collect()
}

fn used(found: &InUse) -> Use {
    Use {
        verdict: match found.verdict {
            StillHolds::Holds => "holds",
            StillHolds::Moved => "moved",
            StillHolds::CannotTell => "cannot tell",
        },
        apart_px: Some(found.apart).filter(|px| px.is_finite()),
        error_px: Some(found.error).filter(|px| px.is_finite()),
        margin_px: found.margin,
    }
}
