//! From points and control to a network with start values.

use calibench_adjust::Network;
use calibench_exchange::{ControlRow, LostRows, Points};
use calibench_model::camera::Camera;

use crate::{CalibrationError, LeftOut, Rival, Settings, Survey, network, optics, search, stages, start};

/// A network with its start values.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// How it was asked for.
    pub settings: Settings,
    /// Who measured what.
    pub survey: Survey,
    /// Where the interior orientation of each camera started.
    pub origins: Vec<String>,
    /// The cameras of the usual start, without what the search for a lower minimum knows: parameters that a compared set does not solve for keep their values.
    pub plain: Vec<Camera>,
    /// Minima that the observations do not tell from the one that is started near.
    pub rivals: Vec<Rival>,
    /// What is adjusted.
    pub network: Network,
    /// The sight behind each observation of the network.
    pub sights: Vec<u32>,
    /// Rows that take no part, with the reason.
    pub left_out: Vec<LeftOut>,
    /// Targets that a method was given and that have no position; [`prepare`] leaves it empty. They have a row in the residuals' table.
    pub unmeasured: LostRows,
}

/// Joins points with control and finds start values for everything.
///
/// # Errors
/// No point in common, an unknown model or parameter, too few control points in an image, a datum of unknown targets.
pub fn prepare(points: Points, control: &[ControlRow], settings: &Settings) -> Result<Prepared, CalibrationError> {
    let survey = Survey::new(points, control)?;
    let owners = optics::owners(&settings.cameras, &survey.images)?;
    let usual = start::starts(&survey, &owners, settings).and_then(|rough| stages::refined(&survey, &owners, rough, settings));
    let plain = usual.as_ref().map(|usual| usual.cameras.clone()).ok();
    let (starts, rivals) = search::better(&survey, &owners, settings, usual)?;
    let (network, sights, left_out) = network::network(&survey, &owners, &starts, settings)?;
    let (plain, origins) = (plain.unwrap_or(starts.cameras), starts.origins);
    Ok(Prepared { settings: settings.clone(), survey, plain, origins, rivals, network, sights, left_out, unmeasured: LostRows::default() })
}
