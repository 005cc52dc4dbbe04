//! A part of a network: some of its images.

use calibench_adjust::{ImageObservation, Network};

/// The network of those images that `takes` takes by their index, without the observations `left_out` and without points that fewer than `least` of its images show; and the
/// indices that its points had.
pub fn part_of(whole: &Network, left_out: &[usize], takes: impl Fn(usize) -> bool, least: usize) -> (Network, Vec<usize>) {
    let images: Vec<usize> = (0..whole.images.len()).filter(|&image| takes(image)).collect();
    let mut image_place = vec![usize::MAX; whole.images.len()];
    images.iter().enumerate().for_each(|(new, &old)| image_place[old] = new);
    let mut is_taken: Vec<bool> = whole.observations.iter().map(|seen| image_place[seen.image] != usize::MAX).collect();
    left_out.iter().for_each(|&index| is_taken[index] = false);
    let taken = || whole.observations.iter().zip(&is_taken).filter(|(_, taken)| **taken).map(|(seen, _)| seen);
    let mut counts = vec![0; whole.points.len()];
    taken().for_each(|seen| counts[seen.point] += 1);
    let points: Vec<usize> = (0..whole.points.len()).filter(|&point| counts[point] >= least).collect();
    let mut point_place = vec![usize::MAX; whole.points.len()];
    points.iter().enumerate().for_each(|(new, &old)| point_place[old] = new);
    let observations = taken().filter(|seen| point_place[seen.point] != usize::MAX);
    let observations =
        observations.map(|seen| ImageObservation { image: image_place[seen.image], point: point_place[seen.point], ..*seen }).collect();
    let network = Network {
        images: images.iter().map(|&image| whole.images[image].clone()).collect(),
        points: points.iter().map(|&point| whole.points[point].clone()).collect(),
        observations,
        ..whole.clone()
    };
    (network, points)
}
