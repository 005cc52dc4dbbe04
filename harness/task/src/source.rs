//! What the uncertainty of a measurement is made of.

/// A source of uncertainty.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Source {
    /// Image coordinates of what is measured.
    Image,
    /// The camera's parameters, together, as the covariance of its calibration says.
    Camera,
    /// By how much more they err, as photographs that are left out or halves of them show.
    Model,
    /// Projection centres, as stated.
    Centres,
    /// Rotations of the images, as stated.
    Angles,
    /// Image coordinates of control, from which the poses come.
    ControlImage,
    /// Object coordinates of control: of a board the print of each point.
    ControlPoints,
    /// The bend of the board.
    Flatness,
    /// Where the known plane lies.
    Plane,
    /// How the known plane is tilted.
    PlaneTilt,
    /// The scale of the object's frame: of a board its print.
    Scale,
    /// The object's temperature and how it expands.
    Temperature,
}

impl Source {
    /// All, in the order of the answer.
    pub const ALL: [Self; 12] = [
        Self::Image,
        Self::Camera,
        Self::Model,
        Self::Centres,
        Self::Angles,
        Self::ControlImage,
        Self::ControlPoints,
        Self::Flatness,
        Self::Plane,
        Self::PlaneTilt,
        Self::Scale,
        Self::Temperature,
    ];

    /// In words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Image => "image coordinates",
            Self::Camera => "camera",
            Self::Model => "model error",
            Self::Centres => "projection centres",
            Self::Angles => "rotations of images",
            Self::ControlImage => "image coordinates of control",
            Self::ControlPoints => "coordinates of control",
            Self::Flatness => "flatness of control",
            Self::Plane => "position of the plane",
            Self::PlaneTilt => "tilt of the plane",
            Self::Scale => "scale",
            Self::Temperature => "temperature",
        }
    }
}
