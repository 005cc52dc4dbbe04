//! Object axes as drawings show them: along an object, up, and towards its viewer.

use calibench_records::description::Views;
use nalgebra::Vector3;

const NAMES: [&str; 3] = ["X", "Y", "Z"];
/// Coordinates beyond so many times the step of the object's size, a power of ten, are told from a multiple of it.
const FAR: f64 = 100.0;

/// An object axis as a drawing shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Side {
    index: usize,
    /// -1 where it is drawn the other way round.
    sign: f64,
    /// What is taken off, object units.
    origin: f64,
}

impl Side {
    /// What the drawing shows of a place, object units.
    pub(crate) fn of(&self, at: &[f64; 3]) -> f64 {
        self.sign * (at[self.index] - self.origin)
    }

    /// What the drawing shows of a direction.
    pub(crate) fn along(&self, direction: &[f64; 3]) -> f64 {
        self.sign * direction[self.index]
    }

    /// The other way round.
    pub(crate) fn reversed(self) -> Self {
        Self { sign: -self.sign, ..self }
    }

    /// The title of its scale, as in `-X, m` or `Y - 259270, m`.
    pub(crate) fn title(&self, unit: &str) -> String {
        let (name, origin) = (NAMES[self.index], self.origin);
        match (self.sign < 0.0, origin == 0.0) {
            (false, true) => format!("{name}, {unit}"),
            (true, true) => format!("-{name}, {unit}"),
            (false, false) => format!("{name} - {origin}, {unit}"),
            (true, false) => format!("{origin} - {name}, {unit}"),
        }
    }

    /// The least and the largest of what is drawn of `places`.
    pub(crate) fn span<'a>(&self, places: impl Iterator<Item = &'a [f64; 3]>) -> [f64; 2] {
        places.map(|at| self.of(at)).fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)])
    }
}

/// The axes of an object that a viewer stands before: to the right, up, and towards the viewer. An object is longer than it is high.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sides {
    pub(crate) across: Side,
    pub(crate) up: Side,
    pub(crate) towards: Side,
}

impl Sides {
    /// Those of an object with a `normal` towards the viewer, in a box from `low` to `high`: the axes that are nearest.
    pub(crate) fn of(normal: [f64; 3], [low, high]: &[[f64; 3]; 2]) -> Self {
        let towards = Vector3::from(normal).abs().imax();
        let [a, b] = [[1, 2], [0, 2], [0, 1]][towards];
        let (across, up) = if high[a] - low[a] >= high[b] - low[b] { (a, b) } else { (b, a) };
        let unit = |index: usize| Vector3::ith(index, 1.0);
        let sign = normal[towards].signum();
        // Right, up and towards the viewer are right-handed.
        let right = (unit(across).cross(&unit(up))[towards] * sign).signum();
        let size = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
        let step = 10_f64.powf(size.log10().floor());
        let side = |index: usize, sign| {
            let origin = if low[index].abs() > FAR * step { (low[index] / step).floor() * step } else { 0.0 };
            Side { index, sign, origin }
        };
        Self { across: side(across, right), up: side(up, 1.0), towards: side(towards, sign) }
    }
}

/// A box around the sheets, or around the targets where there is no sheet: lowest and highest coordinates. `None` without either.
pub(crate) fn around(views: &Views) -> Option<[[f64; 3]; 2]> {
    views.extent.or_else(|| {
        let each = |of: fn(f64, f64) -> f64| {
            let all = views.targets.iter().map(|target| target.surveyed);
            all.reduce(|a, b| std::array::from_fn(|i| of(a[i], b[i])))
        };
        Some([each(f64::min)?, each(f64::max)?])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: [[f64; 3]; 2] = [[-1.0, -7.0, -2.0], [0.5, 7.0, 2.0]];

    /// Before a wall that faces X, Y runs to the right; before its back, to the left.
    #[test]
    fn a_viewer_sees_right_up_and_towards_right_handed() {
        let front = Sides::of([1.0, 0.1, 0.0], &BOX);
        assert_eq!([front.across, front.up, front.towards].map(|side| side.title("m")), ["Y, m", "Z, m", "X, m"]);
        let back = Sides::of([-1.0, 0.1, 0.0], &BOX);
        assert_eq!([back.across, back.up, back.towards].map(|side| side.title("m")), ["-Y, m", "Z, m", "-X, m"]);
        assert_eq!((front.across.of(&[1.0, 3.0, 5.0]), back.across.of(&[1.0, 3.0, 5.0])), (3.0, -3.0));
        assert_eq!(front.towards.reversed().along(&[0.5, 0.0, 0.0]), -0.5);
    }

    #[test]
    fn large_coordinates_are_told_from_a_round_number() {
        let low = [149_450.0, 259_274.7, 613.3];
        let sides = Sides::of([1.0, 0.0, 0.0], &[low, [149_451.5, 259_287.9, 616.9]]);
        assert_eq!(
            [sides.across, sides.up, sides.towards.reversed()].map(|side| side.title("m")),
            ["Y - 259270, m", "Z, m", "149450 - X, m"]
        );
        assert!((sides.across.of(&low) - 4.7).abs() < 1e-9 && sides.towards.reversed().of(&low).abs() < 1e-9);
    }
}
