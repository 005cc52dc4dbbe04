//! `calibench league`.

use std::time::{Duration, Instant};

use calibench_calibrators::Listed;
use calibench_files::atomic::write_atomically;
use calibench_records::league::{self as records, Answered, UNAVAILABLE, file_of, median, read, read_classes, write, written_classes};
use calibench_run::Plan;
use calibench_run::league::{Bout, Class};
use calibench_scenario::{Scenario, Study, Subject};
use clap::Args;

use super::context::Context;
use super::progress::Progress;
use crate::failure::Failure;
use crate::stored::program;

#[derive(Args)]
pub struct League {
    /// Classes: scenarios with [calibrators], or photographs with `league` in [judgement] [default: all of the project]
    #[arg(value_name = "CLASS")]
    classes: Vec<String>,
    /// These calibrators alone, by name or by system [default: all that can run here]
    #[arg(long = "system", short, value_name = "NAME")]
    systems: Vec<String>,
    /// Ask again what is up to date
    #[arg(long)]
    fresh: bool,
    /// Begin nothing more after so many minutes; the next call goes on from there
    #[arg(long, value_name = "N")]
    minutes: Option<f64>,
}

impl League {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let mut scenarios =
            if self.classes.is_empty() { context.scenarios(&context.catalogue()?.names()?)? } else { context.scenarios(&self.classes)? };
        if self.classes.is_empty() {
            scenarios.retain(|scenario| model_of(scenario).is_some());
        } else if let Some(other) = scenarios.iter().find(|scenario| model_of(scenario).is_none()) {
            let message = "expected a scenario with [calibrators], or photographs with `league` in [judgement]";
            return Err(Failure::input(format!("{}: {message}", other.name)));
        }
        if scenarios.is_empty() {
            return Err(Failure::input(
                "there is no class: expected scenarios with [calibrators], or photographs with `league` in [judgement]",
            ));
        }
        let calibrators = self.chosen(context)?;
        let tools = context.tools()?;
        let plans =
            scenarios.iter().map(|scenario| Ok(Plan::new(scenario, tools, context.data()?))).collect::<Result<Vec<_>, Failure>>()?;
        let mut classes = Vec::new();
        for plan in &plans {
            match plan.missing() {
                Some(why) => say!("{}: unavailable: {why}", plan.scenario.name),
                None => classes.extend(Class::new(plan)?),
            }
        }
        write_classes(context, &scenarios)?;
        let (begun, mut left, mut asked) = (Instant::now(), 0_usize, 0_usize);
        for listed in calibrators {
            let version = match listed.calibrator.version() {
                Ok(version) => version,
                Err(why) => {
                    say!("{}: unavailable: {why}", listed.name);
                    continue;
                }
            };
            let done = self.of_calibrator(context, Bout { listed, version: &version }, &classes, begun)?;
            asked += done.0;
            left += done.1;
        }
        say!(
            "league: {asked} cells asked, {left} left for want of time, the others are up to date; `calibench report league` writes the page"
        );
        Ok(())
    }

    /// How many classes `bout` was asked, and how many were left.
    fn of_calibrator(
        &self,
        context: &Context<'_>,
        bout: Bout<'_>,
        classes: &[Class<'_>],
        begun: Instant,
    ) -> Result<(usize, usize), Failure> {
        let path = context.places()?.league.join(file_of(&bout.listed.name));
        let mut rows = read(&path)?;
        let (mut asked, mut left) = (0, 0);
        let code = program(context).unwrap_or_default();
        for class in classes {
            let digest = class.digest(bout.listed, &code);
            if !self.fresh && class.is_up_to_date(&rows, &digest, bout.version) {
                continue;
            }
            if self.minutes.is_some_and(|minutes| begun.elapsed() > Duration::from_secs_f64(60.0 * minutes.max(0.0))) {
                left += 1;
                continue;
            }
            let what = format!("{} {}", bout.listed.name, class.name());
            let progress = Progress::start(&what, class.trials(), context.quiet);
            let mut found = class.rows(bout, &digest, &|| progress.step())?;
            progress.more(class.trials_after(&found) - class.trials());
            found.extend(class.further(bout, &digest, &found, &|| progress.step())?);
            progress.finish(&summary(&found));
            rows.retain(|row| row.class != class.name());
            rows.extend(found);
            rows.sort_by(|a, b| (&a.class, a.trial).cmp(&(&b.class, b.trial)));
            // Class by class: what is interrupted goes on from here.
            if let Some(folder) = path.parent() {
                std::fs::create_dir_all(folder)?;
            }
            write_atomically(&path, |file| write(file, &rows))?;
            asked += 1;
        }
        Ok((asked, left))
    }

    /// The calibrators that are meant.
    fn chosen<'a>(&self, context: &'a Context<'_>) -> Result<Vec<&'a Listed>, Failure> {
        let all = context.tools()?.calibrators;
        let is_called = |listed: &Listed, name: &String| listed.name == *name || listed.system == *name;
        if let Some(unknown) = self.systems.iter().find(|name| !all.iter().any(|listed| is_called(listed, name))) {
            let known: Vec<&str> = all.iter().map(|listed| listed.name.as_str()).collect();
            return Err(Failure::input(format!("no calibrator or system is called `{unknown}`: expected some of {}", known.join(", "))));
        }
        // A calibrator's own name means it alone, though its system be called so.
        let is_one = |name: &String| all.iter().any(|listed| listed.name == *name);
        let is_meant =
            |listed: &Listed| self.systems.iter().any(|name| if is_one(name) { listed.name == *name } else { listed.system == *name });
        Ok(all.iter().filter(|listed| self.systems.is_empty() || is_meant(listed)).collect())
    }
}

