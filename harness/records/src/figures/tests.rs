//! What holds for every row of the catalogue.

use super::pattern::{Piece, SIZES, pieces};
use super::{Better, Entry, FigureName, Group, Quantity, Units};

/// Texts for the places of a pattern: such as come, with slashes, blanks and commas where they may.
fn sample(entry: &Entry) -> Vec<&'static str> {
    let any = ["6", "left/3", "m"];
    let place = |(index, piece): (usize, Piece)| match piece {
        Piece::Text(_) => None,
        Piece::Any => Some(any[index.min(2)]),
        Piece::OneOf(known) => known.last().copied(),
    };
    pieces(entry.pattern).filter(|piece| !matches!(piece, Piece::Text(_))).enumerate().filter_map(place).collect()
}

#[test]
fn every_name_is_read_as_what_it_was_written_as() {
    for (place, entry) in Quantity::CATALOGUE.iter().enumerate() {
        assert_eq!((entry.quantity as usize, entry.quantity.entry().pattern), (place, entry.pattern));
        let parts = sample(entry);
        let name = entry.quantity.of(&parts);
        let read = FigureName::parse(entry.group, name.text()).unwrap();
        assert_eq!((read.quantity(), read.group()), (entry.quantity, entry.group), "{name}");
        assert_eq!(read.parts().concat(), parts.concat(), "{name}");
        assert_eq!(read, name);
    }
}

/// Two that are written alike in one group could not be told apart.
#[test]
fn no_name_is_that_of_another() {
    let mut names: Vec<FigureName> = Quantity::CATALOGUE.iter().map(|entry| entry.quantity.of(&sample(entry))).collect();
    names.sort();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]));
}

#[test]
fn the_least_and_the_most_of_several_networks_are_of_the_same_quantity() {
    let most = Quantity::Sigma0Um.most();
    assert_eq!(most.text(), "sigma0 in um, most");
    let read = FigureName::parse(Group::Network, most.text()).unwrap();
    assert_eq!((read.quantity(), read == most, read == Quantity::Sigma0Um.into()), (Quantity::Sigma0Um, true, false));
    assert_eq!(FigureName::parse(Group::Network, Quantity::Held.least().text()).unwrap().quantity(), Quantity::Held);
    assert_eq!(FigureName::parse(Group::Network, "direct conversion, most, px").unwrap().quantity(), Quantity::DirectMost);
}

#[test]
fn a_name_that_is_none_is_an_error_with_the_one_that_is_meant() {
    for (group, name, meant) in [
        (Group::Network, "sigma_0", Some("sigma0")),
        (Group::Check, "rmse_yx", Some("rmse_xy")),
        (Group::Iop, "k9", None),
        (Group::Network, "modern/joint wrong, large stars/all", None),
        (Group::Network, "images, most, most", None),
        (Group::Frame, "sigma0", None),
    ] {
        let error = FigureName::parse(group, name).unwrap_err();
        assert_eq!((error.group, error.name.as_str()), (group, name));
        if meant.is_some() {
            assert_eq!(error.nearest.as_deref(), meant);
        }
    }
    let error = FigureName::parse(Group::Check, "rmse_yx").unwrap_err().to_string();
    assert_eq!(error, "no figure of `check` is called `rmse_yx`: is `rmse_xy` meant?");
}

#[test]
fn a_classifier_called_as_one_likes_is_one() {
    let of = |what: &str| FigureName::parse(Group::Network, &format!("modern, all/{what}/by night")).unwrap();
    assert_eq!(of("labels").quantity(), Quantity::Labels);
    assert_eq!(of("wrong labels").quantity(), Quantity::WrongLabels);
    let percent = of(&format!("single wrong, %, {}", SIZES[1]));
    assert_eq!((percent.quantity(), percent.parts()), (Quantity::WrongKindsPercent, vec!["modern, all", "single", SIZES[1], "by night"]));
}

#[test]
fn a_unit_is_one_of_the_quantity_s() {
    assert!(Units::Object.have("m") && Units::Object.have("mm") && !Units::Object.have("px"));
    assert!(Units::Number.have("") && !Units::Number.have("px"));
    assert!(Units::Either(&["px", ""]).have("") && !Units::One("px").have(""));
    assert_eq!(Units::Either(&["px", ""]).text(), "px or number");
}

#[test]
fn a_row_says_what_it_means_and_errors_are_better_small() {
    for entry in Quantity::CATALOGUE {
        assert!(entry.meaning.len() > 8 && !entry.meaning.ends_with('.'), "{}", entry.pattern);
        if matches!(entry.group, Group::Frame | Group::Residual | Group::Point) {
            assert_eq!(entry.better, Better::Less, "{}", entry.pattern);
        }
    }
}

#[test]
fn every_group_has_its_own_name() {
    for (group, name) in Group::ALL {
        assert_eq!((group.name(), Group::named(name)), (name, Some(group)));
    }
    assert_eq!(Group::named("eclipse"), None);
}
