//! Which methods there are, by name.

use std::sync::Arc;

use calibench_model::{TargetKind, Told};

use crate::error::MethodError;
use crate::finder::BoardFinder;
use crate::kinds::Kinds;
use crate::operator::Operator;
use crate::parameter::{ON_PHOTOGRAPHS, Parameter, SIGNIFICANCE, Setting, Settings};
use crate::recorded::Recorded;

/// A method as it is listed: an operator whose parameters are yet to be set.
#[derive(Clone)]
pub struct Method {
    /// Its name in scenarios, records and on the command line.
    pub name: &'static str,
    /// What it does, in a line.
    pub about: &'static str,
    /// Where it is published.
    pub source: &'static str,
    /// Its version: ours counts changes of results, a library's is its own.
    pub version: String,
    /// Its parameters.
    pub parameters: &'static [Parameter],
    /// Makes the operator, or says why this build or machine cannot.
    pub build: Build,
}

/// How an operator comes into being.
#[derive(Clone)]
pub enum Build {
    /// From checked settings.
    With(fn(&Settings) -> Box<dyn Operator>),
    /// From outside of this program: whether it can run, and as which version, is known when it is asked for; or what is wrong with its files.
    Outside(Arc<FromOutside>),
    /// Not here, and why.
    Unavailable(&'static str),
}

/// Makes an operator from checked settings, or says what is wrong with its files.
pub type FromOutside = dyn Fn(&Settings) -> Result<Outside, String> + Send + Sync;

/// A method that is no part of this program, with its parameters set.
pub struct Outside {
    /// Its version, as it says itself.
    pub version: String,
    /// The operator, or why there is none.
    pub operator: Result<Box<dyn Operator>, String>,
}

/// A method with its parameters set.
pub struct Configured {
    /// Name, parameters and kinds in one word, as in `forstner:window=11,kinds=corner+cross`: the windows and whatever differs from its default.
    pub label: String,
    /// The label without the kinds.
    pub unlimited_label: String,
    /// The label of the same operator with all parameters at their defaults.
    pub default_label: String,
    /// The method's version.
    pub version: String,
    /// All parameters.
    pub settings: Settings,
    /// The kinds of target that it is limited to, if it is.
    pub kinds: Option<Kinds>,
    /// Whether it is one of this crate's own, and none that took its name.
    pub own: bool,
    /// Whether it is no part of this program: its answers may change with nothing here telling.
    pub outside: bool,
    /// The operator, or why there is none.
    pub operator: Result<Box<dyn Operator>, String>,
}

impl Configured {
    /// The same method for targets of these kinds alone.
    #[must_use]
    pub fn limited(self, kinds: Kinds) -> Self {
        let separator = if self.unlimited_label.contains(':') { ',' } else { ':' };
        Self { label: format!("{}{separator}{KINDS}={kinds}", self.unlimited_label), kinds: Some(kinds), ..self }
    }

    /// Whether `text` is its label, with names or numbers of choices.
    pub fn is_called(&self, text: &str) -> bool {
        let Some((name, settings)) = text.split_once(':') else { return text == self.label };
        let named = settings.split(',').map(|pair| self.settings.named(pair)).collect::<Vec<_>>().join(",");
        format!("{name}:{named}") == self.label
    }

    /// The method's name, without parameters.
    pub fn name(&self) -> &str {
        self.label.split(':').next().unwrap_or(&self.label)
    }

    /// All parameters with their values, those at their defaults among them, and the kinds if it is limited.
    pub fn all_settings(&self) -> String {
        let kinds = self.kinds.as_ref().map(|kinds| format!("{KINDS}={kinds}"));
        self.settings.written().map(|(name, value)| format!("{name}={value}")).chain(kinds).collect::<Vec<_>>().join(",")
    }

    /// What it was recorded as, if it was.
    pub fn recorded(&self) -> Option<&dyn Recorded> {
        self.operator.as_ref().ok()?.recorded()
    }

