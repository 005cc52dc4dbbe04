//! The board's share of what is not predicted: its corners freed on the photographs that take part, and the others predicted with them.

use std::collections::BTreeMap;
use std::sync::Arc;

use calibench_calibrate::choice::ModelChoice;
use calibench_calibrate::{BoardShape, Settings};
use calibench_records::judgement::{Row, Summary, measure};

use super::calibrated::calibrate;
use super::field::Field;
use super::holdout::Unseen;
use super::material::Material;
use super::operator_and_model::folds;
use super::{BENT, Options};

/// `rows` of a judgement, with those that tell the board's share beside those of the operator and the model that are trusted: what unseen photographs keep of their errors
/// where the corners of the board are free in the others, and, of a board whose corners were measured, where these are not used.
///
/// Only of a field that is a board is this the board's share.
pub fn with_board(mut rows: Vec<Row>, material: &Material, options: &Options) -> Vec<Row> {
    let summary = Summary::new(&rows, options.seed);
    let Some(trusted) = summary.trusted() else { return rows };
    let (method, label) = (&trusted.cell.method, &trusted.cell.model);
    let operator = material.operators.iter().position(|corners| corners.method == *method);
    let model = options.models.iter().find(|model| *model.label == **label);
    let (Some(operator), Some(model)) = (operator, model) else { return rows };
    let of_board = of(material, operator, model, options).into_iter().map(|row| row.by(method, label));
    let is_own = |row: &Row| row.method == *method && row.model == *label;
    let after = rows.iter().rposition(is_own).map_or(rows.len(), |last| last + 1);
    rows.splice(after..after, of_board.collect::<Vec<_>>());
    rows
}

fn of(material: &Material, operator: usize, model: &ModelChoice, options: &Options) -> Vec<Row> {
    let lens = ModelChoice::parse(model.label.trim_end_matches(BENT)).unwrap_or_else(|_| model.clone());
    let settings = Settings { shape: BoardShape::Free, ..lens.settings(material.size, options.pitch_um) };
    let mut rows = match left_out(material, operator, &settings, measure::BOARD_FREED) {
        Ok((rows, moved)) => rows.into_iter().chain(moved).collect(),
        Err(why) => vec![Row::without(measure::BOARD_FREED, "", "left out", &why)],
    };
    if let Field::Measured { nominal, .. } = &material.field {
        let of_nominal = Material { field: (**nominal).clone(), ..material.clone() };
        let settings = model.settings(material.size, options.pitch_um);
        rows.extend(match left_out(&of_nominal, operator, &settings, measure::BOARD_NOMINAL) {
            Ok((rows, _)) => rows,
            Err(why) => vec![Row::without(measure::BOARD_NOMINAL, "", "left out", &why)],
        });
    }
    rows
}

type Found = (Vec<Row>, Vec<Row>);

/// Each fold of the views predicted from the others; and of free corners how far they are from their places.
fn left_out(material: &Material, operator: usize, settings: &Settings, name: &'static str) -> Result<Found, String> {
    let views = material.usable(operator);
    let common = material.common();
    let all = calibrate(material, operator, &views, settings).map_err(|error| error.to_string())?;
    let mut found: BTreeMap<usize, Row> = BTreeMap::new();
    for fold in folds(&views) {
        let others: Vec<usize> = views.iter().copied().filter(|view| !fold.contains(view)).collect();
        let part = all.part(&others).map_err(|error| error.to_string())?;
        for view in fold {
            let near = all.pose(view).ok_or("a photograph has no pose")?;
            let unseen = Unseen { material, operator, view, camera: &part.camera, bend: &part.bend, near: &near };
            let squares = unseen.interleaved(&common[view])?;
            let place: &Arc<str> = &material.views[view];
            found.insert(view, Row::px(name, place, squares.rms().unwrap_or(f64::NAN)).of(squares.count()));
        }
    }
    let moved = if settings.shape == BoardShape::Free { all.moved().map_err(|error| error.to_string())?.to_vec() } else { Vec::new() };
    let moved = moved.into_iter().zip(["in the plane", "across"]);
    let moved = moved.map(|((moved, sigma), place)| Row::plain(measure::BOARD_MOVED, place, moved).beside(sigma)).collect();
    Ok((found.into_values().collect(), moved))
}
