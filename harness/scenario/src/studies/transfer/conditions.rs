//! Under which a calibration is made and applied, and the switches between them.

/// What is true of the measurements, and what goes wrong on the way from a calibration to check points.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
pub struct Conditions {
    /// Image coordinates have errors.
    pub measurement: bool,
    /// The survey has errors.
    pub survey: bool,
    /// The direction of the polynomial is ignored.
    pub naive: bool,
    /// Exterior orientations are those of another calibration.
    pub held: bool,
    /// A wrong pixel pitch through which px become mm, um.
    pub pitch_um: Option<f64>,
    /// What is added to the principal point, mm: right, up.
    pub principal_point: [f64; 2],
    /// Height of the board's middle over its outermost corners, the board's units.
    pub bend: f64,
    /// Principal distance before the board less that where the camera is applied, mm.
    pub refocus: f64,
    /// Standard deviation per axis of the corners' coordinates in place of the methods' own, px.
    pub board_sigma_px: Option<f64>,
    /// The network of fewer stations that is all there is, by its place among those of the campaign.
    pub network: Option<usize>,
}

/// One of the conditions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Switch {
    /// Errors of image coordinates.
    Measurement,
    /// Errors of the survey.
    Survey,
    /// The naive conversion.
    Naive,
    /// Exterior orientations of another calibration.
    ExchangedPoses,
    /// The wrong pixel pitch.
    Pitch,
    /// The error of the principal point.
    PrincipalPoint,
    /// The bent board.
    Bend,
    /// The other focus.
    Refocus,
    /// The network of fewer stations.
    Network,
}

impl Switch {
    /// All switches with their names in records.
    pub const ALL: [(Self, &'static str); 9] = [
        (Self::Measurement, "measurement"),
        (Self::Survey, "survey"),
        (Self::Naive, "naive conversion"),
        (Self::ExchangedPoses, "exchanged poses"),
        (Self::Pitch, "pitch"),
        (Self::PrincipalPoint, "principal point"),
        (Self::Bend, "bent board"),
        (Self::Refocus, "refocus"),
        (Self::Network, "network"),
    ];

    /// The name in records.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(switch, _)| *switch == self).map_or("", |(_, name)| name)
    }
}

impl Conditions {
    /// Nothing goes wrong, and nothing has an error.
    pub const fn none() -> Self {
        Self {
            measurement: false,
            survey: false,
            naive: false,
            held: false,
            pitch_um: None,
            principal_point: [0.0; 2],
            bend: 0.0,
            refocus: 0.0,
            board_sigma_px: None,
            network: None,
        }
    }

    /// These with one switch as it is in `other`.
    #[must_use]
    pub fn with(self, switch: Switch, other: &Self) -> Self {
        match switch {
            Switch::Measurement => Self { measurement: other.measurement, ..self },
            Switch::Survey => Self { survey: other.survey, ..self },
            Switch::Naive => Self { naive: other.naive, ..self },
            Switch::ExchangedPoses => Self { held: other.held, ..self },
            Switch::Pitch => Self { pitch_um: other.pitch_um, ..self },
            Switch::PrincipalPoint => Self { principal_point: other.principal_point, ..self },
            Switch::Bend => Self { bend: other.bend, ..self },
            Switch::Refocus => Self { refocus: other.refocus, ..self },
            Switch::Network => Self { network: other.network, ..self },
        }
    }

    /// The switches that differ from `other`'s, in the order of [`Switch::ALL`].
    pub fn differing(&self, other: &Self) -> Vec<Switch> {
        Switch::ALL.iter().map(|(switch, _)| *switch).filter(|&switch| self.with(switch, other) != *self).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn switches_lead_from_one_to_the_other_one_by_one() {
        let on = Conditions {
            measurement: true,
            survey: true,
            naive: true,
            held: true,
            pitch_um: Some(5.0),
            principal_point: [0.0, -0.5],
            bend: 1.0,
            refocus: 0.5,
            board_sigma_px: None,
            network: Some(0),
        };
        let off = Conditions::none();
        let switches = off.differing(&on);
        assert_eq!(switches.len(), Switch::ALL.len());
        assert_eq!(switches.iter().fold(off, |at, switch| at.with(*switch, &on)), on);
        for switch in switches {
            assert_eq!(off.differing(&off.with(switch, &on)), [switch], "{}", switch.name());
        }
        assert_eq!(Conditions { bend: 0.0, ..on }.differing(&on), [Switch::Bend]);
    }
}
