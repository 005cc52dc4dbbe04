//! Line integrals along the border of a mask.
//!
//! With K the profile of a blurred pixel in two dimensions, W its integral in x, and p running along the border: the coverage of the pixel is the
//! integral of `W k(y) dy` (Green's theorem); its derivative by a parameter that moves the border by `q` is the integral of `K (q x dp)`; its derivative
//! by the blur, as K obeys the equation of heat, is `sigma` times the integral of `grad K x dp`.
//!
//! Along one curve, whatever an affine map's parameters do to the border is a combination of a few functions: 1 and t on a line; on an arc cosine, sine
//! and their products. The integrals of K times these are added up in registers, a row of pixels at a time over the whole border, and combined there.

use calibench_model::Curve;

use super::bank::Bank;
use super::curves::{Arc, Expansion, Line};
use super::mask::{Bounds, Mask, Panel, Rule, beyond, map};
use super::planes::{Derivatives, Pose, Window};
use super::profile::Profile;
use super::sweep::sweep;

/// Coverage and derivatives of a mask, written to their planes.
pub(super) fn draw(
    window: Window<'_>,
    bank: &mut Bank,
    mask: &Mask,
    pose: &Pose,
    profile: &Profile,
    (derivatives, rule): (Derivatives, Rule),
) {
    match derivatives {
        Derivatives::None => integrate::<1, 1, false, false>(window, bank, mask, pose, profile, rule),
        Derivatives::Pose => integrate::<3, 6, true, false>(window, bank, mask, pose, profile, rule),
        Derivatives::PoseAndBlur => integrate::<5, 8, true, true>(window, bank, mask, pose, profile, rule),
    }
}

/// `LINE` and `ARC` are how many numbers a node of a line and of an arc has for each pixel of a row.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn integrate<const LINE: usize, const ARC: usize, const MOVED: bool, const BLURRED: bool>(
    window: Window<'_>,
    bank: &mut Bank,
    mask: &Mask,
    pose: &Pose,
    profile: &Profile,
    rule: Rule,
) {
    let a = &pose.affine;
    // Where the affine reflects, the border runs the other way round.
    let sense = if a.axx * a.ayy - a.axy * a.ayx < 0.0 { -1.0 } else { 1.0 };
    let seen = (-profile.reach(), window.pixels as f64 - 1.0 + profile.reach());
    let bounds = Bounds { columns: seen, rows: seen };
    bank.clear();
    for curve in mask.curves() {
        if let Some(rows) = beyond(curve, a, pose.at, &bounds) {
            bank.add_beyond(rows, profile, sense);
        }
        for panel in Panel::of(curve, a, pose.at, profile.sigma(), rule, &bounds) {
            match *curve {
                Curve::Line { from, to } => {
                    let (begin, along) = (map(a, from), map(a, [to[0] - from[0], to[1] - from[1]]));
                    let step = [along[0] * sense, along[1] * sense];
                    bank.begin(Expansion::Line(Line::new(from, to, step)));
                    for (t, weight) in panel.nodes() {
                        let at = [pose.at[0] + begin[0] + t * along[0], pose.at[1] + begin[1] + t * along[1]];
                        bank.push::<2, LINE, MOVED, BLURRED>(profile, at, step, [1.0, t], weight);
                    }
                }
                Curve::Arc { centre, radius, start, sweep } => {
                    let arc = Arc::new(a, centre, radius, sweep, sense);
                    bank.begin(Expansion::Arc(arc.expansion.map(|factors| factors.map(|f| f as f32))));
                    for (t, weight) in panel.nodes() {
                        let (sine, cosine) = (start + t * sweep).sin_cos();
                        let (at, step) = arc.at(a, pose.at, (sine, cosine));
                        let functions = [cosine, sine, cosine * cosine, cosine * sine, sine * sine];
                        bank.push::<5, ARC, MOVED, BLURRED>(profile, at, step, functions, weight);
                    }
                }
            }
        }
    }
    sweep::<LINE, ARC, MOVED, BLURRED>(window, bank, profile.sigma() as f32);
}
