//! One entry of the store: trial after trial of what a method made, to the last bit.

use std::collections::{BTreeSet, HashMap};
use std::io::{self, Read, Write};
use std::sync::{Arc, Mutex, PoisonError};

use calibench_model::{PixelPoint, Rejection};
use calibench_records::figures::{FigureNames, Group};
use calibench_records::results::{Calibrated, Figure, Outcome, PointResult};
use calibench_store::{Found, NewEntry};
use serde::{Deserialize, Serialize};

/// What is kept of a trial.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Points.
    pub points: Vec<PointResult>,
    /// Views without approximate positions, and why.
    pub missed_views: Vec<(Arc<str>, String)>,
    /// What was adjusted.
    pub adjusted: Vec<Calibrated>,
    /// What was counted.
    pub counted: Vec<Calibrated>,
    /// Whether it was counted for all methods at once.
    pub common: bool,
    /// Bounds of points, in their order.
    pub bounds: Vec<Option<f64>>,
}

impl Frame {
    /// Puts it in the place of `method` in the list of methods.
    pub fn belongs_to(&mut self, method: Option<usize>) {
        let Some(method) = method else { return };
        self.points.iter_mut().for_each(|point| point.method = method);
        self.adjusted.iter_mut().for_each(|one| one.method = method);
        if !self.common {
            self.counted.iter_mut().for_each(|one| one.method = method);
        }
    }

    /// Gives its points their bounds, from a frame of its own.
    pub fn bound(&mut self, bounds: &Self) {
        self.points.iter_mut().zip(&bounds.bounds).for_each(|(point, bound)| point.bound = *bound);
    }

    /// Adds another method's.
    pub fn join(&mut self, other: Self) {
        self.points.extend(other.points);
        self.adjusted.extend(other.adjusted);
        // What is counted for all methods at once every one of them has.
        if !other.common || self.counted.is_empty() {
            self.counted.extend(other.counted);
        }
        if self.missed_views.is_empty() {
            self.missed_views = other.missed_views;
        }
    }
}

/// Numbers of names, which stand in the frame in which they come first.
#[derive(Default)]
struct Numbers {
    known: HashMap<Arc<str>, u32>,
    new: Vec<String>,
}

impl Numbers {
    fn of(&mut self, name: &Arc<str>) -> u32 {
        if let Some(number) = self.known.get(name) {
            return *number;
        }
        let number = self.known.len() as u32;
        self.known.insert(name.clone(), number);
        self.new.push(name.to_string());
        number
    }
}

#[derive(Serialize, Deserialize)]
struct FrameWire {
    names: Vec<String>,
    points: Vec<PointWire>,
    missed_views: Vec<(u32, String)>,
    adjusted: Vec<CalibratedWire>,
    counted: Vec<CalibratedWire>,
    common: bool,
    bounds: Vec<Option<f64>>,
}

#[derive(Serialize, Deserialize)]
struct PointWire {
    view: u32,
    target: u32,
    method: u32,
    outcome: OutcomeWire,
    predicted: Option<f64>,
}

#[derive(Serialize, Deserialize)]
enum OutcomeWire {
    Measured(f64, f64),
    Scored(f64, f64, f64, f64),
    /// The place in [`Rejection::ALL`].
    Rejected(u8),
}

#[derive(Serialize, Deserialize)]
struct CalibratedWire {
    method: u32,
    set: u32,
    outcome: Result<Vec<FigureWire>, String>,
    check_failed: Option<String>,
}

#[derive(Serialize, Deserialize)]
struct FigureWire {
    /// The place in [`Group::ALL`].
    group: u8,
    name: u32,
    value: f64,
    sigma: Option<f64>,
    error: Option<f64>,
    unit: u32,
}

/// Writes frames.
pub struct FrameWriter {
    entry: NewEntry,
    numbers: Numbers,
}

impl FrameWriter {
    /// Into `entry`.
    pub fn new(entry: NewEntry) -> Self {
        Self { entry, numbers: Numbers::default() }
    }

    /// Writes the next one.
    ///
    /// # Errors
    /// What the file system refuses.
    pub fn write(&mut self, frame: &Frame) -> io::Result<()> {
        let numbers = &mut self.numbers;
        let points = frame.points.iter().map(|point| point_wire(point, numbers)).collect();
        let missed_views = frame.missed_views.iter().map(|(view, why)| (numbers.of(view), why.clone())).collect();
        let [adjusted, counted] =
            [&frame.adjusted, &frame.counted].map(|all| all.iter().map(|one| calibrated_wire(one, numbers)).collect::<Vec<_>>());
        let names = std::mem::take(&mut numbers.new);
        let wire = FrameWire { names, points, missed_views, adjusted, counted, common: frame.common, bounds: frame.bounds.clone() };
        let bytes = postcard::to_stdvec(&wire).map_err(io::Error::other)?;
        self.entry.write_all(&(bytes.len() as u64).to_le_bytes())?;
        self.entry.write_all(&bytes)
    }

    /// Puts the entry into its place.
    ///
    /// # Errors
    /// What the file system refuses.
    pub fn finish(self) -> io::Result<()> {
        self.entry.finish()
    }
}

