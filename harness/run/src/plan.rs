//! What is run, and with what.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

use calibench_files::NewFolder;
use calibench_measure::{Configured, Known, Recorded, RunId};
use calibench_model::Unknowns;
use calibench_photographs::{Finder, method_info};
use calibench_records::names::DETECTION;
use calibench_records::parts::Span;
use calibench_records::results::MethodInfo;
use calibench_scenario::{PhotographsSubject, Scenario, Study, Subject, Transfer};

use crate::measured::{Answers, Asked, Pictured, of_its_kinds};
use crate::tally::Reuse;
use crate::tools::Tools;
use crate::{RunError, studies};

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
    /// The places of the methods that are asked for, where not all are: what one of them gives is the same whichever others are.
    pub asked: Option<&'a [usize]>,
    /// The store of results, if there is one.
    pub reuse: Option<Reuse<'a>>,
    /// What this build has beside its methods.
    pub tools: Tools<'a>,
    /// Where photographs are.
    pub data: PathBuf,
    /// Whether the Cramér-Rao bound of each target is computed.
    pub bounds: bool,
    /// Ends the run before its next trial, once it is true.
    pub stop: Option<&'a AtomicBool>,
    /// Where the images of the first trial are written, if anywhere.
    pub images: Option<&'a NewFolder>,
}

