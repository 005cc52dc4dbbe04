//! What is stored of methods, and how it becomes the trials of a run.

use std::io;
use std::sync::Arc;

use calibench_records::results::{Calibrated, PointResult, Trial};
use calibench_scenario::Subject;
use calibench_store::{Key, Store};

use super::frames::{Frame, FrameReader, FrameWriter};
use super::keys::{MethodKeys, Wanted};
use super::{Reuse, Tally};
use crate::Plan;
use crate::made::Made;

/// What one method makes, or all together: read from the store, or computed and put there.
pub struct Unit<'k> {
    keys: &'k MethodKeys,
    points: Source,
    /// `None` where no bounds are asked for, or none are kept.
    bounds: Option<Source>,
    /// `None` where it is not apart.
    adjusted: Option<Source>,
}

enum Source {
    Stored(FrameReader),
    Lacking,
    Writing(Box<FrameWriter>),
}

impl Source {
    fn of(reader: Option<FrameReader>) -> Self {
        reader.map_or(Self::Lacking, Self::Stored)
    }

    fn lacks(&self) -> bool {
        !matches!(self, Self::Stored(_))
    }

    /// The next frame of what is stored.
    fn next(&mut self) -> io::Result<Option<Frame>> {
        match self {
            Self::Stored(reader) => reader.next().map(Some),
            Self::Lacking | Self::Writing(_) => Ok(None),
        }
    }

    /// Writes a frame; once one is refused, none any more.
    fn write(&mut self, frame: impl FnOnce() -> Frame, tally: &Tally) {
        if let Self::Writing(writer) = self
            && tally.unless_refused(writer.write(&frame())).is_none()
        {
            *self = Self::Lacking;
        }
    }

    fn finish(self, tally: &Tally) {
        if let Self::Writing(writer) = self {
            tally.unless_refused(writer.finish());
        }
    }
}

impl<'k> Unit<'k> {
    /// What is in the store of it.
    pub fn find(store: &Store, keys: &'k MethodKeys) -> Self {
        let find = |key: Option<Key>| Source::of(key.and_then(|key| store.find(key)).map(FrameReader::new));
        let [bounds, adjusted] = [keys.bounds, keys.adjusted].map(|wanted| (wanted != Wanted::No).then(|| find(wanted.key())));
        Self { keys, points: find(keys.points), bounds, adjusted }
    }

    /// Whether its points have to be measured.
    pub fn lacks_points(&self) -> bool {
        self.points.lacks()
    }

    /// Whether its points have to be adjusted.
    pub fn lacks_adjusted(&self) -> bool {
        self.adjusted.as_ref().is_some_and(Source::lacks)
    }

    /// Whether the bounds of its points have to be computed.
    pub fn lacks_bounds(&self) -> bool {
        self.bounds.as_ref().is_some_and(Source::lacks)
    }

    /// Whether anything of it has to be computed.
    pub fn lacks_anything(&self) -> bool {
        self.lacks_points() || self.lacks_bounds() || self.lacks_adjusted()
    }

    /// Its place among the methods; 0 of all together.
    pub fn place(&self) -> usize {
        self.keys.method.unwrap_or(0)
    }

    /// Begins the entries of what is lacking.
    pub fn begin(&mut self, reuse: Reuse<'_>) {
        let begin = |key: Option<Key>| {
            let entry = reuse.tally.unless_refused(reuse.store.create(key?))?;
            Some(Source::Writing(Box::new(FrameWriter::new(entry))))
        };
        if self.points.lacks() {
            self.points = begin(self.keys.points).unwrap_or(Source::Lacking);
        }
        for (source, wanted) in [(&mut self.bounds, self.keys.bounds), (&mut self.adjusted, self.keys.adjusted)] {
            if let Some(source) = source.as_mut().filter(|source| source.lacks()) {
                *source = begin(wanted.key()).unwrap_or(Source::Lacking);
            }
        }
    }

