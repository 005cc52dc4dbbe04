//! A small campaign in rendered images of the wall and the board of `canon-t3`.

use calibench_adjust::approximate::Control;
use calibench_calibrate::{BoardSolution, BoardSolver};
use calibench_measure::{Board, BoardDetector};
use calibench_model::camera::ImageSize;
use calibench_model::{Image, PixelPoint};

use super::*;
use crate::Tools;

/// Beside those of most tests, by its place.
const SOLVER: usize = 3;

/// The study with fewer views and with images.
fn measured() -> Scenario {
    let solver = r#"
[[transfer.method]]
name = "solver"
from = "board"
model = "opencv"
measured_by = "parametric_corner"
detected = true
solver = "opencv"
sigma_px = 0.01
"#;
    let methods = METHODS.replace("sigma_px = 0.03", "measured_by = \"parametric_corner\"\nsigma_px = 0.01") + solver;
    let case = "[[transfer.case]]\nname = \"plain\"\nposes = \"resected\"\nsurvey = false\n";
    let text = text(&methods, case).replace("sigma_px = 0.5", "sigma_px = 0.01\nmeasured_by = \"parametric_corner\"");
    read(&text.replace("views = 6", "views = 4").replace("trials = 2", "trials = 1"))
}

/// Finds nothing.
struct Blind;

impl BoardDetector for Blind {
    fn name(&self) -> &'static str {
        "blind"
    }

    fn version(&self) -> String {
        "1".into()
    }

    fn detect(&self, image: &Image, board: Board) -> Option<Vec<PixelPoint>> {
        assert_eq!((image.width(), board.columns, board.rows), (4272, 9, 6));
        None
    }
}

/// Tells how many views it was given.
struct Counter;

impl BoardSolver for Counter {
    fn name(&self) -> &'static str {
        "counter"
    }

    fn version(&self) -> String {
        "2".into()
    }

    fn solve(&self, _: ImageSize, views: &[Vec<Control>]) -> Result<BoardSolution, String> {
        Err(format!("{} views", views.len()))
    }
}

/// Operators measure to hundredths of a pixel, and cameras and check points are as good as that makes them; what no detector finds nobody measures.
#[test]
fn rendered_images_are_measured_and_calibrated() {
    let scenario = measured();
    let tools = Tools { detector: Some(&Blind), solver: Some(&Counter), calibrators: &[] };
    let mut trials = Vec::new();
    let plan = Plan::new(&scenario, tools, "".into());
    plan.run(&|| (), &mut |trial| {
        trials.push(trial);
        Ok(())
    })
    .unwrap();
    let found = &trials[0].calibrations;
    for method in [CONTROL, BOARD] {
        let of = (method, 0);
        assert_eq!(figure(found, of, Group::Network, "missed").value, 0.0);
        let sigma0 = figure(found, of, Group::Network, "sigma0").value;
        assert!((0.5..1.6).contains(&sigma0), "{method}: {sigma0}");
        let c = figure(found, of, Group::Iop, "c");
        assert!(c.error.unwrap() != 0.0 && c.error.unwrap().abs() < 4.0 * c.sigma.unwrap(), "{method}: {c:?}");
        let millimetres = 1e3 * value(found, of, "rmse_xyz");
        assert!(millimetres > 0.01 && millimetres < 3.0, "{method}: {millimetres} mm");
    }
    let why = found.iter().find(|one| one.method == SOLVER).unwrap().outcome.as_ref().unwrap_err();
    assert_eq!(why, "0 views");
    let versions: Vec<String> = plan.method_infos().iter().map(|info| info.version.to_string()).collect();
    assert!(versions[CONTROL] == "1" && versions[SOLVER].ends_with(", counter 2"), "{versions:?}");
    let without = Plan::new(&scenario, Tools::default(), "".into()).method_infos();
    assert_eq!(without[SOLVER].unavailable.as_deref(), Some("this build is without OpenCV"));
    assert!(without[BOARD].unavailable.is_none());
    let undetected = Plan::new(&scenario, Tools { detector: None, ..tools }, "".into()).method_infos();
    assert_eq!(undetected[SOLVER].unavailable.as_deref(), Some("this build has no detector of OpenCV's for chessboards"));
}
