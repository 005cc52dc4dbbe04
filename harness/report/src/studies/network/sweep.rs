//! A sweep of a calibrated scenario: how the reduction factor depends on what is swept.

use calibench_records::description::Axis;
use calibench_records::figures::Quantity;
use rayon::prelude::*;

use super::pictures::floor::{Curve, Words, floor};
use super::sweep_orientation;
use crate::LoadError;
use crate::canvas::Pictures;
use crate::load::adjustments::{Summaries, Summary, load_cell};
use crate::markdown::{MarkdownTable, fixed, with_half};
use crate::studies::shown::OnPage;
use crate::sweep::{LoadedSweep, titled};

/// The text of a swept scenario with adjustments and its picture; `None` without adjustments.
///
/// # Errors
/// Records that cannot be read.
pub fn section(loaded: &LoadedSweep, OnPage { stem, printed, .. }: OnPage<'_>) -> Result<Option<(String, Pictures)>, LoadError> {
    let mut cells = Vec::new();
    let read: Vec<_> =
        (0..loaded.cells.len()).into_par_iter().map(|index| load_cell(&loaded.folder, (&loaded.name, &loaded.sweep, index))).collect();
    for (index, found) in read.into_iter().enumerate() {
        if let Some(found) = found? {
            cells.push((loaded.sweep.values(index)[0].clone(), found));
        }
    }
    let Some((_, first)) = cells.first() else { return Ok(None) };
    let swept = &loaded.sweep.axes[0];
    let axis = swept.name.clone();
    let [reference, set] = [&first.methods, &first.sets].map(|names| names.first().map_or("", String::as_str));
    let mut header = vec![format!("`{axis}`"), format!("sigma0 of {reference}, px")];
    let methods: Vec<String> = first.methods.iter().skip(1).cloned().collect();
    for method in &methods {
        header.extend([format!("`{method}`, reported"), format!("`{method}`, true errors")]);
    }
    let mut rows = MarkdownTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    let mut curves: Vec<Curve> = methods
        .iter()
        .flat_map(|method| {
            ["reported standard deviations", "true errors"].map(|what| Curve {
                method: method.clone(),
                name: format!("{method}, {what}"),
                points: Vec::new(),
            })
        })
        .collect();
    for (value, found) in &cells {
        let sigma0 = found.methods.first().and_then(|m| found.get(m, Quantity::Sigma0)?.value.mean());
        let mut row = vec![value.text.clone(), sigma0.map_or_else(String::new, |s| fixed(s, 3))];
        for (i, method) in methods.iter().enumerate() {
            for (k, factor) in [reported(found, method), truth(found, method)].into_iter().enumerate() {
                row.push(factor.map_or_else(String::new, |(ratio, half)| with_half(ratio, Some(half), 3)));
                if let (Some((ratio, half)), Some(x)) = (factor, value.number) {
                    curves[2 * i + k].points.push((x, ratio, half));
                }
            }
        }
        rows.row(row);
    }
    let (title, x, caption) = words(swept);
    let parameters = set.split(',').collect::<Vec<_>>().join(", ");
    let picture = floor(&curves, &Words { title: &title, x: &x, reference, parameters: &parameters }, printed);
    let file = format!("{stem}.png");
    let with_names: Vec<(String, &Summaries)> = cells.iter().map(|(value, found)| (value.text.clone(), found)).collect();
    let mut text = sweep_orientation::table(&axis, &with_names);
    if !methods.is_empty() {
        text.push_str(&format!(
            "Reduction factors against `{reference}`, mean over the parameters of `{set}`, ± half their 95 % interval over {} trials.\n\n{}\n",
            first.trials,
            rows.render()
        ));
    }
    if picture.is_some() {
        text.push_str(&format!("![{caption}]({file})\n\n"));
    }
    Ok(Some((text, picture.map(|picture| (file, picture)).into_iter().collect())))
}

/// The key of the error that all methods share.
const FLOOR: &str = "calibration.floor_px";

/// Title, what is swept and caption of the picture.
fn words(axis: &Axis) -> (String, String, String) {
    if axis.path == FLOOR {
        let x = format!("{}: standard deviation per axis of the common error, px", axis.name);
        return ("Reduction factor over the error that all methods share".into(), x, "The reduction factor over the noise floor".into());
    }
    (format!("Reduction factor over {}", axis.name), titled(axis), format!("The reduction factor over `{}`", axis.name))
}

fn averaged(found: &Summaries, method: &str, of: impl Fn(&Summary) -> Option<(f64, f64)>) -> Option<(f64, f64)> {
    let all: Vec<(f64, f64)> = found.scored().iter().map(|name| of(found.parameter(method, name)?)).collect::<Option<_>>()?;
    let n = all.len() as f64;
    (n > 0.0).then(|| (all.iter().map(|v| v.0).sum::<f64>() / n, all.iter().map(|v| v.1).sum::<f64>() / n))
}

fn reported(found: &Summaries, method: &str) -> Option<(f64, f64)> {
    averaged(found, method, |summary| Some((summary.sigma_ratio.mean()?, summary.sigma_ratio.half().unwrap_or(0.0))))
}

fn truth(found: &Summaries, method: &str) -> Option<(f64, f64)> {
    averaged(found, method, |summary| {
        let (ratio, half) = summary.errors.ratio()?;
        Some((ratio, half.unwrap_or(0.0)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(path: &str) -> Axis {
        Axis { path: path.into(), name: path.rsplit('.').next().unwrap().into(), values: Vec::new(), log: false }
    }

    /// Only the floor is an error that all methods share.
    #[test]
    fn a_picture_says_what_is_swept() {
        let (title, x, caption) = words(&axis("calibration.floor_px"));
        assert!(title.contains("all methods share") && x.contains("common error") && caption.contains("noise floor"));
        for (path, expected) in
            [("optics.blur", "blur, px"), ("calibration.survey_sigma", "calibration.survey_sigma"), ("sensor.grey_noise", "noise")]
        {
            let (title, x, caption) = words(&axis(path));
            assert!(x.contains(expected), "{path}: {x}");
            for text in [&title, &x, &caption] {
                assert!(!text.contains("common") && !text.contains("share") && !text.contains("floor"), "{path}: {text}");
            }
        }
    }

    #[test]
    fn a_picture_names_its_own_method_and_parameters() {
        let words = Words { title: "over blur", x: "blur, px", reference: "centroid", parameters: "c, x0, y0, k1, k2, p1, p2" };
        assert_eq!(words.factor(), "reduction factor against centroid, mean over c, x0, y0, k1, k2, p1, p2; bars: 95 %");
        let curves = [Curve { method: "m".into(), name: "m".into(), points: vec![(0.5, 0.75, 0.125), (1.0, 0.5, 0.25)] }];
        assert!(floor(&curves, &words, &[]).is_some());
    }
}
