//! NumPy's archives of what OpenCV's calibrations return, as people save them: the names and the models of a FileStorage.

use std::io::{Read, Write};

use calibench_model::NamedCamera;
use calibench_model::convert::Target;
use flate2::read::DeflateDecoder;
use rawzip::{CompressionMethod, ZipArchive, ZipArchiveWriter};

use super::PLAIN;
use crate::format::{Binary, Keeps, KeptCovariance, KeptPose, Model};
use crate::number::shortened;
use crate::tree::Entry;
use crate::{CameraFileError, CameraFormat, ReadOptions, npy, opencv};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "numpy",
    tool: "NumPy, what OpenCV's Python returns",
    versions: ".npz, .npy",
    extension: "npz",
    verified: Some("NumPy 2.4 loads what is written, OpenCV 5.0 projects by it alike to 1e-8 px, and what they save is read so"),
    binary: Some(Binary { recognise, read, write }),
    named_matrices: true,
    models: |_| {
        let pinhole = |(coefficients, name)| Model { name, target: Target::OpenCv { coefficients } };
        let mut models: Vec<Model> =
            [(4, "opencv4"), (5, "opencv5"), (8, "opencv8"), (12, "opencv12"), (14, "opencv14")].map(pinhole).into();
        models.push(Model { name: "opencv-fisheye", target: Target::OpenCvFisheye });
        models
    },
    keeps: Keeps { splines: false, name: true, pitch: false, pose: KeptPose::None, covariance: KeptCovariance::Variances },
    half_space: true,
    ..PLAIN
};

/// Arrays of an archive at most.
const MOST_ARRAYS: usize = 10_000;

fn recognise(bytes: &[u8]) -> Result<(), String> {
    if npy::is_array(bytes)
        || (bytes.starts_with(b"PK") && members(bytes, |name, _| Ok(name.is_some())).is_ok_and(|found| found.contains(&true)))
    {
        Ok(())
    } else {
        Err("no archive of .npy arrays".into())
    }
}

fn read(bytes: &[u8], options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    if npy::is_array(bytes) {
        return Err(CameraFileError::new(
            "is one array; with the coefficients beside it, as --distortion FILE.npy, it is read by its path",
        ));
    }
    let (arrays, objects) = arrays(bytes)?;
    let found = opencv::read(&npy::named(arrays)?, options);
    found.map_err(|error| {
        let pickled = objects.first().map_or(String::new(), |name| format!("; `{name}` holds Python objects, which only Python unpickles"));
        CameraFileError { line: None, problem: error.problem + &pickled, ..error }
    })
}

/// What `work` makes of each member of an archive: of its name without .npy, `None` where it is no array, and its bytes, as many as a camera's may need.
fn members<T>(
    bytes: &[u8],
    work: impl Fn(Option<&str>, &dyn Fn() -> Result<Vec<u8>, CameraFileError>) -> Result<T, CameraFileError>,
) -> Result<Vec<T>, CameraFileError> {
    let wrong = |error: &dyn std::fmt::Display| CameraFileError::new(format!("is no archive that can be read: {error}"));
    let archive = ZipArchive::from_slice(bytes).map_err(|error| wrong(&error))?;
    let (mut entries, mut found) = (archive.entries(), Vec::new());
    while let Some(entry) = entries.next_entry().map_err(|error| wrong(&error))? {
        if found.len() == MOST_ARRAYS {
            return Err(CameraFileError::new(format!("holds more than {MOST_ARRAYS} arrays; expected those of a camera")));
        }
        let (place, method) = (entry.wayfinder(), entry.compression_method());
        let unpacked = || {
            let member = archive.get_entry(place).map_err(|error| wrong(&error))?;
            let mut bytes = Vec::new();
            let done = match method {
                CompressionMethod::STORE => member.data().take(npy::MOST_BYTES).read_to_end(&mut bytes),
                CompressionMethod::DEFLATE => DeflateDecoder::new(member.data()).take(npy::MOST_BYTES).read_to_end(&mut bytes),
                _ => return Err(wrong(&"neither stored nor deflated, as NumPy does")),
            };
            done.map(|_| bytes).map_err(|error| wrong(&error))
        };
        let path = entry.file_path();
        let name = std::str::from_utf8(path.as_ref()).ok().and_then(|name| name.strip_suffix(".npy"));
        let place = |error: CameraFileError| error.of(shortened(name.unwrap_or_default()));
        found.push(work(name, &unpacked).map_err(place)?);
    }
    Ok(found)
}

/// An array and its name.
type Named = (String, Entry);

/// The arrays of an archive, and the names of those that hold Python objects.
fn arrays(bytes: &[u8]) -> Result<(Vec<Named>, Vec<String>), CameraFileError> {
    let all = members(bytes, |name, unpacked| {
        let Some(name) = name else { return Ok(None) };
        let bytes = unpacked()?;
        let entry = (!npy::holds_objects(&bytes)).then(|| npy::entry(&bytes)).transpose()?;
        Ok(Some((name.to_owned(), entry)))
    })?;
    let (mut found, mut objects) = (Vec::new(), Vec::new());
    for (name, entry) in all.into_iter().flatten() {
        match entry {
            Some(entry) => found.push((name, entry)),
            None => objects.push(name),
        }
    }
    Ok((found, objects))
}

fn write(cameras: &[NamedCamera]) -> Result<Vec<u8>, CameraFileError> {
    let [named] = cameras else { return Err(CameraFileError::new("numpy holds one camera")) };
    let camera = opencv::written(&named.camera, &FORMAT)?;
    let mut arrays = vec![
        ("camera_matrix", npy::floats(&[3, 3], &camera.matrix)),
        ("dist_coeffs", npy::floats(&[1, camera.distortion.len()], &camera.distortion)),
        ("image_size", npy::integers(&[2], &[camera.size.width, camera.size.height].map(i64::from))),
        ("fisheye_model", npy::integers(&[], &[i64::from(camera.fisheye)])),
    ];
    arrays.extend(camera.xi.map(|xi| ("xi", npy::floats(&[], &[xi]))));
    arrays.extend((!named.name.is_empty()).then(|| ("camera_name", npy::text(&named.name))));
    arrays.extend(opencv::written_spreads(named).into_iter().map(|(name, sigmas)| (name, npy::floats(&[sigmas.len()], &sigmas))));
    let wrong = |error: &dyn std::fmt::Display| CameraFileError::new(format!("cannot be written: {error}"));
    let mut bytes = Vec::new();
    let mut archive = ZipArchiveWriter::new(&mut bytes);
    for (name, array) in arrays {
        // As np.savez, which does not compress either.
        let file = archive.new_file(format!("{name}.npy")).compression_method(CompressionMethod::STORE);
        let (mut entry, config) = file.start().map_err(|error| wrong(&error))?;
        let mut writer = config.wrap(&mut entry);
        writer.write_all(&array).map_err(|error| wrong(&error))?;
        let (_, descriptor) = writer.finish().map_err(|error| wrong(&error))?;
        entry.finish(descriptor).map_err(|error| wrong(&error))?;
    }
    archive.finish().map_err(|error| wrong(&error))?;
    Ok(bytes)
}
