//! What public sources leave open of some formats, as a user may decide it.

use calibench_model::PixelPoint;
use calibench_model::camera::{AgisoftVersion, Camera, CameraModel, TangentialOrder};

use super::{CameraFile, CameraFormat, NamedCamera};

/// What the position (0, 0) is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The outer corner of the first pixel.
    Corner,
    /// The centre of the first pixel.
    Centre,
}

/// Decisions on what a format's public sources leave open; `None` for what is assumed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OpenPoints {
    /// Order of the decentring coefficients of Pix4D, PhotoScan before 1.2 and Lens; OpenCV's is assumed.
    pub order: Option<TangentialOrder>,
    /// Origin of PhotoScan before 1.2 and Lens, where the corner is assumed, and of formats whose [`CameraFormat::origin_is_open`], where the centre is.
    pub origin: Option<Origin>,
}

impl OpenPoints {
    /// The order that was decided on, or the one that is assumed.
    pub fn order(self) -> TangentialOrder {
        self.order.unwrap_or(TangentialOrder::OpenCv)
    }

    /// Whether the corner of the first pixel was chosen as the origin of a format that leaves it open.
    pub fn starts_at_corner(self, format: &CameraFormat) -> bool {
        format.origin_is_open && self.origin == Some(Origin::Corner)
    }

    /// The cameras of a file as its user decided.
    pub fn read(self, file: CameraFile) -> Vec<NamedCamera> {
        let mut cameras = file.cameras;
        for named in &mut cameras {
            self.decide(&mut named.camera);
            if self.starts_at_corner(file.format) {
                named.camera = shifted(&named.camera, -0.5);
            }
        }
        cameras
    }

    /// Cameras as a file of `format` is to hold them: the opposite of [`Self::read`], as far as the origin goes.
    pub fn written(self, format: &CameraFormat, cameras: &mut [NamedCamera]) {
        if self.starts_at_corner(format) {
            cameras.iter_mut().for_each(|named| named.camera = shifted(&named.camera, 0.5));
        }
    }

    fn decide(self, camera: &mut Camera) {
        match camera {
            Camera::Pix4d(pix4d) => pix4d.order = self.order(),
            Camera::Agisoft(agisoft) if agisoft.version != AgisoftVersion::Metashape => {
                if self.order() == TangentialOrder::Brown {
                    agisoft.p.swap(0, 1);
                }
                if self.origin == Some(Origin::Centre) {
                    let corner = PixelPoint::new(agisoft.cx, agisoft.cy).to_corner();
                    (agisoft.cx, agisoft.cy) = (corner.x, corner.y);
                }
            }
            _ => {}
        }
    }
}

/// The camera with its principal point moved along both axes, px.
fn shifted(camera: &Camera, by: f64) -> Camera {
    let moves = |name: &str| ["cx", "cy", "PPx", "PPy"].contains(&name);
    let values = camera.parameters().into_iter().map(|p| if moves(p.name) { p.value + by } else { p.value });
    camera.with_parameters(&values.collect::<Vec<_>>())
}
