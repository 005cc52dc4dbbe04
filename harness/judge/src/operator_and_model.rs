//! One operator with one camera model.

use std::sync::Arc;

use calibench_calibrate::Settings;
use calibench_calibrate::choice::{HALF, ModelChoice};
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{PixelPoint, Pose};
use calibench_records::judgement::{Row, measure};
use nalgebra::DVector;

use super::calibrated::{Calibrated, calibrate};
use super::frame::Frame;
use super::halves::{Map, apart, halves, mean_square, places, vectors};
use super::holdout::{Squares, Unseen};
use super::material::Material;
use super::{Options, lines};
use crate::camera_difference::beside;

/// Up to so many photographs each is left out in turn; of more, a tenth at a time.
const EACH: usize = 20;

/// What came of an operator with a model.
pub(super) struct Judged {
    /// In the order of measures.
    pub(super) rows: Vec<Row>,
    /// The camera of all views, if they determine one.
    pub(super) camera: Option<Camera>,
}

/// What one cell works on.
struct Job<'a> {
    material: &'a Material,
    common: &'a [Vec<bool>],
    operator: usize,
    settings: Settings,
    options: &'a Options,
    views: Vec<usize>,
}

/// All rows of an operator with a model, and the camera.
pub(super) fn rows_of(material: &Material, common: &[Vec<bool>], operator: usize, model: &ModelChoice, options: &Options) -> Judged {
    let settings = model.settings(material.size, options.pitch_um);
    let views = material.usable(operator);
    let job = Job { material, common, operator, settings, options, views };
    let label: Arc<str> = model.label.as_str().into();
    let (rows, camera) = job.rows();
    Judged { rows: rows.into_iter().map(|row| row.by(&material.operators[operator].method, &label)).collect(), camera }
}

