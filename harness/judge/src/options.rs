//! How to judge.

use calibench_calibrate::choice::ModelChoice;
use calibench_model::TargetKind;
use calibench_model::camera::Camera;

/// The methods that measure a chessboard's corners unless others are asked for.
pub const METHODS: [&str; 9] = [
    "pixel",
    "forstner:window=11",
    "forstner:window=11,iterations=20",
    "saddle:window=7",
    "harris_paraboloid:window=11",
    "opencv_subpix:window=11",
    "parametric_corner:window=15",
    "lsm:window=15,shape=chess_corner",
    "chess_corners",
];

/// What measures when a calibration in use is checked.
pub const OF_CAMERA: &str = "parametric_corner:window=15";

/// The camera models that are compared unless others are asked for: from too poor to too rich, on a flat board and on one that may be bent.
pub const MODELS: [&str; 14] = [
    "opencv4:fx,fy,cx,cy",
    "opencv4:fx,fy,cx,cy,k1",
    "opencv4:fx,fy,cx,cy,k1,k2",
    "opencv5:fx,fy,cx,cy,k1,k2,k3",
    "opencv4",
    "opencv5",
    "opencv8",
    "opencv-fisheye",
    "photogrammetric",
    "photogrammetric+bent",
    "opencv4+bent",
    "opencv5+bent",
    "opencv8+bent",
    "opencv-fisheye+bent",
];

/// What is compared on discs.
pub const OF_DISCS: [&str; 4] = ["centroid", "parametric_circle", "ellipse_edges", "lsm:window=15"];

/// What is compared on corners of one area, as those of markers that stand alone: the corner of two areas is another model.
pub const OF_CORNERS: [&str; 6] = [
    "pixel",
    "forstner:window=11",
    "forstner:window=11,iterations=20",
    "opencv_subpix:window=11",
    "parametric_junction:window=15,arms=2",
    "lsm:window=15",
];

/// The names of [`METHODS`], of discs and of corners of one area those that measure these; or what measures best alone when a calibration in use is checked.
pub fn usual_methods(kind: TargetKind, of_camera: bool) -> Vec<String> {
    let (alone, all): (&str, &[&str]) = match kind {
        TargetKind::Disc => ("ellipse_edges", &OF_DISCS),
        TargetKind::Corner => ("parametric_junction:window=15,arms=2", &OF_CORNERS),
        _ => (OF_CAMERA, &METHODS),
    };
    if of_camera { vec![alone.to_owned()] } else { all.iter().map(|name| (*name).to_owned()).collect() }
}

/// The names of [`MODELS`], or of those without a board that may be bent where there is no board.
pub fn usual_models(of_board: bool) -> Vec<String> {
    MODELS.iter().filter(|text| of_board || !text.ends_with(BENT)).map(|text| (*text).to_owned()).collect()
}

/// How the name of a model ends that is of a board which may be bent.
pub const BENT: &str = "+bent";

/// How to judge.
#[derive(Clone, Debug)]
pub struct Options {
    /// The camera models.
    pub models: Vec<ModelChoice>,
    /// Pixel pitch, um, for models in mm; [`NOMINAL_PITCH`](calibench_calibrate::choice::NOMINAL_PITCH) if not known.
    pub pitch_um: Option<f64>,
    /// How often the photographs are split into halves.
    pub splits: u64,
    /// The seed of the splits.
    pub seed: u64,
    /// For what the splits are drawn: other names draw others under one seed.
    pub name: String,
    /// A calibration that somebody published of these photographs.
    pub published: Option<Camera>,
    /// The standard deviation (2D) that its file states of it, RMS over the frame, px.
    pub published_sigma: Option<f64>,
}
