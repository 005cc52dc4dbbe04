//! The eight-group block in small, by a second solver: plain Gauss-Newton on dense normal equations, derivatives by differences, a frame of its own.

use std::collections::BTreeMap;

use calibench_model::Pose;
use calibench_records::figures::Group;
use calibench_records::results::Outcome;
use nalgebra::{DMatrix, DVector, Matrix3, Point3, Vector3};

use super::blocks::{BEND, HEAD, SETS, stand};
use super::{KEY, trials, views};
use crate::prepared::Prepared;

/// The camera of the scenario: mm, mm a pixel, middle of the frame (px), spacing of Ebner's grid (mm).
const C: f64 = 10.0;
const PITCH: f64 = 0.005;
const MIDDLE: [f64; 2] = [499.5, 400.0];
const B: f64 = 2.0;

/// An image point: image, point, group and where it was measured, px.
struct Sight {
    image: usize,
    point: usize,
    group: usize,
    at: [f64; 2],
}

/// Images (`M` and `X0`), points, and twelve parameters a group.
struct Block {
    poses: Vec<(Matrix3<f64>, Vector3<f64>)>,
    points: Vec<Vector3<f64>>,
    sets: Vec<[f64; 12]>,
    sights: Vec<Sight>,
}

fn small_rotation(by: [f64; 3]) -> Matrix3<f64> {
    nalgebra::Rotation3::from_scaled_axis(Vector3::from(by)).into_inner()
}

/// Ebner's correction of a measured place, mm: the formula as printed.
fn ebner([x, y]: [f64; 2], b: &[f64; 12]) -> [f64; 2] {
    let mean = 2.0 * B * B / 3.0;
    let (p, q) = (x * x - mean, y * y - mean);
    [
        b[0] * x + b[1] * y - 2.0 * b[2] * p + b[3] * x * y + b[4] * q + b[6] * x * q + b[8] * y * p + b[10] * p * q,
        -b[0] * y + b[1] * x + b[2] * x * y - 2.0 * b[3] * q + b[5] * p + b[7] * y * p + b[9] * x * q + b[11] * p * q,
    ]
}

impl Block {
    fn unknowns(&self) -> usize {
        6 * self.poses.len() + 3 * self.points.len() + 12 * self.sets.len()
    }

    /// The places of a sight's unknowns: of its image, its point and its group.
    fn places(&self, sight: &Sight) -> Vec<usize> {
        let (points, sets) = (6 * self.poses.len(), 6 * self.poses.len() + 3 * self.points.len());
        let image = 6 * sight.image..6 * sight.image + 6;
        let point = points + 3 * sight.point..points + 3 * sight.point + 3;
        image.chain(point).chain(sets + 12 * sight.group..sets + 12 * sight.group + 12).collect()
    }

    /// Measured less computed, px, with small changes of a sight's 21 unknowns.
    fn misclosure(&self, sight: &Sight, change: &[f64; 21]) -> [f64; 2] {
        let (m, centre) = &self.poses[sight.image];
        let centre = centre + Vector3::new(change[3], change[4], change[5]);
        let point = self.points[sight.point] + Vector3::new(change[6], change[7], change[8]);
        let n = small_rotation([change[0], change[1], change[2]]) * m * (point - centre);
        let ideal = [-C * n.x / n.z, -C * n.y / n.z];
        let set: [f64; 12] = std::array::from_fn(|i| self.sets[sight.group][i] + change[9 + i]);
        let mut seen = ideal;
        for _ in 0..60 {
            let by = ebner(seen, &set);
            seen = [ideal[0] + by[0], ideal[1] + by[1]];
        }
        [sight.at[0] - (MIDDLE[0] + seen[0] / PITCH), sight.at[1] - (MIDDLE[1] - seen[1] / PITCH)]
    }

    /// Normal equations, right side and sum of squares; derivatives are central differences.
    fn normal(&self) -> (DMatrix<f64>, DVector<f64>, f64) {
        let (mut n, mut right, mut sum) = (DMatrix::zeros(self.unknowns(), self.unknowns()), DVector::zeros(self.unknowns()), 0.0);
        for sight in &self.sights {
            let v = self.misclosure(sight, &[0.0; 21]);
            let by: [[f64; 2]; 21] = std::array::from_fn(|i| {
                let mut change = [0.0; 21];
                let step = 1e-6;
                change[i] = step;
                let ahead = self.misclosure(sight, &change);
                change[i] = -step;
                let back = self.misclosure(sight, &change);
                // Of the computed place.
                [0, 1].map(|axis| (back[axis] - ahead[axis]) / (2.0 * step))
            });
            let places = self.places(sight);
            sum += v[0] * v[0] + v[1] * v[1];
            for (i, &a) in places.iter().enumerate() {
                right[a] += by[i][0] * v[0] + by[i][1] * v[1];
                for (j, &b) in places.iter().enumerate() {
                    n[(a, b)] += by[i][0] * by[j][0] + by[i][1] * by[j][1];
                }
            }
        }
        (n, right, sum)
    }

