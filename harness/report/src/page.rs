//! The page of a report.

use calibench_records::description::Description;

use crate::answer::{Answers, heading};
use crate::composed::Composed;
use crate::markdown::contents;
use crate::places::PAGE;
use crate::studies::{self, OnPage, Shown};
use crate::{Canvas, LoadError, Loaded, scores_section, sweep};

/// The page of a paper's tables, and that of its runs.
const TABLES: &str = "tables.md";
const RUNS: &str = "runs.md";
const PREDICTIONS: &str = "predictions.md";

/// A page with its pictures, filled section by section.
pub struct Page {
    family: String,
    /// What it says first.
    pub answers: Answers,
    /// Scenarios of the family without records: of them it says nothing.
    pub not_run: Vec<String>,
    /// Scenarios that a published table of adjustments stands on: they are shown in pictures.
    pub illustrated: Vec<String>,
    /// What the page of a paper shows first, where it was written; all else then stands on pages of its own.
    pub first_screen: Option<String>,
    /// The page of the paper's predictions.
    pub predictions: Option<String>,
    /// The sections of published tables.
    pub printed: String,
    /// The sections of scenarios.
    pub text: String,
    /// Whether there are tables of scores.
    scored: bool,
    pub pictures: Vec<(String, Canvas)>,
    /// Pages of their own, by file name.
    pub beside: Vec<(&'static str, String)>,
}

impl Page {
    pub fn new(family: &str) -> Self {
        Self {
            family: family.to_owned(),
            answers: Answers::default(),
            not_run: Vec::new(),
            illustrated: Vec::new(),
            first_screen: None,
            predictions: None,
            printed: String::new(),
            text: String::new(),
            scored: false,
            pictures: Vec::new(),
            beside: Vec::new(),
        }
    }

    /// The heading of a scenario; the stem of its pictures' names.
    fn head(&mut self, name: &str, scenario: &Description, deviations: &str) -> String {
        self.text.push_str(&format!(
            "## {}\n\n{}\n\nSource: {}.\n\n",
            heading(name),
            scenario.why.trim(),
            scenario.source.trim_end_matches('.')
        ));
        self.text.push_str(deviations);
        for note in &scenario.notes {
            self.text.push_str(&format!("- {}\n", note.split_whitespace().collect::<Vec<_>>().join(" ")));
        }
        if !scenario.notes.is_empty() {
            self.text.push('\n');
        }
        name.split_once('/').map_or(name, |(_, rest)| rest).replace('/', "-")
    }

    /// Adds the section of a sweep.
    ///
    /// # Errors
    /// Records that do not belong together.
    pub fn sweep(&mut self, loaded: &sweep::LoadedSweep, printed: &[(String, f64)]) -> Result<(), LoadError> {
        // The points of adjusted scenarios are those of the first trial: how many there were is in their tables.
        let without = loaded.scenario.adjusted().is_some() || loaded.has_no_points();
        let deviations = if without { String::new() } else { sweep::deviations(loaded) };
        let stem = self.head(&loaded.name, &loaded.scenario, &deviations);
        let shown = studies::of(&loaded.scenario).of_sweep(loaded, OnPage { stem: &stem, illustrated: false, printed })?;
        if shown.scored {
            self.answers.sweep(loaded);
        }
        self.show(shown);
        Ok(())
    }

    /// Adds the section of a scenario without a sweep.
    pub fn scenario(&mut self, loaded: &Loaded) {
        let scenario = &loaded.scenario;
        let stem = self.head(&loaded.name, scenario, &deviations(loaded));
        let on = OnPage { stem: &stem, illustrated: self.illustrated.contains(&loaded.name), printed: &[] };
        let shown = studies::of(scenario).of(loaded, on);
        if shown.scored {
            self.scored = true;
            self.answers.scenario(loaded);
        }
        self.show(shown);
    }

