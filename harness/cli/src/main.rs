//! calibench without OpenCV: quick to build; what needs OpenCV is listed as unavailable.

use std::process::ExitCode;

use calibench_cli::{Toolbox, main as run};
use calibench_measure::Registry;
use calibench_measure::registry::Build;
use calibench_measure::{opencv_chessboard_sb, opencv_subpix};

const WHY: &str = "this build is without OpenCV";

fn main() -> ExitCode {
    let absent = [opencv_subpix::method, opencv_chessboard_sb::method].map(|method| method(Build::Unavailable(WHY), "none".into()));
    run(&Toolbox { registry: absent.into_iter().fold(Registry::builtin(), Registry::with), detector: None, bind_threads: |_| () })
}
