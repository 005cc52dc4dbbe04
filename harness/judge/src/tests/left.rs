//! What is left of each corner is what the rows say of each photograph.

use calibench_records::judgement::measure;

use super::{judged, material, options};
use crate::remaining;

#[test]
fn residuals_of_corners_make_the_figures_of_photographs() {
    let mut material = material("left", 0, 8, &[0.1, 0.1]);
    // A corner that one operator lacks, and one that is 3 px off: its residual points back.
    material.operators[1].at[2][5] = None;
    let at = material.operators[1].at[4][20].as_mut().unwrap();
    at.x += 3.0;
    let options = options(&["opencv5"], 2);
    let (rows, _) = judged(&material, &options);
    let found = remaining(&material, 1, &options.models[0], &options).unwrap();
    assert_eq!(found.len(), 8 * 54 - 1);
    for (view, name) in material.views.iter().enumerate() {
        let own: Vec<_> = found.iter().filter(|one| one.view == view).collect();
        let rms = (own.iter().map(|one| one.v[0].powi(2) + one.v[1].powi(2)).sum::<f64>() / own.len() as f64).sqrt();
        let row =
            rows.iter().find(|row| &*row.method == "operator-2" && &*row.measure == measure::RESIDUALS && row.place == *name).unwrap();
        assert_eq!(row.count, Some(own.len()));
        assert!((row.value.unwrap() - rms).abs() < 1e-6 * rms, "{name}: {rms} {:?}", row.value);
        assert!(own.iter().all(|one| material.operators[1].at[view][one.corner] == Some(one.at)));
    }
    let worst = found.iter().max_by(|a, b| a.v[0].hypot(a.v[1]).total_cmp(&b.v[0].hypot(b.v[1]))).unwrap();
    assert_eq!((worst.view, worst.corner), (4, 20));
    assert!(worst.v[0] < -2.0 && worst.v[1].abs() < 0.7, "{:?}", worst.v);
}
