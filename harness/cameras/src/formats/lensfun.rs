//! lensfun's data base of lenses: distortion by ptlens, poly3, poly5 and Adobe's model for each focal length of a lens, whose images have any size.

use calibench_model::camera::{AgisoftVersion, Camera, CameraModel, ImageSize, LensProjection, OpenCvFisheye, PtLens, pt_lens};
use calibench_model::convert::Target;
use calibench_model::{NamedCamera, PixelPoint};
use roxmltree::Node;

use super::PLAIN;
use crate::brown::{Brown, positive};
use crate::format::{Keeps, Model};
use crate::number::{finite, shortened, shortest};
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions, xml};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "lensfun",
    tool: "lensfun",
    versions: "data base versions 1 and 2, lensfun 0.3",
    extension: "xml",
    words: "lensdatabase lens maker model mount cropfactor calibration distortion focal ptlens poly3 poly5 acm tca vignetting camera",
    verified: Some(
        "lensfun 0.3.4 (lensfunpy 1.18.0) loads what is written and pictures alike to 1e-3 px, its single precision, asked pixel by pixel; so do lenses of its data base. acm, which 0.3.4 refuses, is only read, and unverified",
    ),
    many: true,
    states_size: false,
    recognise: |source| xml::root_is(source.xml.as_ref(), "lensdatabase"),
    read,
    write: Some(write),
    convention: Some(&pt_lens::CONVENTION),
    models: |_| {
        let frame = |radial| Target::Agisoft { version: AgisoftVersion::Metashape, radial, tangential: 0, affinity: false };
        let of = |(_, name, projection)| Model { name, target: Target::PtLens { projection } };
        let mut models = vec![Model { name: "poly3", target: frame(1) }, Model { name: "poly5", target: frame(2) }];
        models.extend(TYPES.map(of));
        models
    },
    keeps: Keeps { name: true, pitch: true, ..PLAIN.keeps },
    ..PLAIN
};

/// Types of lenses in its files, as models here, and how they picture angles.
const TYPES: [(&str, &str, LensProjection); 6] = [
    ("rectilinear", "ptlens", LensProjection::Rectilinear),
    ("fisheye", "ptlens-fisheye", LensProjection::Equidistant),
    ("equisolid", "ptlens-equisolid", LensProjection::Equisolid),
    ("stereographic", "ptlens-stereographic", LensProjection::Stereographic),
    ("orthographic", "ptlens-orthographic", LensProjection::Orthographic),
    ("fisheye_thoby", "ptlens-thoby", LensProjection::Thoby),
];

/// Diagonal of the frame to which crop factors refer, mm: 36 x 24.
const DIAGONAL: f64 = 43.266_615_305_567_87;
/// The sides' ratio of a lens that does not say it.
const ASPECT: f64 = 1.5;

/// How lensfun normalises images of a size: it counts between the centres of the outer pixels.
struct Scale {
    size: ImageSize,
    /// Its unit, half of the shorter side of the images that were calibrated, px.
    unit: f64,
    pitch_um: f64,
}

impl Scale {
    /// For the crop factor and the sides' ratio of the calibration.
    fn new(size: ImageSize, crop: f64, aspect: f64) -> Self {
        let diagonal = f64::from(size.width - 1).hypot(f64::from(size.height - 1)).max(1.0);
        Self { size, unit: 0.5 * diagonal / aspect.hypot(1.0), pitch_um: 1e3 * DIAGONAL / crop / diagonal }
    }

    /// The middle between the outer pixels, moved by so many halves of the shorter side.
    fn centre(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (width, height) = (f64::from(self.size.width - 1), f64::from(self.size.height - 1));
        let half = 0.5 * width.min(height);
        [0.5 * width + x * half, 0.5 * height + y * half]
    }
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let Some(document) = &source.xml else { return Ok(Vec::new()) };
    let size = options.size_or(None)?;
    let (mut cameras, mut left_out) = (Vec::new(), Vec::new());
    for lens in xml::elements(document.root_element()).filter(|node| node.has_tag_name("lens")) {
        match lens_cameras(lens, size, options)? {
            Ok(found) => cameras.extend(found),
            Err(why) => left_out.push(why),
        }
    }
    if let (true, Some(why)) = (cameras.is_empty(), left_out.first()) {
        return Err(CameraFileError::new(format!("holds no lens that is read: {why}")));
    }
    let (count, first) = (left_out.len(), left_out.first());
    let note = first
        .map(|first| if count == 1 { format!("left out: {first}") } else { format!("left out: {first}, and {} more lenses", count - 1) });
    Ok(crate::noted(cameras, note.as_slice()))
}

