//! What the image of a station has of its own.

use crate::optics::{Motion, Optics, Tail};
use crate::sensor::{Design, Gradient};

/// What the image of a station has in place of what lens and sensor have in all; where it is `None`, that.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Own {
    /// Standard deviation of the Gaussian blur, px; that in the corners changes in proportion.
    pub blur: Option<f64>,
    /// A straight motion during the exposure.
    pub motion: Option<Motion>,
    /// Factor of the light, beside the sensor's exposure.
    pub exposure: Option<f64>,
    /// Stray light that exposure and gradient leave alone, fraction of full scale; negative below black.
    pub veil: Option<f64>,
    /// The illumination's gradient.
    pub gradient: Option<Gradient>,
}

impl Own {
    /// The lens of `all` as this image has it.
    pub fn optics(&self, all: &Optics) -> Optics {
        let blur = self.blur.unwrap_or(all.blur);
        let corner_blur = match self.blur {
            Some(own) => all.corner_blur.map(|corner| corner * own / all.blur),
            None => all.corner_blur,
        };
        // A tail is never narrower than the rest.
        let tail = all.tail.map(|tail| Tail { blur: tail.blur.max(corner_blur.unwrap_or(blur)), ..tail });
        Optics { blur, corner_blur, motion: self.motion.or(all.motion), tail, ..*all }
    }

    /// The sensor of `all` under the light of this image.
    pub fn design(&self, all: &Design) -> Design {
        Design {
            exposure: self.exposure.map_or(all.exposure, |factor| factor * all.exposure),
            veil: self.veil.unwrap_or(all.veil),
            gradient: self.gradient.or(all.gradient),
            ..all.clone()
        }
    }

    /// Whether the light is another, and not the lens alone.
    pub fn has_light(&self) -> bool {
        self.exposure.is_some() || self.veil.is_some() || self.gradient.is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_station_has_of_its_own_takes_the_place_of_what_all_have_and_the_rest_stays() {
        let (optics, design) =
            (Optics { blur: 0.5, corner_blur: Some(0.8), ..Optics::default() }, Design { exposure: 0.5, ..Design::default() });
        let none = Own::default();
        assert_eq!((none.optics(&optics), none.design(&design)), (optics, design.clone()));
        let own = Own { blur: Some(1.0), exposure: Some(1.5), veil: Some(-0.1), ..none };
        assert_eq!(own.optics(&optics), Optics { blur: 1.0, corner_blur: Some(1.6), ..optics });
        assert_eq!(own.design(&design), Design { exposure: 0.75, veil: -0.1, ..design });
    }
}
