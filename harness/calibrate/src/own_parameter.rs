//! A number of each image's own, as it is asked for.

use std::str::FromStr;

use thiserror::Error;

/// A number of each image's own, as it is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnParameter {
    /// `c` (of models with two focal lengths both together), `x0`, `y0`, or a parameter as the model calls it.
    pub name: String,
    /// Its a-priori standard deviation over the images, in its unit; `None` to estimate it from them.
    pub sigma: Option<f64>,
}

/// Text that is no number of each image's own.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("`{0}`: expected NAME, or NAME:SIGMA with a positive standard deviation, as in c:2,x0,y0")]
pub struct NoOwnParameter(String);

impl FromStr for OwnParameter {
    type Err = NoOwnParameter;

    fn from_str(text: &str) -> Result<Self, NoOwnParameter> {
        let refused = || NoOwnParameter(text.to_owned());
        let (name, sigma) = text.split_once(':').map_or((text, None), |(name, sigma)| (name, Some(sigma)));
        let number = |sigma: &str| sigma.trim().parse().ok().filter(|sigma: &f64| *sigma > 0.0 && sigma.is_finite()).ok_or_else(refused);
        let name = name.trim().to_owned();
        if name.is_empty() { Err(refused()) } else { Ok(Self { name, sigma: sigma.map(number).transpose()? }) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_may_have_its_scatter() {
        assert_eq!("c:2".parse(), Ok(OwnParameter { name: "c".into(), sigma: Some(2.0) }));
        assert_eq!(" x0 ".parse(), Ok(OwnParameter { name: "x0".into(), sigma: None }));
        for wrong in ["", ":1", "c:", "c:0", "c:-1", "c:nan", "c:inf"] {
            assert!(wrong.parse::<OwnParameter>().is_err(), "{wrong}");
        }
    }
}
