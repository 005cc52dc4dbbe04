//! The `[[method]]` tables: their keys are the method's own parameters.

use calibench_diagnostics::Problem;
use calibench_measure::{Configured, MethodError, Registry};
use toml::de::DeValue;

use super::section::Section;

/// All methods of a scenario; mistakes are added to `problems`.
pub fn methods(sections: Vec<Section<'_>>, registry: &Registry, problems: &mut Vec<Problem>) -> Vec<Configured> {
    let mut found: Vec<Configured> = Vec::new();
    for section in sections {
        let span = section.span.clone();
        let Some(configured) = method(section, registry, problems) else { continue };
        if found.iter().any(|earlier| earlier.label == configured.label) {
            problems.push(Problem::new(span, format!("method `{}` is listed twice; expected each once", configured.label)));
        } else {
            found.push(configured);
        }
    }
    found
}

fn method(mut section: Section<'_>, registry: &Registry, problems: &mut Vec<Problem>) -> Option<Configured> {
    let known = || registry.methods().iter().map(|method| method.name);
    let Some((key_span, value)) = section.take("name") else {
        let names = known().collect::<Vec<_>>().join(", ");
        problems.push(Problem::new(section.span, "[[method]] has no `name`").help(format!("`name`: one of {names}")));
        return None;
    };
    let Some(name) = value.get_ref().as_str() else {
        let found = value.get_ref().type_str();
        problems.push(Problem::new(key_span, format!("`name` is the name of a method, in quotes; found {found}")));
        return None;
    };
    let mut given = Vec::new();
    // An unknown key first: what kind of value it has does not matter.
    let known_keys = registry.methods().iter().find(|m| m.name == name).map_or(&[][..], |m| m.parameters);
    let unknown = |key: &str| !known_keys.is_empty() && !known_keys.iter().any(|p| p.name == key);
    for (key, value) in &section.table {
        if unknown(key.get_ref()) {
            given.push((key.get_ref().to_string(), 0.0));
            continue;
        }
        match number(value.get_ref()) {
            Some(number) => given.push((key.get_ref().to_string(), number)),
            None => {
                let found = value.get_ref().type_str();
                problems.push(Problem::new(value.span(), format!("`{}` of `{name}` is a number, found {found}", key.get_ref())));
                return None;
            }
        }
    }
    let span_of = |key: &str| section.table.iter().find(|(k, _)| k.get_ref() == key).map(|(k, v)| (k.span(), v.span()));
    let problem = |error: MethodError| match &error {
        MethodError::UnknownMethod { name, .. } => Problem::new(value.span(), error.to_string()).nearest(name, known()),
        MethodError::UnknownParameter { key, known, .. } => {
            let span = span_of(key).map_or(section.span.clone(), |spans| spans.0);
            Problem::new(span, error.to_string()).nearest(key, known.iter().map(String::as_str))
        }
        MethodError::Domain { key, .. } | MethodError::Twice { key, .. } => {
            Problem::new(span_of(key).map_or(section.span.clone(), |spans| spans.1), error.to_string())
        }
        MethodError::Form { .. } => Problem::new(value.span(), error.to_string()),
    };
    registry.configure(name, &given).map_err(|error| problems.push(problem(error))).ok()
}

fn number(value: &DeValue<'_>) -> Option<f64> {
    if let Some(integer) = value.as_integer() {
        return i64::from_str_radix(integer.as_str(), integer.radix()).ok().map(|integer| integer as f64);
    }
    value.as_float().and_then(|float| float.as_str().parse().ok())
}