    /// Writes what is its own of a trial.
    pub fn write(&mut self, trial: &Merged, tally: &Tally) {
        let Self { keys, points, bounds, adjusted } = self;
        let mine = |method: usize| keys.method.is_none_or(|own| own == method);
        let of = |all: &[Calibrated]| all.iter().filter(|one| mine(one.method)).cloned().collect::<Vec<_>>();
        let whole = &trial.whole;
        points.write(
            || {
                let counted = if trial.common { trial.counted.clone() } else { of(&trial.counted) };
                Frame {
                    points: whole.points.iter().filter(|point| mine(point.method)).cloned().collect(),
                    missed_views: whole.missed_views.clone(),
                    adjusted: if adjusted.is_some() { Vec::new() } else { of(&whole.calibrations) },
                    counted,
                    common: trial.common,
                    bounds: Vec::new(),
                }
            },
            tally,
        );
        if let Some(bounds) = bounds {
            let of_mine = || whole.points.iter().filter(|point| mine(point.method)).map(|point| point.bound).collect();
            bounds.write(|| Frame { bounds: of_mine(), ..Frame::default() }, tally);
        }
        if let Some(adjusted) = adjusted {
            adjusted.write(|| Frame { adjusted: of(&whole.calibrations), ..Frame::default() }, tally);
        }
    }

    /// Puts what was written into its place.
    pub fn finish(self, tally: &Tally) {
        [Some(self.points), self.bounds, self.adjusted].into_iter().flatten().for_each(|source| source.finish(tally));
    }
}

/// What is stored of a trial.
#[derive(Default)]
pub struct Kept {
    /// Which.
    pub number: u64,
    frame: Frame,
    /// Bounds of points that are not.
    bounds: Vec<(Option<usize>, Frame)>,
}

impl Kept {
    /// The next trial, `number`, of what is stored of `units`.
    ///
    /// # Errors
    /// What the file system refuses.
    pub fn read(number: u64, units: &mut [Unit<'_>]) -> io::Result<Self> {
        let mut kept = Self { number, ..Self::default() };
        for Unit { keys, points, bounds, adjusted } in units {
            let mut own = points.next()?;
            let [bounds, adjusted] = [bounds, adjusted].map(|source| source.as_mut().map(Source::next));
            match (&mut own, bounds.transpose()?.flatten()) {
                (Some(points), Some(bounds)) => points.bound(&bounds),
                // Of points that are measured anew.
                (None, Some(bounds)) => kept.bounds.push((keys.method, bounds)),
                (_, None) => {}
            }
            for mut frame in own.into_iter().chain(adjusted.transpose()?.flatten()) {
                frame.belongs_to(keys.method);
                kept.frame.join(frame);
            }
        }
        Ok(kept)
    }
}

/// A trial that is put together of what was stored and what was computed.
pub struct Merged {
    /// Its points, and what was adjusted from them.
    pub whole: Trial,
    /// What was counted beside the points.
    pub counted: Vec<Calibrated>,
    /// Whether it was counted for all methods at once.
    pub common: bool,
}

/// What was `kept` of a trial together with what was `made` of it, in the order in which one run makes all of it.
pub fn merged(plan: &Plan<'_>, kept: Kept, made: Made) -> Merged {
    let common = matches!(&plan.scenario.subject, Subject::Views(views) if views.recognition.is_some());
    let Kept { number, frame, bounds } = kept;
    let mut points = joined(frame.points, made.trial.points, |point: &PointResult| point.method);
    for (method, bounds) in bounds {
        let mine = points.iter_mut().filter(|point| method.is_none_or(|own| own == point.method));
        mine.zip(bounds.bounds).for_each(|(point, bound)| point.bound = bound);
    }
    let calibrations = joined(frame.adjusted, made.trial.calibrations, |one: &Calibrated| one.method);
    let counted = if common {
        if made.counted.is_empty() { frame.counted } else { made.counted }
    } else {
        joined(frame.counted, made.counted, |one: &Calibrated| one.method)
    };
    let missed_views: Vec<(Arc<str>, String)> =
        if made.trial.missed_views.is_empty() { frame.missed_views } else { made.trial.missed_views };
    Merged { whole: Trial { number, points, missed_views, calibrations }, counted, common }
}

/// Both by method; what is of one alone stays in its order.
fn joined<T>(mut kept: Vec<T>, made: Vec<T>, method: impl Fn(&T) -> usize) -> Vec<T> {
    if kept.is_empty() {
        return made;
    }
    if !made.is_empty() {
        kept.extend(made);
        kept.sort_by_key(method);
    }
    kept
}

impl Merged {
    /// Adds what was adjusted apart.
    pub fn add_adjusted(&mut self, more: Vec<Calibrated>) {
        self.whole.calibrations = joined(std::mem::take(&mut self.whole.calibrations), more, |one: &Calibrated| one.method);
    }

    /// The trial as a run hands it on.
    pub fn into_whole(self) -> Trial {
        Made { trial: self.whole, counted: self.counted }.into_trial()
    }
}
