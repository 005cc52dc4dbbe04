//! A program of one's own: all methods of calibench and one more, with the same command line. In a package elsewhere it needs `calibench-cli`,
//! `calibench-measure` and `calibench-model`.

use std::process::ExitCode;

use calibench_cli::Toolbox;
use calibench_measure::parameter::Parameter;
use calibench_measure::registry::{Build, Method, Registry};
use calibench_measure::{Operator, Settings};
use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start};

/// The middle of the start's pixel, moved by `shift` px in x: an operator that learns nothing from the image.
struct Shifted {
    shift: f64,
}

const PARAMETERS: &[Parameter] = &[Parameter::real("shift", "what is added to x, px", [-1.0, 1.0], 0.0)];

/// Raise `version` whenever results change: the gate names a new version.
fn shifted() -> Method {
    Method {
        name: "shifted",
        about: "the middle of the start's pixel, moved in x",
        source: "an example",
        version: "1".into(),
        parameters: PARAMETERS,
        build: Build::With(|settings: &Settings| Box::new(Shifted { shift: settings.get("shift") })),
    }
}

impl Operator for Shifted {
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        let [x, y] = [start.position.x.round(), start.position.y.round()];
        let inside = |at: f64, size: usize| at >= 0.0 && at < size as f64;
        if !inside(x, image.width()) || !inside(y, image.height()) {
            return Err(Rejection::Border);
        }
        Ok(Measurement { position: PixelPoint::new(x + self.shift, y), covariance: None })
    }
}

fn main() -> ExitCode {
    calibench_cli::main(&Toolbox { registry: Registry::builtin().with(shifted()), ..Toolbox::default() })
}
