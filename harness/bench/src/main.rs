//! calibench without OpenCV: quick to build; what needs OpenCV is listed as unavailable.

use std::process::ExitCode;

use calibench_bench::cli::{Toolbox, main as run};
use calibench_measure::Registry;
use calibench_measure::registry::{Build, Method};

const WHY: &str = "this build is without OpenCV";

fn main() -> ExitCode {
    // Its parameters are known only to the full build: scenarios that set them need that.
    let absent = Method {
        name: "opencv_subpix",
        about: "OpenCV's cornerSubPix",
        source: "OpenCV",
        version: "none".into(),
        parameters: calibench_measure::forstner::PARAMETERS,
        build: Build::Unavailable(WHY),
    };
    run(&Toolbox { registry: Registry::builtin().with(absent), detector: None })
}
