//! Whether the cameras of a rig still sit where they sat, for a terminal.

use std::fmt::Write;

use calibench_calibrate::rig::{Known, RigCalibration, Stand, Still};

use crate::markdown::plain;

/// A paragraph for each camera but the first: the verdict, how far it moved and turned, and what that is at a distance.
pub fn rig_stands(found: &RigCalibration<'_>, stands: &[Stand], (distance, margin_px): (f64, f64)) -> String {
    let mut text: String = found.doubts.iter().map(|doubt| format!("in doubt: {}\n", doubt.words)).collect();
    let (moments, origin) = (found.prepared.rig.stations.len(), found.origin());
    let _ = writeln!(text, "{moments} moments, residuals {} px RMS; interiors as the file has them", plain(found.rms_px()));
    for stand in stands {
        let name = found.name_of(stand.camera);
        let verdict = match stand.verdict(margin_px) {
            Still::Stands => format!("{name} stands as it did against {origin}, up to {} px", plain(margin_px)),
            Still::Moved => format!("{name} has moved against {origin}, by more than {} px", plain(margin_px)),
            Still::CannotTell => {
                format!("{name}: these images do not tell whether it moved against {origin} by more than {} px", plain(margin_px))
            }
        };
        let _ = writeln!(
            text,
            "{verdict}\n  moved by {}, turned by {}\u{b0}; F {:.2}, p {:.1e}",
            with_sigma(stand.moved),
            with_sigma(stand.turned_deg),
            stand.f,
            stand.p
        );
        let _ = writeln!(
            text,
            "  at {}: {} across its line of sight, {} px RMS",
            plain(distance),
            with_sigma(stand.across),
            with_sigma(stand.px)
        );
        if stand.times > 1.0 {
            let _ = writeln!(text, "  standard deviations {:.1} times those of the adjustment, as leaving moments out shows", stand.times);
        }
    }
    text
}

/// A value to the digits of its standard deviation, of which two are shown.
fn with_sigma(Known { value, sigma }: Known) -> String {
    if !(sigma > 0.0 && sigma.is_finite()) {
        return plain(value);
    }
    let digits = (1.0 - sigma.log10().floor()).clamp(0.0, 12.0) as usize;
    format!("{value:.digits$} +- {sigma:.digits$}")
}
