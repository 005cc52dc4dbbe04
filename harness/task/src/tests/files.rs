//! Mistakes in files.

use super::*;

#[test]
fn mistakes_in_a_file_have_their_place() {
    for (text, expected) in [
        ("sigma = 0.1\n", "t.toml:1:1: missing field `measure`"),
        (&DOWN.replace("sigma_tilt", "sigma_tilts"), "t.toml:9:1: unknown field `sigma_tilts`"),
        (&DOWN.replace("sigma = 0.4", "sigma = -1"), "t.toml:8:9: expected a standard deviation of at least 0"),
        (&DOWN.replace("sigma = 0.1", "sigma = 0"), "t.toml:1:9: expected a standard deviation above 0, px"),
        (&DOWN.replace("[0, 0, 2]", "[0, 0, 0]"), "t.toml:7:10: expected a normal with a length"),
        (&DOWN.replace("[50, 0, 0]]", "[-50, 0, 0]]"), "t.toml:4:10: expected two points that are not one"),
        (&DOWN.replace("length =", "angle ="), "t.toml:4:9: expected three points, the second at the apex"),
        (&DOWN.replace("length =", "plane ="), "t.toml:4:9: expected three points at least"),
        (&DOWN.replace("length =", "point = [1, 2, 3]\nlength ="), "t.toml:3:1: expected one of length, point, angle, plane and rotation"),
        (&DOWN.replace("\nangles =", "\ntarget = [0, 0, 0]\nangles ="), "t.toml:11:10: expected `angles`"),
        (&DOWN.replace("\nangles = [0, 0, 0]", "\ntarget = [0, 0, 800]"), "t.toml:12:10: is not to be looked at"),
        (&DOWN.replace("\nangles =", "\nroll = 3\nangles ="), "t.toml:12:8: goes with `target`"),
        (&format!("{DOWN}[[image]]\ncentre = [9, 0, 800]\nangles = [0, 0, 0]\n"), "t.toml:5:1: several images need no [known_plane]"),
        ("sigma = 0.1\n[measure]\npoint = [0, 0, nan]\n", "t.toml:3:9: expected three finite numbers"),
        ("sigma = 0.1\n[measure]\npoint = [0, 0, 0]\n", "t.toml:1:1: has no [[image]]"),
    ] {
        let error = parse("t.toml", text).unwrap_err().to_string();
        assert!(error.starts_with(expected), "{expected}: {error}");
    }
}

/// A camera that looks at a target is the one with the angles of that.
#[test]
fn what_is_looked_at_is_a_pose() {
    let by_angles = task(DOWN);
    let by_target = task(&DOWN.replace("angles = [0, 0, 0]", "target = [0, 0, 5]"));
    assert!((by_angles.images[0].pose.rotation - by_target.images[0].pose.rotation).norm() < 1e-12);
}
