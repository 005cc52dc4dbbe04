//! Parameters of operators: declared once, checked here, described in `list` and in the scenario schema.

use std::fmt;

use crate::error::MethodError;

/// The parameter by which an operator tests whether a window holds what it measures, in standard deviations, and its value for photographs.
pub(crate) const SIGNIFICANCE: &str = "significance";
pub(crate) const ON_PHOTOGRAPHS: f64 = 4.0;

/// What a parameter may be. Every domain excludes NaN and infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// An odd number of px from `min` to `max`: a window.
    Odd {
        /// Smallest.
        min: u32,
        /// Largest.
        max: u32,
    },
    /// A whole number from `min` to `max`.
    Whole {
        /// Smallest.
        min: u32,
        /// Largest.
        max: u32,
    },
    /// A number from `min` to `max`.
    Real {
        /// Smallest.
        min: f64,
        /// Largest.
        max: f64,
    },
    /// One of these whole numbers, which are in order.
    Choice(&'static [u32]),
    /// One of these names; its value is the place in the list, and may be given as such.
    Named(&'static [&'static str]),
}

impl Domain {
    /// Whether `value` is one of these.
    pub fn holds(self, value: f64) -> bool {
        let (min, max) = self.range();
        let right_form = match self {
            Self::Odd { .. } => value.fract() == 0.0 && value.rem_euclid(2.0) == 1.0,
            Self::Whole { .. } | Self::Named(_) => value.fract() == 0.0,
            Self::Choice(choices) => choices.iter().any(|choice| f64::from(*choice) == value),
            Self::Real { .. } => true,
        };
        value.is_finite() && value >= min && value <= max && right_form
    }

    /// Smallest and largest.
    pub fn range(self) -> (f64, f64) {
        match self {
            Self::Odd { min, max } | Self::Whole { min, max } => (f64::from(min), f64::from(max)),
            Self::Real { min, max } => (min, max),
            Self::Named(names) => (0.0, names.len() as f64 - 1.0),
            Self::Choice(choices) => [choices.first(), choices.last()].map(|end| end.map_or(f64::NAN, |end| f64::from(*end))).into(),
        }
    }

    /// In words, for an error or a table.
    pub fn describe(self) -> String {
        let (min, max) = self.range();
        match self {
            Self::Odd { .. } => format!("an odd number from {min} to {max}"),
            Self::Whole { .. } => format!("a whole number from {min} to {max}"),
            Self::Choice(choices) => format!("one of {}", choices.iter().map(u32::to_string).collect::<Vec<_>>().join(", ")),
            Self::Named(names) => format!("one of {}", names.join(", ")),
            Self::Real { .. } => format!("a number from {min} to {max}"),
        }
    }

    /// The value that `setting` means; `None` for a name that there is not.
    fn value(self, setting: &Setting) -> Option<f64> {
        match (self, setting) {
            (_, Setting::Number(value)) => Some(*value),
            (Self::Named(names), Setting::Name(name)) => names.iter().position(|known| known == name).map(|place| place as f64),
            (_, Setting::Name(_)) => None,
        }
    }

    /// The setting that `value` is, as it is written.
    pub fn setting(self, value: f64) -> Setting {
        match self {
            Self::Named(names) => names.get(value as usize).map_or(Setting::Number(value), |name| Setting::Name((*name).to_owned())),
            _ => Setting::Number(value),
        }
    }
}

/// What is given for a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Setting {
    /// A number, in the unit of the parameter.
    Number(f64),
    /// The name of a choice.
    Name(String),
}

impl Setting {
    /// A number, or else a name.
    pub fn parse(text: &str) -> Self {
        text.parse().map_or_else(|_| Self::Name(text.to_owned()), Self::Number)
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(value) => write!(f, "{value}"),
            Self::Name(name) => f.write_str(name),
        }
    }
}

/// A declared parameter of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Its key.
    pub name: &'static str,
    /// What it means, with its unit.
    pub about: &'static str,
    /// Values that are allowed.
    pub domain: Domain,
    /// What it is when nobody sets it, in its unit.
    pub default: f64,
    /// It is part of the method's label even at its default.
    pub always_shown: bool,
}

impl Parameter {
    const fn new(name: &'static str, about: &'static str, domain: Domain, default: f64) -> Self {
        Self { name, about, domain, default, always_shown: false }
    }

    /// An odd number of px from the first of `bounds` to the second: a window. `about` says what it means, with its unit.
    pub const fn odd(name: &'static str, about: &'static str, [min, max]: [u32; 2], default: f64) -> Self {
        Self::new(name, about, Domain::Odd { min, max }, default)
    }

