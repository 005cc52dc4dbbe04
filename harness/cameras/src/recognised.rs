//! Which format a camera file is of: all are asked, and what two of them read as different cameras is refused.

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, ImageSize, implausible};

use super::source::Source;
use super::unknown;
use super::{CameraFile, CameraFileError, CameraFormat, NamedCamera, ReadOptions};

/// Cameras that picture what one pixel sees no further apart than this, px, are one.
const SAME_PX: f64 = 1e-6;
/// Cameras of a list that are looked at for what no lens has.
const MOST_DOUBTED: usize = 50;
/// Pixels of the comparison along each side.
const PLACES: u32 = 21;

type Read = Result<CameraFile, CameraFileError>;

/// The cameras of `source`, by the one of `formats` that recognises it, or by several that read the same cameras.
///
/// # Errors
/// No format recognises it, or not the one that was asked for; the mistake of the one that does; several that do not read the same.
pub(super) fn cameras(formats: &[&'static CameraFormat], source: &Source<'_>, options: &ReadOptions) -> Read {
    if let Some(from) = options.from.filter(|from| from.binary.is_some()) {
        return Err(CameraFileError::new(format!("is no file of {}: it is text", from.name)));
    }
    let texts = formats.iter().filter(|format| format.binary.is_none());
    let asked: Vec<_> = texts.map(|&format| (format, (format.recognise)(source))).collect();
    let mut claims: Vec<&'static CameraFormat> = asked.iter().filter(|(_, answer)| answer.is_ok()).map(|(format, _)| *format).collect();
    if claims.is_empty() {
        if let Some(Err(why)) = options.from.and_then(|from| asked.iter().find(|(format, _)| *format == from)).map(|(_, answer)| answer) {
            let from = options.from.map_or("", |from| from.name);
            return Err(CameraFileError::new(format!("is no file of {from}: {why}")));
        }
        let why: Vec<(&CameraFormat, String)> = asked.into_iter().filter_map(|(format, answer)| Some((format, answer.err()?))).collect();
        return Err(unknown::text(source, &why));
    }
    if let Some(from) = options.from {
        if let Some((_, Err(why))) = asked.iter().find(|(format, _)| *format == from) {
            let problem = format!("is no file of {}: {why}; it is one of {}", from.name, names(&claims));
            return Err(CameraFileError::new(problem));
        }
        claims = vec![from];
    }
    let mut found: Vec<Read> = claims.iter().map(|&format| read(format, source, options)).collect();
    let first = found.remove(0);
    if found.iter().all(|other| matches!((&first, other), (Ok(a), Ok(b)) if are_same(a, b))) {
        return first;
    }
    let all: Vec<String> = claims.iter().zip(std::iter::once(&first).chain(&found)).map(|(format, read)| said(format, read)).collect();
    Err(CameraFileError::new(format!(
        "may be a file of {}, which are not the same cameras: {}; say which with --from FORMAT, or write it anew with `calibench convert --from FORMAT`",
        names(&claims),
        all.join("; ")
    )))
}

/// The cameras of `bytes` that are no text, by the format that recognises them; `None` where none does.
pub(super) fn binary(formats: &[&'static CameraFormat], bytes: &[u8], options: &ReadOptions) -> Option<Read> {
    let asked = |format: &&&'static CameraFormat| options.from.is_none_or(|from| from == **format);
    let is_of = |format: &&&'static CameraFormat| format.binary.as_ref().is_some_and(|binary| (binary.recognise)(bytes).is_ok());
    if let Some(format) = formats.iter().filter(asked).find(is_of).copied() {
        let cameras =
            format.binary.as_ref().map(|binary| has_named_matrices(format, options).and_then(|()| (binary.read)(bytes, options)))?;
        return Some(cameras.map(|mut cameras| {
            cameras.iter_mut().enumerate().for_each(|(place, named)| doubt(place, named));
            CameraFile { format, cameras }
        }));
    }
    let from = options.from?;
    let why = from.binary.as_ref().map_or(Err("it is no text".to_owned()), |binary| (binary.recognise)(bytes));
    Some(Err(CameraFileError::new(format!("is no file of {}: {}", from.name, why.err()?))))
}

fn names(formats: &[&CameraFormat]) -> String {
    formats.iter().map(|format| format.name).collect::<Vec<_>>().join(" or ")
}

/// Notes with the camera at a place of its file what no lens has.
pub(super) fn doubt(place: usize, named: &mut NamedCamera) {
    if place < MOST_DOUBTED {
        let faults = implausible(&named.camera);
        named.implausible = !faults.is_empty();
        named.notes.extend(faults.iter().map(|fault| format!("in doubt: {fault}")));
    }
}

/// Refuses names of matrices for a format that has none of one's own.
fn has_named_matrices(format: &CameraFormat, options: &ReadOptions) -> Result<(), CameraFileError> {
    let asked = options.matrix.as_ref().or(options.distortion.as_ref()).filter(|_| !format.named_matrices);
    asked.map_or(Ok(()), |name| {
        let problem = format!(
            "is a file of {}, whose numbers have names of its own; --matrix and --distortion are for OpenCV's and NumPy's",
            format.name
        );
        Err(CameraFileError::new(problem).of(name.as_str()))
    })
}

fn read(format: &'static CameraFormat, source: &Source<'_>, options: &ReadOptions) -> Read {
    has_named_matrices(format, options)?;
    let mut cameras = (format.read)(source, options)?;
    cameras.iter_mut().enumerate().for_each(|(place, named)| doubt(place, named));
    if cameras.is_empty() {
        return Err(CameraFileError::new(format!("{} without a camera; expected at least one", format.name)));
    }
    Ok(CameraFile { format, cameras })
}

/// What a format makes of a file: its first camera's size and scale, or the mistake that it finds.
fn said(format: &CameraFormat, read: &Read) -> String {
    let of = |file: &CameraFile| {
        let (camera, count) = (&file.cameras[0].camera, file.cameras.len());
        let ImageSize { width, height } = camera.size();
        let parameters: Vec<String> =
            camera.parameters().iter().take(4).map(|p| format!("{} {:.6} {}", p.name, p.value, p.unit).trim_end().to_owned()).collect();
        format!("{count} of {width} x {height} px, {}", parameters.join(", "))
    };
    let what = read.as_ref().map_or_else(|error| error.to_string().trim_start_matches([':', ' ']).to_owned(), of);
    format!("{}: {what}", format.name)
}

/// Whether the cameras of two readings agree, one by one.
fn are_same(a: &CameraFile, b: &CameraFile) -> bool {
    a.cameras.len() == b.cameras.len() && a.cameras.iter().zip(&b.cameras).all(|(a, b)| are_within(SAME_PX, &a.camera, &b.camera))
}

/// Whether two cameras picture the same within so many px over the frame, which they leave without a ray at the same pixels.
pub(super) fn are_within(px: f64, a: &Camera, b: &Camera) -> bool {
    let size = a.size();
    let place = |index: u32, length: u32| f64::from(length.saturating_sub(1)) * f64::from(index) / f64::from(PLACES - 1);
    let mut pixels = (0..PLACES * PLACES).map(|i| PixelPoint::new(place(i % PLACES, size.width), place(i / PLACES, size.height)));
    size == b.size()
        && (a == b
            || pixels.all(|pixel| match (a.unproject(pixel), b.unproject(pixel)) {
                (Ok(ray), Ok(_)) => b.project(ray).is_ok_and(|image| image.distance(pixel) <= px),
                (Err(_), Err(_)) => true,
                _ => false,
            }))
}
