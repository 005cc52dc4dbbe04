//! Where converted cameras go.

use std::io;

use calibench_cameras::{CameraFormat, camera_bytes};
use calibench_files::{OutputFile, OutputFolder};
use calibench_model::NamedCamera;

use crate::deliver::stream;
use crate::failure::Failure;

/// Where converted cameras go.
pub enum CamerasFile {
    Standard,
    File(OutputFile),
    Folder(OutputFolder),
}

impl CamerasFile {
    /// Writes them, all or none.
    pub fn write(&self, format: &CameraFormat, cameras: &[NamedCamera]) -> Result<(), Failure> {
        match self {
            Self::Folder(folder) => folder.replace(|folder| {
                for (index, camera) in cameras.iter().enumerate() {
                    let bytes = camera_bytes(format, std::slice::from_ref(camera)).map_err(io::Error::other)?;
                    let name = format!("{}.{}", file_name(&camera.name, index), format.extension);
                    folder.write(&name, |file| file.write_all(&bytes))?;
                }
                Ok(())
            }),
            Self::Standard | Self::File(_) if cameras.len() > 1 && !format.many => {
                Err(Failure::input(format!("{} holds one camera a file: name a folder with -o", format.name)))
            }
            Self::Standard => {
                let bytes = camera_bytes(format, cameras)?;
                stream(|output| output.write_all(&bytes))
            }
            Self::File(file) => {
                let bytes =
                    camera_bytes(format, cameras).map_err(|error| Failure::input(format!("-o {}: {error}", file.path().display())))?;
                Ok(file.write(|output| output.write_all(&bytes))?)
            }
        }
    }
}

/// A file's name for a camera, without what would leave the folder.
fn file_name(name: &str, index: usize) -> String {
    let kept: String = name.chars().map(|c| if c.is_alphanumeric() || "-_".contains(c) { c } else { '_' }).collect();
    let kept = kept.trim_matches('_');
    if kept.is_empty() { format!("camera-{}", index + 1) } else { format!("{:03}-{kept}", index + 1) }
}
