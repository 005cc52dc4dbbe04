//! Hugin's and PanoTools' projects (.pto): lens type, angle of view, a, b, c, d, e of each image.

use calibench_model::camera::{Camera, ImageSize, LensProjection, OpenCvFisheye, PtLens, pt_lens};
use calibench_model::convert::Target;
use calibench_model::{NamedCamera, PixelPoint};

use super::PLAIN;
use crate::brown::{Brown, middle, positive};
use crate::format::{Keeps, Model};
use crate::number::{finite, pixels, shortened, shortest};
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "panotools",
    tool: "Hugin, PanoTools",
    versions: ".pto of Hugin 2022, PanoTools 2.9",
    extension: "pto",
    words: "hugin pto TIFF cropFactor Ra Rb Rc TrX TrY TrZ",
    verified: Some("Hugin 2022.0's pano_trafo reads what is written and pictures alike to 1e-6 px, for every type of lens"),
    many: true,
    recognise: |source| {
        let found = source.xml.is_none() && images(source).next().is_some();
        if found { Ok(()) } else { Err("no line `i w... h... f... v...`".into()) }
    },
    read,
    write: Some(write),
    convention: Some(&pt_lens::CONVENTION),
    models: |_| {
        LENSES
            .iter()
            .filter(|lens| lens.code != CIRCULAR)
            .map(|lens| Model { name: lens.name, target: Target::PtLens { projection: lens.projection } })
            .collect()
    },
    keeps: Keeps { name: true, ..PLAIN.keeps },
    ..PLAIN
};

/// A type of lens.
struct Lens {
    /// Its number in a project.
    code: u32,
    name: &'static str,
    projection: LensProjection,
}

/// The circular fisheye, which pictures as the full-frame one does.
const CIRCULAR: u32 = 2;

static LENSES: [Lens; 7] = [
    Lens { code: 0, name: "rectilinear", projection: LensProjection::Rectilinear },
    Lens { code: 3, name: "fisheye", projection: LensProjection::Equidistant },
    Lens { code: CIRCULAR, name: "circular-fisheye", projection: LensProjection::Equidistant },
    Lens { code: 21, name: "equisolid", projection: LensProjection::Equisolid },
    Lens { code: 10, name: "stereographic", projection: LensProjection::Stereographic },
    Lens { code: 8, name: "orthographic", projection: LensProjection::Orthographic },
    Lens { code: 20, name: "thoby", projection: LensProjection::Thoby },
];

/// The letters of a lens that are numbers.
const LENS: [&str; 10] = ["w", "h", "f", "v", "a", "b", "c", "d", "e", "n"];
/// Where the camera looked, how bright the image is, and how it is used.
const ABOUT: &[&str] = &[
    "r", "p", "y", "Tx", "Ty", "Tz", "Tpy", "Tpp", "TrX", "TrY", "TrZ", "Te0", "Te1", "Te2", "Te3", "Ti0", "Ti1", "Ti2", "Ti3", "Ra", "Rb",
    "Rc", "Rd", "Re", "Eev", "Er", "Eb", "j", "Va", "Vb", "Vc", "Vd", "Vx", "Vy", "Vm", "Vf", "u", "m", "o", "k", "X", "Y", "Z", "Tt",
    "Tv", "Tu", "Ts", "disabled", "Eg", "Vs", "Ti", "Te",
];

/// The lines of images.
fn images<'a>(source: &Source<'a>) -> impl Iterator<Item = (usize, &'a str)> {
    source.lines().filter_map(|(number, line)| {
        let rest = line.strip_prefix("i ")?;
        let has = |letter: char| {
            rest.split_whitespace().any(|word| {
                word.strip_prefix(letter).is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit() || "=.-".contains(c)))
            })
        };
        "whfv".chars().all(has).then_some((number, rest))
    })
}