impl Job<'_> {
    fn rows(&self) -> (Vec<Row>, Option<Camera>) {
        let few = |view: &usize| !self.views.contains(view);
        let left_out = (0..self.material.views.len()).filter(few);
        let mut rows: Vec<Row> = left_out
            .map(|view| {
                Row::without(measure::RESIDUALS, &self.material.views[view], "left out", "the operator measured too few corners in it")
            })
            .collect();
        let all = match calibrate(self.material, self.operator, &self.views, &self.settings) {
            Ok(all) => all,
            Err(error) => {
                rows.push(Row::without(measure::RESIDUALS, "", "failed", &error.to_string()));
                return (rows, None);
            }
        };
        let of_board = if all.bend.deflection().is_some() { 3 } else { 0 };
        rows.push(Row::plain(measure::PARAMETERS, "", (all.names.len() + of_board) as f64));
        let residuals = all.views.iter().zip(&all.residuals);
        rows.extend(residuals.map(|(view, (rms, count))| Row::px(measure::RESIDUALS, &self.material.views[*view], *rms).of(*count)));
        rows.extend(principal(&all, "all"));
        rows.extend(Self::uncertainty(&all));
        rows.extend(self.left_out(&all));
        rows.extend(self.splits(&all));
        rows.extend(self.options.published.iter().flat_map(|published| self.published(&all, published)));
        (rows, Some(all.camera))
    }

    /// Each fold of the views left out in turn: predictions, straight lines, principal point.
    fn left_out(&self, all: &Calibrated) -> Vec<Row> {
        let (mut rows, mut without) = (Vec::new(), Vec::new());
        for fold in folds(&self.views) {
            let name = |view: &usize| &self.material.views[*view];
            let others: Vec<usize> = self.views.iter().copied().filter(|view| !fold.contains(view)).collect();
            let found = match all.part(&others) {
                Ok(found) => {
                    let names: Vec<&str> = fold.iter().map(|view| &**name(view)).collect();
                    rows.extend(principal(&found, &format!("without {}", names.join(", "))));
                    without.push(found.values());
                    found
                }
                Err(error) => {
                    let why = format!("without this view: {error}");
                    rows.extend(fold.iter().map(|view| Row::without(measure::HOLDOUT, name(view), "failed", &why)));
                    continue;
                }
            };
            for view in &fold {
                rows.extend(all.pose(*view).into_iter().flat_map(|near| self.predicted(&found, *view, &near)));
            }
        }
        let of_all = without.len() == folds(&self.views).len();
        rows.extend(over_frame(all, if of_all { &without } else { &[] }));
        rows
    }

    fn predicted(&self, found: &Calibrated, view: usize, near: &Pose) -> Vec<Row> {
        let (name, chosen) = (&self.material.views[view], &self.common[view][..]);
        let row = |measure: &str, found: Result<(f64, usize), String>| match found {
            Ok((value, count)) => Row::px(measure, name, value).of(count),
            Err(why) => Row::without(measure, name, "failed", &why),
        };
        let rms = |found: Result<Squares, String>| found.map(|squares| (squares.rms().unwrap_or(f64::NAN), squares.count()));
        let (material, operator, camera, bend) = (self.material, self.operator, &found.camera, &found.bend);
        let unseen = Unseen { material, operator, view, camera, bend, near };
        let mut rows = vec![row(measure::HOLDOUT, rms(unseen.interleaved(chosen))), row(measure::ACROSS, rms(unseen.across(chosen)))];
        if !material.field.lines().is_empty() {
            rows.push(row(measure::STRAIGHT, lines::straightness(material, operator, view, camera, chosen)));
        }
        rows
    }

    /// Halves of the views, compared.
    fn splits(&self, all: &Calibrated) -> Vec<Row> {
        let (mut rows, mut map) = (Vec::new(), Map::default());
        if self.views.len() < 2 * HALF {
            return vec![Row::without(measure::SPLIT, "", "failed", "the operator measured too few views for halves")];
        }
        for split in 0..self.options.splits {
            let place = (split + 1).to_string();
            let [first, second] = halves(&self.views, (self.options.seed, &self.options.name), split);
            let found = all.part(&first).and_then(|first| Ok((first, all.part(&second)?))).map_err(|error| error.to_string());
            let found = found.and_then(|(first, second)| apart(&first, &second).map(|apart| (apart, first, second)));
            match found {
                Err(why) => rows.push(Row::without(measure::SPLIT, &place, "failed", &why)),
                Ok((apart, first, second)) => {
                    let (difference, predicted) = apart.rms();
                    let (sum, modes) = apart.chi_square;
                    rows.push(Row::px(measure::SPLIT, &place, difference).beside(predicted));
                    rows.push(Row::plain(measure::SPLIT_TEST, &place, sum / modes as f64).beside(apart.p).of(modes));
                    rows.extend(principal(&first, &format!("half {place}a")));
                    rows.extend(principal(&second, &format!("half {place}b")));
                    map.add(&apart);
                }
            }
        }
        rows.extend(
            map.places().map(|(at, found, predicted)| Row::px(measure::MAP, &format!("{}:{}", at.x, at.y), found).beside(predicted)),
        );
        rows
    }

    fn uncertainty(all: &Calibrated) -> Vec<Row> {
        let size = all.camera.size();
        let (right, bottom) = (f64::from(size.width - 1), f64::from(size.height - 1));
        // The rotation is that of a grid over the whole frame: an odd one, with the corners and the centre among its places.
        let grid = |k: usize| PixelPoint::new(right * (k % 9) as f64 / 8.0, bottom * (k / 9) as f64 / 8.0);
        let at: Vec<PixelPoint> = (0..81).map(grid).collect();
        let Some(frame) = Frame::new(&all.camera, &all.names, &at) else {
            return vec![Row::without(measure::UNCERTAINTY, "corner", "failed", "a corner of the frame has no ray")];
        };
        let variances = frame.variances(&all.covariance);
        let corner = [0, 8, 72, 80].into_iter().map(|k| variances[k]).fold(0.0, f64::max);
        vec![Row::px(measure::UNCERTAINTY, "centre", variances[40].sqrt()), Row::px(measure::UNCERTAINTY, "corner", corner.sqrt())]
    }

    /// Beside the published camera: over the frame, and view by view with our corners.
    fn published(&self, all: &Calibrated, published: &Camera) -> Vec<Row> {
        let mut rows = Vec::new();
        match vectors(&all.camera, published) {
            Err(why) => rows.push(Row::without(measure::PUBLISHED, "", "failed", &why)),
            Ok((at, vectors)) => {
                let lengths: Vec<f64> = vectors.as_slice().chunks(2).map(|v| v[0].hypot(v[1])).collect();
                let predicted = Frame::new(&all.camera, &all.names, &at).map(|frame| frame.spread(&all.covariance).0.sqrt());
                let rms = mean_square(all.camera.size(), &at, &vectors).sqrt();
                rows.push(Row::px(measure::PUBLISHED, "", rms).beside(predicted.unwrap_or(f64::NAN)));
                rows.push(Row::px(measure::PUBLISHED_MOST, "", lengths.iter().copied().fold(0.0, f64::max)));
            }
        }
        rows.extend(self.options.published_sigma.map(|sigma| Row::px(measure::PUBLISHED_SIGMA, "", sigma)));
        let corners = self.material.positions(self.operator);
        rows.extend(
            beside(&all.camera, published, &corners).ok().and_then(|found| Some(Row::px(measure::PUBLISHED_SEEN, "", found.seen?))),
        );
        for (&view, near) in self.views.iter().filter_map(|view| Some((view, all.pose(*view)?))) {
            let name = &self.material.views[view];
            let unseen = Unseen { material: self.material, operator: self.operator, view, camera: published, bend: &all.bend, near: &near };
            rows.push(match unseen.resected() {
                Ok(squares) => Row::px(measure::PUBLISHED_VIEW, name, squares.rms().unwrap_or(f64::NAN)).of(squares.count()),
                Err(why) => Row::without(measure::PUBLISHED_VIEW, name, "failed", &why),
            });
        }
        rows
    }
}