    /// What it finds boards by, if it does that.
    pub fn board_finder(&self) -> Option<&dyn BoardFinder> {
        self.operator.as_ref().ok()?.board_finder()
    }

    /// Whether it measures targets of this kind. One that is limited measures none of which the kind is not known.
    pub fn measures(&self, kind: Option<TargetKind>) -> bool {
        self.kinds.as_ref().is_none_or(|kinds| kind.is_some_and(|kind| kinds.iter().any(|known| known == kind)))
    }
}

/// What is to be known of how the results of methods came about, by their names: of each, if it is nothing too.
pub fn told<'m>(methods: impl IntoIterator<Item = &'m Configured>) -> Vec<(&'m str, Told)> {
    let of = |method: &'m Configured| method.operator.as_ref().map_or_else(|_| Told::default(), |operator| operator.told());
    methods.into_iter().map(|method| (method.name(), of(method))).collect()
}

/// The same in words, each once.
pub fn notes<'m>(methods: impl IntoIterator<Item = &'m Configured>) -> Vec<(&'m str, String)> {
    calibench_model::told::notes(told(methods))
}

/// What the kinds are called among the parameters of a method.
pub const KINDS: &str = "kinds";

/// All methods of a build, in the order in which they are listed.
#[derive(Clone, Default)]
pub struct Registry {
    methods: Vec<Method>,
    /// The names of those that are this crate's own.
    own: Vec<&'static str>,
}

impl Registry {
    /// Adds a method, in place of one of the same name if there is one.
    #[must_use]
    pub fn with(mut self, method: Method) -> Self {
        self.own.retain(|name| *name != method.name);
        match self.methods.iter_mut().find(|m| m.name == method.name) {
            Some(old) => *old = method,
            None => self.methods.push(method),
        }
        self
    }

    /// The same methods, all of them this crate's own.
    pub(crate) fn all_own(mut self) -> Self {
        self.own = self.methods.iter().map(|method| method.name).collect();
        self
    }

    /// All methods.
    pub fn methods(&self) -> &[Method] {
        &self.methods
    }

    /// Whether the method that `text` names, in the form of [`Self::parse`], is among these.
    pub fn has(&self, text: &str) -> bool {
        let (_, method) = before_the_name(text);
        let name = method.split(':').next().unwrap_or(method).trim();
        self.methods.iter().any(|method| method.name == name)
    }

    /// The method called `name`, with `given` parameters: keys, and values in the unit of the parameter or names.
    ///
    /// # Errors
    /// An unknown method or parameter, a value outside its domain, files of a method from outside that are wrong.
    pub fn configure(&self, name: &str, given: &[(String, Setting)]) -> Result<Configured, MethodError> {
        let Some(method) = self.methods.iter().find(|m| m.name == name) else {
            let known = self.methods.iter().map(|m| m.name.to_owned()).collect();
            return Err(MethodError::UnknownMethod { name: name.to_owned(), known });
        };
        let settings = Settings::resolve(name, method.parameters, given)?;
        let (version, operator) = match &method.build {
            Build::With(build) => (method.version.clone(), Ok(build(&settings))),
            Build::Outside(build) => {
                let Outside { version, operator } =
                    build(&settings).map_err(|problem| MethodError::File { method: name.to_owned(), problem })?;
                (version, operator)
            }
            Build::Unavailable(why) => (method.version.clone(), Err((*why).to_owned())),
        };
        let default_label = label(method, &Settings::resolve(name, method.parameters, &[])?);
        let label = label(method, &settings);
        let (own, outside) = (self.own.contains(&method.name), matches!(method.build, Build::Outside(_)));
        Ok(Configured { unlimited_label: label.clone(), label, default_label, version, settings, kinds: None, own, outside, operator })
    }

