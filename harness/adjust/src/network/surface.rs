//! Surfaces that control points lie on and whose shape is unknown.

use nalgebra::{Matrix3, Point3, Vector3};

use super::{Datum, Network, NetworkError, Status};

/// Control points that share a shape which is an unknown: a point is at `P = P0 + B a`, with its known position `P0` and the three coefficients `a` of all.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Its name in messages.
    pub name: String,
    /// Start values of the coefficients, object units.
    pub coefficients: [f64; 3],
    /// What is known of each coefficient.
    pub statuses: [Status; 3],
    /// Its points.
    pub points: Vec<OnSurface>,
}

/// A point of a surface: fixed control but for the surface's shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnSurface {
    /// Index of the object point.
    pub point: usize,
    /// `B`, 3 x 3, numbers: each column is the shift of the point for one object unit of a coefficient.
    pub basis: Matrix3<f64>,
}

/// Which unknowns move which points. An unknown triple is a point's own X, Y and Z, or, after all points', a surface's coefficients.
#[derive(Clone, Debug, Default)]
pub(crate) struct Triples {
    /// How many points there are.
    points: usize,
    /// How many surfaces there are.
    pub(crate) surfaces: usize,
    /// Of each point, the surface that moves it and how; empty without surfaces.
    moved_by: Vec<Option<(usize, Matrix3<f64>)>>,
}

impl Triples {
    pub(crate) fn of(network: &Network) -> Self {
        let (points, surfaces) = (network.points.len(), network.surfaces.len());
        let mut moved_by = vec![None; if surfaces > 0 { points } else { 0 }];
        for (index, surface) in network.surfaces.iter().enumerate() {
            surface.points.iter().for_each(|on| moved_by[on.point] = Some((index, on.basis)));
        }
        Self { points, surfaces, moved_by }
    }

    /// The triple that moves a point.
    #[inline]
    pub(crate) fn of_point(&self, point: usize) -> usize {
        self.surface_of(point).map_or(point, |(surface, _)| self.points + surface)
    }

    /// The surface that moves a point, and how.
    #[inline]
    pub(crate) fn surface_of(&self, point: usize) -> Option<(usize, &Matrix3<f64>)> {
        self.moved_by.get(point)?.as_ref().map(|(surface, basis)| (*surface, basis))
    }

    /// The triples of the surfaces.
    pub(crate) fn of_surfaces(&self) -> std::ops::Range<usize> {
        self.points..self.points + self.surfaces
    }

    /// Moves the points of the surfaces as `change` of all triples changes their coefficients.
    pub(crate) fn carry(&self, change: &[[f64; 3]], points: &mut [Point3<f64>]) {
        for (point, moved_by) in points.iter_mut().zip(&self.moved_by) {
            if let Some((surface, basis)) = moved_by {
                *point += basis * Vector3::from(change[self.points + surface]);
            }
        }
    }
}

impl Network {
    pub(super) fn check_surfaces(&self) -> Result<(), NetworkError> {
        if self.surfaces.is_empty() {
            return Ok(());
        }
        let refuse = |of: &str, why: &'static str| Err(NetworkError::Surface { name: of.to_owned(), why });
        let mut taken = vec![false; self.points.len()];
        for surface in &self.surfaces {
            if self.datum != Datum::Control {
                return refuse(&surface.name, "its points are control, and the datum makes them start values");
            }
            for on in &surface.points {
                super::check::within(|| format!("surface {}", surface.name), "point", on.point, self.points.len())?;
                super::check::finite(|| format!("surface {}", surface.name), on.basis.iter().copied())?;
                if self.points[on.point].coordinates != [Status::Fixed; 3] {
                    return refuse(&surface.name, "one of its points is not fixed");
                }
                if std::mem::replace(&mut taken[on.point], true) {
                    return refuse(&surface.name, "one of its points is on a surface already");
                }
            }
        }
        Ok(())
    }
}
