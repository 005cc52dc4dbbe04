//! COLMAP's images.txt and images.bin: where each image was taken and by which camera of the list beside it.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::little_endian::{Bytes, Stream};
use super::number::{finite, shortened};
use super::pose::{of_quaternion, of_rt};
use super::{CameraFile, CameraFileError, NamedCamera, Pose, PoseFrame, ReadOptions, parse_camera, source};

/// Quaternions are written with 17 digits; what is further from length one, squared, is no list of images.
const UNIT: f64 = 1e-6;

/// An image: its pose as `X_camera = R X_world + t`, its camera and name.
pub(super) struct Image {
    /// qw, qx, qy, qz.
    q: [f64; 4],
    t: [f64; 3],
    /// The id of its camera.
    pub camera: u32,
    pub name: String,
}

impl Image {
    /// The image's camera, with its name and pose; `None` for the camera says that it is not in `list`.
    ///
    /// # Errors
    /// No camera, a rotation of no length.
    pub fn posed(self, camera: Option<&NamedCamera>, list: &str) -> Result<NamedCamera, CameraFileError> {
        let at = |error: CameraFileError| error.of(shortened(&self.name));
        let camera = camera.ok_or_else(|| at(CameraFileError::new(format!("camera {} is not in {list}", self.camera))))?;
        let pose = Some(self.pose().map_err(at)?);
        Ok(NamedCamera { name: self.name, pose, pose_frame: PoseFrame::World, ..camera.clone() })
    }

    /// Where it was taken.
    ///
    /// # Errors
    /// A rotation of no length.
    pub fn pose(&self) -> Result<Pose, CameraFileError> {
        let [w, x, y, z] = self.q;
        of_rt(of_quaternion([x, y, z, w])?, self.t)
    }
}

fn is_unit(q: &[f64]) -> bool {
    (q.iter().map(|v| v * v).sum::<f64>() - 1.0).abs() <= UNIT
}

/// Whether `bytes` begin as a list of images does, as text or not.
pub(super) fn are_images(bytes: &[u8]) -> bool {
    are_in_bytes(bytes) || std::str::from_utf8(bytes).is_ok_and(are_in_text)
}

/// Whether `bytes` begin as images.bin does.
pub(super) fn are_in_bytes(bytes: &[u8]) -> bool {
    let first = || {
        let count = u64::from_le_bytes(*bytes.first_chunk()?);
        let mut rest = Bytes::new(bytes.get(12..44)?);
        let q = [rest.f64().ok()?, rest.f64().ok()?, rest.f64().ok()?, rest.f64().ok()?];
        ((1..=u64::from(u32::MAX)).contains(&count) && is_unit(&q)).then_some(())
    };
    first().is_some()
}

/// Whether `text` begins as images.txt does.
pub(super) fn are_in_text(text: &str) -> bool {
    lines(text).next().is_some_and(|(_, line)| in_text(line).is_ok_and(|i| is_unit(&i.q)))
}

/// The lines of images: each is followed by one of points, which may be empty.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    lines_with_points(text).map(|(line, image, _)| (line, image))
}

