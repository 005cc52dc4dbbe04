//! `calibench calibrate --reconstruction`: what another tool adjusted, adjusted anew.

use std::path::{Path, PathBuf};

use calibench_calibrate::{Behind, Calibration, Settings, Solved, calibrate, prepare_reconstruction};
use calibench_cameras::inputs_of;
use calibench_cameras::reconstructions::{ReconstructionFile, read_reconstruction, write_colmap};
use calibench_files::{NewFolder, OutputFolder};
use calibench_images::Reading;
use calibench_model::Reconstruction;
use clap::{Args, ValueEnum};

use super::super::context::Context;
use super::super::output;
use super::{Calibrate, sets};
use crate::failure::Failure;

#[derive(Args)]
pub struct ReconstructionArguments {
    /// A reconstruction with its image points, adjusted anew as a free network: a folder with COLMAP's cameras, images and points3D, Bundler's bundle.out, OpenMVG's sfm_data.json, or a problem of Bundle Adjustment in the Large
    #[arg(long = "reconstruction", value_name = "FILE", id = "reconstruction",
          conflicts_with_all = ["photos", "points", "control", "approx", "poses", "claims", "pitch", "model", "priors", "per_image", "start", "names",
                                "board_shape", "board_file", "save_board", "board_scale", "print_noise", "eccentricity", "covariances", "certificate"])]
    pub path: Option<PathBuf>,
    /// Image points of points behind their cameras, where nothing is seen: count them by the line through the projection centre, as most tools do, or leave them out; they are named
    #[arg(long, value_enum, value_name = "WHAT", default_value = "count", requires = "reconstruction")]
    behind: BehindCamera,
    /// Folder for the adjusted reconstruction as COLMAP's text model
    #[arg(long, value_name = "DIR", requires = "reconstruction")]
    adjusted: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum BehindCamera {
    Count,
    LeaveOut,
}

impl Calibrate {
    /// As [`Calibrate::run`], of what another tool adjusted.
    pub(super) fn run_reconstruction(&self, path: &Path, context: &Context<'_>) -> Result<(), Failure> {
        let inputs = inputs_of([path.to_owned()].into_iter().chain(self.distances.clone()));
        let adjusted = self.reconstruction.adjusted.as_deref();
        let adjusted = adjusted.map(|path| output::folder("--adjusted", path, &inputs, ("calibrate", None))).transpose()?;
        let outputs = self.outputs(&inputs)?;
        let ReconstructionFile { tool, reconstruction, rigs } = read_reconstruction(path, self.cameras.common_size())?;
        if !context.quiet {
            let Reconstruction { cameras, images, points, sights, .. } = &reconstruction;
            let counts = [(cameras.len(), "cameras"), (images.len(), "images"), (points.len(), "points"), (sights.len(), "image points")];
            say!("{tool}: {}", counts.map(|(count, what)| format!("{count} {what}")).join(", "));
        }
        reconstruction.notes.iter().for_each(|note| say!("{note}"));
        let behind = match self.reconstruction.behind {
            BehindCamera::Count => Behind::Count,
            BehindCamera::LeaveOut => Behind::LeaveOut,
        };
        let solved = self.cameras.common_solve().map_or(Solved::Lens, Solved::Named);
        let settings: Settings = self.settings_of(Vec::new(), None)?;
        let mut found = prepare_reconstruction(&reconstruction, (&solved, behind), &settings)?;
        found.note_rigs(&reconstruction, &rigs);
        if self.answered.json {
            found.prepared.notes.iter().for_each(|note| say!("{note}"));
        }
        let doubts = found.doubts(behind);
        calibrate(&found.prepared, &sets(&self.compare)?, |calibration| {
            doubts.iter().for_each(|doubt| say!("in doubt: {doubt}"));
            let told = self.tell(calibration, &doubts, &[]);
            let delivered = self.deliver(calibration, (&[], Reading::default(), &doubts), &[], (&outputs, &[]));
            let written = adjusted.as_ref().map_or(Ok(()), |folder| write(folder, calibration, &reconstruction));
            told.and(delivered.map(|_| ())).and(written)?;
            if calibration.doubts().is_empty() && doubts.is_empty() { Ok(()) } else { Err(Failure::Doubt) }
        })?
    }
}

/// The images and points that took part, as they were adjusted.
fn write(folder: &OutputFolder, calibration: &Calibration<'_>, given: &Reconstruction) -> Result<(), Failure> {
    let (reconstruction, errors_px) = calibration.reconstruction(given);
    let files = write_colmap(&reconstruction, &errors_px)?;
    Ok(folder.replace(|folder: &NewFolder| {
        files.iter().try_for_each(|(name, text)| folder.write(name, |file| file.write_all(text.as_bytes())))
    })?)
}