fn point_wire(point: &PointResult, numbers: &mut Numbers) -> PointWire {
    let outcome = match point.outcome {
        Outcome::Measured { position: PixelPoint { x, y, .. }, error: None } => OutcomeWire::Measured(x, y),
        Outcome::Measured { position: PixelPoint { x, y, .. }, error: Some((dx, dy)) } => OutcomeWire::Scored(x, y, dx, dy),
        Outcome::Rejected(why) => OutcomeWire::Rejected(place(&Rejection::ALL, |known| *known == why)),
    };
    let (view, target) = (numbers.of(&point.view), numbers.of(&point.target));
    PointWire { view, target, method: point.method as u32, outcome, predicted: point.predicted }
}

fn calibrated_wire(one: &Calibrated, numbers: &mut Numbers) -> CalibratedWire {
    let mut figure = |figure: &Figure| FigureWire {
        group: place(&Group::ALL, |(known, _)| *known == figure.name.group()),
        name: numbers.of(figure.name.shared()),
        value: figure.value,
        sigma: figure.sigma,
        error: figure.error,
        unit: numbers.of(&figure.unit.into()),
    };
    let outcome = one.outcome.as_ref().map(|figures| figures.iter().map(&mut figure).collect()).map_err(Clone::clone);
    CalibratedWire { method: one.method as u32, set: one.set as u32, outcome, check_failed: one.check_failed.clone() }
}

/// Every rejection and every group of figures is in its list.
fn place<T>(all: &[T], is: impl Fn(&T) -> bool) -> u8 {
    all.iter().position(is).unwrap_or(usize::from(u8::MAX)) as u8
}

/// Reads frames.
pub struct FrameReader {
    found: Found,
    names: Vec<Arc<str>>,
    figures: FigureNames,
}

impl FrameReader {
    /// From what was `found`.
    pub fn new(found: Found) -> Self {
        Self { found, names: Vec::new(), figures: FigureNames::default() }
    }

    /// The next one.
    ///
    /// # Errors
    /// What the file system refuses, and an entry that ends before, or holds what none was written with: its key was another's.
    pub fn next(&mut self) -> io::Result<Frame> {
        let mut size = [0; 8];
        self.found.read_exact(&mut size)?;
        let mut bytes = Vec::new();
        Read::by_ref(&mut self.found).take(u64::from_le_bytes(size)).read_to_end(&mut bytes)?;
        let wire: FrameWire = postcard::from_bytes(&bytes).map_err(io::Error::other)?;
        self.names.extend(wire.names.iter().map(|name| name.as_str().into()));
        self.frame(wire).ok_or_else(|| io::Error::new(io::ErrorKind::InvalidData, "an entry of the store names what there is not"))
    }

    fn frame(&mut self, wire: FrameWire) -> Option<Frame> {
        let (names, figures) = (&self.names, &mut self.figures);
        let name = |number: u32| names.get(number as usize).cloned();
        let point = |wire: PointWire| {
            let outcome = match wire.outcome {
                OutcomeWire::Measured(x, y) => Outcome::Measured { position: PixelPoint::new(x, y), error: None },
                OutcomeWire::Scored(x, y, dx, dy) => Outcome::Measured { position: PixelPoint::new(x, y), error: Some((dx, dy)) },
                OutcomeWire::Rejected(why) => Outcome::Rejected(*Rejection::ALL.get(usize::from(why))?),
            };
            Some(PointResult {
                predicted: wire.predicted,
                ..PointResult::new(name(wire.view)?, name(wire.target)?, wire.method as usize, outcome)
            })
        };
        let mut figure = |wire: FigureWire| {
            let (group, _) = *Group::ALL.get(usize::from(wire.group))?;
            let FigureWire { value, sigma, error, .. } = wire;
            let (_, figure) = figures.get(group, &name(wire.name)?).ok()?;
            Some(Figure { name: figure, value, sigma, error, unit: unit(&name(wire.unit)?) })
        };
        let mut calibrated = |wire: CalibratedWire| {
            let outcome = match wire.outcome {
                Ok(figures) => Ok(figures.into_iter().map(&mut figure).collect::<Option<Vec<_>>>()?),
                Err(why) => Err(why),
            };
            Some(Calibrated { method: wire.method as usize, set: wire.set as usize, outcome, check_failed: wire.check_failed })
        };
        Some(Frame {
            points: wire.points.into_iter().map(point).collect::<Option<_>>()?,
            missed_views: wire.missed_views.into_iter().map(|(view, why)| Some((name(view)?, why))).collect::<Option<_>>()?,
            adjusted: wire.adjusted.into_iter().map(&mut calibrated).collect::<Option<_>>()?,
            counted: wire.counted.into_iter().map(&mut calibrated).collect::<Option<_>>()?,
            common: wire.common,
            bounds: wire.bounds,
        })
    }
}

/// The unit of this name. There are a dozen; each is kept once for as long as the program runs.
fn unit(name: &str) -> &'static str {
    static UNITS: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut units = UNITS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = units.get(name) {
        return known;
    }
    let new: &'static str = Box::leak(name.into());
    units.insert(new);
    new
}