/// The camera model that calibrators are asked for; `None` of a scenario that is no class.
fn model_of(scenario: &Scenario) -> Option<&str> {
    match &scenario.subject {
        Subject::Views(views) => match &views.study {
            Study::Calibrators(study) => Some(&study.model),
            _ => None,
        },
        Subject::Photographs(photographs) => photographs.judgement.as_ref()?.league.as_deref(),
        Subject::Scene(_) | Subject::Printed(_) => None,
    }
}

/// Writes what the classes are beside their tables.
fn write_classes(context: &Context<'_>, scenarios: &[Scenario]) -> Result<(), Failure> {
    let folder = context.places()?.league;
    let mut classes = read_classes(&folder)?;
    for scenario in scenarios {
        let Some(model) = model_of(scenario) else { continue };
        classes.retain(|class| class.class != scenario.name);
        let why = scenario.why.split_whitespace().collect::<Vec<_>>().join(" ");
        classes.push(records::Class {
            class: scenario.name.clone(),
            why,
            model: model.to_owned(),
            photographs: matches!(scenario.subject, Subject::Photographs(_)),
        });
    }
    classes.sort_by(|a, b| a.class.cmp(&b.class));
    let (name, bytes) = written_classes(&classes)?;
    std::fs::create_dir_all(&folder)?;
    Ok(write_atomically(&folder.join(name), |file| file.write_all(&bytes))?)
}

/// What came of a class in a line.
fn summary(rows: &[Answered]) -> String {
    if rows.iter().all(|row| row.status == UNAVAILABLE) {
        return rows.first().map_or_else(String::new, |row| row.message.clone());
    }
    let frames = || rows.iter().map(|row| row.frame.or(row.held_out));
    let px = median(frames()).filter(|px| px.is_finite());
    let median = px.map_or_else(|| "no camera in most trials".to_owned(), |px| format!("{px:.3} px in the median"));
    let silent = rows.iter().filter(|row| row.silent).count();
    format!("{median}, {} of {} trials with a camera, {silent} wrong and silent", frames().flatten().count(), rows.len())
}
