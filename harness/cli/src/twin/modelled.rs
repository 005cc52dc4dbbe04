//! Camera, board and poses of photographs, from the points of one operator.

use std::collections::HashMap;

use calibench_calibrate::choice::ModelChoice;
use calibench_calibrate::{BoardShape, Calibration, DatumChoice, GrossErrors, Settings, StatedBoard, calibrate, prepare, with_corners};
use calibench_judge::Material;
use calibench_model::boards::Chessboard;
use calibench_model::{BoardCorner, ControlRow, NamedCamera, Pose};
use calibench_twin::Geometry;

use super::MAKER;
use crate::failure::Failure;

/// Camera, board and poses.
pub struct Modelled {
    /// The camera model.
    pub model: ModelChoice,
    /// The camera.
    pub camera: NamedCamera,
    /// All corners of the board, in its order.
    pub corners: Vec<BoardCorner>,
    /// The views that took part, and from where they were taken.
    pub stations: Vec<(String, Pose)>,
    /// What is in doubt of the board and of the calibration.
    pub doubts: Vec<String>,
}

impl Modelled {
    /// What the points of [`MAKER`] in `material` give with a camera model: first the board with its corners free, then camera and poses on this board.
    pub fn of(material: &Material, model: &ModelChoice) -> Result<Self, Failure> {
        let maker = material.operators.iter().position(|operator| *operator.method == *MAKER);
        let maker = maker.ok_or_else(|| Failure::input(format!("{MAKER} makes the twin: name it among the methods")))?;
        let views: Vec<usize> = material.usable(maker);
        let nominal = material.field.control();
        let board = StatedBoard { is_measured: true, ..StatedBoard::default() };
        let usual = Settings { gross: GrossErrors::Sought, ..model.settings(material.size, None) };
        let settings = Settings { shape: BoardShape::Free, datum: DatumChoice::Free, board, ..usual.clone() };
        let prepared = prepare(material.points(maker, &views), &nominal, &settings)?;
        let found = calibrate(&prepared, &[], |calibration| corners_of(calibration, &nominal))?;
        let (corners, mut doubts) = found.map_err(|why| Failure::input(format!("the board cannot be measured: {why}")))?;
        let control = with_corners(&nominal, &corners).map_err(|error| Failure::input(error.to_string()))?;
        let prepared = prepare(material.points(maker, &views), &control, &Settings { datum: DatumChoice::Fixed, ..usual })?;
        let (camera, stations, others) = calibrate(&prepared, &[], |calibration| {
            let images = calibration.prepared.survey.images.iter().cloned();
            let stations = images.zip(calibration.solution.poses().iter().copied()).collect();
            let doubts: Vec<String> = calibration.doubts().iter().map(|doubt| doubt.words.clone()).collect();
            (calibration.named_camera(0), stations, doubts)
        })?;
        doubts.extend(others);
        Ok(Self { model: model.clone(), camera: camera.map_err(Failure::Input)?, corners, stations, doubts })
    }

    /// The board before the camera.
    pub fn geometry(&self, board: &Chessboard) -> Geometry {
        let at: HashMap<&str, [f64; 3]> = self.corners.iter().map(|corner| (corner.target.as_str(), corner.position)).collect();
        let names = (1..=board.rows).flat_map(|row| (1..=board.columns).map(move |column| format!("r{row}c{column}")));
        Geometry::new(self.camera.camera, [board.rows, board.columns], names.filter_map(|name| at.get(name.as_str()).copied()))
    }
}

/// The corners as they were adjusted, and what is in doubt of them; or why there are none.
fn corners_of(calibration: &Calibration<'_>, nominal: &[ControlRow]) -> Result<(Vec<BoardCorner>, Vec<String>), String> {
    match &calibration.measured_board {
        Some(Ok(board)) => Ok((board.all(nominal, &calibration.prepared.settings.board), board.doubts())),
        Some(Err(why)) => Err(why.clone()),
        None => Err("its corners were not asked for".into()),
    }
}
