//! Line integrals along the border of a mask.
//!
//! With K the profile of a blurred pixel in two dimensions, W its integral in x, and p running along the border: the coverage of the pixel is the
//! integral of `W k(y) dy` (Green's theorem); its derivative by a parameter that moves the border by `q` is the integral of `K (q x dp)`; its derivative
//! by the blur, as K obeys the equation of heat, is `sigma` times the integral of `grad K x dp`.
//!
//! Along one curve, whatever an affine map's parameters do to the border is a combination of a few functions: 1 and t on a line; on an arc cosine, sine
//! and their products. Where the lens warps the border, its nodes and steps are moved for the coverage; derivatives by the affine parameters keep the unwarped steps, which are a few hundredths off
//! at most and change the way to the result alone. The integrals of K times these are added up in registers, a row of pixels at a time over the whole border, and combined there.

use calibench_model::{Curve, Warp};

use super::bank::Bank;
use super::curves::{Arc, Expansion, Line};
use super::mask::{Bounds, Mask, Panel, Rule, beyond, map};
use super::planes::{Derivatives, Pose, Window};
use super::profile::Profile;
use super::sweep::sweep;

/// What a mask is mapped by: a pose, and what the lens adds.
pub(super) struct Bent<'a> {
    pub(super) pose: &'a Pose,
    pub(super) warp: Option<&'a Warp>,
}

impl Bent<'_> {
    /// Where the border runs that the affine map alone has `at` a place, px.
    #[inline(always)]
    fn at(&self, at: [f64; 2], reach: f64) -> [f64; 2] {
        let Some(warp) = self.warp else { return at };
        let shift = warp.shift(self.offset(at, reach).0);
        [at[0] + shift[0], at[1] + shift[1]]
    }

    /// Its step there, which is `step` by the affine map alone.
    #[inline(always)]
    fn step(&self, at: [f64; 2], step: [f64; 2], reach: f64) -> [f64; 2] {
        let Some(warp) = self.warp else { return step };
        let (offset, is_near) = self.offset(at, reach);
        let turn = if is_near { warp.shift_along(offset, step) } else { [0.0; 2] };
        [step[0] + turn[0], step[1] + turn[1]]
    }

    /// A place from the reference point, px, and whether it is within `reach`: beyond, where second order tells nothing, what is moved is moved as far as there.
    #[inline(always)]
    fn offset(&self, at: [f64; 2], reach: f64) -> ([f64; 2], bool) {
        let offset = [at[0] - self.pose.at[0], at[1] - self.pose.at[1]];
        let far = offset[0].hypot(offset[1]);
        if far > reach { (offset.map(|part| part * reach / far), false) } else { (offset, true) }
    }
}

/// Coverage and derivatives of a mask, written to their planes.
pub(super) fn draw(
    window: Window<'_>,
    bank: &mut Bank,
    mask: &Mask,
    bent: &Bent<'_>,
    profile: &Profile,
    (derivatives, rule): (Derivatives, Rule),
) {
    match derivatives {
        Derivatives::None => integrate::<1, 1, false, false>(window, bank, mask, bent, profile, rule),
        Derivatives::Pose => integrate::<3, 6, true, false>(window, bank, mask, bent, profile, rule),
        Derivatives::PoseAndBlur => integrate::<5, 8, true, true>(window, bank, mask, bent, profile, rule),
    }
}

/// `LINE` and `ARC` are how many numbers a node of a line and of an arc has for each pixel of a row.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn integrate<const LINE: usize, const ARC: usize, const MOVED: bool, const BLURRED: bool>(
    window: Window<'_>,
    bank: &mut Bank,
    mask: &Mask,
    bent: &Bent<'_>,
    profile: &Profile,
    rule: Rule,
) {
    let (pose, a) = (bent.pose, &bent.pose.affine);
    // Where the affine reflects, the border runs the other way round.
    let sense = if a.axx * a.ayy - a.axy * a.ayx < 0.0 { -1.0 } else { 1.0 };
    let seen = (-profile.reach(), window.pixels as f64 - 1.0 + profile.reach());
    let bounds = Bounds { columns: seen, rows: seen };
    // To the window's corners, from wherever in it the reference point is.
    let reach = std::f64::consts::SQRT_2 * window.pixels as f64;
    bank.clear();
    for curve in mask.curves() {
        if let Some([begin, end]) = beyond(curve, a, pose.at, &bounds) {
            let rows = (bent.at(begin, reach)[1], bent.at(end, reach)[1]);
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
                        let (at, step) = (bent.at(at, reach), bent.step(at, step, reach));
                        bank.push::<2, LINE, MOVED, BLURRED>(profile, at, step, [1.0, t], weight);
                    }
                }
                Curve::Arc { centre, radius, start, sweep } => {
                    let arc = Arc::new(a, centre, radius, sweep, sense);
                    bank.begin(Expansion::Arc(arc.expansion.map(|factors| factors.map(|f| f as f32))));
                    for (t, weight) in panel.nodes() {
                        let (sine, cosine) = (start + t * sweep).sin_cos();
                        let (at, step) = arc.at(a, pose.at, (sine, cosine));
                        let (at, step) = (bent.at(at, reach), bent.step(at, step, reach));
                        let functions = [cosine, sine, cosine * cosine, cosine * sine, sine * sine];
                        bank.push::<5, ARC, MOVED, BLURRED>(profile, at, step, functions, weight);
                    }
                }
            }
        }
    }
    sweep::<LINE, ARC, MOVED, BLURRED>(window, bank, profile.sigma() as f32);
}
