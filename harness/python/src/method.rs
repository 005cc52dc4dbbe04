//! Callables of Python's as methods.

use std::sync::Arc;

use calibench_measure::operator::nearest_detected;
use calibench_measure::parameter::{Domain, Parameter};
use calibench_measure::{Build, Method, Operator, Outside, Settings};
use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start, Told};
use calibench_plugins::Teller;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::{matrices, positions, table};
use crate::measuring::covariance;
use crate::session::add;

/// A method as Python declares it.
struct Declared {
    callable: Arc<Py<PyAny>>,
    /// The radius within which a detection counts, px, of one that finds by itself; `None` for one that is given starts.
    radius: Option<f64>,
    told: Teller,
}

/// One whose parameters are set.
struct Asked {
    declared: Arc<Declared>,
    settings: Settings,
    /// Those that are whole numbers.
    whole: Vec<&'static str>,
}

/// Adds a callable to the methods: `calibench.method` calls it. Parameters are name, default, least, most, whether odd, whether whole, and what it is.
#[pyfunction]
pub fn add_method(
    name: String,
    version: Py<PyAny>,
    about: String,
    source: String,
    callable: Py<PyAny>,
    parameters: Vec<(String, f64, f64, f64, bool, bool, String)>,
    radius: Option<f64>,
) -> PyResult<()> {
    let whole: Vec<&'static str> = parameters.iter().filter(|parameter| parameter.5).map(|parameter| leak(&parameter.0)).collect();
    let parameter = |(name, default, min, max, odd, whole, about): (String, f64, f64, f64, bool, bool, String)| {
        let (least, most) = (min as u32, max as u32);
        let domain = match (odd, whole) {
            (true, _) => Domain::Odd { min: least, max: most },
            (false, true) => Domain::Whole { min: least, max: most },
            (false, false) => Domain::Real { min, max },
        };
        Parameter { name: leak(&name), about: leak(&about), domain, default, always_shown: name == "window" }
    };
    let parameters: Vec<Parameter> = parameters.into_iter().map(parameter).collect();
    // Names live as long as the process: methods are few.
    let (name, about, source, parameters) = (leak(&name), leak(&about), leak(&source), &*Box::leak(parameters.into_boxed_slice()));
    let (version, callable) = (Arc::new(version), Arc::new(callable));
    add(name, move || {
        let declared = Arc::new(Declared { callable: callable.clone(), radius, told: Teller::default() });
        let (version, whole) = (version.clone(), whole.clone());
        let build = move |settings: &Settings| {
            let asked = Asked { declared: declared.clone(), settings: settings.clone(), whole: whole.clone() };
            Ok(match Python::attach(|py| version_of(version.bind(py)).map_err(|error| error.to_string())) {
                Ok(version) => Outside { version, operator: Ok(Box::new(asked)) },
                Err(why) => Outside { version: UNKNOWN.into(), operator: Err(why) },
            })
        };
        Method { name, about, source, version: UNKNOWN.into(), parameters, build: Build::Outside(Arc::new(build)) }
    })
}

/// The version of a method that was not asked yet.
const UNKNOWN: &str = "?";

/// A text, or what a function knows.
fn version_of(version: &Bound<'_, PyAny>) -> PyResult<String> {
    let known = if version.is_callable() { version.call0()? } else { version.clone() };
    Ok(known.str()?.to_string())
}

fn leak(text: &str) -> &'static str {
    Box::leak(text.to_owned().into_boxed_str())
}

/// What an answer is: positions and covariances.
type Answer = (Vec<PixelPoint>, Option<Vec<[[f64; 2]; 2]>>);

impl Asked {
    /// Calls the callable; why not, with what is told, where it raises or answers something else.
    fn call(&self, py: Python<'_>, image: &Image, starts: Option<&[Start]>) -> Result<Answer, Rejection> {
        let raised = |error: PyErr| {
            self.declared.told.tell(&in_a_line(&error.to_string()));
            Rejection::Raised
        };
        let answer = self.answer(py, image, starts).map_err(raised)?;
        read(&answer, starts.map(<[Start]>::len)).map_err(|error| {
            self.declared.told.tell(&in_a_line(&error.value(py).to_string()));
            Rejection::Malformed
        })
    }