/// An image's words: names of letters and their values.
fn words(line: &str) -> Vec<(&str, &str)> {
    let mut found = Vec::new();
    let mut rest = line.trim_start();
    while !rest.is_empty() {
        let letters = rest.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(rest.len());
        // e0 is a number, Te0 a name that ends in one.
        let letters = if rest.starts_with("Te") || rest.starts_with("Ti") { (letters + 1).min(rest.len()) } else { letters };
        let (name, value) = rest.split_at_checked(letters).unwrap_or((rest, ""));
        let end = match value.strip_prefix('"') {
            Some(quoted) => quoted.find('"').map_or(value.len(), |end| end + 2),
            None => value.find(char::is_whitespace).unwrap_or(value.len()),
        };
        let (value, after) = value.split_at_checked(end).unwrap_or((value, ""));
        found.push((name, value.trim_matches('"')));
        // A character that is none of a project's ends it.
        rest = if name.is_empty() && value.is_empty() { "" } else { after.trim_start() };
    }
    found
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let lines: Vec<(usize, Vec<(&str, &str)>)> = images(source).map(|(line, text)| (line, words(text))).collect();
    (0..lines.len()).map(|index| camera(&lines, index, options).map_err(|error| error.on_line(lines[index].0))).collect()
}

/// The text of a letter, of another image where the project says `v=0`.
fn value<'a>(lines: &[(usize, Vec<(&'a str, &'a str)>)], mut image: usize, name: &str) -> Result<Option<&'a str>, CameraFileError> {
    for _ in 0..=lines.len() {
        let found = lines[image].1.iter().find(|(own, _)| *own == name).map(|(_, value)| *value);
        let Some(other) = found.and_then(|value| value.strip_prefix('=')) else { return Ok(found) };
        let wrong = || CameraFileError::new(format!("expected the number of an image after `=`, found `{}`", shortened(other))).of(name);
        image = other.parse().ok().filter(|other| *other < lines.len()).ok_or_else(wrong)?;
    }
    Err(CameraFileError::new("is that of an image that takes it from this one").of(name))
}

fn camera(lines: &[(usize, Vec<(&str, &str)>)], index: usize, options: &ReadOptions) -> Result<NamedCamera, CameraFileError> {
    let text = |name: &str| value(lines, index, name);
    let needed = |name: &str| text(name)?.ok_or_else(|| CameraFileError::new("is missing").of(name));
    let number = |name: &str| text(name)?.map_or(Ok(0.0), |text| finite(text).map_err(|error| error.of(name)));
    let side = |name: &str| pixels(needed(name)?).map_err(|error| error.of(name));
    let size = options.size_or(Some(ImageSize { width: side("w")?, height: side("h")? }))?;
    let code = needed("f")?;
    let lens = LENSES.iter().find(|lens| code.parse::<u32>().ok() == Some(lens.code)).ok_or_else(|| {
        let known = LENSES.iter().map(|lens| format!("{} ({})", lens.code, lens.name)).collect::<Vec<_>>().join(", ");
        CameraFileError::new(format!("type of lens `{}` is no camera here; expected {known}", shortened(code))).of("f")
    })?;
    let degrees = positive("v", finite(needed("v")?).map_err(|error| error.of("v"))?)?;
    let focal = focal(lens.projection, size, degrees)
        .ok_or_else(|| CameraFileError::new(format!("no {} lens sees {degrees} degrees across", lens.name)).of("v"))?;
    for name in ["g", "t"] {
        let shear = number(name)?;
        if shear != 0.0 && !options.ignore.iter().any(|ignored| ignored == name) {
            let problem = format!("is {shear}: a shear of the image, which no camera here has; `--ignore-key {name}` leaves it out");
            return Err(CameraFileError::new(problem).of(name));
        }
    }
    if let Some(selection) = text("S")? {
        return Err(CameraFileError::new(format!(
            "a part of the image is used (S{}), around whose middle its numbers are; expected whole images",
            shortened(selection)
        ))
        .of("S"));
    }
    let known = [&LENS[..], ABOUT, &["g", "t", "S", "C"]].concat();
    let notes = options.of_lens(lines[index].1.iter().map(|(name, _)| (*name, ())), &known, |(), error| error)?;
    let centre = middle(size);
    let centre = [centre.x + number("d")?, centre.y + number("e")?];
    let unit = half_of_shorter(size);
    let terms = [number("a")?, number("b")?, number("c")?];
    let left = 1.0 - terms.iter().sum::<f64>();
    if left <= 0.0 {
        let problem = format!("a, b, c leave {left} of the focal length on the axis; expected more than 0");
        return Err(CameraFileError::new(problem).of("a"));
    }
    let found = PtLens::of_tool(size, lens.projection, focal, centre, terms, unit);
    let name = text("n")?.unwrap_or_default();
    Ok(NamedCamera { notes, ..NamedCamera::new(name, found.into()) })
}

