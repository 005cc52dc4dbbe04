//! Measured points as JSON.

use std::borrow::Cow;
use std::cell::RefCell;

use calibench_exchange::{MeasuredRow, Outcome};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Serialize, Serializer};

use super::Answer;

/// Points in photographs.
#[derive(Serialize, JsonSchema)]
#[serde(bound = "")]
#[schemars(bound = "")]
pub struct MeasurementAnswer<'a, I: Iterator<Item = MeasuredRow<'a>>> {
    /// How many points there are of each status.
    counts: MeasurementCounts,
    /// A row for each method and each point of its kinds, in the order given.
    points: Points<I>,
}

/// Points by their status.
#[derive(Clone, Copy, Default, Serialize, JsonSchema)]
pub struct MeasurementCounts {
    /// With a position.
    pub measured: usize,
    /// Seen and rejected.
    pub rejected: usize,
    /// Never tried: their photograph was not given, or no method measures their kind.
    pub unavailable: usize,
}

impl<'a, I: Iterator<Item = MeasuredRow<'a>>> MeasurementAnswer<'a, I> {
    /// Of rows, which are written one by one: there may be ten million.
    pub fn new(counts: MeasurementCounts, rows: I) -> Self {
        Self { counts, points: Points(RefCell::new(Some(rows))) }
    }
}

impl<'a, I: Iterator<Item = MeasuredRow<'a>>> Answer for MeasurementAnswer<'a, I> {
    const COMMAND: &'static str = "measure";
    const SCHEMA: u32 = 1;
}

/// Rows that are written once.
struct Points<I>(RefCell<Option<I>>);

impl<'a, I: Iterator<Item = MeasuredRow<'a>>> Serialize for Points<I> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.borrow_mut().take().into_iter().flatten().map(Point::from))
    }
}

impl<I> JsonSchema for Points<I> {
    fn schema_name() -> Cow<'static, str> {
        "Points".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        generator.subschema_for::<Vec<Point<'static>>>()
    }
}

/// A point of a photograph.
#[derive(Serialize, JsonSchema)]
struct Point<'a> {
    /// Name of the photograph.
    image: Cow<'a, str>,
    /// Name of the target.
    target: Cow<'a, str>,
    /// The method; empty where none measures points of its kind.
    method: Cow<'a, str>,
    /// `measured`, `rejected` or `unavailable`.
    status: &'static str,
    /// Column, px from the centre of the first pixel; null where it was not measured.
    x: Option<f64>,
    /// Row, px downwards.
    y: Option<f64>,
    /// Variance of x, px squared, where the method states it.
    sxx: Option<f64>,
    /// Covariance of x and y, px squared.
    sxy: Option<f64>,
    /// Variance of y, px squared.
    syy: Option<f64>,
    /// Why it was not measured.
    reason: Option<Cow<'a, str>>,
}

impl<'a> From<MeasuredRow<'a>> for Point<'a> {
    fn from(MeasuredRow { given, method, outcome }: MeasuredRow<'a>) -> Self {
        let (found, status, reason) = match outcome {
            Outcome::Measured(found) => (Some(found), "measured", None),
            Outcome::Rejected(rejection) => (None, "rejected", Some(rejection.name().into())),
            Outcome::Unavailable(why) => (None, "unavailable", Some(why.into())),
        };
        let covariance = found.and_then(|found| found.covariance);
        Self {
            image: given.image.into(),
            target: given.target.into(),
            method: method.into(),
            status,
            x: found.map(|found| found.position.x),
            y: found.map(|found| found.position.y),
            sxx: covariance.map(|covariance| covariance.sxx),
            sxy: covariance.map(|covariance| covariance.sxy),
            syy: covariance.map(|covariance| covariance.syy),
            reason,
        }
    }
}
