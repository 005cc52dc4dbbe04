//! Defects that counting finds before anything is computed.

use super::geometry::reasons;
use crate::datum::undetermined;
use crate::defect::{Defect, Reason};
use crate::network::{Attitude, Centre, Layout, Network, Status};
use crate::state::State;

/// What cannot be determined whatever the values are; `None` if counting finds nothing.
pub(crate) fn counted(network: &Network, layout: &Layout, held: &[(usize, usize)]) -> Option<Defect> {
    let frame = || {
        let free = undetermined(network, held);
        if free.is_empty() {
            return None;
        }
        let mut reasons = reasons(layout, &State::of(network));
        reasons.retain(|reason| *reason == Reason::OnALine);
        Some(Defect::Datum { free, reasons })
    };
    let count = || {
        let (observations, unknowns) = (layout.counts.observations(), layout.counts.unknowns);
        let missing = format!("{observations} observations cannot determine {unknowns} unknowns");
        (layout.counts.redundancy() < 0).then_some(Defect::Count { missing })
    };
    points(network, layout).or_else(|| images(network, layout)).or_else(|| cameras(network, layout)).or_else(frame).or_else(count)
}

fn points(network: &Network, layout: &Layout) -> Option<Defect> {
    let mut distances = vec![0; layout.triple_free.len()];
    layout.distances.iter().flatten().for_each(|&end| distances[end] += 1);
    let lacking = |&i: &usize| {
        let known = (0..3).filter(|&axis| !layout.triple_free[i][axis] || network.points[i].coordinates[axis] != Status::Free).count();
        layout.is_triple_unknown(i) && 2 * layout.of_triple(i).len() + known + distances[i] < 3
    };
    let points: Vec<_> =
        (0..network.points.len()).filter(lacking).map(|i| (network.points[i].name.clone(), layout.of_triple(i).len())).collect();
    (!points.is_empty()).then_some(Defect::Points { points })
}

fn images(network: &Network, layout: &Layout) -> Option<Defect> {
    let lacking = |&i: &usize| {
        let image = &network.images[i];
        let unknowns = 3 * (usize::from(image.centre == Centre::Free) + usize::from(image.attitude == Attitude::Free));
        2 * layout.of_image[i].len() < unknowns
    };
    let images: Vec<_> =
        (0..network.images.len()).filter(lacking).map(|i| (network.images[i].name.clone(), layout.of_image[i].len())).collect();
    (!images.is_empty()).then_some(Defect::Images { images })
}

fn cameras(network: &Network, layout: &Layout) -> Option<Defect> {
    let mut coordinates = vec![0; network.cameras.len()];
    layout.sights.iter().for_each(|sight| coordinates[layout.camera_of[sight.image()]] += 2);
    let lacking = |(i, interior): (usize, &crate::network::Interior)| {
        let free = interior.parameters.iter().filter(|status| **status == Status::Free).count();
        let missing = format!("{free} free parameters of {} and {} image coordinates", interior.name, coordinates[i]);
        (coordinates[i] < free).then_some(Defect::Count { missing })
    };
    network.cameras.iter().enumerate().find_map(lacking)
}