/// The text of a child that may stand there in several languages: the one without a language.
fn plain<'a>(node: Node<'a, '_>, name: &str) -> &'a str {
    let mut all = xml::elements(node).filter(|child| child.has_tag_name(name)).peekable();
    let first = all.peek().copied();
    all.find(|child| child.attributes().len() == 0).or(first).and_then(|child| child.text()).unwrap_or("").trim()
}

/// The cameras of a lens, one for each focal length that was calibrated; or why it is none of those that are read here.
fn lens_cameras(lens: Node<'_, '_>, size: ImageSize, options: &ReadOptions) -> Result<Result<Vec<NamedCamera>, String>, CameraFileError> {
    let model = plain(lens, "model");
    let name = |problem: &str| format!("{} ({problem})", shortened(model));
    let kind = Some(plain(lens, "type")).filter(|kind| !kind.is_empty()).unwrap_or("rectilinear");
    let Some((_, _, projection)) = TYPES.into_iter().find(|(known, ..)| *known == kind) else { return Ok(Err(name(kind))) };
    let centre = match xml::child(lens, "center")? {
        Some(centre) => [number(centre, "x")?.unwrap_or(0.0), number(centre, "y")?.unwrap_or(0.0)],
        None => [0.0; 2],
    };
    let mut found = Vec::new();
    for calibration in xml::elements(lens).filter(|node| node.has_tag_name("calibration")) {
        let scale = scale(lens, calibration, size)?;
        for distortion in xml::elements(calibration).filter(|node| node.has_tag_name("distortion")) {
            let Some((camera, notes)) = camera(distortion, projection, &scale, centre, options)? else { continue };
            let focal = number(distortion, "focal")?.unwrap_or(0.0);
            found.push((focal, NamedCamera { pitch_um: Some(scale.pitch_um), notes, ..NamedCamera::new("", camera) }));
        }
    }
    let several = found.len() > 1;
    if found.is_empty() {
        return Ok(Err(name("no distortion")));
    }
    Ok(Ok(found
        .into_iter()
        .map(|(focal, named)| {
            let own = if several { format!("{model} at {focal} mm") } else { model.to_owned() };
            NamedCamera { name: own, ..named }
        })
        .collect()))
}

fn number(node: Node<'_, '_>, name: &str) -> Result<Option<f64>, CameraFileError> {
    node.attribute(name).map(|text| finite(text).map_err(|error| xml::at(node, error).of(name))).transpose()
}

/// Of the calibration, where version 2 says it, or of the lens.
fn scale(lens: Node<'_, '_>, calibration: Node<'_, '_>, size: ImageSize) -> Result<Scale, CameraFileError> {
    let own = number(calibration, "cropfactor")?;
    let crop = match own {
        Some(crop) => crop,
        None => xml::required_number(lens, "cropfactor")?,
    };
    positive("cropfactor", crop).map_err(|error| xml::at(lens, error).of("cropfactor"))?;
    let text = calibration.attribute("aspect-ratio").map_or_else(|| plain(lens, "aspect-ratio"), str::trim);
    let wrong = || xml::at(lens, CameraFileError::new(format!("expected 3:2 or 1.5, found `{}`", shortened(text)))).of("aspect-ratio");
    let aspect = match text.split_once(':') {
        _ if text.is_empty() => ASPECT,
        Some((long, short)) => finite(long).and_then(|long| Ok(long / finite(short)?)).map_err(|_| wrong())?,
        None => finite(text).map_err(|_| wrong())?,
    };
    if !(aspect.is_finite() && aspect > 0.0) {
        return Err(wrong());
    }
    Ok(Scale::new(size, crop, aspect))
}

