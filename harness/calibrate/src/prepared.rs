//! From points and control to a network with start values.

use std::sync::Arc;

use calibench_adjust::Network;
use calibench_model::camera::Camera;
use calibench_model::{ControlRow, LostRows, Points};

use crate::against_gross::{self, Found};
use crate::search::is_of_start;
use crate::{
    BoardShape, CalibrationError, DatumChoice, Eccentricity, GrossErrors, LeftOut, Risk, Rival, Scatter, Settings, Shape, Survey, network,
    optics, per_image, shape,
};

/// A network with its start values.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// How it was asked for.
    pub settings: Settings,
    /// Who measured what.
    pub survey: Arc<Survey>,
    /// Where the interior orientation of each camera started.
    pub origins: Vec<String>,
    /// The cameras of the usual start, without what the search for a lower minimum knows: parameters that a compared set does not solve for keep their values.
    pub plain: Vec<Camera>,
    /// Minima that the observations do not tell from the one that is started near.
    pub rivals: Vec<Rival>,
    /// What is held of the shape of a planar testfield.
    pub shape: Shape,
    /// Coefficients that the images do not determine, held by priors that nobody asked for: [`Prepared::held_weakly`].
    pub held: Vec<String>,
    /// What is adjusted.
    pub network: Network,
    /// How far numbers of each image's own scatter, where that was to be told from the images.
    pub scatter: Vec<Scatter>,
    /// What was taken from the observations of discs, if that was asked for; [`prepare`] leaves it empty.
    pub eccentricity: Option<Eccentricity>,
    /// The sight behind each observation of the network.
    pub sights: Vec<u32>,
    /// Points of the network between which lengths are asked for.
    pub(crate) lengths: Vec<[usize; 2]>,
    /// Rows that take no part, with the reason.
    pub left_out: Vec<LeftOut>,
    /// Targets that a method was given and that have no position; [`prepare`] leaves it empty. They have a row in the residuals' table.
    pub unmeasured: LostRows,
    /// Points of a reconstruction that take no part, since their rays are as good as parallel.
    pub far: Vec<String>,
    /// Points of a reconstruction that take no part, since the last two of their rays do not meet, and either may be wrong.
    pub disputed: Vec<String>,
    /// What is to be known of how it was prepared, in words: no doubts.
    pub notes: Vec<String>,
    /// Start values were given for everything, and are not to be looked for.
    pub(crate) is_given: bool,
}

/// Joins points with control and finds start values for everything.
///
/// # Errors
/// No point in common, an unknown model or parameter, too few control points in an image, a datum of unknown targets, the shape of a board where there is
/// none, a scale of the board beside another scale.
pub fn prepare(points: Points, control: &[ControlRow], settings: &Settings) -> Result<Prepared, CalibrationError> {
    let settings = with_shape(settings)?;
    settings.check_scale()?;
    let survey = Arc::new(Survey::new(points, &settings.board.applied(control))?);
    let against = Settings { gross: GrossErrors::Rejected(Risk::WholeSet), ..settings.clone() };
    match prepared(&survey, &settings) {
        // Gross errors may be why.
        Err(error) if settings.gross == GrossErrors::Sought && is_of_start(&error) => prepared(&survey, &against).map_err(|_| error),
        found => found,
    }
}

fn prepared(survey: &Arc<Survey>, settings: &Settings) -> Result<Prepared, CalibrationError> {
    let owners = optics::owners(&settings.cameras, &survey.images)?;
    let Found { plain, starts, rivals } = against_gross::found(survey, &owners, settings)?;
    let (mut network, sights, left_out) = network::network(survey, &owners, &starts, settings)?;
    network.per_image = per_image::asked(settings, &network)?;
    let shape = shape::shape(&mut network, settings)?;
    let scatter = per_image::estimate(&mut network, settings)?;
    let (plain, origins) = (plain.unwrap_or(starts.cameras), starts.origins);
    Ok(Prepared {
        settings: settings.clone(),
        survey: Arc::clone(survey),
        plain,
        origins,
        rivals,
        shape,
        held: Vec::new(),
        scatter,
        eccentricity: None,
        lengths: network::lengths(survey, settings, &network)?,
        network,
        sights,
        left_out,
        unmeasured: LostRows::default(),
        far: Vec::new(),
        disputed: Vec::new(),
        notes: Vec::new(),
        is_given: false,
    })
}

impl Prepared {
    /// The same observations, of which those in gross error are to be left out, and start values against them; `None` where there are none.
    pub(crate) fn without_gross_errors(&self) -> Option<Self> {
        let settings = Settings { gross: GrossErrors::Rejected(Risk::WholeSet), ..self.settings.clone() };
        if self.is_given {
            return Some(Self { settings, ..self.clone() });
        }
        let found = prepared(&self.survey, &settings).ok()?;
        Some(Self { unmeasured: self.unmeasured.clone(), ..found })
    }
}

/// `settings` with the datum that a board's shape asks for: every corner is free in a free network, where the shape is no question of its own.
fn with_shape(settings: &Settings) -> Result<Settings, CalibrationError> {
    let (mut settings, is_control) = (settings.clone(), !settings.datum.is_minimal());
    if settings.board.is_measured {
        match settings.shape {
            BoardShape::Tested | BoardShape::Free => settings.shape = BoardShape::Free,
            _ => return Err(CalibrationError::NotMeasured { why: "every corner is free when it is; expected --board-shape free" }),
        }
        if !settings.distances.is_empty() || !settings.stations.is_empty() {
            return Err(CalibrationError::NotMeasured {
                why: "its scale and place are those of its nominal corners, and distances or poses are given",
            });
        }
    }
    match settings.shape {
        BoardShape::Free if is_control => settings.datum = DatumChoice::Free,
        BoardShape::Tested if !is_control => settings.shape = BoardShape::Free,
        BoardShape::Bent | BoardShape::BentAxes if !is_control => {
            return Err(CalibrationError::NoBoard { why: "its points are free in this datum" });
        }
        _ => {}
    }
    Ok(settings)
}
