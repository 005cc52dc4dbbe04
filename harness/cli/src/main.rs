//! calibench without OpenCV: quick to build; what needs OpenCV is listed as unavailable.

use std::process::ExitCode;

use calibench_cli::{Toolbox, main as run};
use calibench_measure::Registry;
use calibench_measure::opencv_subpix;
use calibench_measure::registry::Build;

const WHY: &str = "this build is without OpenCV";

fn main() -> ExitCode {
    let absent = opencv_subpix::method(Build::Unavailable(WHY), "none".into());
    run(&Toolbox { registry: Registry::builtin().with(absent), detector: None })
}
