//! One look at an image: from its grid and dark areas to what is found.

use std::ops::RangeInclusive;

use calibench_model::{PixelPoint, upper_median};

use crate::adjust::OnLine;
use crate::bank::Bank;
use crate::design::{IN_SQUARE, Printed};
use crate::error::NotRecognised;
use crate::found::{Blob, GridFound, LineFound, Reason, Recognised, Recognition, Rejected, SquareFound};
use crate::grid::{Grid, straightened};
use crate::ground::Ground;
use crate::hough::fit;
use crate::identify::{FEWEST, Identified, Seen, identify};
use crate::label::{Labels, affine, label};
use crate::level::Level;
use crate::mapping::{Mapping, Place};
use crate::recogniser::{Classifier, Recogniser};
use crate::ridge::Ridge;
use crate::square::Square;

/// The areas of the field's targets beside those of the design under the same blur, in the median: 0.95 to 1.00 in renders; ink spreads.
const SIZES: RangeInclusive<f64> = 0.8..=1.25;

impl Recogniser {
    /// The field on a ground of its design, and the side of a square there, px.
    pub(crate) fn on(&self, ground: &Ground<'_>) -> Result<(Recognition, f64), NotRecognised> {
        let Ground { level, points, grid, bank, blur, .. } = ground;
        let mut squares = ground.squares.clone();
        squares.iter_mut().for_each(|square| square.decide(self.classifier, &self.table, bank));
        let seen: Vec<Seen> = squares
            .iter()
            .map(|square| Seen {
                square: square.at,
                at: square.places(),
                areas: (0..square.areas.areas.len()).map(|area| square.share(area)).collect(),
                code: square.decisions.as_ref().map(|d| d.code),
            })
            .collect();
        let identified = identify(&self.design, &self.places, &seen, self.classifier == Classifier::Contours)?;
        let on_field = grid.adjusted.mapping.moved(&identified.place).ok_or(NotRecognised::NoWholeSquare)?;
        let look = Look { recogniser: self, level, on_field, place: identified.place, bank };
        let labels = look.labels(&squares, &identified)?;
        let mut found = look.recognition(grid, points, *blur);
        look.squares(&squares, &labels, &identified, &mut found);
        found.targets.sort_by_key(|recognised| recognised.target);
        Ok((found, ground.side))
    }
}

/// What a look needs to tell what it sees.
struct Look<'a> {
    recogniser: &'a Recogniser,
    level: &'a Level<'a>,
    /// From the field to the image.
    on_field: Mapping,
    place: Place,
    bank: &'a Bank,
}

