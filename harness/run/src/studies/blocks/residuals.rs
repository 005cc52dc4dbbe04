//! What residuals have in common in pairs of images.

use std::collections::BTreeMap;

use calibench_records::figures::Quantity;
use calibench_records::results::Figure;
use calibench_scenario::ResidualPairs;

use super::network::Solved;

/// Residuals (px) by station and target.
pub type Residuals = BTreeMap<(usize, usize), [f64; 2]>;

/// The residuals of a block's networks.
pub fn of(solved: &[Solved]) -> Residuals {
    solved.iter().flat_map(|one| one.residuals.iter().map(|(station, target, v)| ((*station, *target), *v))).collect()
}

/// Correlations of the residuals of the same targets within the pairs, and between the first image of each and the second of every other.
///
/// # Errors
/// In words: a pair without a common target.
pub fn compared(plan: &ResidualPairs, by_block: &[Residuals]) -> Result<Vec<Figure>, String> {
    let mut all = Residuals::new();
    plan.blocks.iter().for_each(|&block| all.extend(by_block[block].iter().map(|(key, v)| (*key, *v))));
    let (mut within, mut across) = (Vec::new(), Vec::new());
    for (i, [first, _]) in plan.pairs.iter().enumerate() {
        for (j, [_, second]) in plan.pairs.iter().enumerate() {
            if let Some(found) = correlation(&all, *first, *second) {
                if i == j { within.push(found) } else { across.push(found) }
            }
        }
    }
    if within.is_empty() {
        return Err("no pair of images has a target in common".into());
    }
    let figure = |quantity: Quantity, values: &[f64]| {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let scatter = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0)).sqrt();
        let sigma = (values.len() > 1).then(|| scatter / count.sqrt());
        Figure { name: quantity.into(), value: mean, sigma, error: None, unit: "" }
    };
    let mut figures = vec![figure(Quantity::CorrelationWithin, &within), Figure::plain(Quantity::Pairs, within.len() as f64, "")];
    if !across.is_empty() {
        figures.push(figure(Quantity::CorrelationAcross, &across));
    }
    Ok(figures)
}

/// The correlation about zero of the residuals of the targets that two images have in common; `None` without one.
fn correlation(all: &Residuals, first: usize, second: usize) -> Option<f64> {
    let (mut product, mut squares) = (0.0, [0.0; 2]);
    for ((_, target), a) in all.range((first, 0)..(first + 1, 0)) {
        let Some(b) = all.get(&(second, *target)) else { continue };
        product += a[0] * b[0] + a[1] * b[1];
        squares = [squares[0] + a[0] * a[0] + a[1] * a[1], squares[1] + b[0] * b[0] + b[1] * b[1]];
    }
    let norm = (squares[0] * squares[1]).sqrt();
    (norm > 0.0).then(|| product / norm)
}

#[cfg(test)]
mod tests {
    use calibench_records::results::find;

    use super::*;

    #[test]
    fn equal_and_opposite_residuals_and_those_of_other_targets() {
        let all: Residuals =
            [((0, 1), [1.0, 2.0]), ((0, 2), [-1.0, 0.5]), ((1, 1), [2.0, 4.0]), ((1, 2), [-2.0, 1.0]), ((1, 9), [7.0, 7.0])].into();
        assert!((correlation(&all, 0, 1).unwrap() - 1.0).abs() < 1e-15);
        let mut turned = all.clone();
        turned.insert((1, 1), [-2.0, -4.0]);
        turned.insert((1, 2), [2.0, -1.0]);
        assert!((correlation(&turned, 0, 1).unwrap() + 1.0).abs() < 1e-15);
        assert_eq!(correlation(&all, 0, 5), None);
        let plan = ResidualPairs { blocks: vec![0], pairs: vec![[0, 1], [1, 0]] };
        let figures = compared(&plan, &[all]).unwrap();
        let value = |quantity: Quantity| find(&figures, quantity).map(|figure| figure.value);
        assert_eq!((value(Quantity::Pairs), value(Quantity::CorrelationWithin)), (Some(2.0), Some(1.0)));
    }
}
