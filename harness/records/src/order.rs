//! The order of rows: what all methods say of one target stands together, so that what they share compresses to nothing.

use std::collections::HashMap;

use crate::results::PointResult;

/// Remembers which methods have had a row: readers number them by their first.
#[derive(Default)]
pub(crate) struct Order {
    met: Vec<bool>,
}

impl Order {
    /// The points, which are in the order of their methods, target by target; in the order given where a reader would not find that order again.
    pub(crate) fn of<'a>(&mut self, points: &'a [PointResult]) -> Vec<&'a PointResult> {
        // The method with most points knows best in which order the targets are: others measure some kinds of them.
        let mut methods: Vec<&[PointResult]> = points.chunk_by(|a, b| a.method == b.method).collect();
        methods.sort_by_key(|points| std::cmp::Reverse(points.len()));
        let mut targets = HashMap::new();
        for point in methods.into_iter().flatten() {
            let next = targets.len();
            targets.entry(target(point)).or_insert(next);
        }
        let mut rows: Vec<&PointResult> = points.iter().collect();
        rows.sort_by_cached_key(|point| targets[&target(point)]);
        if !self.is_found_again(&rows, points) {
            rows = points.iter().collect();
        }
        self.meet(points);
        rows
    }

    /// Whether a reader that numbers methods by their first row and sorts the rows by method finds the order of `points`.
    fn is_found_again(&self, rows: &[&PointResult], points: &[PointResult]) -> bool {
        let new = Self { met: self.met.clone() }.meet(rows.iter().copied());
        let mut sorted = rows.to_vec();
        sorted.sort_by_key(|point| point.method);
        new.is_sorted() && sorted.into_iter().zip(points).all(|(a, b)| std::ptr::eq(a, b))
    }

    /// Those of the methods that had no row before, in the order in which they come.
    fn meet<'a>(&mut self, points: impl IntoIterator<Item = &'a PointResult>) -> Vec<usize> {
        let mut new = Vec::new();
        for PointResult { method, .. } in points {
            self.met.resize(self.met.len().max(method + 1), false);
            if !std::mem::replace(&mut self.met[*method], true) {
                new.push(*method);
            }
        }
        new
    }
}

/// A target in an image.
fn target(point: &PointResult) -> (&str, &str) {
    (&point.view, &point.target)
}

#[cfg(test)]
mod tests {
    use calibench_model::Rejection;

    use super::*;
    use crate::results::Outcome;

    fn point(target: &str, method: usize) -> PointResult {
        PointResult::new("v", target, method, Outcome::Rejected(Rejection::NoCorner))
    }

    fn order(order: &mut Order, points: &[PointResult]) -> Vec<(String, usize)> {
        order.of(points).into_iter().map(|point| (point.target.to_string(), point.method)).collect()
    }

    fn named(rows: &[(&str, usize)]) -> Vec<(String, usize)> {
        rows.iter().map(|(target, method)| ((*target).to_owned(), *method)).collect()
    }

    #[test]
    fn methods_stand_together_at_a_target() {
        let points = [point("a", 0), point("b", 0), point("a", 1), point("b", 1), point("a", 2)];
        assert_eq!(order(&mut Order::default(), &points), named(&[("a", 0), ("a", 1), ("a", 2), ("b", 0), ("b", 1)]));
    }

    #[test]
    fn a_method_that_comes_late_is_not_numbered_first() {
        // Sorted by targets method 2 would come before method 1, and keep its place for all trials.
        let points = [point("a", 0), point("b", 1), point("a", 2)];
        let given = named(&[("a", 0), ("b", 1), ("a", 2)]);
        let mut met = Order::default();
        assert_eq!(order(&mut met, &points), given);
        assert_eq!(order(&mut met, &points), named(&[("a", 0), ("a", 2), ("b", 1)]), "all are numbered by now");
    }

    #[test]
    fn who_measures_all_kinds_of_targets_says_their_order() {
        let points = [point("a", 0), point("c", 0), point("a", 1), point("b", 1), point("c", 1)];
        assert_eq!(order(&mut Order::default(), &points), named(&[("a", 0), ("a", 1), ("b", 1), ("c", 0), ("c", 1)]));
    }

    #[test]
    fn an_order_that_would_be_lost_stays() {
        // Method 1 came to the targets the other way round.
        let points = [point("a", 0), point("b", 0), point("b", 1), point("a", 1)];
        let given: Vec<_> = points.iter().map(|point| (point.target.to_string(), point.method)).collect();
        assert_eq!(order(&mut Order::default(), &points), given);
    }
}