/// The camera of a focal length, with what was left out; `None` where nothing is said of its distortion.
fn camera(
    node: Node<'_, '_>,
    projection: LensProjection,
    scale: &Scale,
    centre: [f64; 2],
    options: &ReadOptions,
) -> Result<Option<(Camera, Vec<String>)>, CameraFileError> {
    let at = |error: CameraFileError| xml::at(node, error);
    let v = |name: &str| Ok::<f64, CameraFileError>(number(node, name)?.unwrap_or(0.0));
    let size = scale.size;
    let model = xml::attribute(node, "model")?;
    let names: &[&str] = match model {
        "none" => return Ok(None),
        "ptlens" => &["a", "b", "c"],
        "poly3" => &["k1"],
        "poly5" => &["k1", "k2"],
        "acm" => &["k1", "k2", "k3", "k4", "k5"],
        other => {
            let problem = format!("`{}` is not known here; expected ptlens, poly3, poly5, acm or none", shortened(other));
            return Err(at(CameraFileError::new(problem)).of("model"));
        }
    };
    let attributes = node.attributes().map(|attribute| (attribute.name(), ()));
    let mut notes = options.of_lens(attributes, &[names, &["model", "focal", "real-focal"]].concat(), |(), error| {
        at(error.clone()).of(error.element.unwrap_or_default())
    })?;
    let mm = number(node, "focal")?.ok_or_else(|| at(CameraFileError::new("has no attribute `focal`")))?;
    let px = |mm: f64| positive("focal", mm).map(|mm| 1e3 * mm / scale.pitch_um).map_err(|error| at(error).of("focal"));
    let [a, b, c] = match model {
        "ptlens" => [v("a")?, v("b")?, v("c")?],
        "poly3" => [0.0, v("k1")?, 0.0],
        _ => [0.0; 3],
    };
    if a + b + c >= 1.0 {
        let problem = format!("a, b, c leave {} of the focal length on the axis; expected more than 0", 1.0 - a - b - c);
        return Err(at(CameraFileError::new(problem)));
    }
    // The focal length of the undistorted image; that on the axis, where the file says it, is shorter by what the polynomial is there.
    let focal = match real_focal(node, mm)? {
        Some(real) => px(real)? / (1.0 - a - b - c),
        None => px(mm)?,
    };
    let [cx, cy] = scale.centre(centre);
    let s = focal / scale.unit;
    let camera: Camera = match (model, projection) {
        ("poly5", LensProjection::Rectilinear) => {
            let k = [v("k1")? * s * s, v("k2")? * s.powi(4), 0.0, 0.0];
            Brown { k, ..Brown::plain(size, [focal, focal, cx, cy]) }.camera()
        }
        ("poly5", LensProjection::Equidistant) => {
            let k = [v("k1")? * s * s, v("k2")? * s.powi(4), 0.0, 0.0];
            OpenCvFisheye { size, fx: focal, fy: focal, cx, cy, skew: 0.0, k }.into()
        }
        ("acm", _) => {
            notes.push("unverified: acm: formulas after the source of lensfun 0.3.95; 0.3.4, which was asked, refuses it".into());
            // In units of the focal length; k4 stands beside y, k5 beside x.
            let ([k1, k2, k3], [p1, p2]) = ([v("k1")?, v("k2")?, v("k3")?], [v("k4")?, v("k5")?]);
            let plain = Brown { k: [k1, k2, k3, 0.0], p1, p2, ..Brown::plain(size, [focal, focal, cx, cy]) };
            match projection {
                LensProjection::Rectilinear => plain.camera(),
                LensProjection::Equidistant if !plain.has_tangential() => {
                    OpenCvFisheye { size, fx: focal, fy: focal, cx, cy, skew: 0.0, k: plain.k }.into()
                }
                _ => {
                    let problem = "acm on this type of lens is no model here; expected rectilinear, or fisheye without k4 and k5";
                    return Err(at(CameraFileError::new(problem)).of("model"));
                }
            }
        }
        ("poly5", _) => {
            let problem = "poly5 on this type of lens is no model here; expected rectilinear or fisheye, or ptlens";
            return Err(at(CameraFileError::new(problem)).of("model"));
        }
        _ => {
            let lens = PtLens::of_tool(size, projection, focal, [cx, cy], [a, b, c], scale.unit);
            match (model, projection) {
                // What has k1 alone is everybody's camera.
                ("poly3", LensProjection::Rectilinear) => {
                    Brown { k: [lens.b, 0.0, 0.0, 0.0], ..Brown::plain(size, [lens.f, lens.f, cx, cy]) }.camera()
                }
                _ => lens.into(),
            }
        }
    };
    Ok(Some((camera, notes)))
}

/// The focal length on the axis, mm, of one that is nominally `mm`: in an attribute, as versions after 0.3 have it, or in an element beside the distortion.
fn real_focal(node: Node<'_, '_>, mm: f64) -> Result<Option<f64>, CameraFileError> {
    if let Some(own) = number(node, "real-focal")? {
        return Ok(Some(own));
    }
    let siblings = node.parent_element().into_iter().flat_map(xml::elements);
    for sibling in siblings.filter(|sibling| sibling.has_tag_name("real-focal-length")) {
        if number(sibling, "focal")? == Some(mm) {
            return number(sibling, "real-focal");
        }
    }
    Ok(None)
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let mut out = String::from("<lensdatabase version=\"1\">\n    <mount><name>Generic</name></mount>\n");
    let size = cameras[0].camera.size();
    for (index, named) in cameras.iter().enumerate() {
        if named.camera.size() != size {
            return Err(CameraFileError::new("does not state sizes of images: all cameras of a file need the same"));
        }
        let name = if named.name.is_empty() { format!("camera {index}") } else { named.name.clone() };
        out.push_str(&lens(named, &name)?);
    }
    Ok(out + "</lensdatabase>\n")
}