impl Look<'_> {
    fn original(&self, field: [f64; 2]) -> Option<PixelPoint> {
        self.on_field.image(field).map(|at| self.level.original(at))
    }

    /// The grid and its lines; no squares yet.
    fn recognition(&self, grid: &Grid, points: &[Ridge], blur: f64) -> Recognition {
        let times = self.level.factor as f64;
        let middle = self.level.original(self.on_field.unit.middle);
        let (shift, h) = (self.level.original([0.0, 0.0]), self.on_field.homography());
        let row = |i: usize, shift: f64| [0, 1, 2].map(|j| times * h[(i, j)] + shift * h[(2, j)]);
        let homography = [row(0, shift.x), row(1, shift.y), [h[(2, 0)], h[(2, 1)], h[(2, 2)]]];
        let found = GridFound {
            homography,
            bend: self.on_field.bend,
            middle,
            reach: self.on_field.unit.reach * times,
            rms: grid.adjusted.rms * times,
            blur: blur * times,
            reduced: self.level.factor,
        };
        Recognition {
            targets: Vec::new(),
            squares: Vec::new(),
            lines: self.lines(&grid.adjusted.on, points),
            rejected: Vec::new(),
            grid: found,
        }
    }

    /// The grid's lines, each adjusted by itself.
    fn lines(&self, on: &[OnLine], points: &[Ridge]) -> Vec<LineFound> {
        let mut sorted: Vec<&OnLine> = on.iter().collect();
        sorted.sort_by_key(|on| (on.family, on.number));
        let of_line = sorted.chunk_by(|a, b| (a.family, a.number) == (b.family, b.number));
        let mut lines: Vec<LineFound> = of_line.filter(|of| of.len() > 2).filter_map(|of| self.line(of, points)).collect();
        lines.sort_by_key(|line| (line.family, line.index));
        lines
    }

    fn line(&self, on: &[&OnLine], points: &[Ridge]) -> Option<LineFound> {
        let (unit, bend) = (self.on_field.unit, self.on_field.bend);
        let own: Vec<Ridge> = on.iter().map(|on| straightened(&points[on.point], unit, bend)).collect();
        let all: Vec<usize> = (0..own.len()).collect();
        let line = fit(&own, &all);
        let times = self.level.factor as f64;
        let end = |s: f64| {
            let [x, y] = line.along(s);
            self.on_field.bent([unit.middle[0] + x, unit.middle[1] + y]).map(|at| self.level.original(at))
        };
        let across = if on[0].family == 0 { [1.0, 0.0] } else { [0.0, 1.0] };
        let [x, y] = self.place.direction(across);
        let number = on[0].number as f64;
        let [px, py] = self.place.of(across.map(|v| v * number));
        let (family, index) = if x.abs() > y.abs() { (0, px) } else { (1, py) };
        let index = index.round() as i64;
        let (sigma, rms) = (line.sigma() * times, line.rms * times);
        Some(LineFound { family, index, ends: [end(line.span[0])?, end(line.span[1])?], sigma, rms, points: line.points })
    }

    /// What the areas of each square are; `None` of a square that is not the design's.
    ///
    /// # Errors
    /// Another field: its squares are mostly not the design's, or its targets have other sizes.
    fn labels(&self, squares: &[Square], identified: &Identified) -> Result<Vec<Option<Labels>>, NotRecognised> {
        let Recogniser { design, classifier, .. } = self.recogniser;
        let of = |(square, explained): (&Square, &Option<bool>)| {
            let labels = (*explained == Some(true)).then(|| label(square, design, &self.place, *classifier, self.bank))??;
            labels.agrees().then_some(labels)
        };
        let labels: Vec<Option<Labels>> = squares.iter().zip(&identified.explained).map(of).collect();
        let explained = labels.iter().flatten().count();
        let with_targets = squares.iter().filter(|square| square.areas.areas.len() >= FEWEST).count();
        // A square with targets that are not the field's, or where the field has none, speaks against it.
        if explained == 0 || 2 * explained <= with_targets {
            return Err(NotRecognised::OtherField { squares: with_targets, explained });
        }
        let sizes = labels.iter().flatten().flat_map(|labels| labels.sizes.iter().copied());
        match upper_median(sizes) {
            Some(times) if !SIZES.contains(&times) => Err(NotRecognised::OtherSizes { times }),
            _ => Ok(labels),
        }
    }

    fn squares(&self, squares: &[Square], labels: &[Option<Labels>], identified: &Identified, found: &mut Recognition) {
        for ((square, labels), explained) in squares.iter().zip(labels).zip(&identified.explained) {
            let count = square.areas.areas.len();
            // Beside the field, where nothing is printed.
            if explained.is_none() && count < FEWEST {
                continue;
            }
            let [row, column] = self.place.square(square.at);
            let place = labels.as_ref().map(|_| [row as usize, column as usize]);
            let reason = match (explained, labels) {
                (None, _) => Some(Reason::Outside),
                (_, None) => Some(Reason::Contradicts),
                (_, Some(_)) => (count != IN_SQUARE).then_some(Reason::Count { found: count }),
            };
            if let (Some(reason), Some(at)) = (reason, self.original([column as f64 + 0.5, row as f64 + 0.5])) {
                found.rejected.push(Rejected { at, square: place, target: None, reason });
            }
            let cell = place.map(|[row, column]| self.recogniser.design.cell(row, column));
            if let (Some(labels), Some(cell)) = (labels, cell) {
                self.targets(square, cell, labels, found);
            }
            found.squares.extend(self.square(square, [column, row], place, labels.as_ref(), cell));
        }
    }

    fn targets(&self, square: &Square, cell: &[Printed; 16], labels: &Labels, found: &mut Recognition) {
        let [row, column] = self.place.square(square.at).map(|v| v as usize);
        for labelled in &labels.found {
            let printed = &cell[labelled.printed];
            let (Some(target), Some(position)) = (printed.target, self.position(square, labelled.area)) else { continue };
            let Some(affine) = affine(&self.on_field, printed, self.level.factor as f64) else { continue };
            found.targets.push(Recognised { target, position, affine, kind: printed.kind, likeness: labelled.likeness });
        }
        for lost in &labels.lost {
            let printed = &cell[lost.printed];
            if let Some(at) = self.original(printed.at) {
                found.rejected.push(Rejected { at, square: Some([row, column]), target: printed.target, reason: lost.reason });
            }
        }
    }

    /// The centre of an area in the image.
    fn position(&self, square: &Square, area: usize) -> Option<PixelPoint> {
        let [x, y] = square.areas.areas[area].centre.map(crate::normal::to_square);
        self.original(self.place.of([square.at[0] as f64 + x, square.at[1] as f64 + y]))
    }

    fn square(
        &self,
        square: &Square,
        [column, row]: [i64; 2],
        place: Option<[usize; 2]>,
        labels: Option<&Labels>,
        cell: Option<&[Printed; 16]>,
    ) -> Option<SquareFound> {
        let corner = |dx: f64, dy: f64| self.original([column as f64 + dx, row as f64 + dy]);
        let corners = [corner(0.0, 0.0)?, corner(1.0, 0.0)?, corner(1.0, 1.0)?, corner(0.0, 1.0)?];
        let decisions = square.decisions.as_ref();
        let blob = |area: usize| {
            let target = labels.and_then(|labels| labels.by_place[area]).zip(cell).and_then(|(index, cell)| cell[index].target);
            Some(Blob {
                position: self.position(square, area)?,
                area: square.share(area),
                group: decisions.map(|d| d.groups[area]),
                single: decisions.map(|d| d.single[area]),
                joint: decisions.map(|d| d.joint[area]),
                features: decisions.map(|d| d.features[area]),
                target,
            })
        };
        let blobs = (0..square.areas.areas.len()).filter_map(blob).collect();
        Some(SquareFound { place, corners, code: decisions.map(|d| d.code), blobs })
    }
}
