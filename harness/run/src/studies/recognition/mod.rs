//! What a recogniser finds in the images of a trial, counted against the truth.
//!
//! A blob of a whole square is a target if the true place of one is nearest and within 2 px; how it was taken is compared with what it is.

mod lines;

use std::collections::BTreeMap;

use calibench_files::NewFolder;
use calibench_images::encode_png_densely;
use calibench_model::{Image, PixelPoint, Start, TargetKind, Testfield};
use calibench_recognise::{Recognition as Found, SizeGroup, recognise_each};
use calibench_records::figures::{FigureName, Quantity};
use calibench_records::names::{kept_image_name, recognition_step};
use calibench_records::results::{Calibrated, Figure};
use calibench_scenario::Recognition;
use calibench_synth::view::TargetTruth;

use crate::RunError;
use crate::prepared::PreparedView;
use lines::Lines;

/// How far a blob may lie from the target that it is, px.
const NEAR: f64 = 2.0;
/// How far a recognised target may lie from its true place, px: beyond, its label is wrong.
const RIGHT: f64 = 2.0;

/// What is counted, by classifier and figure, and where lines lie.
#[derive(Clone, Debug, Default)]
pub struct Counted {
    counts: BTreeMap<(usize, FigureName), f64>,
    lines: Lines,
}

/// Where measuring starts: of each target, by its place in the field; and what was counted.
pub struct Recognised {
    /// Starts by target.
    pub starts: BTreeMap<usize, Start>,
    /// Counts.
    pub counted: Counted,
}

/// The place of the image of which the steps are kept.
pub fn shown(plan: &Recognition) -> Option<usize> {
    plan.images.last().and_then(|(_, images)| images.first().copied())
}

/// Keeps the steps of recognition of an image beside it: the first one of the last group of images that are counted together. None where no grid is found.
///
/// # Errors
/// A folder that cannot be written.
pub fn keep_steps(plan: &Recognition, image: &Image, (view, name): (usize, &str), folder: &NewFolder) -> Result<(), RunError> {
    let (Some(recogniser), true) = (plan.recognisers.first(), shown(plan) == Some(view)) else { return Ok(()) };
    let Ok(steps) = recogniser.steps(image) else { return Ok(()) };
    let pictures = [("normal", &steps.normal), ("enlarged", &steps.enlarged), ("binary", &steps.binary), ("contours", &steps.contours)];
    for (step, picture) in pictures {
        folder.write(&kept_image_name(&recognition_step(name, step)), |file| encode_png_densely(file, picture, false))?;
    }
    Ok(())
}

