//! How much room targets have for the windows of methods.

use calibench_records::description::{Description, Room, operator};

/// What is to be known of windows on a scene whose targets have neighbours; empty where no room is known.
pub(crate) fn sentence<'l>(scenario: &Description, labels: impl Iterator<Item = &'l str>) -> String {
    let Some(views) = scenario.study.views() else { return String::new() };
    let Some(Room { least, middle }) = views.room else { return String::new() };
    let beyond: Vec<String> =
        labels.filter(|label| window(scenario, label).is_some_and(|side| side > 2.0 * least)).map(|label| format!("`{label}`")).collect();
    let wider = match &beyond[..] {
        [] => String::new(),
        [one] => format!("; the window of {one} reaches further"),
        [all @ .., last] => format!("; the windows of {} and {last} reach further", all.join(", ")),
    };
    format!(
        "Room: around every point a window of {least} px holds nothing else, around half of them one of {middle} px{wider}.\n\n",
        least = odd(2.0 * least),
        middle = odd(2.0 * middle)
    )
}

/// The largest odd number of whole pixels.
fn odd(side: f64) -> u64 {
    let whole = side.max(1.0) as u64;
    whole - (whole + 1) % 2
}

/// The side of a method's window, px, if it has one.
fn window(scenario: &Description, label: &str) -> Option<f64> {
    let own = |label: &str| label.split([':', ',']).find_map(|part| part.strip_prefix("window=")?.parse().ok());
    own(label).or_else(|| own(scenario.defaults.get(operator(label))?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_that_reach_beyond_are_named() {
        let text = r#"{"why": "", "source": "", "notes": [], "seed": 1, "trials": 1, "bound_window": 11, "methods": [],
            "defaults": {"a": "a:window=25", "b": "b"}, "sweep": null, "subject": {"views": {"size": [4, 3], "unit": "mm", "extent": null,
            "normal": null, "stations": [], "targets": [], "adjustment": null, "blocks": null, "room": {"least": 7.9, "middle": 12.6}}}}"#;
        let scenario = calibench_records::description::read(text.as_bytes()).unwrap();
        let said = |labels: &[&str]| sentence(&scenario, labels.iter().copied());
        let room = "Room: around every point a window of 15 px holds nothing else, around half of them one of 25 px";
        assert_eq!(said(&["c:window=15", "b"]), format!("{room}.\n\n"));
        assert_eq!(
            said(&["c:window=15", "c:window=17", "a", "b"]),
            format!("{room}; the windows of `c:window=17` and `a` reach further.\n\n")
        );
        assert_eq!((odd(16.0), odd(15.0), odd(14.99), odd(0.2)), (15, 15, 13, 1));
    }
}
