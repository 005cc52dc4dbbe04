//! The section of printed figures: cameras, the network that they ask for, changed cameras.

use calibench_records::description::Printed;
use calibench_records::figures::Group;

use super::pictures::Drawn;
use super::tables::{again, by_figure, by_set, failures, numbers, stations};
use crate::canvas::Pictures;
use crate::load::Loaded;

/// What stands above the figures of the network.
const NETWORK: &str = "The network of stations that explains the fitted columns, and where its stations stand.";
/// What stands above changed cameras.
const VARIANTS: &str = "Each camera with something changed: in the image against the camera as printed, after the best rotation and where neither folds over; and what it predicts in the same network. \
                        *Misfit*: root mean square of predicted less printed absolute errors.";
/// What stands above readings and cameras with which the network is fitted again.
const AGAIN: &str = "The network fitted again: with another reading of the print, or with a camera changed. *Misfit* is that of the fitted columns, and of each column's errors; *near*: \
                     how many errors of columns that are not fitted are predicted within what the scenario says.";

/// The section of `loaded`, whose sets are `sets`, and its pictures, whose names begin with `stem`.
pub fn section(loaded: &Loaded, sets: &Printed, stem: &str) -> (String, Pictures) {
    let Some(found) = &loaded.calibrations else { return (String::new(), Pictures::new()) };
    let mut drawn = Drawn::new(stem);
    let mut text = by_figure(found, std::slice::from_ref(&sets.sensor), &[Group::Network]) + "\n";
    let cameras: Vec<String> = sets.cameras.iter().map(|camera| camera.name.clone()).collect();
    text.push_str(&format!("### Cameras\n\n{}\n", by_figure(found, &cameras, &[Group::Network, Group::Check])));
    text.push_str(&drawn.cameras(sets));
    if let Some(network) = &sets.network {
        let set = &network.set;
        text.push_str(&format!("### The network\n\n{NETWORK}\n\n{}\n", by_figure(found, std::slice::from_ref(set), &[Group::Network])));
        text.push_str(&format!("{}\n{}\n", numbers(found, set), stations(found, set)));
        text.push_str(&drawn.network(sets, network, found));
    }
    if !sets.variants.is_empty() {
        text.push_str(&format!("### Changed cameras\n\n{VARIANTS}\n\n{}\n", by_set(found, &sets.variants)));
    }
    if !sets.again.is_empty() {
        text.push_str(&format!("### Fitted again\n\n{AGAIN} Unit: {}.\n\n{}\n", sets.unit, again(found, sets)));
    }
    (text + &failures(found), drawn.pictures)
}
