//! What is run, and with what.

use std::path::PathBuf;

use calibench_exchange::NewFolder;
use calibench_measure::{BoardDetector, Configured};
use calibench_model::{Image, Rejection, Start, Unknowns};
use calibench_records::results::MethodInfo;
use calibench_scenario::{PhotographsSubject, Scenario, Subject};

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
    /// Finds chessboards, where this build can.
    pub detector: Option<&'a dyn BoardDetector>,
    /// Where photographs are.
    pub data: PathBuf,
    /// Whether the Cramér-Rao bound of each target is computed.
    pub bounds: bool,
    /// Where the images of the first trial are written, if anywhere.
    pub images: Option<&'a NewFolder>,
}

impl<'a> Plan<'a> {
    /// The scenario as its file says, with no images kept.
    pub fn new(scenario: &'a Scenario, detector: Option<&'a dyn BoardDetector>, data: PathBuf) -> Self {
        Self {
            scenario,
            methods: &scenario.methods,
            seed: scenario.seed,
            trials: scenario.trials,
            detector,
            data,
            bounds: true,
            images: None,
        }
    }

    /// The methods as results list them.
    pub fn method_infos(&self) -> Vec<MethodInfo> {
        let missing = self.missing();
        let info = |method: &Configured| MethodInfo {
            label: method.label.as_str().into(),
            version: method.version.as_str().into(),
            unavailable: missing.clone().or_else(|| method.operator.as_ref().err().map(|why| (*why).to_owned())),
        };
        self.methods.iter().map(info).collect()
    }

    /// Name and version of the detector that gives the approximate positions, if one does.
    pub fn detector_used(&self) -> Option<(String, String)> {
        let used = matches!(self.scenario.subject, Subject::Photographs(_)) && self.missing().is_none();
        self.detector.filter(|_| used).map(|detector| (detector.name().to_owned(), detector.version()))
    }

    /// Why nothing at all can be measured, if so.
    pub fn missing(&self) -> Option<String> {
        match &self.scenario.subject {
            Subject::Scene(_) | Subject::Views(_) => None,
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

    /// As [`Self::measure`], with targets that nobody found: where there is no start, no operator is asked.
    pub(crate) fn measure_found(
        &self,
        image: &Image,
        starts: &[Option<Start>],
    ) -> Vec<(usize, Vec<Result<calibench_model::Measurement, Rejection>>)> {
        let found: Vec<Start> = starts.iter().copied().flatten().collect();
        let whole = |(method, results): (usize, Vec<_>)| {
            let mut results = results.into_iter();
            let of = |start: &Option<Start>| start.and_then(|_| results.next()).unwrap_or(Err(Rejection::NotDetected));
            (method, starts.iter().map(of).collect())
        };
        self.measure(image, &found).into_iter().map(whole).collect()
    }

    /// Every available method on one image: (method, results in the order of `starts`).
    pub(crate) fn measure(&self, image: &Image, starts: &[Start]) -> Vec<(usize, Vec<Result<calibench_model::Measurement, Rejection>>)> {
        let available = self.methods.iter().enumerate().filter_map(|(i, method)| Some((i, method.operator.as_deref().ok()?)));
        available.map(|(index, operator)| (index, operator.measure_all(image, starts))).collect()
    }
}

/// Why the photographs cannot be measured, if so.
fn missing(plan: &Plan<'_>, subject: &PhotographsSubject) -> Option<String> {
    if plan.detector.is_none() {
        return Some("this build has no chessboard detector (it is built without OpenCV)".into());
    }
    let folder = plan.folder_of(subject);
    let absent: Vec<&str> = subject.files.iter().map(String::as_str).filter(|file| !folder.join(file).is_file()).collect();
    let first = absent.first()?;
    // The folder's own path would differ from machine to machine.
    Some(format!("{} of {} photographs are not in `{}`, {first} for one", absent.len(), subject.files.len(), subject.folder))
}
