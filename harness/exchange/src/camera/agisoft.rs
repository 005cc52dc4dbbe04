//! Agisoft's `<calibration>` element, which all its camera files share.

use calibench_model::camera::{Agisoft, AgisoftVersion, ImageSize};
use roxmltree::Node;

use super::number::{finite, scientific, shortened};
use super::{CameraFileError, xml};

/// Coefficients of every version.
const COEFFICIENTS: [&str; 8] = ["k1", "k2", "k3", "k4", "p1", "p2", "p3", "p4"];
/// Elements that do not change the geometry, or that are read elsewhere.
const KNOWN: [&str; 13] = ["projection", "width", "height", "resolution", "date", "f", "fx", "fy", "cx", "cy", "skew", "b1", "b2"];

/// The camera of a `<calibration>`, and notes on what was left out. With `f` it is Metashape's, with `fx` and `fy` an older one.
pub(super) fn read(node: Node<'_, '_>, size: ImageSize) -> Result<(Agisoft, Vec<String>), CameraFileError> {
    frame_only(node)?;
    let notes = unknown(node)?;
    let old = xml::child(node, "fx")?.is_some();
    if let (true, Some(f)) = (old, xml::child(node, "f")?) {
        return Err(xml::at(f, CameraFileError::new("stands beside `fx`; expected `f` alone, or `fx` and `fy`")));
    }
    let or_zero = |name| Ok::<_, CameraFileError>(xml::number(node, name)?.unwrap_or(0.0));
    let mut coefficients = [0.0; 8];
    for (slot, name) in coefficients.iter_mut().zip(COEFFICIENTS) {
        *slot = or_zero(name)?;
    }
    let [k1, k2, k3, k4, p1, p2, p3, p4] = coefficients;
    let (k, p) = ([k1, k2, k3, k4], [p1, p2, p3, p4]);
    if !old {
        refuse(node, &["fy", "skew"], "belongs to files with `fx`, this one has `f`")?;
        let f = positive(node, "f")?;
        let version = AgisoftVersion::Metashape;
        return Ok((
            Agisoft { size, version, f, cx: or_zero("cx")?, cy: or_zero("cy")?, b1: or_zero("b1")?, b2: or_zero("b2")?, k, p },
            notes,
        ));
    }
    refuse(node, &["b1", "b2", "p3", "p4", "k4"], "belongs to files with `f`, this one has `fx`")?;
    let (fx, f) = (positive(node, "fx")?, positive(node, "fy")?);
    let (cx, cy) = (xml::required_number(node, "cx")?, xml::required_number(node, "cy")?);
    Ok((Agisoft { size, version: AgisoftVersion::PhotoScan, f, cx, cy, b1: fx - f, b2: or_zero("skew")?, k, p }, notes))
}

/// Other projections are refused by name.
fn frame_only(node: Node<'_, '_>) -> Result<(), CameraFileError> {
    let Some(projection) = xml::child(node, "projection")? else { return Ok(()) };
    projection_is_frame(projection, xml::text(projection)?)
}

/// Refuses another projection than `frame`.
pub(super) fn projection_is_frame(at: Node<'_, '_>, found: &str) -> Result<(), CameraFileError> {
    if found == "frame" {
        return Ok(());
    }
    Err(xml::at(at, CameraFileError::new(format!("projection `{}` is not known here; expected `frame`", shortened(found)))))
}

/// An unknown number that is not zero changes the camera; other unknown elements are noted.
fn unknown(node: Node<'_, '_>) -> Result<Vec<String>, CameraFileError> {
    let mut notes = Vec::new();
    for child in xml::elements(node) {
        let name = child.tag_name().name();
        if KNOWN.contains(&name) || COEFFICIENTS.contains(&name) {
            continue;
        }
        match child.text().map(finite) {
            Some(Ok(value)) if value != 0.0 => {
                return Err(xml::at(
                    child,
                    CameraFileError::new(format!("is {value}; no such parameter is known, and without it the camera is another")),
                ));
            }
            _ => notes.push(format!("element `{}` is not known and was left out", shortened(name))),
        }
    }
    Ok(notes)
}

fn refuse(node: Node<'_, '_>, names: &[&str], why: &str) -> Result<(), CameraFileError> {
    for name in names {
        if let Some(child) = xml::child(node, name)? {
            return Err(xml::at(child, CameraFileError::new(why)));
        }
    }
    Ok(())
}

fn positive(node: Node<'_, '_>, name: &str) -> Result<f64, CameraFileError> {
    let value = xml::required_number(node, name)?;
    if value > 0.0 {
        return Ok(value);
    }
    Err(xml::at(xml::required(node, name)?, CameraFileError::new(format!("expected a focal length above zero, found {value}"))))
}

/// The elements inside a `<calibration>` that follow its size, each on a line after `indent`. Terms that are zero are left out, as Agisoft does.
pub(super) fn written(camera: &Agisoft, indent: &str) -> String {
    let Agisoft { f, cx, cy, b1, b2, k, p, .. } = *camera;
    let mut out = String::new();
    let mut line = |name: &str, value: f64| out.push_str(&format!("{indent}<{name}>{}</{name}>\n", scientific(value)));
    if camera.version == AgisoftVersion::Metashape {
        line("f", f);
        line("cx", cx);
        line("cy", cy);
        [("b1", b1), ("b2", b2)].into_iter().filter(|(_, value)| *value != 0.0).for_each(|(name, value)| line(name, value));
    } else {
        line("fx", f + b1);
        line("fy", f);
        line("cx", cx);
        line("cy", cy);
        line("skew", b2);
    }
    let coefficients = COEFFICIENTS.into_iter().zip(k.into_iter().chain(p));
    coefficients.filter(|(_, value)| *value != 0.0).for_each(|(name, value)| line(name, value));
    out
}