    /// The method that `text` names, as in `forstner:window=15`. One that is limited to kinds of targets is written `corner+cross=forstner:window=15`, or
    /// as its label, `forstner:window=15,kinds=corner+cross`.
    ///
    /// # Errors
    /// As [`Self::configure`]; a text of another form; kinds that are unknown or given twice.
    pub fn parse(&self, text: &str) -> Result<Configured, MethodError> {
        let malformed = || MethodError::Form { text: text.to_owned() };
        let (mut kinds, method) = before_the_name(text);
        let (name, rest) = method.split_once(':').unwrap_or((method, ""));
        let mut given = Vec::new();
        for pair in rest.split(',').filter(|pair| !pair.is_empty()) {
            let (key, value) = pair.split_once('=').ok_or_else(malformed)?;
            if key.trim() != KINDS {
                given.push((key.trim().to_owned(), Setting::parse(value.trim())));
            } else if kinds.replace(value).is_some() {
                return Err(MethodError::Twice { method: name.trim().to_owned(), key: KINDS.to_owned() });
            }
        }
        let configured = self.configure(name.trim(), &given)?;
        let Some(kinds) = kinds else { return Ok(configured) };
        let kinds = Kinds::parse(kinds).map_err(|error| MethodError::Kinds { method: configured.unlimited_label.clone(), error })?;
        Ok(configured.limited(kinds))
    }
}

impl Registry {
    /// As [`Self::parse`], for photographs, which hold more than targets: operators that can test whether a window holds a corner do so, as
    /// `forstner:window=15,significance=4`, unless `text` says otherwise.
    ///
    /// # Errors
    /// As [`Self::parse`].
    pub fn parse_for_photographs(&self, text: &str) -> Result<Configured, MethodError> {
        let configured = self.parse(text)?;
        let tests = configured.settings.iter().any(|(key, _)| key == SIGNIFICANCE);
        if !tests || text.contains(SIGNIFICANCE) {
            return Ok(configured);
        }
        let joint = if text.contains(':') { ',' } else { ':' };
        self.parse(&format!("{text}{joint}{SIGNIFICANCE}={ON_PHOTOGRAPHS}"))
    }
}

/// The kinds of `corner+cross=forstner:window=15`, if there are any, and the rest.
fn before_the_name(text: &str) -> (Option<&str>, &str) {
    match text.split_once('=') {
        Some((kinds, rest)) if !kinds.contains(':') => (Some(kinds), rest),
        _ => (None, text),
    }
}

