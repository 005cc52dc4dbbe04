//! calibench without OpenCV: quick to build; what needs OpenCV is listed as unavailable.

use std::process::ExitCode;

use calibench_cli::{Toolbox, main as run};
use calibench_measure::Registry;
use calibench_measure::registry::Build;
use calibench_measure::{opencv_boards, opencv_chessboard_sb, opencv_subpix};

const WHY: &str = "this build is without OpenCV";

fn main() -> ExitCode {
    let others = [opencv_subpix::method, opencv_chessboard_sb::method].into_iter().chain(opencv_boards::ALL);
    let absent = others.map(|method| method(Build::Unavailable(WHY), "none".into()));
    run(&Toolbox { registry: absent.into_iter().fold(Registry::builtin(), Registry::with), ..Toolbox::default() })
}
