//! The poses are eliminated, each over the columns that its image touches.

use super::CORE;
use super::equations::{Frame, ImageNormals, SplinedNormals, SplinedStep};
use crate::solve::{Factor, Reduced, Run, backward, cholesky, forward, subtract_6};

/// An image whose pose its own points do not determine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Loose(pub(super) usize);

/// What is left of the equations: the matrix of what is kept, its right side, and of each image the factor of its own block.
pub(super) struct Eliminated {
    pub(super) matrix: Reduced,
    right: Vec<f64>,
    factors: Vec<[[f64; 6]; 6]>,
}

/// Columns of an image that follow each other without a gap: the first one's place in the image and among all that is kept, and their number.
type Group = (usize, usize, usize);

impl SplinedNormals {
    /// Eliminates the poses; diagonals are raised by the share `damping`.
    ///
    /// # Errors
    /// [`Loose`].
    pub(super) fn eliminate(&self, damping: f64) -> Result<Eliminated, Loose> {
        let n = self.right.len();
        let (mut values, mut right, mut factors) = (self.kept.clone(), self.right.clone(), Vec::with_capacity(self.images.len()));
        (0..n).for_each(|i| values[i * (n + 1)] *= 1.0 + damping);
        let (mut groups, mut runs) = (Vec::new(), Vec::new());
        for (index, image) in self.images.iter().enumerate() {
            let mut own = image.own;
            (0..6).for_each(|i| own[i][i] *= 1.0 + damping);
            let l = cholesky(&own).ok_or(Loose(index))?;
            let (y, mut z, m) = (image.solved(&l), image.right, image.columns.len());
            forward(&l, &mut z);
            group(&image.columns, &mut groups);
            for (i, &(from, column, width)) in groups.iter().enumerate() {
                runs.clear();
                runs.extend(groups[i..].iter().map(|&(from, row, length)| Run { from, start: column * n + row, length }));
                subtract_6(&y, m, (from, width), &runs, n, &mut values);
            }
            for (k, &column) in image.columns.iter().enumerate() {
                right[column] -= (0..6).map(|d| y[d * m + k] * z[d]).sum::<f64>();
            }
            factors.push(l);
        }
        Ok(Eliminated { matrix: Reduced { size: n, values, sparse: None }, right, factors })
    }

    /// The step of the control points alone, all else as it is; `None` if their equations are singular.
    pub(super) fn settling(&self, frame: &Frame<'_>) -> Option<SplinedStep> {
        let n = self.right.len();
        let control = CORE..frame.of.numbers();
        let (mut values, mut kept) = (self.kept.clone(), self.right.clone());
        for held in (0..n).filter(|i| !control.contains(i)) {
            values[held * n..(held + 1) * n].fill(0.0);
            (0..held).for_each(|column| values[column * n + held] = 0.0);
            values[held * (n + 1)] = 1.0;
            kept[held] = 0.0;
        }
        Factor::of(Reduced { size: n, values, sparse: None }, self.scale(), None)?.solve(&mut kept);
        kept.iter().all(|value| value.is_finite()).then(|| SplinedStep { kept, poses: vec![[0.0; 6]; self.images.len()] })
    }

    /// Roots of the diagonal of what is kept.
    fn scale(&self) -> Vec<f64> {
        let n = self.right.len();
        let root = |value: f64| if value > 0.0 { value.sqrt() } else { 1.0 };
        (0..n).map(|i| root(self.kept[i * (n + 1)])).collect()
    }
}

impl ImageNormals {
    /// `L^-1` of the coupling: 6 x columns, row by row.
    pub(super) fn solved(&self, l: &[[f64; 6]; 6]) -> Vec<f64> {
        let (mut y, m) = (self.coupling.clone(), self.columns.len());
        for (i, row) in l.iter().enumerate() {
            let (above, this) = y.split_at_mut(i * m);
            for (k, factor) in row[..i].iter().enumerate() {
                this[..m].iter_mut().zip(&above[k * m..]).for_each(|(y, above)| *y -= factor * above);
            }
            this[..m].iter_mut().for_each(|y| *y /= row[i]);
        }
        y
    }
}

fn group(columns: &[usize], into: &mut Vec<Group>) {
    into.clear();
    for (place, &column) in columns.iter().enumerate() {
        match into.last_mut() {
            Some((_, first, length)) if *first + *length == column => *length += 1,
            _ => into.push((place, column, 1)),
        }
    }
}

impl Eliminated {
    /// Decomposes what is kept; `None` if it is singular.
    pub(super) fn factor(self, normals: &SplinedNormals) -> Option<Solved> {
        let factor = Factor::of(self.matrix, normals.scale(), None)?;
        Some(Solved { factor, right: self.right, factors: self.factors })
    }
}

/// The equations, solved.
#[derive(Clone, Debug)]
pub(super) struct Solved {
    factor: Factor,
    right: Vec<f64>,
    pub(super) factors: Vec<[[f64; 6]; 6]>,
}

/// The equations, solved, with [`Solved::cofactors`].
#[derive(Clone, Debug)]
pub(super) struct Inverse {
    pub(super) solved: Solved,
    pub(super) cofactors: Vec<f64>,
}

impl Solved {
    /// The step that the equations ask for; `None` if it is no number.
    pub(super) fn step(&self, normals: &SplinedNormals) -> Option<SplinedStep> {
        let mut kept = self.right.clone();
        self.factor.solve(&mut kept);
        let pose = |(image, l): (&ImageNormals, &[[f64; 6]; 6])| {
            let m = image.columns.len();
            let mut x: [f64; 6] = std::array::from_fn(|d| {
                let row = &image.coupling[d * m..(d + 1) * m];
                image.right[d] - row.iter().zip(&image.columns).map(|(c, &column)| c * kept[column]).sum::<f64>()
            });
            forward(l, &mut x);
            backward(l, &mut x);
            x
        };
        let poses: Vec<[f64; 6]> = normals.images.iter().zip(&self.factors).map(pose).collect();
        let finite = kept.iter().chain(poses.as_flattened()).all(|value| value.is_finite());
        finite.then_some(SplinedStep { kept, poses })
    }

    /// The cofactors of what is kept: both triangles, column by column; zeros of what may not change.
    pub(super) fn cofactors(&self, frame: &Frame<'_>) -> Vec<f64> {
        let n = self.right.len();
        let mut inverse = Reduced { size: n, values: vec![0.0; n * n], sparse: None };
        self.factor.inverse(&mut inverse);
        let mut values = inverse.into_dense();
        for held in (0..n).filter(|&i| !frame.free[i]) {
            values[held * (n + 1)] = 0.0;
        }
        values
    }
}
