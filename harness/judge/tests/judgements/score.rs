//! What comes of a drawn set.

use calibench_calibrate::choice::ModelChoice;
use calibench_judge::{MODELS, Options, judge};
use calibench_records::judgement::{StillHolds, Summary};

use super::draw::{Class, Drawn, Fault, Lens};

/// The model of the truth.
pub fn truth(class: Class) -> &'static str {
    match (class.lens, class.fault) {
        (Lens::Decentred, Fault::Bent) => "opencv4+bent",
        (_, Fault::Bent) => "opencv5+bent",
        (Lens::Radial(1), _) => "opencv4:fx,fy,cx,cy,k1",
        (Lens::Radial(2), _) => "opencv4:fx,fy,cx,cy,k1,k2",
        (Lens::Radial(_), _) => "opencv5:fx,fy,cx,cy,k1,k2,k3",
        (Lens::Decentred, _) => "opencv4",
        (Lens::Rational, _) => "opencv8",
        (Lens::Fisheye, _) => "opencv-fisheye",
    }
}

/// The verdict beside the truth. Errors are RMS over the frame after the best rotation, px.
#[derive(Clone, Debug, PartialEq)]
pub struct End {
    /// The model that is trusted.
    pub model: String,
    /// The error of its camera.
    pub error: f64,
    /// The stated limit; `None` where the verdict is in doubt.
    pub limit: Option<f64>,
    /// In how many modes the camera is uncertain.
    pub modes: f64,
    /// Whether the true camera is said to have moved if it may not differ at all.
    pub moved: bool,
    /// Whether it is said to hold within 1 px.
    pub holds: bool,
    /// The least error of any model.
    pub least: f64,
    /// That of the true model; `None` where it was not calibrated.
    pub of_truth: Option<f64>,
}

/// Judges a set; `None` if nothing could be judged.
pub fn ended(class: Class, drawn: &Drawn, seed: u64) -> Option<End> {
    let models = MODELS.iter().filter_map(|model| ModelChoice::parse(model).ok()).collect();
    let published = Some(drawn.camera);
    let options = Options { models, pitch_um: None, splits: 6, seed, name: "judgements".into(), published, published_sigma: None };
    let rows = judge(&drawn.material, &options).ok()?;
    let summary = Summary::new(&rows, seed);
    let trusted = summary.trusted()?;
    let errors = || summary.cells.iter().filter_map(|cell| Some((&*cell.model, cell.published?.beside.frame)));
    Some(End {
        model: trusted.cell.model.to_string(),
        error: trusted.cell.published?.beside.frame,
        limit: trusted.limit.filter(|_| trusted.doubt().is_none()),
        moved: trusted.in_use(0.0).is_some_and(|found| found.verdict == StillHolds::Moved),
        holds: trusted.in_use(1.0).is_some_and(|found| found.verdict == StillHolds::Holds),
        modes: trusted.cell.predicted.map_or(f64::NAN, |predicted| predicted.modes),
        least: errors().map(|(_, error)| error).fold(f64::INFINITY, f64::min),
        of_truth: errors().find(|(model, _)| *model == truth(class)).map(|(_, error)| error),
    })
}
