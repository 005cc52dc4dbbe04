//! Answers of the command line's `--json` as Python's dicts.

use calibench_report::json::{Answer, write_answer};
use pyo3::prelude::*;

/// An answer as a dict: the same keys as the JSON document.
pub fn as_dict<'py>(py: Python<'py>, answer: &impl Answer) -> PyResult<Bound<'py, PyAny>> {
    let mut text = Vec::new();
    write_answer(&mut text, answer)?;
    py.import("json")?.call_method1("loads", (String::from_utf8_lossy(&text),))
}
