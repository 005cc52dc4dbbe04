//! Numbers of each image's own: eliminated before anything else, image by image.

use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector};

use super::blocks::Normals;
use super::own::Own;
use super::projection::POSE;
use crate::network::{Layout, Network};
use crate::state::{State, Step};

/// What the images before one have said of what it shares with them, put aside.
pub(super) struct Aside {
    camera: Vec<f64>,
    right: Vec<f64>,
    pair: Vec<f64>,
    point: ([f64; 9], [f64; 3]),
}

/// Where the blocks of an image with numbers of its own stand.
struct Place {
    image: usize,
    camera: usize,
    parameters: Range<usize>,
    /// The one surface that there may be, and its coupling with the camera.
    surface: Option<(usize, Range<usize>)>,
}

impl Place {
    fn of(layout: &Layout, image: usize) -> Self {
        let camera = layout.camera_of[image];
        let place = &layout.cameras[camera];
        let (offset, width) = (place.offset, place.free.len());
        let surface = layout.surface().map(|triple| {
            let pair = layout.pairs_of(triple).map(|pair| layout.pairs[pair]).find(|pair| pair.camera == camera);
            (triple, pair.map_or(0..0, |pair| pair.offset..pair.offset + 3 * width))
        });
        Self { image, camera, parameters: offset..offset + width, surface }
    }
}

fn add(into: &mut [f64], from: &[f64]) {
    into.iter_mut().zip(from).for_each(|(into, from)| *into += from);
}

impl Normals {
    /// Puts aside what other images say of what this one shares with them.
    pub(super) fn put_aside(&mut self, layout: &Layout, image: usize) -> Aside {
        let Place { camera, parameters, surface, .. } = Place::of(layout, image);
        let taken = |values: &mut [f64]| values.iter_mut().map(std::mem::take).collect::<Vec<f64>>();
        Aside {
            camera: taken(&mut self.camera[camera]),
            right: taken(&mut self.camera_right[parameters]),
            pair: surface.as_ref().map(|(_, pair)| taken(&mut self.point_camera[pair.clone()])).unwrap_or_default(),
            point: surface
                .map(|(triple, _)| (std::mem::take(&mut self.point[triple]), std::mem::take(&mut self.point_right[triple])))
                .unwrap_or_default(),
        }
    }

    /// Eliminates the numbers of an image's own from its equations, and adds what was put aside; `None` if they are not numbers.
    pub(super) fn eliminate_own(
        &mut self,
        (network, layout): (&Network, &Layout),
        state: &State,
        image: usize,
        aside: &Aside,
    ) -> Option<()> {
        let place = Place::of(layout, image);
        let along = layout.along(network, place.camera);
        let width = place.parameters.len();
        let own: Vec<(f64, f64)> =
            network.of_each_image(place.camera).zip(&state.own[image]).map(|(own, value)| (own.sigma.powi(-2), *value)).collect();
        let block = DMatrix::from_row_slice(width, width, &self.camera[place.camera]);
        let across = self.across(&place, &block) * &along;
        let mut matrix = along.tr_mul(&(&block * &along));
        let mut right = along.tr_mul(&DVector::from_column_slice(&self.camera_right[place.parameters.clone()]));
        for (i, (weight, value)) in own.into_iter().enumerate() {
            matrix[(i, i)] += weight;
            right[i] -= weight * value;
            self.cost += weight * value * value;
        }
        let factor = Cholesky::new(matrix)?;
        let (follow, alone) = (factor.solve(&across.transpose()), factor.solve(&right));
        self.own_gain += right.dot(&alone);
        self.subtract_own(&place, &(&across * &follow), &(&across * &alone));
        self.own[image] = Own { along, cofactors: factor.inverse(), follow, alone };
        add(&mut self.camera[place.camera], &aside.camera);
        add(&mut self.camera_right[place.parameters], &aside.right);
        if let Some((triple, pair)) = place.surface {
            add(&mut self.point_camera[pair], &aside.pair);
            add(&mut self.point[triple], &aside.point.0);
            add(&mut self.point_right[triple], &aside.point.1);
        }
        Some(())
    }

    /// Products of pose, parameters and surface with the parameters: (6 + n + 3) x n.
    fn across(&self, place: &Place, block: &DMatrix<f64>) -> DMatrix<f64> {
        let width = place.parameters.len();
        let pair = place.surface.as_ref().map_or(&[][..], |(_, pair)| &self.point_camera[pair.clone()]);
        DMatrix::from_fn(POSE + width + pair.len() / width.max(1), width, |i, j| match i {
            i if i < POSE => self.pose_camera[place.image][i * width + j],
            i if i < POSE + width => block[(i - POSE, j)],
            i => pair[(i - POSE - width) * width + j],
        })
    }

    fn subtract_own(&mut self, place: &Place, product: &DMatrix<f64>, right: &DVector<f64>) {
        let (image, width) = (place.image, place.parameters.len());
        let beyond = POSE + width;
        for i in 0..POSE {
            (0..POSE).for_each(|j| self.pose[image][i * POSE + j] -= product[(i, j)]);
            (0..width).for_each(|j| self.pose_camera[image][i * width + j] -= product[(i, POSE + j)]);
            self.pose_right[image][i] -= right[i];
        }
        for i in 0..width {
            (0..width).for_each(|j| self.camera[place.camera][i * width + j] -= product[(POSE + i, POSE + j)]);
            self.camera_right[place.parameters.start + i] -= right[POSE + i];
        }
        let Some((triple, pair)) = place.surface.as_ref().filter(|(_, pair)| !pair.is_empty()) else { return };
        for i in 0..3 {
            (0..3).for_each(|j| self.point[*triple][3 * i + j] -= product[(beyond + i, beyond + j)]);
            (0..width).for_each(|j| self.point_camera[pair.start + i * width + j] -= product[(beyond + i, POSE + j)]);
            (0..POSE).for_each(|j| self.surface_pose[image][i * POSE + j] -= product[(beyond + i, j)]);
            self.point_right[*triple][i] -= right[beyond + i];
        }
    }

    /// The step of the numbers of each image's own, from those of all else.
    pub(crate) fn follow(&self, layout: &Layout, step: &mut Step) {
        step.own.clear();
        for (image, own) in self.own.iter().enumerate() {
            if own.is_none() {
                step.own.push(Vec::new());
                continue;
            }
            let Place { parameters, surface, .. } = Place::of(layout, image);
            let surface = surface.filter(|(_, pair)| !pair.is_empty()).map_or(&[][..], |(triple, _)| &step.points[triple]);
            let all = step.poses[image].iter().chain(&step.cameras[parameters]).chain(surface);
            let rest = DVector::from_iterator(own.follow.ncols(), all.copied());
            step.own.push((&own.alone - &own.follow * rest).as_slice().to_vec());
        }
    }
}
