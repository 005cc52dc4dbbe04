//! What is said where causes overlap: gross errors look like structures, and one structure like another.

use crate::Verdict;
use crate::allowed::Allowed;

/// Share of the variance that a structure must explain to be no shadow of gross errors.
pub(super) const EXPLAINED: f64 = 0.5;
/// A structure that explains less than this share of what another one does may be a shadow of it.
const HIDDEN: f64 = 0.8;

/// The verdicts on gross errors and on each structure, beside one another.
pub(super) fn settled(gross: Verdict, structures: [Allowed; 3]) -> (Verdict, [Verdict; 3]) {
    let most = structures.iter().map(Allowed::explains).fold(0.0, f64::max);
    let is_clean = structures.iter().any(|allowed| allowed.is_structure() && allowed.is_clean);
    match gross {
        // Image points are off together, and not for themselves.
        Verdict::Doubt(finding, _) | Verdict::Slight(finding, _) if is_clean => (Verdict::Sound(finding), beside(structures, most)),
        Verdict::Doubt(finding, cause) if most > EXPLAINED => (Verdict::Slight(finding, cause), beside(structures, most)),
        Verdict::Doubt(..) => (gross, [(); 3].map(|()| Verdict::Untested("image points are in gross error".into()))),
        other => (other, beside(structures, most)),
    }
}

/// The same where image points do not fit and are not wrong for themselves: something counts, however little it moves the camera. Without a doubt it is the structure
/// that explains most, or else what does not fit.
pub(super) fn counted(gross: Verdict, structures: [Verdict; 3]) -> (Verdict, [Verdict; 3]) {
    let explains = |verdict: &Verdict| match verdict {
        Verdict::Slight(finding, _) => finding.explains,
        _ => -1.0,
    };
    let most = structures.iter().map(explains).fold(-1.0, f64::max);
    if gross.is_doubt() || structures.iter().any(Verdict::is_doubt) {
        return (gross, structures);
    }
    if most < 0.0 {
        return (gross.doubted(), structures);
    }
    (gross, structures.map(|verdict| if explains(&verdict) >= most { verdict.doubted() } else { verdict }))
}

/// Without those that may be shadows of the one that explains `most`; a doubt is a shadow of none but another doubt.
fn beside(structures: [Allowed; 3], most: f64) -> [Verdict; 3] {
    let is_doubt = |allowed: &Allowed| allowed.verdict.is_doubt();
    let strongest_counts = structures.iter().any(|allowed| is_doubt(allowed) && allowed.explains() >= most);
    structures.map(|allowed| {
        let is_shadow = allowed.is_structure() && allowed.explains() < HIDDEN * most && (strongest_counts || !is_doubt(&allowed));
        if is_shadow { Verdict::Untested("another structure explains more of the residuals".into()) } else { allowed.verdict }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Finding;

    fn finding(explains: f64) -> Finding {
        Finding { p: 1e-9, moves: Some(5.0), explains }
    }

    fn doubt(explains: f64) -> Verdict {
        Verdict::Doubt(finding(explains), "cause".into())
    }

    fn slight(explains: f64) -> Verdict {
        Verdict::Slight(finding(explains), "cause".into())
    }

    fn sound() -> Verdict {
        Verdict::Sound(finding(0.0))
    }

    /// D, s, - and ? for doubt, slight, sound and untested.
    fn letters(verdicts: &[Verdict]) -> String {
        let letter = |verdict: &Verdict| match verdict {
            Verdict::Doubt(..) => 'D',
            Verdict::Slight(..) => 's',
            Verdict::Sound(_) => '-',
            Verdict::Untested(_) => '?',
        };
        verdicts.iter().map(letter).collect()
    }

    #[test]
    fn what_overlaps_is_said_once() {
        for (gross, structures, expected) in [
            // A structure that explains less than four fifths of another one is its shadow,
            (sound(), [doubt(0.9), slight(0.7), sound()], "-D?-"),
            (sound(), [doubt(0.9), slight(0.73), doubt(0.5)], "-Ds?"),
            (sound(), [doubt(0.6), doubt(0.6), doubt(0.6)], "-DDD"),
            // but no doubt is a shadow of what does not count.
            (sound(), [slight(0.9), doubt(0.5), slight(0.5)], "-sD?"),
            // Gross errors leave the rest untested, unless a structure explains more than half of the variance.
            (doubt(0.0), [doubt(0.4), slight(0.3), sound()], "D???"),
            (doubt(0.0), [doubt(0.6), sound(), sound()], "sD--"),
            (slight(0.0), [doubt(0.4), sound(), sound()], "sD--"),
        ] {
            let allowed = structures.clone().map(|verdict| Allowed { verdict, is_clean: false });
            let (gross, others) = settled(gross, allowed);
            assert_eq!(letters(&[gross]) + &letters(&others), expected, "{structures:?}");
        }
    }

    #[test]
    fn something_counts_where_points_are_off_together() {
        for (gross, structures, expected) in [
            (slight(0.0), [slight(0.6), slight(0.7), sound()], "ssD-"),
            (sound(), [sound(), sound(), slight(0.6)], "---D"),
            (slight(0.0), [sound(), Verdict::Untested(String::new()), sound()], "D-?-"),
            (slight(0.0), [doubt(0.6), slight(0.7), sound()], "sDs-"),
            (doubt(0.0), [slight(0.3), sound(), sound()], "Ds--"),
            (sound(), [sound(), sound(), sound()], "----"),
        ] {
            let (gross, others) = counted(gross, structures.clone());
            assert_eq!(letters(&[gross]) + &letters(&others), expected, "{structures:?}");
        }
    }

    #[test]
    fn gross_errors_that_go_with_a_structure_are_none() {
        let with = |verdict: Verdict| [Allowed { verdict, is_clean: true }, Allowed::untested(""), Allowed::untested("")];
        for gross in [doubt(0.0), slight(0.0)] {
            let (settled, others) = settled(gross.clone(), with(slight(0.2)));
            assert_eq!(letters(&[settled]) + &letters(&others), "-s??", "{gross:?}");
        }
        // Without a structure nothing went.
        let (settled, others) = settled(doubt(0.0), with(sound()));
        assert_eq!(letters(&[settled]) + &letters(&others), "D???");
    }
}
