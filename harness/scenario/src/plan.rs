//! A checked scenario.

use calibench_measure::Configured;
use calibench_model::TargetKind;

use crate::{Phase, Resolved, Subject, Sweep};

/// A checked scenario.
pub struct Scenario {
    /// Its name: its path below the scenario folder without `.toml`.
    pub name: String,
    /// What it is to show.
    pub why: String,
    /// Where it comes from.
    pub source: String,
    /// What is to be known when its figures are read.
    pub notes: Vec<String>,
    /// Whether `check` leaves it to `check --nightly`.
    pub nightly: bool,
    /// The seed of all its random numbers.
    pub seed: u64,
    /// How many trials.
    pub trials: u64,
    /// The methods, with distinct labels.
    pub methods: Vec<Configured>,
    /// Side of the window to which the Cramér-Rao bound belongs, px.
    pub bound_window: usize,
    /// The same of discs.
    pub bound_window_discs: usize,
    /// What is measured.
    pub subject: Subject,
    /// The kinds of its targets, each once; of a sweep and of its cells those of all cells.
    pub kinds: Vec<TargetKind>,
    /// Its sweep, if it has one; all else is then that of the first cell.
    pub sweep: Option<Sweep>,
    /// The text of its file.
    pub text: String,
    /// What it says, of a sweep its first cell.
    pub resolved: Resolved,
    /// For what its random numbers are drawn: [`Drawn::all`](crate::Drawn::all).
    pub drawn: String,
}

impl Scenario {
    /// Whether nothing in it is random: its figures are then the same in every trial and for every seed.
    pub fn is_deterministic(&self) -> bool {
        match &self.subject {
            Subject::Scene(scene) => {
                let still = scene.phase == Phase::Fixed && scene.starts.are_fixed();
                still && scene.grey_noise == 0.0 && !scene.imaging.is_random()
            }
            Subject::Views(views) => {
                let still = !views.study.plan().is_random() && views.hand.is_steady();
                still && !views.changes() && !views.imaging.is_random()
            }
            Subject::Photographs(_) | Subject::Printed(_) => true,
        }
    }

    /// Whether the truth of its points is known.
    pub fn has_truth(&self) -> bool {
        !matches!(self.subject, Subject::Photographs(_))
    }

    /// The pixel pitch of the adjusted camera, um.
    pub fn pitch_um(&self) -> Option<f64> {
        self.subject.study().pitch_um()
    }

    /// The part of the name before the first `/`: the folder, and the report.
    pub fn family(&self) -> &str {
        self.name.split('/').next().unwrap_or(&self.name)
    }
}
