//! Calibration tools by name.

use super::Target;
use crate::camera::{AgisoftVersion, ImageSize, TangentialOrder};

/// A tool whose cameras the Canon paper converts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tool {
    /// Agisoft PhotoScan, whose model is Metashape's.
    PhotoScan,
    /// Pix4D; T1 and T2 in OpenCV's order, which is most likely and not confirmed.
    Pix4d,
    /// OpenCV with five coefficients.
    OpenCv,
    /// Agisoft Lens.
    Lens,
}

impl Tool {
    /// All tools with their names in files.
    pub const ALL: [(Self, &'static str); 4] =
        [(Self::PhotoScan, "photoscan"), (Self::Pix4d, "pix4d"), (Self::OpenCv, "opencv"), (Self::Lens, "lens")];

    /// The tool that is called so in files.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(_, known)| *known == name).map(|(tool, _)| tool)
    }

    /// Its name in files.
    pub fn name(self) -> &'static str {
        Self::ALL.into_iter().find(|(tool, _)| *tool == self).map_or("", |(_, name)| name)
    }

    /// Its convention, for images of `size` with a pixel pitch in um.
    pub fn target(self, size: ImageSize, pitch_um: f64) -> Target {
        match self {
            Self::PhotoScan => Target::metashape(),
            Self::Pix4d => Target::Pix4d { sensor_width_mm: f64::from(size.width) * pitch_um * 1e-3, order: TangentialOrder::OpenCv },
            Self::OpenCv => Target::OpenCv { coefficients: 5 },
            Self::Lens => Target::Agisoft { version: AgisoftVersion::Lens, radial: 3, tangential: 2, affinity: false },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tools_are_found_by_their_names() {
        for (tool, name) in Tool::ALL {
            assert_eq!((Tool::named(name), tool.name()), (Some(tool), name));
        }
        assert_eq!(Tool::named("metashape"), None);
    }
}
