//! Agisoft's `<calibration>` element, which all its camera files share.

use calibench_model::camera::{Agisoft, AgisoftFisheye, AgisoftVersion, Camera, FisheyeProjection, ImageSize};
use roxmltree::Node;

use super::number::{scientific, shortened};
use super::{CameraFileError, ReadOptions, xml};

/// Coefficients of every version.
const COEFFICIENTS: [&str; 8] = ["k1", "k2", "k3", "k4", "p1", "p2", "p3", "p4"];
/// Elements that do not change the geometry, or that are read elsewhere.
const KNOWN: [&str; 13] = ["projection", "width", "height", "resolution", "date", "f", "fx", "fy", "cx", "cy", "skew", "b1", "b2"];

/// The projection that a sensor or a calibration states; `None` for a frame camera.
pub(super) type Projection = Option<FisheyeProjection>;

/// Names of projections, as files have them; the first of each is written.
const PROJECTIONS: [(&str, Projection); 4] = [
    ("frame", None),
    ("equidistant_fisheye", Some(FisheyeProjection::Equidistant)),
    ("fisheye", Some(FisheyeProjection::Equidistant)),
    ("equisolid_fisheye", Some(FisheyeProjection::Equisolid)),
];

/// The projection called `name`; others are refused.
pub(super) fn projection(at: Node<'_, '_>, name: &str) -> Result<Projection, CameraFileError> {
    let known = PROJECTIONS.map(|(name, _)| name).join(", ");
    let wrong =
        || xml::at(at, CameraFileError::new(format!("projection `{}` is not known here; expected one of {known}", shortened(name))));
    PROJECTIONS.iter().find(|(known, _)| *known == name).map(|(_, projection)| *projection).ok_or_else(wrong)
}

/// The name of a camera's projection; Metashape's older versions read it too.
pub(super) fn projection_name(camera: &Camera) -> &'static str {
    match camera {
        Camera::AgisoftFisheye(AgisoftFisheye { projection: FisheyeProjection::Equidistant, .. }) => "fisheye",
        Camera::AgisoftFisheye(AgisoftFisheye { projection: FisheyeProjection::Equisolid, .. }) => "equisolid_fisheye",
        _ => "frame",
    }
}

/// The camera of a `<calibration>`, and notes on what was left out. With `f` it is Metashape's, with `fx` and `fy` an older one. `stated` is what was said around it.
pub(super) fn read(
    node: Node<'_, '_>,
    size: ImageSize,
    stated: Option<Projection>,
    options: &ReadOptions,
) -> Result<(Camera, Vec<String>), CameraFileError> {
    let inside = match xml::child(node, "projection")? {
        Some(own) => Some((own, projection(own, xml::text(own)?)?)),
        None => None,
    };
    if let (Some((at, inside)), Some(stated)) = (inside, stated)
        && inside != stated
    {
        return Err(xml::at(at, CameraFileError::new("contradicts the type of the sensor")));
    }
    let fisheye = inside.map(|(_, projection)| projection).or(stated).flatten();
    let (camera, notes) = frame(node, size, options)?;
    let Some(projection) = fisheye else { return Ok((camera.into(), notes)) };
    let Agisoft { version, f, cx, cy, b1, b2, k, p, .. } = camera;
    if version != AgisoftVersion::Metashape {
        return Err(xml::at(node, CameraFileError::new("is a fisheye with `fx`; expected `f`")));
    }
    for name in ["p3", "p4"] {
        if let Some(at) = xml::child(node, name)?.filter(|_| p[2..] != [0.0; 2]) {
            return Err(xml::at(at, CameraFileError::new("is no parameter of a fisheye in the tool's manual; expected zero or none")));
        }
    }
    Ok((AgisoftFisheye { size, projection, f, cx, cy, b1, b2, k, p: [p[0], p[1]] }.into(), notes))
}

/// The parameters as those of a frame camera, which a fisheye has alike.
fn frame(node: Node<'_, '_>, size: ImageSize, options: &ReadOptions) -> Result<(Agisoft, Vec<String>), CameraFileError> {
    let elements = xml::elements(node).map(|child| (child.tag_name().name(), child));
    let notes = options.of_lens(elements, &[&KNOWN[..], &COEFFICIENTS].concat(), xml::at)?;
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

/// A fisheye's elements are those of a frame camera.
fn as_frame(camera: &Camera) -> Option<Agisoft> {
    match *camera {
        Camera::Agisoft(camera) => Some(camera),
        Camera::AgisoftFisheye(AgisoftFisheye { size, f, cx, cy, b1, b2, k, p: [p1, p2], .. }) => {
            Some(Agisoft { size, version: AgisoftVersion::Metashape, f, cx, cy, b1, b2, k, p: [p1, p2, 0.0, 0.0] })
        }
        _ => None,
    }
}

/// The elements inside a `<calibration>` that follow its size, each on a line after `indent`; `None` for a camera that is not Agisoft's. Terms that are zero are left
/// out, as Agisoft does.
pub(super) fn written(camera: &Camera, indent: &str) -> Option<String> {
    let camera = as_frame(camera)?;
    let Agisoft { f, cx, cy, b1, b2, k, p, .. } = camera;
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
    Some(out)
}
