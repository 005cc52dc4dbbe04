//! What a swept key and its values are called on an axis: in the field's words, with the unit.

use calibench_records::description::{Axis, Value};

/// The noise as a ratio of contrast to noise, dB; shown as noise in % of the contrast.
const SNR: &str = "snr_contrast_db";

/// The last part of the key that is a word: `tilts` of `stations.tilts.0.1`.
fn key(axis: &Axis) -> &str {
    axis.path.rsplit('.').find(|part| part.parse::<usize>().is_err()).unwrap_or(&axis.path)
}

/// The key with its unit; the whole path where neither is known.
pub fn titled(axis: &Axis) -> String {
    match key(axis) {
        SNR => "noise, % of contrast".into(),
        "snr_mean_db" => "mean of light and dark / noise, dB".into(),
        "grey_noise" => "noise, fraction of full scale".into(),
        "tilt" | "tilts" => "tilt, degrees".into(),
        "roll" | "rolls" => "rotation, degrees".into(),
        "angle" | "angles" => "corner angle, degrees".into(),
        name @ ("distance" | "distances" | "size" | "square" | "aside" | "bend" | "print_noise") if !axis.path.starts_with("camera") => {
            format!("{name}, object units")
        }
        name @ ("x0" | "y0" | "c") => format!("{name}, mm"),
        name @ ("blur" | "corner_blur" | "defocus" | "motion" | "window" | "sigma" | "gauss") => format!("{name}, px"),
        _ => axis.path.clone(),
    }
}

/// A value as its axis shows it.
pub fn label(axis: &Axis, value: &Value) -> String {
    match value.number {
        Some(db) if key(axis) == SNR => percent(db),
        _ => value.text.clone(),
    }
}

/// The noise in % of the contrast, two digits.
fn percent(db: f64) -> String {
    let share = 100.0 * 10_f64.powf(-db / 20.0);
    let digits = (1 - share.log10().floor() as i32).max(0) as usize;
    let text = format!("{share:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A number as its axis shows it, in the unit of [`titled`].
pub fn shown(axis: &Axis, number: f64) -> f64 {
    if key(axis) == SNR { percent(number).parse().unwrap_or(number) } else { number }
}

/// Where a value lies along its axis: more noise lies further on, though its dB are fewer.
pub fn position(axis: &Axis, number: f64) -> f64 {
    if key(axis) == SNR { -number } else { number }
}

#[cfg(test)]
mod tests {
    use super::percent;

    #[test]
    fn decibels_are_shown_as_shares_of_the_contrast() {
        assert_eq!([46.0, 40.0, 34.0, 26.0, 20.0].map(percent), ["0.5", "1", "2", "5", "10"]);
        assert_eq!([80.0, 0.0].map(percent), ["0.01", "100"]);
    }
}
