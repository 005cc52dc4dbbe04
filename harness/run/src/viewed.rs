//! The views of a trial: drawn and measured side by side, put together in their order.

use std::sync::Arc;

use calibench_images::encode_png_densely;
use calibench_measure::{Configured, ImageId};
use calibench_model::{Image, TargetKind};
use calibench_random::Key;
use calibench_records::names::kept_image_name;
use calibench_records::results::{PointResult, Trial};
use calibench_synth::view::TargetTruth;
use rayon::prelude::*;

use super::detection::{Tally, TruePlaces};
use super::prepared::{Pointed, Prepared, PreparedView, is_pointed_at, kind_of, seen, started};
use super::studies::recognition::{Counted, Recognised, keep_steps, recognise, shown};
use super::{Plan, RunError};
use crate::made::Made;
use crate::measured::{Answers, Asked, Pictured};

/// What was made of one view.
struct Viewed {
    /// Where it may be kept; of thousands of trials nobody looks at it again.
    image: Option<Image<'static>>,
    /// By method, with its place.
    points: Vec<(usize, Vec<PointResult>)>,
    /// The kinds of the targets that are pointed at.
    kinds: Vec<TargetKind>,
    counted: Counted,
    tally: Tally,
}

pub(super) fn run_views(plan: &Plan<'_>, prepared: &Prepared<'_>, key: Key<'_>) -> Result<Made, RunError> {
    let mut first = FirstViews::of(plan, prepared);
    let mut by_method: Vec<Vec<PointResult>> = vec![Vec::new(); plan.methods.len()];
    let (mut counted, mut tally) = (Counted::default(), Tally::default());
    let views: Vec<(usize, &PreparedView<'_>)> = prepared.views.iter().enumerate().collect();
    // What may be kept is in memory: as many images as threads.
    for batch in views.chunks(rayon::current_num_threads()) {
        let viewed = batch.par_iter().map(|&(place, view)| of_view(plan, prepared, (place, view), key)).collect::<Vec<_>>();
        for (&(place, view), viewed) in batch.iter().zip(viewed) {
            let viewed = viewed?;
            viewed.points.into_iter().for_each(|(method, points)| by_method[method].extend(points));
            counted.join(viewed.counted);
            tally.join(viewed.tally);
            let is_shown =
                first.is_in(place, &viewed.kinds) || prepared.subject.recognition.as_ref().is_some_and(|plan| shown(plan) == Some(place));
            if let (Some(folder), Some(image)) = (plan.images, viewed.image.filter(|_| is_shown)) {
                // Pages show 8 bits, and noise below the levels of a sensor, or of an image without any, does not compress.
                let deep = prepared.subject.imaging.has_deep_levels();
                folder.write(&kept_image_name(&view.station.name), |file| encode_png_densely(file, &image, deep))?;
            }
        }
    }
    let trial = Trial { number: key.trial, points: by_method.into_iter().flatten().collect(), ..Trial::default() };
    let recognised = prepared.subject.recognition.as_ref().map(|plan| counted.calibrated(plan, prepared.subject.sets().len() - 1));
    Ok(Made { trial, counted: recognised.into_iter().chain(tally.calibrated(0)).collect() })
}

fn of_view(plan: &Plan<'_>, prepared: &Prepared<'_>, (place, view): (usize, &PreparedView<'_>), key: Key<'_>) -> Result<Viewed, RunError> {
    let image = prepared.image(view, key)?.image;
    let seen = seen(prepared, view, Key { view: &view.station.name, ..key });
    let mut tally = Tally::default();
    let (starts, counted) = match &prepared.subject.recognition {
        Some(recognition) => {
            if let Some(folder) = plan.images.filter(|_| key.trial == 0) {
                keep_steps(recognition, &image, (place, &view.station.name), folder)?;
            }
            let Recognised { starts, counted } = recognise(recognition, &image, (place, view), &prepared.subject.field);
            (seen.iter().map(|point| starts.get(&point.target).copied()).collect(), counted)
        }
        None => (started(prepared, &image, &seen), Counted::default()),
    };
    let name = |point: &Pointed| &*prepared.targets[point.target];
    let asked = seen.iter().zip(starts).map(|(point, start)| Asked { name: name(point), kind: kind_of(prepared, point), start });
    let which = Some(ImageId { trial: key.trial, view: &view.station.name });
    let picture = Pictured { which, image: &image, board: prepared.sought.as_ref() };
    let truth = plan.counts_detections().then(|| true_places(prepared, view));
    let of_method = |(method, answers): (usize, Answers<'_>)| {
        if let (Some(found), Some(truth)) = (&answers.found, &truth) {
            tally.image(method, found, truth);
        }
        let unknowns = plan.unknowns(method);
        let results = seen.iter().zip(answers.results).filter_map(|(point, result)| Some((point, result?)));
        let points = results.map(|(point, result)| {
            let bound = view.bounds[point.target].get(&unknowns).copied().flatten();
            let target = prepared.targets[point.target].clone();
            PointResult { bound, ..PointResult::scored(view.name.clone(), target, method, point.truth, result) }
        });
        (method, points.collect())
    };
    let points = plan.measure(picture, &asked.collect::<Vec<_>>()).into_iter().map(of_method).collect();
    let image = (plan.images.is_some() && key.trial == 0).then_some(image);
    let kinds = seen.iter().map(|point| kind_of(prepared, point)).collect();
    Ok(Viewed { image, points, kinds, counted, tally })
}

/// Where the targets are in the image of a view.
fn true_places<'p>(prepared: &'p Prepared<'_>, view: &PreparedView<'_>) -> TruePlaces<'p> {
    let place = |(name, truth): (&'p Arc<str>, &TargetTruth)| Some((&**name, (truth.at?, is_pointed_at(prepared.subject, truth))));
    TruePlaces { all: prepared.targets.iter().zip(&view.truth).filter_map(place).collect() }
}

/// In which view each method has its first point. Noisy images do not compress: only that of the first point of all, which pages show, is kept. Methods that are not asked for
/// count, so that the image is the same whichever are.
struct FirstViews<'p> {
    methods: Vec<&'p Configured>,
    first: Vec<Option<usize>>,
}

impl<'p> FirstViews<'p> {
    fn of(plan: &Plan<'p>, prepared: &Prepared<'_>) -> Self {
        let knows = |method: &&Configured| {
            let finder = method.board_finder();
            finder.is_none_or(|finder| prepared.sought.as_ref().is_some_and(|sought| finder.unfit(&sought.board).is_none()))
        };
        let methods: Vec<_> = plan.all_available().into_iter().map(|index| &plan.methods[index]).filter(knows).collect();
        Self { first: vec![None; methods.len()], methods }
    }

    /// Whether the first point of all, as far as views were looked at, lies in view `place`, where targets of `kinds` are pointed at.
    fn is_in(&mut self, place: usize, kinds: &[TargetKind]) -> bool {
        for (method, first) in self.methods.iter().zip(&mut self.first).filter(|(_, first)| first.is_none()) {
            *first = kinds.iter().any(|kind| method.measures(Some(*kind))).then_some(place);
        }
        self.first.iter().find_map(|first| *first) == Some(place)
    }
}
