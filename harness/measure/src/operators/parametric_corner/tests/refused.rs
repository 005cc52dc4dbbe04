//! What is no crossing: bare edges, noise and texture.

use super::operator;
use crate::tests::no_corners::accepted;

/// Of all windows of a kind at most one in a thousand.
fn refuses(spec: &str, windows: usize) {
    for (what, count) in accepted(&*operator(spec), windows) {
        assert!(count * 1000 <= windows, "{spec}, {what}: {count} of {windows}");
    }
}

#[test]
fn edges_noise_and_texture_are_no_corners() {
    refuses("window=15", 3000);
}

/// With a gradient, a curvature or a smaller window up to one texture in a hundred passes: the more unknowns and the fewer pixels, the more a saddle of grey values is like a
/// corner.
#[test]
#[ignore = "takes minutes"]
fn of_a_hundred_thousand_windows_next_to_none_is_taken_for_a_corner() {
    for spec in ["window=15", "window=21"] {
        refuses(spec, std::env::var("WINDOWS").map_or(100_000, |windows| windows.parse().unwrap()));
    }
}
