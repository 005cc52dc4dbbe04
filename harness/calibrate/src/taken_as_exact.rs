//! What of the object is taken as exact, since nobody stated how exact it is.

use calibench_adjust::{Datum, Status};

use crate::{BoardShape, Calibration, Shape, shape};

impl Calibration<'_> {
    /// What of the object's coordinates takes no part in the standard deviations, in words; empty where all was stated, measured or adjusted.
    pub fn taken_as_exact(&self) -> Vec<String> {
        let (settings, network) = (&self.prepared.settings, &self.prepared.network);
        let fixed = network.points.iter().filter(|point| point.coordinates == [Status::Fixed; 3]).count();
        if self.prepared.survey.control_points() == 0 {
            return Vec::new();
        }
        if !shape::is_flat(network) {
            return if fixed > 0 { vec![format!("the coordinates of {fixed} control points")] } else { Vec::new() };
        }
        let by_others = !settings.distances.is_empty() && network.datum != Datum::Control;
        let is_scaled = settings.board.scale.is_some() || by_others;
        let is_shaped =
            fixed == 0 || matches!(self.prepared.shape, Shape::Flat { .. } | Shape::Bent { .. }) || settings.shape == BoardShape::Free;
        let words = [
            (!is_scaled).then(|| "the scale of the board (--board-scale)".to_owned()),
            (!is_shaped).then(|| "its flatness (--board-shape)".to_owned()),
            (fixed > 0).then(|| "the places of its points (--print-noise, --board-file, --board-shape free)".to_owned()),
        ];
        words.into_iter().flatten().collect()
    }
}