    fn change(&mut self, by: &DVector<f64>) {
        let (points, sets) = (6 * self.poses.len(), 6 * self.poses.len() + 3 * self.points.len());
        for (i, (m, centre)) in self.poses.iter_mut().enumerate() {
            *m = small_rotation([by[6 * i], by[6 * i + 1], by[6 * i + 2]]) * *m;
            *centre += by.fixed_rows::<3>(6 * i + 3);
        }
        self.points.iter_mut().enumerate().for_each(|(i, point)| *point += by.fixed_rows::<3>(points + 3 * i));
        self.sets.iter_mut().flatten().enumerate().for_each(|(i, set)| *set += by[sets + i]);
    }

    /// Sums of squares step by step, then standard deviation of an image coordinate (px) and cofactors; the frame is held by seven coordinates.
    fn adjust(&mut self, [a, b, c]: [usize; 3]) -> (Vec<f64>, f64, DMatrix<f64>) {
        let points = 6 * self.poses.len();
        let held: Vec<usize> = [3 * a, 3 * a + 1, 3 * a + 2, 3 * b, 3 * b + 1, 3 * b + 2, 3 * c + 2].map(|i| points + i).to_vec();
        let free: Vec<usize> = (0..self.unknowns()).filter(|i| !held.contains(i)).collect();
        let redundancy = 2 * self.sights.len() - free.len();
        let mut sums = Vec::new();
        for _ in 0..30 {
            let (n, right, sum) = self.normal();
            sums.push(sum);
            let inverse = n.select_columns(&free).select_rows(&free).cholesky().expect("determined").inverse();
            let step = &inverse * right.select_rows(&free);
            let mut whole = DVector::zeros(self.unknowns());
            free.iter().zip(step.iter()).for_each(|(&at, &by)| whole[at] = by);
            self.change(&whole);
            let last = sums.len().checked_sub(2).map(|before| sums[before]);
            if last.is_some_and(|last| (last - sum).abs() < 1e-12 * sum) {
                let mut cofactors = DMatrix::zeros(self.unknowns(), self.unknowns());
                for (i, &a) in free.iter().enumerate() {
                    free.iter().enumerate().for_each(|(j, &b)| cofactors[(a, b)] = inverse[(i, j)]);
                }
                return (sums, (sum / redundancy as f64).sqrt(), cofactors);
            }
        }
        panic!("no convergence: {sums:?}")
    }
}

/// What was measured in the scenario, with start values: the survey, the truth of the stations and no parameters.
fn block(scenario: &calibench_scenario::Scenario, points: &[calibench_records::results::PointResult]) -> Block {
    let prepared = Prepared::new(views(scenario), KEY).unwrap();
    let stations: BTreeMap<&str, usize> = prepared.views.iter().enumerate().map(|(i, view)| (view.station.name.as_str(), i)).collect();
    let targets: BTreeMap<&str, usize> =
        prepared.subject.field.targets.iter().enumerate().map(|(i, target)| (target.id.as_str(), i)).collect();
    // The second digit of a station is its tilt, the fourth its roll.
    let group = |name: &str| 2 * usize::from(name.as_bytes()[1] == b'2') + usize::from(name.as_bytes()[3] == b'2');
    let sight = |point: &calibench_records::results::PointResult| {
        let Outcome::Measured { position, .. } = point.outcome else { panic!("{point:?}") };
        let (image, at) = (stations[&*point.view], [position.x, position.y]);
        Sight { image, point: targets[&*point.target], group: group(&point.view), at }
    };
    let pose = |pose: &Pose| (pose.rotation, pose.centre.coords);
    let at = |point: &Point3<f64>| point.coords;
    Block {
        poses: prepared.views.iter().map(|view| pose(&view.station.pose)).collect(),
        points: prepared.subject.field.targets.iter().map(|target| at(&target.surveyed)).collect(),
        sets: vec![[0.0; 12]; 4],
        sights: points.iter().map(sight).collect(),
    }
}

/// Sigma0, all parameters and their standard deviations agree to a millionth, whatever holds the frame and although the sum of squares rises on the way.
#[test]
fn a_dense_solver_with_differences_agrees_to_a_millionth() {
    let scenario = stand(BEND, "c = 10.0\n", &format!("{HEAD}[[block]]\nname = \"sets\"{SETS}"), "0.2");
    let trial = trials(&scenario, 1).swap_remove(0);
    let mut block = block(&scenario, &trial.points);
    assert_eq!((block.poses.len(), block.points.len(), block.sights.len()), (16, 25, 400));
    let (sums, sigma0, cofactors) = block.adjust([0, 4, 20]);
    let figures = trial.calibrations[0].outcome.as_ref().unwrap();
    let ours = figures.iter().find(|figure| figure.name.group() == Group::Network && figure.name.text() == "sigma0").unwrap().value;
    assert!((ours / sigma0 - 1.0).abs() < 1e-6, "{ours} {sigma0} {sums:?}");
    let first = 6 * block.poses.len() + 3 * block.points.len();
    let parameters: Vec<_> = figures.iter().filter(|figure| figure.name.group() == Group::Iop).collect();
    assert_eq!(parameters.len(), 48);
    for (i, (figure, value)) in parameters.iter().zip(block.sets.iter().flatten()).enumerate() {
        let sigma = sigma0 * cofactors[(first + i, first + i)].sqrt();
        assert!((figure.value - value).abs() < 1e-6 * sigma, "{}: {} {value} {sigma}", figure.name, figure.value);
        assert!((figure.sigma.unwrap() / sigma - 1.0).abs() < 1e-6, "{}: {:?} {sigma}", figure.name, figure.sigma);
    }
}
