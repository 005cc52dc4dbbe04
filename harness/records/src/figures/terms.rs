//! What the catalogue says of a quantity.

/// What a figure is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Group {
    /// A parameter of the interior orientation, by name.
    Iop,
    /// A parameter of an exterior orientation, as in `6/phi`.
    Eop,
    /// The adjustment as a whole: sigma0, redundancy, iterations, image points.
    Network,
    /// The camera over the frame: its rms distance from the true one after the best rotation.
    Frame,
    /// The second step: errors of check points.
    Check,
    /// Root mean square residual of an image, by its name.
    Residual,
    /// A residual of the first trial, as in `6/left/3/x`.
    Point,
    /// A coordinate of an object point in the first trial, as in `left/3/Z`.
    Object,
}

impl Group {
    /// All groups with their names in files.
    pub const ALL: [(Self, &'static str); 8] = [
        (Self::Iop, "iop"),
        (Self::Eop, "eop"),
        (Self::Network, "network"),
        (Self::Frame, "frame"),
        (Self::Check, "check"),
        (Self::Residual, "residual"),
        (Self::Point, "point"),
        (Self::Object, "object"),
    ];

    /// The name in files.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(group, _)| *group == self).map_or("", |(_, name)| name)
    }

    /// The group of this name in files.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(_, known)| *known == name).map(|(group, _)| *group)
    }
}

/// What kind of result has a quantity among its figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A camera, adjusted or applied: compared with the true one where that is known.
    Camera,
    /// A free network: without control, judged by its own residuals.
    FreeNetwork,
    /// What residuals of pairs of images have in common.
    ResidualPairs,
    /// A blind recognition of targets, counted against the truth.
    Recognition,
    /// A finder of boards, counted against the truth.
    Detection,
    /// Printed figures, and what follows from them.
    Printed,
}

/// The units that a quantity has in records.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Units {
    /// A number without a unit.
    Number,
    /// Always this one.
    One(&'static str),
    /// One of these.
    Either(&'static [&'static str]),
    /// That of object space: mm or m.
    Object,
    /// That of the camera's parameter.
    Parameter,
}

impl Units {
    /// Whether a figure may be in `unit`; a number has an empty one.
    pub fn have(self, unit: &str) -> bool {
        match self {
            Self::Number => unit.is_empty(),
            Self::One(only) => unit == only,
            Self::Either(some) => some.contains(&unit),
            Self::Object => ["mm", "m"].contains(&unit),
            Self::Parameter => true,
        }
    }

    /// As it is told.
    pub fn text(self) -> String {
        match self {
            Self::Number => "number".into(),
            Self::One(only) => only.into(),
            Self::Either(some) => some.iter().map(|unit| if unit.is_empty() { "number" } else { unit }).collect::<Vec<_>>().join(" or "),
            Self::Object => "object unit".into(),
            Self::Parameter => "that of the parameter".into(),
        }
    }
}

/// Which value of a quantity is the better one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Better {
    /// The nearer to zero.
    Less,
    /// The larger.
    More,
    /// The nearer to one.
    One,
    /// Neither: it says what there is, not how good it is.
    Neither,
}

impl Better {
    /// As it is told.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Less => "less",
            Self::More => "more",
            Self::One => "1",
            Self::Neither => "",
        }
    }
}
