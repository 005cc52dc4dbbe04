//! What nobody said the uncertainty of.

use calibench_model::ControlRow;

use crate::{KnownCamera, Task};

/// What is taken as exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exact {
    /// The camera has no covariance.
    Camera,
    /// What its model leaves.
    Model,
    /// Of an image.
    Centres,
    /// Of an image.
    Angles,
    /// Of control.
    ControlPoints,
    /// Of control.
    Flatness,
    /// Of the known plane.
    Plane,
    /// Of the known plane.
    PlaneTilt,
    /// Of the object's frame.
    Scale,
    /// Of the object.
    Temperature,
}

impl Exact {
    /// In words, with the key that states it.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Camera => "the camera (its file has no covariance)",
            Self::Model => "the camera's model (--halves, or a calibration that left photographs out, tells its error)",
            Self::Centres => "projection centres (sigma_centre)",
            Self::Angles => "rotations of images (sigma_angles)",
            Self::ControlPoints => "coordinates of control (print_sigma, or sX,sY,sZ)",
            Self::Flatness => "the flatness of control (flatness_sigma)",
            Self::Plane => "the position of the plane (sigma)",
            Self::PlaneTilt => "the tilt of the plane (sigma_tilt)",
            Self::Scale => "the scale (scale_sigma)",
            Self::Temperature => "the object's temperature ([temperature])",
        }
    }

    /// All that is taken as exact in a task. What does not act on what is measured is not named: an angle has no scale.
    pub(crate) fn of(task: &Task, camera: &KnownCamera<'_>, control: Option<&[ControlRow]>) -> Vec<Self> {
        let stated = control.is_none();
        let (errors, plane, has_scale) = (task.control, task.plane, task.quantity.has_scale());
        let exact_rows = |rows: &[ControlRow]| rows.iter().any(|row| row.sigmas.is_none()) && errors.print_sigma == 0.0;
        let all = [
            (camera.covariance.is_none(), Self::Camera),
            (camera.covariance.is_some() && camera.halves.is_none(), Self::Model),
            (stated && task.images.iter().any(|station| station.sigma_centre == 0.0), Self::Centres),
            (stated && task.images.iter().any(|station| station.sigma_angles == 0.0), Self::Angles),
            (control.is_some_and(exact_rows), Self::ControlPoints),
            (control.is_some() && errors.flatness_sigma == 0.0, Self::Flatness),
            (plane.is_some_and(|plane| plane.sigma == 0.0), Self::Plane),
            (plane.is_some_and(|plane| plane.sigma_tilt == 0.0), Self::PlaneTilt),
            (has_scale && task.scale_sigma == 0.0, Self::Scale),
            (has_scale && task.temperature.is_none(), Self::Temperature),
        ];
        all.into_iter().filter(|(is_exact, _)| *is_exact).map(|(_, exact)| exact).collect()
    }
}
