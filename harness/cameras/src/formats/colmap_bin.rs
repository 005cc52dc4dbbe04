//! COLMAP's cameras.bin: what cameras.txt says, as numbers of little-endian bytes.

use calibench_model::NamedCamera;
use calibench_model::camera::{CameraModel, ImageSize, tool_conventions};

use super::PLAIN;
use crate::format::{Binary, Keeps, Parts};
use crate::ids::Ids;
use crate::little_endian::{Bytes, Stream};
use crate::number::pixels;
use crate::numbering::Numbering;
use crate::{CameraFileError, CameraFormat, ReadOptions, colmap_models};

pub(crate) static FORMAT: CameraFormat = CameraFormat {
    name: "colmap-bin",
    tool: "COLMAP",
    versions: "cameras.bin of 3.x and 4.x",
    extension: "bin",
    verified: Some("pycolmap 4.2.1 reads what is written and projects alike in every model, to 1e-8 px"),
    many: true,
    binary: Some(Binary { recognise, read, write }),
    parts: Some(Parts { head, body }),
    convention: Some(&tool_conventions::COLMAP),
    models: colmap_models::models,
    keeps: Keeps { name: true, ..PLAIN.keeps },
    half_space: true,
    ..PLAIN
};

/// Bytes of a camera without its numbers: id, model, columns, rows.
const HEAD: usize = 24;
/// Sides above this are no images: what lies there is of another file.
const LARGEST_SIDE: u64 = 1 << 28;

/// A count, then an id, a model that may be one and sides that may be those of an image.
pub(crate) fn recognise(bytes: &[u8]) -> Result<(), String> {
    let no = || "no count of cameras before a camera's id, model, columns and rows".to_owned();
    let count = bytes.first_chunk().map(|count| u64::from_le_bytes(*count)).ok_or_else(no)?;
    if is_big_endian(bytes) {
        return Ok(());
    }
    if count == 0 || count > u64::from(u32::MAX) {
        return Err(no());
    }
    let mut rest = Bytes::new(&bytes[8..]);
    let Ok(_) = rest.u32() else { return Ok(()) };
    let Ok(model) = rest.i32() else { return Ok(()) };
    let sides = [rest.u64(), rest.u64()];
    let plausible = (-1..256).contains(&model) && sides.iter().flatten().all(|side| *side <= LARGEST_SIDE);
    if plausible { Ok(()) } else { Err(no()) }
}

/// Whether count, model and sides are read the other way round.
fn is_big_endian(bytes: &[u8]) -> bool {
    let Some(head) = bytes.first_chunk::<{ 8 + HEAD }>() else { return false };
    let number = |at: usize| head[at..at + 8].iter().fold(0, |sum, byte| sum << 8 | u64::from(*byte));
    let model = number(8) & u64::from(u32::MAX);
    (1..1 << 24).contains(&number(0)) && model < 256 && (1..LARGEST_SIDE).contains(&number(16)) && (1..LARGEST_SIDE).contains(&number(24))
}

fn read(bytes: &[u8], options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    has_least_byte_first(bytes)?;
    let (mut records, mut ids, mut cameras) = (Records::new(Bytes::new(bytes))?, Ids::default(), Vec::new());
    while let Some(named) = records.next(options)? {
        ids.take(&named.name, cameras.len() + 1).map_err(|_| twice(records.index, records.count, &named.name))?;
        cameras.push(named);
    }
    Ok(cameras)
}

/// Refuses a file that begins with numbers that are the other way round.
pub(crate) fn has_least_byte_first(head: &[u8]) -> Result<(), CameraFileError> {
    let wrong = "its numbers have the greatest byte first; expected the least first, as COLMAP writes them";
    if is_big_endian(head) { Err(CameraFileError::new(wrong)) } else { Ok(()) }
}