/// The predicted standard deviation of the camera over the frame, and the one that `without` shows: the parameters without each group of photographs.
fn over_frame(all: &Calibrated, without: &[DVector<f64>]) -> Vec<Row> {
    let frame = places(&all.camera)
        .and_then(|at| Frame::new(&all.camera, &all.names, &at).ok_or_else(|| "a place of the frame has no ray".to_owned()));
    let frame = match frame {
        Ok(frame) => frame,
        Err(why) => return vec![Row::without(measure::FRAME, "", "failed", &why)],
    };
    let (mean, modes) = frame.spread(&all.covariance);
    let by_views = jackknife(&frame, without).map_or(f64::NAN, f64::sqrt);
    vec![Row::px(measure::FRAME, "", mean.sqrt()).beside(by_views), Row::plain(measure::FRAME_MODES, "", modes)]
}

/// The mean variance (2D, px^2) over the frame that groups show which were left out in turn.
fn jackknife(frame: &Frame, without: &[DVector<f64>]) -> Option<f64> {
    without.first()?;
    let groups = without.len() as f64;
    let mean = without.iter().sum::<DVector<f64>>() / groups;
    Some((groups - 1.0) / groups * without.iter().map(|values| frame.moved(&(values - &mean))).sum::<f64>())
}

fn principal(found: &Calibrated, place: &str) -> Vec<Row> {
    match found.principal_point() {
        Some(axes) => {
            measure::PRINCIPAL.iter().zip(axes).map(|(measure, (value, sigma))| Row::px(measure, place, value).beside(sigma)).collect()
        }
        None => vec![Row::without(measure::PRINCIPAL[0], place, "failed", "the camera does not picture its axis")],
    }
}

/// The views that are left out together.
pub(super) fn folds(views: &[usize]) -> Vec<Vec<usize>> {
    let count = if views.len() <= EACH { views.len() } else { 10 };
    (0..count).map(|fold| views.iter().copied().skip(fold).step_by(count).collect()).collect()
}
