//! Sensors that cannot be.

use super::*;
use crate::sensor::{ColourFilter, Demosaic, DemosaicTo, FallOff, Gamma, Gradient, Pattern, Per, SensorError, Vignetting};

fn message(design: Design) -> String {
    Sensor::new(design).err().map(|error: SensorError| error.to_string()).unwrap_or_default()
}

#[test]
fn each_mistake_is_named() {
    let bare = Design::default;
    let of_well = || Electrons::of_well(1e4);
    let demosaic = Some(Demosaic { to: DemosaicTo::Grey, white_balance: None });
    let filter = |s| Some(ColourFilter { pattern: Pattern::Rggb, sensitivity: [1.0, s, 1.0] });
    let vignetting = |fall_off| Some(Vignetting { centre: None, fall_off });
    for (design, named) in [
        (Design { exposure: f64::NAN, ..bare() }, "the exposure is NaN"),
        (Design { exposure: 0.0, ..bare() }, "the exposure"),
        (Design { vignetting: vignetting(FallOff::Cos4 { c: 0.0 }), ..bare() }, "principal distance"),
        (Design { vignetting: vignetting(FallOff::Polynomial([0.0, f64::INFINITY, 0.0])), ..bare() }, "vignetting"),
        (Design { gradient: Some(Gradient { x: 3.0, y: 0.0, per: Per::Frame }), ..bare() }, "gradient"),
        (Design { filter: filter(0.0), ..bare() }, "sensitivity"),
        (Design { demosaic, ..bare() }, "without a colour filter"),
        (Design { noise: Noise::White { sigma: -0.1, prnu: 0.0 }, ..bare() }, "the noise is -0.1"),
        (Design { converter: Some(9), ..bare() }, "9 bits"),
        (Design { output: Some(14), ..bare() }, "8, 12 or 16"),
        (Design { gamma: Some(Gamma::Power(0.0)), ..bare() }, "gamma"),
        (Design { jpeg: Some(0), ..bare() }, "quality"),
        (Design { jpeg: Some(90), output: Some(12), ..bare() }, "the output is to have 12"),
        (electrons(Electrons { full_well: 0.0, ..of_well() }), "full well"),
        (electrons(Electrons { read: f64::NAN, ..of_well() }), "read noise"),
        (electrons(Electrons { gain: Some(1.0), ..of_well() }), "without the bits"),
        (electrons(Electrons { black_level: 1.0, ..of_well() }), "without the bits"),
    ] {
        let message = message(design);
        assert!(message.contains(named), "{named}: {message}");
    }
}