/// Recognises the field in the image of `view`, whose station has the place `place`, with every classifier.
pub fn recognise(plan: &Recognition, image: &Image, (place, view): (usize, &PreparedView<'_>), field: &Testfield) -> Recognised {
    let kinds: Vec<TargetKind> = field.targets.iter().map(|target| target.kind).collect();
    let mut recognised = Recognised { starts: BTreeMap::new(), counted: Counted::default() };
    for (which, found) in recognise_each(&plan.recognisers, image).into_iter().enumerate() {
        let found = found.ok();
        if which == 0 {
            let targets = found.iter().flat_map(|found| &found.targets);
            let start = |kind, affine, position| Start { kind: Some(kind), affine: Some(affine), ..Start::at(position) };
            recognised.starts = targets.map(|t| (t.target, start(t.kind, t.affine, t.position))).collect();
        }
        for (name, _) in plan.images.iter().filter(|(_, images)| images.contains(&place)) {
            recognised.counted.image((which, &plan.classifiers[which]), name, found.as_ref(), &view.truth, &kinds);
            recognised.counted.lines.image((which, name), found.as_ref(), &view.nodes);
        }
    }
    recognised
}

impl Counted {
    fn add(&mut self, which: usize, figure: FigureName, count: f64) {
        *self.counts.entry((which, figure)).or_default() += count;
    }

    /// Adds what others have counted.
    pub fn join(&mut self, other: Self) {
        other.counts.into_iter().for_each(|((which, figure), count)| self.add(which, figure, count));
        self.lines.join(other.lines);
    }

    fn image(
        &mut self,
        (which, classifier): (usize, &str),
        images: &str,
        found: Option<&Found>,
        truth: &[TargetTruth],
        kinds: &[TargetKind],
    ) {
        let of = |quantity: Quantity| quantity.of(&[classifier, images]);
        self.add(which, of(Quantity::SeenImages), 1.0);
        let Some(found) = found else { return };
        self.add(which, of(Quantity::SeenGrids), 1.0);
        let places: Vec<Option<PixelPoint>> = truth.iter().map(|truth| truth.at).collect();
        let nearest = |at: PixelPoint| {
            // Along each axis first: most targets are far off.
            let beside = |place: &PixelPoint| (place.x - at.x).abs() <= NEAR && (place.y - at.y).abs() <= NEAR;
            let near = places.iter().enumerate().filter_map(|(i, place)| Some((i, place.filter(beside)?)));
            let distances = near.map(|(i, place)| (place.distance(at), i));
            distances.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(distance, _)| *distance <= NEAR).map(|(_, target)| target)
        };
        let recognised: BTreeMap<usize, PixelPoint> = found.targets.iter().map(|target| (target.target, target.position)).collect();
        for target in &found.targets {
            let right = places[target.target].is_some_and(|at| at.distance(target.position) <= RIGHT);
            self.add(which, of(Quantity::Labels), 1.0);
            self.add(which, of(Quantity::WrongLabels), f64::from(u8::from(!right)));
        }
        for (blob, target) in found.squares.iter().flat_map(|square| &square.blobs).filter_map(|blob| Some((blob, nearest(blob.position)?)))
        {
            self.add(which, of(Quantity::SeenTargets), 1.0);
            let labelled = recognised.get(&target).is_some_and(|at| places[target].is_some_and(|place| place.distance(*at) <= RIGHT));
            self.add(which, of(Quantity::Labelled), f64::from(u8::from(labelled)));
            let Some(group) = blob.group else { continue };
            let (group, kind) = (group.name(), kinds[target]);
            self.add(which, Quantity::OfSize.of(&[classifier, group, images]), 1.0);
            for (how, taken) in [("single", blob.single), ("joint", blob.joint)] {
                let wrong = taken.is_some_and(|taken| taken != kind);
                self.add(which, Quantity::WrongKinds.of(&[classifier, how, group, images]), f64::from(u8::from(wrong)));
                if let (true, Some(taken)) = (wrong, taken) {
                    let of = [classifier, how, kind.name(), taken.name(), images];
                    self.add(which, Quantity::TakenFor.of(&of), 1.0);
                }
            }
        }
    }

    /// The figures of a trial, under the set of place `set`, beside the first method.
    pub fn calibrated(self, plan: &Recognition, set: usize) -> Calibrated {
        let (shares, lines) = (self.shares(plan), self.lines.figures(&plan.classifiers));
        let counts = self.counts.into_iter().map(|((_, figure), count)| (figure, count));
        let figures = counts.chain(shares).map(|(figure, value)| Figure::plain(figure, value, "")).chain(lines);
        Calibrated { method: 0, set, outcome: Ok(figures.collect()), check_failed: None }
    }

    /// Shares of all images together and of each group of images.
    fn shares(&self, plan: &Recognition) -> Vec<(FigureName, f64)> {
        let get = |which: usize, figure: FigureName| self.counts.get(&(which, figure)).copied().unwrap_or(0.0);
        let mut shares = Vec::new();
        for (which, classifier) in plan.classifiers.iter().enumerate() {
            for group in SizeGroup::ALL.map(SizeGroup::name) {
                for how in ["single", "joint"] {
                    let (mut wrong, mut all) = (0.0, 0.0);
                    for (images, _) in &plan.images {
                        let w = get(which, Quantity::WrongKinds.of(&[classifier, how, group, images]));
                        let a = get(which, Quantity::OfSize.of(&[classifier, group, images]));
                        (wrong, all) = (wrong + w, all + a);
                        if a > 0.0 {
                            shares.push((Quantity::WrongKindsPercent.of(&[classifier, how, group, images]), 100.0 * w / a));
                        }
                    }
                    shares.push((Quantity::WrongKindsOfAll.of(&[classifier, how, group]), wrong));
                    shares.push((Quantity::KindsOfAll.of(&[classifier, how, group]), all));
                }
            }
        }
        shares
    }
}

