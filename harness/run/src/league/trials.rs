//! Trials of a scenario, one by one, for whoever asks calibrators himself.

use calibench_scenario::studies::calibrators::Calibrators;
use calibench_scenario::{Study, Subject, ViewsSubject};

use crate::studies::calibrators::{Asked, asked};
use crate::{Plan, RunError, views};

/// What makes the trials of a scenario.
pub struct Trials<'a> {
    plan: &'a Plan<'a>,
    subject: &'a ViewsSubject,
    study: &'a Calibrators,
    views: views::Trials<'a>,
}

impl<'a> Trials<'a> {
    /// Those of `plan`; `None` where its scenario tells nothing to calibrators.
    ///
    /// # Errors
    /// Optics or views that cannot be pictured.
    pub fn new(plan: &'a Plan<'a>) -> Result<Option<Self>, RunError> {
        let Subject::Views(subject) = &plan.scenario.subject else { return Ok(None) };
        let Study::Calibrators(study) = &subject.study else { return Ok(None) };
        Ok(Some(Self { plan, subject, study, views: views::Trials::new(plan, subject)? }))
    }

    /// The model that is asked for.
    pub fn model(&self) -> &str {
        &self.study.model
    }

    /// Whether image points are drawn, so that another trial costs next to nothing.
    pub fn are_drawn(&self) -> bool {
        self.study.drawn.is_some()
    }

    /// What calibrators are told beside the points, as text.
    pub fn told(&self) -> String {
        let Calibrators { model, sigma_px, drawn, start_f, distance, faults, .. } = self.study;
        format!("{model} {sigma_px:?} {drawn:?} {start_f} {distance} {faults:?}")
    }

    /// What is asked in trial `number`, about the points of the first method.
    ///
    /// # Errors
    /// Images that cannot be rendered; in words, a trial without points.
    pub fn asked(&self, number: u64) -> Result<Asked<'a>, RunError> {
        let points = self.views.points(self.plan, number)?;
        asked(self.study, self.subject, (&points, 0), self.plan.key(number)).map_err(|why| std::io::Error::other(why).into())
    }
}