impl<'a> Plan<'a> {
    /// The scenario as its file says, with no images kept.
    pub fn new(scenario: &'a Scenario, tools: Tools<'a>, data: PathBuf) -> Self {
        let Scenario { methods, seed, trials, .. } = scenario;
        Self {
            scenario,
            methods,
            seed: *seed,
            trials: *trials,
            only: None,
            asked: None,
            reuse: None,
            tools,
            data,
            bounds: true,
            stop: None,
            images: None,
        }
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

    /// # Errors
    /// [`RunError::Stopped`] once it is to end.
    pub(crate) fn go_on(&self) -> Result<(), RunError> {
        if self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed)) { Err(RunError::Stopped) } else { Ok(()) }
    }

    /// The methods as results list them.
    pub fn method_infos(&self) -> Vec<MethodInfo> {
        if let Some(own) = studies::method_infos(&self.scenario.subject, self.tools) {
            return own;
        }
        let missing = self.missing();
        let info =
            |method: &Configured| MethodInfo { unavailable: missing.clone().or_else(|| self.unavailable(method)), ..method_info(method) };
        self.methods.iter().map(info).collect()
    }

    /// The calibrations that are applied, where those are the methods.
    pub fn transfer(&self) -> Option<&'a Transfer> {
        let Subject::Views(views) = &self.scenario.subject else { return None };
        views.study.transfer()
    }

    /// Name and version of the detector that gives the approximate positions, if one does.
    pub fn detector_used(&self) -> Option<(String, String)> {
        let used = matches!(self.scenario.subject, Subject::Photographs(_)) && self.missing().is_none();
        let (name, version) = Finder::detector();
        used.then(|| (name.to_owned(), version.to_owned()))
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

    /// Sides of the windows of bounds, and of those of discs, px.
    pub(crate) fn bound_windows(&self) -> [usize; 2] {
        [self.scenario.bound_window, self.scenario.bound_window_discs]
    }

    /// What each method that is asked for estimates.
    pub(crate) fn all_unknowns(&self) -> impl Iterator<Item = Unknowns> {
        (0..self.methods.len()).filter(|index| self.asks_for(*index)).map(|index| self.unknowns(index))
    }

    /// Why a method cannot measure, if so.
    fn unavailable(&self, method: &Configured) -> Option<String> {
        let photographs = matches!(self.scenario.subject, Subject::Photographs(_));
        let run = RunId { scenario: &self.scenario.name, seed: self.seed, photographs };
        method.operator.as_ref().map_or_else(|why| Some(why.clone()), |_| method.recorded()?.unfit(&run))
    }

    /// Whether method `index` can measure.
    pub(crate) fn is_available(&self, index: usize) -> bool {
        self.unavailable(&self.methods[index]).is_none()
    }

    /// Whether method `index` is asked for.
    pub(crate) fn asks_for(&self, index: usize) -> bool {
        self.asked.is_none_or(|asked| asked.contains(&index))
    }

    /// The places of the methods that can measure, of those that are asked for.
    pub(crate) fn available(&self) -> Vec<usize> {
        (0..self.methods.len()).filter(|&index| self.asks_for(index) && self.is_available(index)).collect()
    }

    /// The places of all methods that can measure, asked for or not.
    pub(crate) fn all_available(&self) -> Vec<usize> {
        (0..self.methods.len()).filter(|&index| self.is_available(index)).collect()
    }

    /// Whether the names of recorded methods that are of this run are those of its targets.
    pub(crate) fn check_recorded(&self) -> Result<(), RunError> {
        let recorded: Vec<(&Configured, &dyn Recorded)> =
            self.available().into_iter().filter_map(|index| Some((&self.methods[index], self.methods[index].recorded()?))).collect();
        if recorded.is_empty() {
            return Ok(());
        }
        let corners = self.corners();
        let known = match &self.scenario.subject {
            Subject::Scene(subject) => {
                Known { targets: subject.scene.targets.iter().map(|target| target.id.as_str()).collect(), ..Known::default() }
            }
            Subject::Views(subject) => {
                Known { targets: subject.field.targets.iter().map(|target| target.id.as_str()).collect(), ..Known::default() }
            }
            Subject::Photographs(subject) => Known {
                targets: corners.iter().map(String::as_str).collect(),
                photographs: subject.files.iter().map(String::as_str).collect(),
            },
            Subject::Printed(_) => return Ok(()),
        };
        let wrong = |(method, recorded): (&Configured, &dyn Recorded)| {
            recorded.check(&known).map_err(|problem| RunError::Recorded { method: method.label.clone(), problem })
        };
        recorded.into_iter().try_for_each(wrong)
    }

    /// The names of a board's corners in photographs.
    fn corners(&self) -> Vec<String> {
        let Subject::Photographs(subject) = &self.scenario.subject else { return Vec::new() };
        (0..subject.board.corners()).map(|index| subject.board.target(index)).collect()
    }

    /// The sets of figures that its records have, if they have any: those of its subject, or counts of what finders of boards find.
    pub fn sets(&self) -> Vec<String> {
        let mut sets = self.scenario.subject.sets();
        sets.extend(self.counts_detections().then(|| DETECTION.to_owned()));
        sets
    }

    /// Whether what finders of boards find is counted: where they are among the methods, and nothing else is made of their points.
    pub(crate) fn counts_detections(&self) -> bool {
        let Subject::Views(views) = &self.scenario.subject else { return false };
        let plain = matches!(views.study, Study::Points) && views.recognition.is_none();
        let finds = |method: &Configured| {
            views.sheet.is_some_and(|board| method.board_finder().is_some_and(|finder| finder.unfit(&board).is_none()))
        };
        plain && self.methods.iter().any(finds)
    }

    /// Every available method on one image, at the targets of its kinds, with its place.
    pub(crate) fn measure<'p>(&self, shown: Pictured<'p>, targets: &[Asked<'p>]) -> Vec<(usize, Answers<'p>)> {
        let of = |index| Some((index, of_its_kinds(&self.methods[index], shown, targets)?));
        self.available().into_iter().filter_map(of).collect()
    }
}

/// Why the photographs cannot be measured, if so.
fn missing(plan: &Plan<'_>, subject: &PhotographsSubject) -> Option<String> {
    let folder = plan.folder_of(subject);
    let absent: Vec<&str> = subject.files.iter().map(String::as_str).filter(|file| !folder.join(file).is_file()).collect();
    let first = absent.first()?;
    // The folder's own path would differ from machine to machine.
    Some(format!("{} of {} photographs are not in `{}`, {first} for one", absent.len(), subject.files.len(), subject.folder))
}
