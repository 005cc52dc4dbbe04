//! What a fit takes for granted of the light over its window.

use calibench_model::Gradient;

/// Nothing changes, or linearly over the window ...
pub(crate) const EVEN: u8 = 0;
/// ... something is added: grey values a px, ...
pub(crate) const ADDED: u8 = 1;
/// ... the light, which multiplies all: shares of the light at the point a px, ...
pub(crate) const LIGHT: u8 = 2;
/// ... each area's grey value for itself, a px. The two before are among them.
pub(crate) const EACH: u8 = 3;

/// What a setting of `gradient` estimates.
pub(crate) fn estimated(setting: u8) -> Gradient {
    match setting {
        EVEN => Gradient::None,
        ADDED => Gradient::Added,
        LIGHT => Gradient::Light,
        _ => Gradient::Both,
    }
}