    fn answer<'py>(&self, py: Python<'py>, image: &Image, starts: Option<&[Start]>) -> PyResult<Bound<'py, PyAny>> {
        let grey = PyArray1::from_slice(py, image.grey()).reshape([image.height(), image.width()])?;
        let named = PyDict::new(py);
        for (name, value) in self.settings.iter() {
            if self.whole.contains(&name) { named.set_item(name, value as i64)? } else { named.set_item(name, value)? }
        }
        let callable = self.declared.callable.bind(py);
        match starts {
            Some(starts) => {
                let at: Vec<[f64; 2]> = starts.iter().map(|start| [start.position.x, start.position.y]).collect();
                callable.call((grey, table(py, &at)?), Some(&named))
            }
            None => callable.call((grey,), Some(&named)),
        }
    }
}

/// Positions, and covariances if there are any; `expected` is how many.
fn read(answer: &Bound<'_, PyAny>, expected: Option<usize>) -> PyResult<Answer> {
    let (xy, cov) = match answer.cast::<PyTuple>() {
        Ok(pair) if pair.len() == 2 => (pair.get_item(0)?, Some(pair.get_item(1)?)),
        _ => (answer.clone(), None),
    };
    let found = positions(&xy, "xy")?;
    if let Some(count) = expected.filter(|count| *count != found.len()) {
        return Err(crate::error::input(format!(
            "xy: {} positions for {count} starts; expected one for each, NaN where there is none",
            found.len()
        )));
    }
    let cov = cov.filter(|cov| !cov.is_none()).map(|cov| matrices(&cov, found.len(), "cov")).transpose()?;
    Ok((found, cov))
}

/// A message of several lines in one.
fn in_a_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A point of an answer.
fn point(position: PixelPoint, own: Option<[[f64; 2]; 2]>) -> Result<Measurement, Rejection> {
    if position.x.is_nan() && position.y.is_nan() {
        return Err(Rejection::Declined);
    }
    let own = own.map(covariance).filter(|s| !s.sxx.is_nan());
    let is_covariance = own.is_none_or(|s| s.sxx.is_finite() && s.sxx >= 0.0 && s.syy >= 0.0 && s.sxx * s.syy >= s.sxy * s.sxy);
    if position.is_finite() && is_covariance { Ok(Measurement { position, covariance: own }) } else { Err(Rejection::Malformed) }
}

impl Operator for Asked {
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        self.measure_all(image, std::slice::from_ref(start)).pop().unwrap_or(Err(Rejection::Malformed))
    }

    fn measure_all(&self, image: &Image, starts: &[Start]) -> Vec<Result<Measurement, Rejection>> {
        let asked = |starts| Python::attach(|py| self.call(py, image, starts));
        match self.declared.radius {
            Some(radius) => {
                let mut failed = None;
                let found = || {
                    let kept = |(found, _): Answer| found.into_iter().filter(|at| at.is_finite()).collect();
                    asked(None).map_or_else(
                        |why| {
                            failed = Some(why);
                            Vec::new()
                        },
                        kept,
                    )
                };
                let results = nearest_detected((image, starts), (0, radius), found);
                results
                    .into_iter()
                    .map(|result| result.map_err(|why| failed.filter(|_| why == Rejection::NoCorner).unwrap_or(why)))
                    .collect()
            }
            None => match asked(Some(starts)) {
                Ok((found, cov)) => {
                    let own = |i: usize| cov.as_ref().map(|cov| cov[i]);
                    found.into_iter().enumerate().map(|(i, position)| point(position, own(i))).collect()
                }
                Err(why) => vec![Err(why); starts.len()],
            },
        }
    }

    /// It is asked once an image: Python runs on one thread at a time.
    fn is_local(&self) -> bool {
        false
    }

    fn told(&self) -> Told {
        self.declared.told.all()
    }
}