fn label(method: &Method, settings: &Settings) -> String {
    let pairs: Vec<String> = settings.shown().map(|(key, value)| format!("{key}={value}")).collect();
    if pairs.is_empty() { method.name.to_owned() } else { format!("{}:{}", method.name, pairs.join(",")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str) -> MethodError {
        Registry::builtin().parse(text).err().unwrap()
    }

    #[test]
    fn labels_are_canonical() {
        let registry = Registry::builtin();
        assert_eq!(registry.parse("forstner").unwrap().label, "forstner:window=11");
        assert_eq!(registry.parse("forstner: window = 15").unwrap().label, "forstner:window=15");
        assert_eq!(registry.parse("harris_paraboloid:k=0.2,sigma=2,window=7").unwrap().label, "harris_paraboloid:window=7,sigma=2");
        assert_eq!(registry.parse("forstner:window=15").unwrap().default_label, "forstner:window=11");
        assert_eq!(registry.parse("pixel").unwrap().label, "pixel");
    }

    #[test]
    fn choices_have_names_and_are_read_by_their_numbers() {
        let label = |text: &str| Registry::builtin().parse(text).unwrap().label;
        for (number, name) in [
            ("lsm:window=15,shape=2,neighbours=0", "lsm:window=15,shape=chess_corner,neighbours=counted"),
            ("lsm:sharpness=0", "lsm:window=15,sharpness=held"),
            ("forstner:covariance=1", "forstner:window=11,covariance=noise"),
            ("parametric_corner:gradient=3,curvature=1", "parametric_corner:window=15,gradient=both,curvature=yes"),
            ("chess_corners:detector=1,refiner=0", "chess_corners:detector=radon,refiner=own"),
        ] {
            assert_eq!((label(number).as_str(), label(name).as_str()), (name, name));
        }
        assert_eq!(label("lsm:shape=0,sharpness=1"), "lsm:window=15", "as at first");
        let matching = Registry::builtin().parse("lsm:window=13,neighbours=0,kinds=disc").unwrap();
        for text in ["lsm:window=13,neighbours=0,kinds=disc", "lsm:window=13,neighbours=counted,kinds=disc"] {
            assert!(matching.is_called(text), "{text}");
        }
        for text in ["lsm", "lsm:window=13", "lsm:window=13,neighbours=1,kinds=disc", "forstner:window=13,neighbours=0,kinds=disc"] {
            assert!(!matching.is_called(text), "{text}");
        }
        let message = error("lsm:shape=chess").to_string();
        assert!(message.contains("one of start, corner, chess_corner, junction, cross") && message.ends_with("found chess"), "{message}");
        assert!(matches!(error("lsm:shape=8"), MethodError::Domain { .. }));
        assert!(matches!(error("lsm:shape=1.5"), MethodError::Domain { .. }));
        let all = Registry::builtin().parse("lsm:shape=5").unwrap().all_settings();
        assert!(all.contains("shape=disc,") && all.contains("sharpness=sought,neighbours=left_out,"), "{all}");
    }

    #[test]
    fn kinds_stand_before_the_name_or_in_the_label() {
        let label = |text: &str| Registry::builtin().parse(text).unwrap().label;
        assert_eq!(label("disc=parametric_circle"), "parametric_circle:kinds=disc");
        assert_eq!(label("cross+corner=forstner: window = 15"), "forstner:window=15,kinds=corner+cross");
        for text in ["parametric_circle:kinds=disc", "forstner:window=15,kinds=corner+cross", "pixel:kinds=corner"] {
            assert_eq!(label(text), text);
        }
        assert!(matches!(error("disk=forstner"), MethodError::Kinds { .. }));
        assert!(matches!(error("disc+disc=forstner"), MethodError::Kinds { .. }));
        assert!(matches!(error("=forstner"), MethodError::Kinds { .. }));
        assert!(matches!(error("forstner:kinds="), MethodError::Kinds { .. }));
        assert!(matches!(error("disc=forstner:kinds=disc"), MethodError::Twice { .. }));
        assert!(matches!(error("disc="), MethodError::UnknownMethod { .. }));
    }

    #[test]
    fn a_method_is_known_in_all_forms_of_its_name() {
        let registry = Registry::builtin();
        for text in ["forstner", " forstner : window = 15", "cross+corner=forstner:window=15", "forstner:windw=3"] {
            assert!(registry.has(text), "{text}");
        }
        for text in ["", "forster", "forstner=pixel2", "mine:window=15"] {
            assert!(!registry.has(text), "{text}");
        }
    }

    #[test]
    fn on_photographs_significance_is_asked_for() {
        let label = |text: &str| Registry::builtin().parse_for_photographs(text).unwrap().label;
        assert_eq!(label("forstner"), "forstner:window=11,significance=4");
        assert_eq!(label("corner=forstner"), "forstner:window=11,significance=4,kinds=corner");
        assert_eq!(label("forstner:window=9"), "forstner:window=9,significance=4");
        assert_eq!(label("forstner:significance=0"), "forstner:window=11");
        assert_eq!(label("saddle"), "saddle:window=7");
        assert!(Registry::builtin().parse_for_photographs("forster").is_err());
    }

    #[test]
    fn mistakes_are_named() {
        assert!(matches!(error("forster"), MethodError::UnknownMethod { .. }));
        assert!(matches!(error("forstner:windw=3"), MethodError::UnknownParameter { .. }));
        for bad in ["10", "1", "33", "11.5", "NaN", "inf", "-3", "x", ""] {
            assert!(matches!(error(&format!("forstner:window={bad}")), MethodError::Domain { .. }), "{bad}");
        }
        assert!(matches!(error("forstner:window"), MethodError::Form { .. }));
        assert!(matches!(error("forstner:window=3,window=5"), MethodError::Twice { .. }));
        assert_eq!(error("pixel:window=3").to_string(), "`pixel` has no parameter `window`; it has none");
    }
}
