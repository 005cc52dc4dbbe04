//! `calibench list`.

use std::fmt::Write;

use clap::ValueEnum;

use super::context::Context;
use super::{Failure, print};
use crate::published;
use calibench_measure::registry::Build;

/// What can be listed.
#[derive(Clone, Copy, ValueEnum)]
pub enum What {
    /// Scenarios, with what they are to show
    Scenarios,
    /// Methods and their parameters
    Methods,
    /// Published tables and the scenarios behind them
    Tables,
}

pub fn list(context: &Context<'_>, what: What) -> Result<(), Failure> {
    print(&match what {
        What::Scenarios => scenarios(context)?,
        What::Methods => methods(context),
        What::Tables => tables(context)?,
    })
}

fn scenarios(context: &Context<'_>) -> Result<String, Failure> {
    let mut text = String::new();
    for name in context.catalogue()?.names()? {
        let scenario = context.scenario(&name)?;
        let why: Vec<&str> = scenario.why.split_whitespace().collect();
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{name}\n    {}", why.join(" "));
    }
    Ok(text)
}

fn methods(context: &Context<'_>) -> String {
    let mut text = String::new();
    for method in context.toolbox.registry.methods() {
        let _ = writeln!(text, "{} (version {})\n    {}\n    source: {}", method.name, method.version, method.about, method.source);
        for parameter in method.parameters {
            let _ = writeln!(text, "    {}={}: {}; {}", parameter.name, parameter.default, parameter.about, parameter.domain.describe());
        }
        if let Build::Unavailable(why) = method.build {
            let _ = writeln!(text, "    unavailable: {why}");
        }
    }
    text
}

fn tables(context: &Context<'_>) -> Result<String, Failure> {
    let places = context.places()?;
    let mut text = String::new();
    for paper in published::papers(&places.published) {
        for (name, table) in published::tables(&places.published, &paper)? {
            let _ = writeln!(
                text,
                "{paper}/{name}\n    {}\n    {} printed cells, behind them {} with {}",
                table.title,
                table.cells.len(),
                table.scenario,
                table.method
            );
        }
    }
    Ok(text)
}