/// The same with the lines of their points.
pub(super) fn lines_with_points(text: &str) -> impl Iterator<Item = (usize, &str, &str)> {
    let mut all = text.strip_prefix('\u{feff}').unwrap_or(text).lines().enumerate();
    std::iter::from_fn(move || {
        let (index, line) = all.find(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#'))?;
        let points = all.next().map_or("", |(_, line)| line);
        Some((index + 1, line.trim(), points.trim()))
    })
}

/// The image of a line.
pub(super) fn in_text(line: &str) -> Result<Image, CameraFileError> {
    if line.contains('\0') {
        return Err(CameraFileError::new("expected text, found a zero byte"));
    }
    let wrong = || CameraFileError::new("expected IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME");
    let mut rest = line;
    let mut word = || {
        let (word, after) = rest.split_once(char::is_whitespace).ok_or_else(wrong)?;
        rest = after.trim_start();
        Ok(word)
    };
    let whole = |text: &str, name| {
        text.parse::<u32>().map_err(|_| CameraFileError::new(format!("expected a whole number, found `{}`", shortened(text))).of(name))
    };
    whole(word()?, "IMAGE_ID")?;
    let mut numbers = [0.0; 7];
    for number in &mut numbers {
        *number = finite(word()?)?;
    }
    let camera = whole(word()?, "CAMERA_ID")?;
    if rest.is_empty() {
        return Err(wrong());
    }
    let [qw, qx, qy, qz, t @ ..] = numbers;
    Ok(Image { q: [qw, qx, qy, qz], t, camera, name: rest.to_owned() })
}

/// The image that begins here; its points are passed over.
pub(super) fn in_bytes<R: Stream>(rest: &mut Bytes<R>) -> Result<Image, CameraFileError> {
    let (image, points) = head_in_bytes(rest)?;
    // x, y and the id of the object point.
    rest.pass(points.saturating_mul(24))?;
    Ok(image)
}

/// The image that begins here, and how many points follow.
pub(super) fn head_in_bytes<R: Stream>(rest: &mut Bytes<R>) -> Result<(Image, u64), CameraFileError> {
    rest.u32()?;
    let mut numbers = [0.0; 7];
    for number in &mut numbers {
        *number = rest.f64()?;
    }
    let [qw, qx, qy, qz, t @ ..] = numbers;
    let (camera, name) = (rest.u32()?, rest.text()?);
    Ok((Image { q: [qw, qx, qy, qz], t, camera, name }, rest.u64()?))
}

fn images(bytes: &[u8]) -> Result<Vec<Image>, CameraFileError> {
    if !are_in_bytes(bytes) {
        let text = std::str::from_utf8(bytes).map_err(|_| CameraFileError::new("expected text in UTF-8, found other bytes"))?;
        return lines(text).map(|(line, text)| in_text(text).map_err(|error| error.on_line(line))).collect();
    }
    let mut rest = Bytes::new(bytes);
    let (count, mut images) = (rest.u64()?, Vec::new());
    for index in 1..=count {
        images.push(in_bytes(&mut rest).map_err(|error| of_image(index, count, error))?);
    }
    Ok(images)
}

/// A mistake in a file of bytes with the place of the image.
pub(super) fn of_image(index: u64, count: u64, error: CameraFileError) -> CameraFileError {
    error.of(format!("image {index} of {count}"))
}

/// The error where the list of cameras cannot be looked for.
pub(super) fn without_cameras() -> CameraFileError {
    CameraFileError::new(
        "is COLMAP's list of images, whose cameras stand in cameras.bin or cameras.txt beside it; expected a file in a folder with that",
    )
}

/// The list of cameras in the folder of a list of images.
pub(super) fn beside(path: &Path) -> Option<PathBuf> {
    let own = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    let names = [format!("cameras.{own}"), "cameras.bin".to_owned(), "cameras.txt".to_owned()];
    names.iter().map(|name| path.with_file_name(name)).find(|path| path.is_file())
}

/// A camera an image, with the image's name and pose, by the list of cameras in the same folder.
///
/// # Errors
/// No list of cameras, or one with a mistake; an image with a mistake, or of a camera that is not listed.
pub(super) fn read(path: &Path, bytes: &[u8], options: &ReadOptions) -> Result<CameraFile, CameraFileError> {
    let file = path.display().to_string();
    let beside = beside(path).ok_or_else(|| without_cameras().in_file(&file))?;
    let list = beside.display().to_string();
    let CameraFile { format, cameras } =
        source::read(&beside).map_err(|error| error.in_file(&list)).and_then(|bytes| parse_camera(&list, &bytes, options))?;
    let by_id: HashMap<&str, &NamedCamera> = cameras.iter().map(|camera| (camera.name.as_str(), camera)).collect();
    let posed = |image: Image| {
        let camera = by_id.get(image.camera.to_string().as_str()).copied();
        image.posed(camera, &list)
    };
    let cameras = images(bytes)
        .and_then(|images| images.into_iter().map(posed).collect::<Result<Vec<_>, _>>())
        .map_err(|error| error.in_file(&file))?;
    Ok(CameraFile { format, cameras })
}