    fn show(&mut self, Shown { text, pictures, answer, .. }: Shown) {
        answer.into_iter().for_each(|answer| self.answers.say(answer));
        self.text.push_str(&text);
        self.pictures.extend(pictures);
    }

    /// What this page lacks.
    fn not_run(&self) -> String {
        if self.not_run.is_empty() {
            return String::new();
        }
        let names: Vec<String> = self.not_run.iter().map(|name| format!("`{name}`")).collect();
        format!("**Not run**, so that nothing is said of them here: {}. `calibench run {}` runs all.", names.join(", "), self.family)
    }

    /// The page with all that is beside it.
    pub fn composed(self) -> Composed {
        let legend = if self.scored { scores_section::legend() } else { String::new() };
        let family = &self.family;
        let made = format!(
            "Made by `calibench report {family}` from records and published tables. Pixel centres are whole numbers, x points right, y down. Some of the methods compared here are our own, `forstner` \
             and `harris_paraboloid` among them: each gets the same images, the same starts and the same score."
        );
        // In one paragraph: the front page has it too.
        let answer = [self.answers.paragraph(), self.not_run()].into_iter().filter(|words| !words.is_empty()).collect::<Vec<_>>().join(" ");
        let answer = if answer.is_empty() { answer } else { format!("{answer}\n\n") };
        let (counted, led) = (self.answers.counted(), self.answers.led());
        let whole = |title: &str, before: &str, body: &str| format!("# {title}\n\n{before}{}{}\n", contents(body), body.trim_end());
        let predicted = if self.predictions.is_some() {
            format!(" [Predictions]({PREDICTIONS}) of experiments that the paper did not make.")
        } else {
            String::new()
        };
        let runs = format!("{}\n\n{legend}", self.text.trim_end());
        let mut composed = match &self.first_screen {
            None => {
                let body = format!("{made}\n\n{}{runs}", self.printed);
                Composed::page(whole(family, &format!("{answer}{counted}{led}"), &body), self.pictures)
            }
            Some(first) => {
                let rest = format!(
                    "[Printed tables beside ours, cell by cell]({TABLES}), with what was found out. [Every run behind them]({RUNS}).{predicted}"
                );
                let mut composed = Composed::page(format!("# {family}\n\n{answer}{}\n\n{rest}\n\n{made}\n", first.trim()), self.pictures);
                let up = format!("[The paper in one screen]({PAGE}).\n\n");
                let pages = [
                    (TABLES, whole(&format!("{family}: printed tables"), &format!("{up}{counted}"), &self.printed)),
                    (RUNS, whole(&format!("{family}: runs"), &format!("{up}{led}"), &runs)),
                ];
                composed.pages.extend(pages.map(|(name, text)| (name.to_owned(), text)));
                composed
            }
        };
        composed.pages.extend(self.predictions.map(|text| (PREDICTIONS.to_owned(), text)));
        composed.pages.extend(self.beside.into_iter().map(|(name, text)| (name.to_owned(), text)));
        composed
    }
}

/// In what a run was not the scenario of the file: other trials, seed or methods.
fn deviations(loaded: &Loaded) -> String {
    let (scenario, head) = (&loaded.scenario, &loaded.head);
    if loaded.unavailable().is_some() {
        return String::new();
    }
    let mut found = Vec::new();
    let trials = loaded.calibrations.as_ref().map_or(loaded.scores.trials, |found| found.trials);
    if trials != scenario.trials {
        found.push(format!("{trials} trials in place of {}", scenario.trials));
    }
    if head.run.seed != scenario.seed {
        found.push(format!("seed {} in place of {}", head.run.seed, scenario.seed));
    }
    let has = |label: &str| head.methods.iter().any(|method| &*method.label == label);
    let methods = scenario.methods.iter().filter(|label| !has(label)).count();
    if methods > 0 || head.methods.len() != scenario.methods.len() {
        found.push("other methods".to_owned());
    }
    if found.is_empty() { String::new() } else { format!("**Not the scenario as its file says: {}.**\n\n", found.join(", ")) }
}
