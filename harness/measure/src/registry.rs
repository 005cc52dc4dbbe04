//! Which methods there are, by name.

use crate::error::MethodError;
use crate::operator::Operator;
use crate::parameter::{Parameter, Settings};

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
#[derive(Clone, Copy)]
pub enum Build {
    /// From checked settings.
    With(fn(&Settings) -> Box<dyn Operator>),
    /// Not here, and why.
    Unavailable(&'static str),
}

/// A method with its parameters set.
pub struct Configured {
    /// Name and parameters in one word, as in `forstner:window=11`: the windows and whatever differs from its default.
    pub label: String,
    /// The label of the same operator with all parameters at their defaults.
    pub default_label: String,
    /// The method's version.
    pub version: String,
    /// All parameters.
    pub settings: Settings,
    /// The operator, or why there is none.
    pub operator: Result<Box<dyn Operator>, &'static str>,
}

/// All methods of a build, in the order in which they are listed.
#[derive(Clone, Default)]
pub struct Registry {
    methods: Vec<Method>,
}

impl Registry {
    /// Adds a method, in place of one of the same name if there is one.
    #[must_use]
    pub fn with(mut self, method: Method) -> Self {
        match self.methods.iter_mut().find(|m| m.name == method.name) {
            Some(old) => *old = method,
            None => self.methods.push(method),
        }
        self
    }

    /// All methods.
    pub fn methods(&self) -> &[Method] {
        &self.methods
    }

    /// The method called `name`, with `given` parameters: keys, and values in the unit of the parameter.
    ///
    /// # Errors
    /// An unknown method or parameter, a value outside its domain.
    pub fn configure(&self, name: &str, given: &[(String, f64)]) -> Result<Configured, MethodError> {
        let Some(method) = self.methods.iter().find(|m| m.name == name) else {
            let known = self.methods.iter().map(|m| m.name.to_owned()).collect();
            return Err(MethodError::UnknownMethod { name: name.to_owned(), known });
        };
        let settings = Settings::resolve(name, method.parameters, given)?;
        let operator = match method.build {
            Build::With(build) => Ok(build(&settings)),
            Build::Unavailable(why) => Err(why),
        };
        let default_label = label(method, &Settings::resolve(name, method.parameters, &[])?);
        Ok(Configured { label: label(method, &settings), default_label, version: method.version.clone(), settings, operator })
    }

    /// The method that `text` names, as in `forstner:window=15`.
    ///
    /// # Errors
    /// As [`Self::configure`], and a text of another form.
    pub fn parse(&self, text: &str) -> Result<Configured, MethodError> {
        let malformed = || MethodError::Form { text: text.to_owned() };
        let (name, rest) = text.split_once(':').unwrap_or((text, ""));
        let pairs = rest.split(',').filter(|pair| !pair.is_empty());
        let given = pairs.map(|pair| {
            let (key, value) = pair.split_once('=').ok_or_else(malformed)?;
            Ok((key.trim().to_owned(), value.trim().parse().map_err(|_| malformed())?))
        });
        self.configure(name.trim(), &given.collect::<Result<Vec<_>, MethodError>>()?)
    }
}

fn label(method: &Method, settings: &Settings) -> String {
    let shown = method.parameters.iter().zip(settings.iter()).filter(|(p, (_, value))| p.always_shown || *value != p.default);
    let pairs: Vec<String> = shown.map(|(_, (key, value))| format!("{key}={value}")).collect();
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
    fn mistakes_are_named() {
        assert!(matches!(error("forster"), MethodError::UnknownMethod { .. }));
        assert!(matches!(error("forstner:windw=3"), MethodError::UnknownParameter { .. }));
        for bad in ["10", "1", "33", "11.5", "NaN", "inf", "-3"] {
            assert!(matches!(error(&format!("forstner:window={bad}")), MethodError::Domain { .. }), "{bad}");
        }
        assert!(matches!(error("forstner:window"), MethodError::Form { .. }));
        assert!(matches!(error("forstner:window=x"), MethodError::Form { .. }));
        assert!(matches!(error("forstner:window=3,window=5"), MethodError::Twice { .. }));
        assert_eq!(error("pixel:window=3").to_string(), "`pixel` has no parameter `window`; it has none");
    }
}