/// The error of an id that an earlier camera has.
pub(crate) fn twice(index: u64, count: u64, id: &str) -> CameraFileError {
    of_camera(index, count, &CameraFileError::new(format!("the id {id} is another camera's")))
}

fn of_camera(index: u64, count: u64, error: &CameraFileError) -> CameraFileError {
    let element = error.element.as_ref().map_or(String::new(), |element| format!(", {element}"));
    error.clone().of(format!("camera {index} of {count}{element}"))
}

/// The cameras of a file one after the other, whose ids may be the same.
pub(crate) struct Records<R> {
    bytes: Bytes<R>,
    /// How many cameras there are.
    pub count: u64,
    /// How many of them have been read.
    pub index: u64,
}

impl<R: Stream> Records<R> {
    /// Those of a file, from its beginning.
    ///
    /// # Errors
    /// A file without a count.
    pub fn new(mut bytes: Bytes<R>) -> Result<Self, CameraFileError> {
        Ok(Self { count: bytes.u64()?, bytes, index: 0 })
    }

    /// The byte at which the next camera begins.
    pub fn at(&self) -> u64 {
        self.bytes.at()
    }

    /// The next camera.
    ///
    /// # Errors
    /// The first mistake, with the place of the camera; bytes after the last one.
    pub fn next(&mut self, options: &ReadOptions) -> Result<Option<NamedCamera>, CameraFileError> {
        if self.index < self.count {
            self.index += 1;
            let place = |error| of_camera(self.index, self.count, &error);
            return camera(&mut self.bytes, options).map(Some).map_err(place);
        }
        match self.bytes.left() {
            0 => Ok(None),
            left => Err(CameraFileError::new(format!("{left} bytes follow the last of {} cameras; expected none", self.count))),
        }
    }
}

/// The camera that begins here.
pub(crate) fn camera<R: Stream>(rest: &mut Bytes<R>, options: &ReadOptions) -> Result<NamedCamera, CameraFileError> {
    let (id, number) = (rest.u32()?, rest.i32()?);
    let known = usize::try_from(number).ok().and_then(|number| colmap_models::MODELS.get(number));
    let Some((model, length)) = known else {
        let last = colmap_models::MODELS.len() - 1;
        return Err(CameraFileError::new(format!("model number {number} is not known; expected 0 to {last}")));
    };
    let mut side = |name| rest.u64().and_then(|side| pixels(&side.to_string())).map_err(|error| error.of(name));
    let size = options.size_or(Some(ImageSize { width: side("WIDTH")?, height: side("HEIGHT")? }))?;
    let values = (0..*length).map(|_| rest.f64()).collect::<Result<Vec<_>, _>>().map_err(|error| error.of("PARAMS[]"))?;
    let camera = colmap_models::camera(model, size, &values).map_err(|error| error.of(*model))?;
    Ok(NamedCamera::new(id.to_string(), camera))
}

fn write(cameras: &[NamedCamera]) -> Result<Vec<u8>, CameraFileError> {
    Ok([head(cameras.len()), body(cameras, Numbering::of(cameras))?].concat())
}

fn head(count: usize) -> Vec<u8> {
    (count as u64).to_le_bytes().to_vec()
}

fn body(cameras: &[NamedCamera], numbering: Numbering) -> Result<Vec<u8>, CameraFileError> {
    let mut out = Vec::new();
    for (index, named) in cameras.iter().enumerate() {
        let (model, values) = colmap_models::written(&named.camera, &FORMAT)?;
        let number = colmap_models::MODELS.iter().position(|(known, _)| *known == model).unwrap_or_default();
        let ImageSize { width, height } = named.camera.size();
        out.extend(numbering.id(index, named)?.to_le_bytes());
        out.extend((number as i32).to_le_bytes());
        out.extend([width, height].into_iter().flat_map(|side| u64::from(side).to_le_bytes()));
        out.extend(values.into_iter().flat_map(f64::to_le_bytes));
    }
    Ok(out)
}
