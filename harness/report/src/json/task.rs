//! What a task costs, as JSON.

use calibench_task::{Budget, Component, Exact, Map, Part, Task};
use schemars::JsonSchema;
use serde::Serialize;

use super::Answer;
use crate::task::unit_of;

/// How well something will be measured, and what makes that up.
#[derive(Serialize, JsonSchema)]
pub struct TaskAnswer {
    /// `length`, `point`, `angle`, `plane` or `rotation`.
    measured: &'static str,
    /// The unit of the object, as the task names it; null where it does not.
    unit: Option<String>,
    /// The numbers that are measured: one of a length or an angle, three of a point, a plane or a rotation.
    numbers: Vec<Number>,
    /// What is taken as exact, in words.
    exact: Vec<&'static str>,
    /// Whether the camera's parameters are taken as independent, since its file has no correlations.
    uncorrelated: bool,
    /// By how many times the camera errs more than its covariance says, as photographs that are left out or halves of them show; null where nobody looked.
    halves: Option<f64>,
    /// By which part of half an interval its ends are elsewhere than the derivatives say, the largest; null where the measurement fails there.
    bent: Option<f64>,
    /// Why the answer is in doubt, and the exit code 3.
    doubts: Vec<String>,
    /// The same measured elsewhere, a plane each; empty where no map was asked for.
    maps: Vec<Plane>,
}

#[derive(Serialize, JsonSchema)]
struct Number {
    /// What it is.
    name: &'static str,
    /// `degrees`, or the unit of the object; null where it has no name.
    unit: Option<String>,
    /// Its value; null where only its error has a meaning.
    value: Option<f64>,
    /// Its standard uncertainty.
    sigma: f64,
    /// Half of its 95 % interval.
    half: f64,
    /// Where it is measured at 95 %, from here; null without a value.
    from: Option<f64>,
    /// To here.
    to: Option<f64>,
    /// What makes up the uncertainty.
    sources: Vec<Share>,
}

#[derive(Serialize, JsonSchema)]
#[expect(clippy::struct_field_names, reason = "keys")]
struct Share {
    /// What errs.
    source: &'static str,
    /// The standard uncertainty that it makes alone.
    sigma: f64,
    /// Its share of the variance, 0 to 1.
    share: f64,
}

#[derive(Serialize, JsonSchema)]
struct Plane {
    /// Names of its two axes.
    axes: [String; 2],
    /// From where to where along both, object units.
    extent: [[f64; 2]; 2],
    /// The axis across; null of a plane that is not along the object's axes.
    across: Option<&'static str>,
    /// Where the plane lies along it, object units; null likewise.
    at: Option<f64>,
    /// Places along both axes.
    grid: [usize; 2],
    /// Row by row, the first axis along a row: half of the 95 % interval, of several numbers the largest in the unit of the first; null where it cannot be measured.
    half: Vec<Option<f64>>,
    /// The source that makes the most of it; null likewise.
    largest: Vec<Option<&'static str>>,
}

impl Answer for TaskAnswer {
    const COMMAND: &'static str = "task";
    const SCHEMA: u32 = 1;
}

impl TaskAnswer {
    /// Of a task and its budget, with what is in doubt, what halves show, and maps.
    pub fn new(task: &Task, budget: &Budget, doubts: Vec<String>, halves: Option<f64>, maps: &[Map]) -> Self {
        Self {
            measured: task.quantity.word(),
            unit: task.unit.clone(),
            numbers: budget.components.iter().map(|component| number(task, component)).collect(),
            exact: budget.exact.iter().map(|exact| Exact::words(*exact)).collect(),
            uncorrelated: budget.uncorrelated,
            halves,
            bent: budget.bent,
            doubts,
            maps: maps.iter().map(plane).collect(),
        }
    }
}

fn number(task: &Task, component: &Component) -> Number {
    let part = |part: &Part| Share { source: part.source.words(), sigma: part.sigma, share: part.share };
    let interval = component.interval();
    Number {
        name: component.named.name,
        unit: unit_of(task, component).map(str::to_owned),
        value: component.named.value,
        sigma: component.sigma,
        half: component.half(),
        from: interval.map(|ends| ends[0]),
        to: interval.map(|ends| ends[1]),
        sources: component.parts.iter().map(part).collect(),
    }
}

fn plane(map: &Map) -> Plane {
    Plane {
        axes: map.axes.clone(),
        extent: map.extent,
        across: map.at.map(|at| at.0),
        at: map.at.map(|at| at.1),
        grid: map.grid,
        half: map.cells.iter().map(|cell| cell.map(|cell| cell.half)).collect(),
        largest: map.cells.iter().map(|cell| cell.map(|cell| cell.largest.words())).collect(),
    }
}
