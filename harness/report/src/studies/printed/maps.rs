//! Maps of printed cameras over the frame: their distortion, and what their direct conversion costs.

use calibench_model::camera::Camera;
use calibench_model::convert::{ConvertError, Difference, DifferenceOptions, Region, difference};
use calibench_records::description::{Printed, PrintedCamera};

use crate::field::Field;
use crate::markdown::plain;

/// The distortion of every camera that has any: from where the same camera without distortion has a ray to where it has it.
pub(super) fn distortions(printed: &Printed) -> Vec<(String, Result<Field, ConvertError>)> {
    let of = |camera: &PrintedCamera| {
        let (ideal, seen): (Camera, Camera) = (printed.undistorted(camera).into(), printed.camera(camera).into());
        let found = difference(&ideal, &seen, &DifferenceOptions { rotation: false, ..DifferenceOptions::default() });
        let title = |found: &Difference| format!("{}: at most {} px", camera.name, plain(found.spread.max_px));
        (camera.name.clone(), found.map(|found| field(printed, &title(&found), &found)))
    };
    printed.cameras.iter().filter(|camera| camera.is_distorted()).map(of).collect()
}

/// What the direct conversion of every tool's camera costs: from where the tool's own camera has a ray to where the printed one has it, after the best
/// rotation, where the tool's own is one to one.
pub(super) fn conversions(printed: &Printed) -> Vec<(String, Result<Field, ConvertError>)> {
    let of = |camera: &PrintedCamera| {
        let own = printed.own(camera)?;
        let compared = own.and_then(|own| {
            let options = DifferenceOptions { region: Region::inside_fold(&own), ..DifferenceOptions::default() };
            difference(&own, &printed.camera(camera).into(), &options)
        });
        let title = |found: &Difference| {
            format!("{}: {} px rms, at most {} px", camera.name, plain(found.spread.rms_px), plain(found.spread.max_px))
        };
        Some((camera.name.clone(), compared.map(|found| field(printed, &title(&found), &found))))
    };
    printed.cameras.iter().filter_map(of).collect()
}

fn field(printed: &Printed, title: &str, found: &Difference) -> Field {
    let [width, height] = printed.size;
    Field::of(title, (width, height), found.vectors.iter().map(|v| (v.at, (v.dx, v.dy))))
}
