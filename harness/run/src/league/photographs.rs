//! Photographs as a class of the league: calibrators are told halves of them, and their cameras predict the others.

use calibench_calibrators::{HeldOut, Start, Task, TaskImage};
use calibench_images::size_of;
use calibench_judge::{Field, halves};
use calibench_model::PixelPoint;
use calibench_model::camera::ImageSize;
use calibench_records::results::Outcome;
use calibench_scenario::{JudgementPlan, PhotographsSubject, Subject};
use nalgebra::Point3;

use crate::{Plan, RunError, photographs};

/// The place of the method whose points calibrators are told: the scenario's first.
const FIRST: &[usize] = &[0];

/// What was measured in photographs of one camera.
pub struct Photographs<'a> {
    plan: &'a Plan<'a>,
    judgement: &'a JudgementPlan,
    model: &'a str,
    field: Field,
    size: ImageSize,
    images: Vec<TaskImage>,
}

/// What is asked of a split into halves.
pub struct Half {
    /// The half that is told.
    pub task: Task,
    /// The other.
    pub held_out: HeldOut,
}

impl<'a> Photographs<'a> {
    /// Those of `plan`, measured; `None` where its scenario is of none, or asks nothing of calibrators.
    ///
    /// # Errors
    /// In words: photographs that are not there, cannot be read or have several sizes.
    pub fn new(plan: &'a Plan<'a>) -> Result<Option<Self>, RunError> {
        let Subject::Photographs(subject) = &plan.scenario.subject else { return Ok(None) };
        let Some(judgement) = &subject.judgement else { return Ok(None) };
        let Some(model) = &judgement.league else { return Ok(None) };
        if let Some(why) = plan.missing() {
            return Err(RunError::Asked(why));
        }
        let field = Field::Board { board: subject.board, side: judgement.side };
        let size = size_of_all(plan, subject)?;
        let first = Plan { asked: Some(FIRST), ..Plan::new(plan.scenario, plan.tools, plan.data.clone()) };
        let trial = photographs::run(&first, subject, &|| ())?;
        let image = |file: &String| {
            let points = trial.points.iter().filter(|point| *point.view == **file).filter_map(|point| {
                let Outcome::Measured { position, .. } = point.outcome else { return None };
                Some(((0..field.count()).find(|place| field.name(*place) == *point.target)?, position))
            });
            TaskImage { name: file.clone(), points: points.collect() }
        };
        let images = subject.files.iter().map(image).filter(|image| !image.points.is_empty()).collect();
        Ok(Some(Self { plan, judgement, model, field, size, images }))
    }

    /// The model that is asked for.
    pub fn model(&self) -> &str {
        self.model
    }

    /// How often they are split.
    pub fn splits(&self) -> u64 {
        self.judgement.splits
    }

    /// What calibrators are told, as text.
    pub fn told(&self) -> String {
        format!("{} {} {:?} {:?} {:?}", self.model, self.judgement.splits, self.field, self.size, self.images)
    }

    /// Split `number`: the smaller half is told, if their number is odd.
    pub fn half(&self, number: u64) -> Half {
        let all: Vec<usize> = (0..self.images.len()).collect();
        let [told, unseen] = halves(&all, (self.plan.seed, &self.plan.scenario.drawn), number);
        let of = |places: &[usize]| -> Vec<&TaskImage> { places.iter().map(|place| &self.images[*place]).collect() };
        let objects: Vec<Point3<f64>> = (0..self.field.count()).map(|place| Point3::from(self.field.object(place))).collect();
        let held_out = HeldOut::new(&of(&unseen), objects.clone(), &self.field.interleaved(), &self.field.sides());
        let ImageSize { width, height } = self.size;
        let centre = PixelPoint::new(0.5 * f64::from(width - 1), 0.5 * f64::from(height - 1));
        let names = (0..self.field.count()).map(|place| self.field.name(place).into_owned());
        let task = Task {
            model: self.model.to_owned(),
            size: self.size,
            sigma_px: None,
            unit: self.judgement.unit.clone(),
            board: self.board(),
            points: names.zip(objects).collect(),
            points_sigma: 0.0,
            images: of(&told).into_iter().cloned().collect(),
            start: Some(Start { f: f64::from(width.max(height)), centre }),
            grid: held_out.grid(),
            seconds: 0.0,
        };
        Half { task, held_out }
    }

    /// The board in a word, as options have it.
    fn board(&self) -> Option<String> {
        let Field::Board { board, side } = &self.field else { return None };
        Some(format!("chessboard:{}x{}:{side}", board.columns, board.rows))
    }
}

/// The size of all photographs.
fn size_of_all(plan: &Plan<'_>, subject: &PhotographsSubject) -> Result<ImageSize, RunError> {
    let mut sizes = subject.files.iter().map(|file| {
        let path = plan.folder_of(subject).join(file);
        size_of(&path).map_err(|error| RunError::Asked(format!("{}: {error}", path.display())))
    });
    let first = sizes.next().unwrap_or_else(|| Err(RunError::Asked("there is no photograph".to_owned())))?;
    for (size, file) in sizes.zip(&subject.files[1..]) {
        let size = size?;
        if size != first {
            let [a, b] = [size, first].map(|size| format!("{} x {} px", size.width, size.height));
            return Err(RunError::Asked(format!("{file} has {a}, the first photograph {b}: photographs of one camera have one size")));
        }
    }
    Ok(first)
}
