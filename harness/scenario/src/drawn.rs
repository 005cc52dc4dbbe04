//! For what the random numbers of a scenario are drawn.

use toml::de::{DeTable, DeValue};

use crate::resolved::text_of;
use crate::sweep::Sweep;

const FIELD: &str = "testfield";
/// Tables that say what is pictured beside it.
const PICTURED: [&str; 7] = ["scene", "figure", "photographs", "camera", "stations", "station", "mount"];
/// Keys of stations that say how light becomes grey values there.
const OF_STATIONS: [&str; 5] = ["blur", "motion", "exposure", "veil", "gradient_across"];
const TRANSFER: &str = "transfer";
/// Keys of these tables that say how much is drawn, how it becomes grey values, or what is done with it: whoever changes one of them alone draws the same numbers.
const ASIDE: [&str; 11] =
    ["grey_noise", "bits", "phase", "pixels", "pointing", "print_noise", "survey_sigma", "sigma_px", "method", "case", "decomposition"];

/// For what the random numbers of a scenario are drawn, as digests: what is pictured, from where. With the seed they are all that draws depend on: not its name and words, not
/// light, sensor, amounts of noise and methods, nor what is made of its points. Cells of a sweep draw the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Drawn {
    /// The testfield by itself: the same thing in whatever scenario pictures it.
    pub field: String,
    /// All that is pictured.
    pub all: String,
}

impl Drawn {
    /// That of the table of a file; of a sweep, whatever values it has.
    pub(crate) fn of(root: &DeTable<'_>, sweep: Option<&Sweep>) -> Self {
        let mut root = sweep.map_or_else(|| root.clone(), |sweep| sweep.without_values(root));
        for (_, table) in &mut root {
            if let DeValue::Table(table) = table.get_mut() {
                ASIDE.iter().for_each(|key| drop(table.remove(*key)));
            }
        }
        if let Some(DeValue::Array(stations)) = root.get_mut("station").map(toml::Spanned::get_mut) {
            for station in stations.iter_mut() {
                if let DeValue::Table(station) = station.get_mut() {
                    OF_STATIONS.iter().for_each(|key| drop(station.remove(*key)));
                }
            }
        }
        let field = text_of(&root, |key| key == FIELD);
        let pictured = text_of(&root, |key| PICTURED.contains(&key) || key == TRANSFER);
        Self { all: digest(&[&field, &pictured]), field: digest(&[&field]) }
    }
}

fn digest(texts: &[&str]) -> String {
    let mut hasher = blake3::Hasher::new();
    for text in texts {
        hasher.update(text.as_bytes()).update(&[0]);
    }
    hasher.finalize().to_hex()[..32].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(text: &str) -> Drawn {
        let mut root = DeTable::parse(text).unwrap().into_inner();
        let sweep = root.contains_key("sweep").then(|| crate::sweep::read::take(&mut root, text, "f.toml", &mut Vec::new()).unwrap());
        Drawn::of(&root, sweep.as_ref())
    }

    const TEXT: &str = "why = \"a\"\nseed = 7\ntrials = 3\n[camera]\nc = 5\n[testfield]\nkind = \"wall\"\n[stations]\nkind = \"arc\"\n[[station]]\nname = \"x\"\n\
        [optics]\nblur = 0.7\n[sensor]\ngrey_noise = 0.01\n[pointing]\nsigma = 0.7\n[[method]]\nname = \"pixel\"\n";

    #[test]
    fn words_light_noise_methods_and_what_is_made_of_points_change_no_draw() {
        let one = drawn(TEXT);
        for (old, new) in [
            ("\"a\"", "\"b\""),
            ("seed = 7", "seed = 8 # as --seed"),
            ("trials = 3", "trials = 4\nnightly = true\nbound_window = 21"),
            ("c = 5", "c = 5.0 # mm"),
            ("blur = 0.7", "blur = 0.8"),
            ("grey_noise = 0.01", "grey_noise = 0.011"),
            ("[optics]\nblur = 0.7\n[sensor]\ngrey_noise = 0.01", "[sensor]\ngrey_noise = 1.0e-2\n[optics]\nblur = 7e-1"),
            ("kind = \"wall\"", "kind = \"wall\"\nsurvey_sigma = 0.1"),
            ("sigma = 0.7", "detector = \"harris\""),
            ("name = \"x\"", "name = \"x\"\nblur = 1\nmotion = [0, 1]\nexposure = 0.9\nveil = 0.1\ngradient_across = [0, 0.1]"),
            ("name = \"pixel\"", "name = \"lsm\"\n[[method]]\nname = \"pixel\"\n[calibration]\nsets = [\"c\"]"),
        ] {
            let other = TEXT.replacen(old, new, 1);
            assert!(other != TEXT && drawn(&other) == one, "{old} {new}");
        }
    }

    #[test]
    fn what_is_pictured_changes_all_draws_and_the_field_those_within_it() {
        let one = drawn(TEXT);
        for (old, new, within) in [
            ("c = 5", "c = 6", false),
            ("\"x\"", "\"y\"", false),
            ("\"arc\"", "\"random\"", false),
            ("kind = \"wall\"", "kind = \"board\"", true),
        ] {
            let other = drawn(&TEXT.replacen(old, new, 1));
            assert!(other.all != one.all && (other.field != one.field) == within, "{old} {new}");
        }
        let alone = ["scene", "figure", "photographs"].map(|table| drawn(&format!("[{table}]\nname = \"a\"")).all);
        assert!(alone[0] != alone[1] && alone[1] != alone[2] && alone.iter().all(|one| *one != drawn("").all), "{alone:?}");
    }

    #[test]
    fn cells_of_a_sweep_draw_the_same_whatever_else_is_swept() {
        let swept = |key: &str, values: &str| drawn(&format!("{TEXT}[sweep]\n\"{key}\" = {values}\n\"method.pixel.window\" = [3, 5]\n"));
        assert_eq!(swept("camera.c", "[4, 5]"), swept("camera.c", "[3, 4, 5]"));
        assert_ne!(swept("camera.c", "[4, 5]").all, drawn(TEXT).all);
        // What two sweeps over other keys have in common is drawn alike.
        assert_eq!(swept("optics.blur", "[0.3, 0.7]"), swept("sensor.grey_noise", "[0.01, 0.02]"));
    }

    #[test]
    fn a_transfer_draws_the_same_for_whatever_method() {
        let with = |more: &str| drawn(&format!("[transfer]\nsigma_px = 0.1\n{more}"));
        assert_eq!(
            with(""),
            with("[[transfer.method]]\nname = \"a\"\n[[transfer.case]]\nname = \"b\"\n[[transfer.decomposition]]\nname = \"c\"\n")
        );
        assert_eq!(with(""), with("survey_sigma = 1\n"));
        assert_ne!(with("").all, with("[transfer.board]\nsquare = 1\n").all);
    }
}