    /// A whole number within bounds, as [`Self::odd`].
    pub const fn whole(name: &'static str, about: &'static str, [min, max]: [u32; 2], default: f64) -> Self {
        Self::new(name, about, Domain::Whole { min, max }, default)
    }

    /// A number within bounds, as [`Self::odd`].
    pub const fn real(name: &'static str, about: &'static str, [min, max]: [f64; 2], default: f64) -> Self {
        Self::new(name, about, Domain::Real { min, max }, default)
    }

    /// One of some whole numbers, which are in order.
    pub const fn choice(name: &'static str, about: &'static str, of: &'static [u32], default: f64) -> Self {
        Self::new(name, about, Domain::Choice(of), default)
    }

    /// One of some names, the one at a place at first.
    pub const fn named(name: &'static str, about: &'static str, of: &'static [&'static str], default: usize) -> Self {
        Self::new(name, about, Domain::Named(of), default as f64)
    }

    /// Yes or no, no at first.
    pub const fn flag(name: &'static str, about: &'static str) -> Self {
        Self::named(name, about, &["no", "yes"], 0)
    }

    /// The same, as part of the method's label even at its default.
    #[must_use]
    pub const fn always_shown(self) -> Self {
        Self { always_shown: true, ..self }
    }
}

/// Checked values of all parameters of one method, in the order of their declaration.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    values: Vec<(Parameter, f64)>,
}

impl Settings {
    /// The defaults of `parameters`, changed by `given`: keys, and values in the unit of the parameter or names.
    ///
    /// # Errors
    /// An unknown key, a key given twice, a value outside its domain.
    pub fn resolve(method: &str, parameters: &[Parameter], given: &[(String, Setting)]) -> Result<Self, MethodError> {
        let mut values: Vec<(Parameter, f64)> = parameters.iter().map(|p| (*p, p.default)).collect();
        for (index, (key, setting)) in given.iter().enumerate() {
            let Some(position) = parameters.iter().position(|p| p.name == key) else {
                let known = parameters.iter().map(|p| p.name.to_owned()).collect();
                return Err(MethodError::UnknownParameter { method: method.to_owned(), key: key.clone(), known });
            };
            if given[..index].iter().any(|(earlier, _)| earlier == key) {
                return Err(MethodError::Twice { method: method.to_owned(), key: key.clone() });
            }
            let domain = parameters[position].domain;
            let Some(value) = domain.value(setting).filter(|value| domain.holds(*value)) else {
                let expected = domain.describe();
                return Err(MethodError::Domain { method: method.to_owned(), key: key.clone(), expected, found: setting.to_string() });
            };
            values[position].1 = value;
        }
        Ok(Self { values })
    }

    /// The value of parameter `name`, in its unit.
    ///
    /// # Panics
    /// If the method did not declare it: a mistake in the operator's file that its first test finds.
    pub fn get(&self, name: &str) -> f64 {
        self.values.iter().find(|(parameter, _)| parameter.name == name).unwrap_or_else(|| panic!("no parameter `{name}` was declared")).1
    }

    /// A window (px) or another whole number.
    ///
    /// # Panics
    /// As [`Self::get`].
    pub fn whole(&self, name: &str) -> usize {
        self.get(name) as usize
    }

    /// All names and values, in the order of their declaration.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, f64)> + '_ {
        self.values.iter().map(|(parameter, value)| (parameter.name, *value))
    }

    /// All names and values as they are written, in the order of their declaration.
    pub fn written(&self) -> impl Iterator<Item = (&'static str, Setting)> + '_ {
        self.values.iter().map(|(parameter, value)| (parameter.name, parameter.domain.setting(*value)))
    }

    /// `pair`, as `shape=2`, with the name of the choice in place of its number; anything else as it is.
    pub(crate) fn named(&self, pair: &str) -> String {
        let name = || {
            let (key, value) = pair.split_once('=')?;
            let (parameter, _) = self.values.iter().find(|(parameter, _)| parameter.name == key)?;
            let value = value.parse().ok().filter(|value| parameter.domain.holds(*value))?;
            Some(format!("{key}={}", parameter.domain.setting(value)))
        };
        name().unwrap_or_else(|| pair.to_owned())
    }

    /// As [`Self::written`], of what a label shows: what is not at its default, or shown always.
    pub(crate) fn shown(&self) -> impl Iterator<Item = (&'static str, Setting)> + '_ {
        let shown = self.values.iter().filter(|(parameter, value)| parameter.always_shown || *value != parameter.default);
        shown.map(|(parameter, value)| (parameter.name, parameter.domain.setting(*value)))
    }
}
