//! What is run, and with what.

use std::path::PathBuf;

use calibench_exchange::NewFolder;
use calibench_measure::Configured;
use calibench_model::{Image, Start, TargetKind, Unknowns};
use calibench_records::parts::Span;
use calibench_records::results::MethodInfo;
use calibench_scenario::transfer::{Calibrates, Solver};
use calibench_scenario::{PhotographsSubject, Scenario, Subject, Transfer};

use crate::measured::{Measured, of_its_kinds};
use crate::printed::PRINT;
use crate::tools::Tools;

/// The version of calibration methods: raised when their numbers change on purpose.
const TRANSFER_VERSION: &str = "1";

/// How a scenario is run.
pub struct Plan<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// The methods: the scenario's or others.
    pub methods: &'a [Configured],
    /// The seed: the scenario's or another.
    pub seed: u64,
    /// How many trials: the scenario's number or another.
    pub trials: u64,
    /// Which of them, where not all are run: a trial is the same whichever others are run.
    pub only: Option<Span>,
    /// What this build has beside its methods.
    pub tools: Tools<'a>,
    /// Where photographs are.
    pub data: PathBuf,
    /// Whether the Cramér-Rao bound of each target is computed.
    pub bounds: bool,
    /// Where the images of the first trial are written, if anywhere.
    pub images: Option<&'a NewFolder>,
}

impl<'a> Plan<'a> {
    /// The scenario as its file says, with no images kept.
    pub fn new(scenario: &'a Scenario, tools: Tools<'a>, data: PathBuf) -> Self {
        let Scenario { methods, seed, trials, .. } = scenario;
        Self { scenario, methods, seed: *seed, trials: *trials, only: None, tools, data, bounds: true, images: None }
    }

    /// How many trials there are, whichever of them are run: one where nothing is drawn.
    pub fn all_trials(&self) -> u64 {
        match &self.scenario.subject {
            Subject::Scene(_) | Subject::Views(_) => self.trials,
            Subject::Photographs(_) | Subject::Printed(_) => 1,
        }
    }

    /// The trials that are run.
    pub fn span(&self) -> Span {
        let all = self.all_trials();
        self.only.map_or(Span { from: 0, to: all }, |only| Span { from: only.from, to: only.to.min(all) })
    }

    /// The methods as results list them.
    pub fn method_infos(&self) -> Vec<MethodInfo> {
        if let Subject::Printed(_) = self.scenario.subject {
            return vec![MethodInfo { label: PRINT.into(), version: "1".into(), unavailable: None }];
        }
        if let Some(transfer) = self.transfer() {
            let info = |(place, method): (usize, &calibench_scenario::transfer::Method)| MethodInfo {
                label: method.name.as_str().into(),
                version: self.version(method).into(),
                unavailable: self.tools.lack(transfer, place),
            };
            return transfer.methods.iter().enumerate().map(info).collect();
        }
        let missing = self.missing();
        let info = |method: &Configured| MethodInfo {
            label: method.label.as_str().into(),
            version: method.version.as_str().into(),
            unavailable: missing.clone().or_else(|| method.operator.as_ref().err().cloned()),
        };
        self.methods.iter().map(info).collect()
    }

    /// The version of a calibration that is applied, with those of what measures for it and solves for it.
    fn version(&self, method: &calibench_scenario::transfer::Method) -> String {
        let measuring = method.measured_by.iter().map(|measuring| format!("{} {}", measuring.operator.label, measuring.operator.version));
        let solver = match method.calibrates {
            Calibrates::FromBoard { solver: Solver::Opencv, .. } => {
                self.tools.solver.map(|solver| format!("{} {}", solver.name(), solver.version()))
            }
            _ => None,
        };
        [TRANSFER_VERSION.to_owned()].into_iter().chain(measuring).chain(solver).collect::<Vec<_>>().join(", ")
    }

    /// The calibrations that are applied, where those are the methods.
    pub fn transfer(&self) -> Option<&'a Transfer> {
        let Subject::Views(views) = &self.scenario.subject else { return None };
        views.transfer.as_ref()
    }

    /// Name and version of the detector that gives the approximate positions, if one does.
    pub fn detector_used(&self) -> Option<(String, String)> {
        let used = matches!(self.scenario.subject, Subject::Photographs(_)) && self.missing().is_none();
        self.tools.detector.filter(|_| used).map(|detector| (detector.name().to_owned(), detector.version()))
    }

    /// Why nothing at all can be measured, if so.
    pub fn missing(&self) -> Option<String> {
        match &self.scenario.subject {
            Subject::Scene(_) | Subject::Views(_) | Subject::Printed(_) => None,
            Subject::Photographs(subject) => missing(self, subject),
        }
    }

    /// Where photographs are.
    pub(crate) fn folder_of(&self, subject: &PhotographsSubject) -> PathBuf {
        // An absolute folder replaces the data folder.
        self.data.join(&subject.folder)
    }

    /// What method `index` estimates beside the position.
    pub(crate) fn unknowns(&self, index: usize) -> Unknowns {
        self.methods[index].operator.as_ref().map_or_else(|_| Unknowns::default(), |operator| operator.unknowns())
    }

    pub(crate) fn all_unknowns(&self) -> impl Iterator<Item = Unknowns> {
        (0..self.methods.len()).map(|index| self.unknowns(index))
    }

    /// Every available method on one image, at the targets of its kinds: (method, results in the order of `targets`, `None` where it is not to measure).
    ///
    /// A target is its kind and its start; where nobody found it there is none, and no operator is asked.
    pub(crate) fn measure(&self, image: &Image, targets: &[(TargetKind, Option<Start>)]) -> Vec<(usize, Vec<Option<Measured>>)> {
        let of = |(index, method): (usize, &Configured)| Some((index, of_its_kinds(method, image, targets)?));
        self.methods.iter().enumerate().filter_map(of).collect()
    }
}

/// Why the photographs cannot be measured, if so.
fn missing(plan: &Plan<'_>, subject: &PhotographsSubject) -> Option<String> {
    if plan.tools.detector.is_none() {
        return Some("this build has no chessboard detector (it is built without OpenCV)".into());
    }
    let folder = plan.folder_of(subject);
    let absent: Vec<&str> = subject.files.iter().map(String::as_str).filter(|file| !folder.join(file).is_file()).collect();
    let first = absent.first()?;
    // The folder's own path would differ from machine to machine.
    Some(format!("{} of {} photographs are not in `{}`, {first} for one", absent.len(), subject.files.len(), subject.folder))
}
