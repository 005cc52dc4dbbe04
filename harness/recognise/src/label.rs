//! Areas of identified squares to targets.

use std::f64::consts::FRAC_PI_2;

use calibench_model::{Affine, TargetKind};

use crate::bank::Bank;
use crate::design::{Design, Printed};
use crate::found::{Reason, SizeGroup};
use crate::identify::NEAR;
use crate::mapping::{Mapping, Place};
use crate::number::seconds;
use crate::recogniser::Classifier;
use crate::square::Square;

/// The least correlation with its drawing of what is taken for a target.
const LIKE: f64 = 0.75;
/// The share of a square's dark areas that must be targets of its place on the design.
const AGREEING: f64 = 0.6;

/// A target of the design and the area that it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Labelled {
    /// Of the square's areas.
    pub area: usize,
    /// Of the cell's targets.
    pub printed: usize,
    pub likeness: f64,
}

/// A target of the design that was not found, or an area that was taken for something else.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lost {
    pub printed: usize,
    pub reason: Reason,
}

/// What the areas of a square are.
#[derive(Default)]
pub(crate) struct Labels {
    pub found: Vec<Labelled>,
    pub lost: Vec<Lost>,
    /// For each area the target of the cell whose place it has.
    pub by_place: Vec<Option<usize>>,
    /// Of the areas that have the place of a target and look like it, how much larger they are than it under the same blur.
    pub sizes: Vec<f64>,
}

impl Labels {
    /// Whether the areas of the square are those of the design, most of them by place and looks: of a square elsewhere a tenth is, by chance.
    pub fn agrees(&self) -> bool {
        self.sizes.len() as f64 >= AGREEING * self.by_place.len() as f64
    }
}

/// The targets of a square of which the place on the field is known: by its place, held against its drawing; of the contours also by kind and number.
pub(crate) fn label(square: &Square, design: &Design, place: &Place, classifier: Classifier, bank: &Bank) -> Option<Labels> {
    let [row, column] = place.square(square.at).map(|v| usize::try_from(v).ok());
    let cell = design.cell(row.filter(|v| *v < design.squares)?, column.filter(|v| *v < design.squares)?);
    let on_field: Vec<[f64; 2]> =
        square.places().iter().map(|[x, y]| place.of([square.at[0] as f64 + x, square.at[1] as f64 + y])).collect();
    let off = |area: usize, printed: &Printed| (on_field[area][0] - printed.at[0]).hypot(on_field[area][1] - printed.at[1]);
    let mut labels = Labels { by_place: vec![None; on_field.len()], ..Labels::default() };
    let told = if classifier == Classifier::Contours { told(square, cell, &on_field) } else { None };
    for (index, printed) in cell.iter().enumerate() {
        let nearest = (0..on_field.len()).min_by(|&a, &b| off(a, printed).total_cmp(&off(b, printed)));
        let Some(area) = nearest.filter(|&area| off(area, printed) < NEAR) else {
            labels.lost.push(Lost { printed: index, reason: Reason::Missing });
            continue;
        };
        labels.by_place[area] = Some(index);
        let turn = printed.axes[0][1].atan2(printed.axes[0][0]) - place.turns as f64 * FRAC_PI_2;
        let shape = (printed.kind, printed.large);
        let likeness = bank.likeness(&bank.seen(&square.normal, square.areas.areas[area].centre, shape), shape, Some(turn));
        let wrong = match (&told, classifier) {
            (Some(told), _) => (told[area] != Some(index)).then(|| other(square, area)),
            (None, Classifier::Contours) => Some(Reason::Count { found: on_field.len() }),
            (None, Classifier::Modern) => None,
        };
        if likeness >= LIKE {
            labels.sizes.push(square.share(area) / bank.area(shape));
        }
        let unlike = (likeness < LIKE).then_some(Reason::Unlike { likeness });
        match wrong.or(unlike) {
            Some(reason) => labels.lost.push(Lost { printed: index, reason }),
            None => labels.found.push(Labelled { area, printed: index, likeness }),
        }
    }
    Some(labels)
}

fn other(square: &Square, area: usize) -> Reason {
    let taken_for = square.decisions.as_ref().map_or(TargetKind::Disc, |decisions| decisions.joint[area]);
    Reason::OtherKind { taken_for }
}

/// The target of the cell that each area is by its kind, size and number alone; `None` without decisions.
fn told(square: &Square, cell: &[Printed], on_field: &[[f64; 2]]) -> Option<Vec<Option<usize>>> {
    let decisions = square.decisions.as_ref()?;
    let large = |group: SizeGroup| matches!(group, SizeGroup::LargeAngular | SizeGroup::LargeRound);
    let seen: Vec<_> = (0..on_field.len()).map(|i| (decisions.joint[i], large(decisions.groups[i]), on_field[i])).collect();
    let designed: Vec<_> = cell.iter().map(|p| (p.kind, p.large, p.at)).collect();
    let (seen_seconds, design_seconds) = (seconds(&seen), seconds(&designed));
    let same = |i: usize, k: usize| seen[i].0 == designed[k].0 && seen[i].1 == designed[k].1 && seen_seconds[i] == design_seconds[k];
    Some((0..seen.len()).map(|i| (0..designed.len()).find(|&k| same(i, k))).collect())
}

/// The affine map of a target; `mapping` is that of the field, `times` the image larger.
pub(crate) fn affine(mapping: &Mapping, printed: &Printed, times: f64) -> Option<Affine> {
    let by = mapping.by_grid(printed.at)? * times;
    let [[ux, uy], [vx, vy]] = printed.axes;
    let along = |x: f64, y: f64| [by[(0, 0)] * x + by[(0, 1)] * y, by[(1, 0)] * x + by[(1, 1)] * y];
    let ([axx, ayx], [axy, ayy]) = (along(ux, uy), along(vx, vy));
    Some(Affine { axx, axy, ayx, ayy })
}