fn half_of_shorter(size: ImageSize) -> f64 {
    0.5 * f64::from(size.width.min(size.height))
}

/// The focal length of an angle of view across, px; `None` where the lens does not see so much.
fn focal(projection: LensProjection, size: ImageSize, degrees: f64) -> Option<f64> {
    let radius = projection.radius_of(0.5 * degrees.to_radians())?;
    Some(0.5 * f64::from(size.width) / radius)
}

/// The angle of view across, degrees, of a focal length, px.
fn degrees(projection: LensProjection, size: ImageSize, focal: f64) -> Option<f64> {
    Some(2.0 * projection.angle_of(0.5 * f64::from(size.width) / focal)?.to_degrees())
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let mut out = String::from("# hugin project file\np f2 w3600 h1800 v360  n\"TIFF_m\"\nm g1 i0\n\n# image lines\n");
    for (index, named) in cameras.iter().enumerate() {
        let lens = lens(&named.camera)
            .ok_or_else(|| FORMAT.other_model("lenses of a, b, c: one focal length, a distortion of the radius alone"))?;
        let size = lens.size;
        let wrong = || CameraFileError::new("no ray is pictured at half of the shorter side, by which the file's numbers are scaled");
        let (focal, [a, b, c]) = lens.tool(half_of_shorter(size)).ok_or_else(wrong)?;
        let wide = || CameraFileError::new("sees more across than its projection has: the file has no angle of view for it");
        let v = degrees(lens.projection, size, focal).ok_or_else(wide)?;
        let code = LENSES.iter().find(|known| known.projection == lens.projection).map_or(0, |known| known.code);
        let (middle, at) = (middle(size), PixelPoint::new(lens.cx, lens.cy));
        let [a, b, c, d, e] = [a, b, c, at.x - middle.x, at.y - middle.y].map(shortest);
        let name = if named.name.is_empty() { format!("image-{index}.jpg") } else { named.name.replace('"', "'") };
        let name: String = name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        out.push_str(&format!(
            "i w{} h{} f{code} v{} Ra0 Rb0 Rc0 Rd0 Re0 Eev0 Er1 Eb1 r0 p0 y0 TrX0 TrY0 TrZ0 Tpy0 Tpp0 j0 a{a} b{b} c{c} d{d} e{e} g0 t0 Va1 Vb0 Vc0 Vd0 Vx0 Vy0 Vm5 n\"{name}\"\n",
            size.width,
            size.height,
            shortest(v)
        ));
    }
    Ok(out)
}

/// The camera as a lens of PanoTools'.
fn lens(camera: &Camera) -> Option<PtLens> {
    match *camera {
        Camera::PtLens(lens) => Some(lens),
        Camera::OpenCvFisheye(OpenCvFisheye { size, fx, fy, cx, cy, skew: 0.0, k: [b, 0.0, 0.0, 0.0] }) if fx == fy => {
            Some(PtLens { size, projection: LensProjection::Equidistant, f: fx, cx, cy, a: 0.0, b, c: 0.0 })
        }
        _ => {
            let brown = Brown::of(camera).filter(|b| b.skew == 0.0 && b.has_one_focal() && b.radial() <= 1 && !b.has_tangential())?;
            let Brown { size, fx: f, cx, cy, k, .. } = brown;
            Some(PtLens { size, projection: LensProjection::Rectilinear, f, cx, cy, a: 0.0, b: k[0], c: 0.0 })
        }
    }
}
