//! The image scale within a run: pixels to an object unit, mean over the images that have both targets.

use std::collections::BTreeMap;

use calibench_model::PixelPoint;
use calibench_random::Key;
use calibench_records::figures::Quantity;
use calibench_records::results::{Calibrated, Figure, Outcome, PointResult};
use calibench_scenario::ViewsSubject;

use super::Scale;
use crate::studies::adjust::Adjust;

impl Adjust for Scale {
    fn adjust(&self, subject: &ViewsSubject, points: &[PointResult], methods: &[usize], _: Key<'_>) -> Vec<Calibrated> {
        let ends = self.between.map(|target| &subject.field.targets[target]);
        let surveyed = (ends[1].surveyed - ends[0].surveyed).norm();
        let scale = |&method: &usize| {
            let mut images: BTreeMap<&str, [Option<PixelPoint>; 2]> = BTreeMap::new();
            for point in points.iter().filter(|point| point.method == method) {
                if let (Some(end), Outcome::Measured { position, .. }) =
                    (ends.iter().position(|end| *end.id == *point.target), &point.outcome)
                {
                    images.entry(&point.view).or_default()[end] = Some(*position);
                }
            }
            let all: Vec<f64> = images.values().filter_map(|[a, b]| Some(a.as_ref()?.distance(*b.as_ref()?) / surveyed)).collect();
            let mean = all.iter().sum::<f64>() / all.len() as f64;
            let outcome = if all.is_empty() { Err("no image has both targets".to_owned()) } else { Ok(mean) };
            let figures = outcome.map(|mean| vec![Figure::plain(Quantity::ImageScale, mean, "px")]);
            Calibrated { method, set: 0, outcome: figures, check_failed: None }
        };
        methods.iter().map(scale).collect()
    }
}