#[cfg(test)]
mod tests {
    use calibench_model::Affine;
    use calibench_recognise::{Blob, GridFound, Recognised, SquareFound};
    use calibench_records::figures::Group;
    use calibench_synth::view::Visibility;
    use nalgebra::Point3;

    use super::*;

    const KINDS: [TargetKind; 4] = [TargetKind::Square, TargetKind::Triangle, TargetKind::Square, TargetKind::Triangle];

    fn place(target: usize) -> PixelPoint {
        PixelPoint::new(10.0 + 20.0 * target as f64, 30.0)
    }

    fn truth() -> Vec<TargetTruth> {
        let of = |target| TargetTruth {
            object: Point3::origin(),
            at: Some(place(target)),
            visibility: Visibility::Visible,
            affine: None,
            ellipse: None,
            room: None,
        };
        (0..KINDS.len()).map(of).collect()
    }

    /// All four targets where they are, `taken[i]` for what the i-th is.
    fn found(taken: [usize; 4]) -> Found {
        let affine = Affine { axx: 5.0, axy: 0.0, ayx: 0.0, ayy: 5.0 };
        let label = |i: usize| Recognised { target: taken[i], position: place(i), affine, kind: KINDS[taken[i]], likeness: 1.0 };
        let blob = |i: usize| Blob {
            position: place(i),
            area: 0.01,
            group: Some(SizeGroup::SmallAngular),
            single: Some(KINDS[i]),
            joint: Some(KINDS[taken[i]]),
            features: None,
            target: Some(taken[i]),
        };
        let square = SquareFound { place: Some([0, 0]), corners: [place(0); 4], code: None, blobs: (0..4).map(blob).collect() };
        let grid = GridFound {
            homography: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            bend: 0.0,
            middle: place(0),
            reach: 100.0,
            rms: 0.0,
            blur: 0.6,
            reduced: 1,
        };
        Found { targets: (0..4).map(label).collect(), squares: vec![square], lines: Vec::new(), rejected: Vec::new(), grid }
    }

    fn counted(found: Option<&Found>) -> impl Fn(&str) -> Option<f64> + use<> {
        let mut counted = Counted::default();
        counted.image((0, "modern"), "all", found, &truth(), &KINDS);
        move |name| counted.counts.get(&(0, FigureName::parse(Group::Network, &format!("modern/{name}/all")).unwrap())).copied()
    }

    #[test]
    fn what_is_right_is_counted_right_and_an_image_without_grid_has_nothing() {
        let right = counted(Some(&found([0, 1, 2, 3])));
        for (name, count) in [("images", 1.0), ("grids", 1.0), ("labels", 4.0), ("wrong labels", 0.0), ("targets", 4.0), ("labelled", 4.0)]
        {
            assert_eq!(right(name), Some(count), "{name}");
        }
        assert_eq!(right("joint wrong, small squares and triangles"), Some(0.0));
        let none = counted(None);
        assert_eq!((none("images"), none("grids"), none("labels")), (Some(1.0), None, None));
    }

    /// A square and a triangle are taken for each other: two labels, and two joint decisions; the single ones are right.
    #[test]
    fn a_swap_is_two_wrong_labels_and_two_wrong_decisions() {
        let swapped = counted(Some(&found([1, 0, 2, 3])));
        assert_eq!([swapped("labels"), swapped("wrong labels"), swapped("labelled")], [Some(4.0), Some(2.0), Some(2.0)]);
        assert_eq!(swapped("joint wrong, small squares and triangles"), Some(2.0));
        assert_eq!(swapped("single wrong, small squares and triangles"), Some(0.0));
        assert_eq!(swapped("small squares and triangles"), Some(4.0));
        assert_eq!(swapped("joint, square taken for triangle"), Some(1.0));
        assert_eq!(swapped("joint, triangle taken for square"), Some(1.0));
    }
}