/// A lens for a camera: with its own name as that of the camera too, since lensfun looks lenses up by camera.
fn lens(named: &NamedCamera, name: &str) -> Result<String, CameraFileError> {
    let size = named.camera.size();
    let ImageSize { width, height } = size;
    let aspect = f64::from(width.max(height)) / f64::from(width.min(height));
    // Without a pitch the frame is as large as that to which crop factors refer.
    let diagonal = f64::from(width - 1).hypot(f64::from(height - 1)).max(1.0);
    let crop = named.pitch_um.map_or(1.0, |pitch_um| 1e3 * DIAGONAL / pitch_um / diagonal);
    let scale = Scale::new(size, crop, aspect);
    let (kind, centre, focal, model, terms) = parts(&named.camera, scale.unit)
        .ok_or_else(|| FORMAT.other_model("lenses of ptlens, poly3 and poly5: one focal length, a distortion of the radius alone"))?;
    let [x, y] = scale.centre([0.0; 2]);
    let half = 0.5 * f64::from(width.min(height) - 1).max(1.0);
    let [x, y] = [(centre.x - x) / half, (centre.y - y) / half];
    let centre =
        if [x, y] == [0.0; 2] { String::new() } else { format!("        <center x=\"{}\" y=\"{}\"/>\n", shortest(x), shortest(y)) };
    let terms: String = terms.iter().map(|(name, value)| format!(" {name}=\"{}\"", shortest(*value))).collect();
    let (name, crop, mm) = (xml::escaped(name), shortest(crop), shortest(focal * scale.pitch_um * 1e-3));
    Ok(format!(
        "    <camera>\n        <maker>camera</maker>\n        <model>{name}</model>\n        <mount>Generic</mount>\n        <cropfactor>{crop}</cropfactor>\n    </camera>\n    \
         <lens>\n        <maker>lens</maker>\n        <model>{name}</model>\n        <mount>Generic</mount>\n        <cropfactor>{crop}</cropfactor>\n        \
         <aspect-ratio>{}</aspect-ratio>\n        <type>{kind}</type>\n{centre}        <calibration>\n            \
         <distortion model=\"{model}\" focal=\"{mm}\"{terms}/>\n        </calibration>\n    </lens>\n",
        shortest(aspect)
    ))
}

/// Type of the lens, principal point, focal length of the undistorted image, px, model and its terms.
type Parts = (&'static str, PixelPoint, f64, &'static str, Vec<(&'static str, f64)>);

fn parts(camera: &Camera, unit: f64) -> Option<Parts> {
    let poly5 = |kind, f: f64, centre, [k1, k2]: [f64; 2]| {
        let s = unit / f;
        Some((kind, centre, f, "poly5", vec![("k1", k1 * s * s), ("k2", k2 * s.powi(4))]))
    };
    match *camera {
        Camera::PtLens(lens) => of_pt_lens(&lens, unit),
        Camera::OpenCvFisheye(OpenCvFisheye { fx, fy, cx, cy, skew: 0.0, k: [k1, k2, 0.0, 0.0], .. }) if fx == fy => {
            poly5("fisheye", fx, PixelPoint::new(cx, cy), [k1, k2])
        }
        _ => {
            let brown = Brown::of(camera).filter(|b| b.skew == 0.0 && b.has_one_focal() && b.radial() <= 2 && !b.has_tangential())?;
            let Brown { size, fx: f, cx, cy, k, .. } = brown;
            if k[1] != 0.0 {
                return poly5("rectilinear", f, PixelPoint::new(cx, cy), [k[0], k[1]]);
            }
            of_pt_lens(&PtLens { size, projection: LensProjection::Rectilinear, f, cx, cy, a: 0.0, b: k[0], c: 0.0 }, unit)
        }
    }
}

fn of_pt_lens(lens: &PtLens, unit: f64) -> Option<Parts> {
    let (kind, ..) = TYPES.into_iter().find(|(.., projection)| *projection == lens.projection)?;
    let (focal, [a, b, c]) = lens.tool(unit)?;
    let centre = PixelPoint::new(lens.cx, lens.cy);
    let alone = a == 0.0 && c == 0.0;
    let (model, terms) = if alone { ("poly3", vec![("k1", b)]) } else { ("ptlens", vec![("a", a), ("b", b), ("c", c)]) };
    Some((kind, centre, focal, model, terms))
}
