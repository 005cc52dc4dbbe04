//! `calibench list`.

use std::fmt::Write;

use calibench_cameras::FORMATS;
use calibench_cameras::target::TARGETS;
use calibench_measure::registry::Build;
use calibench_model::camera::{Convention, Verification};
use calibench_records::figures::{Better, Group, Quantity};
use calibench_report::published;
use clap::ValueEnum;

use super::context::Context;
use crate::deliver::{As, answer, print};
use crate::failure::{Failure, project_failure};
use crate::peers::peers;

/// What can be listed.
#[derive(Clone, Copy, ValueEnum)]
pub enum What {
    /// Scenarios, with what they are to show
    Scenarios,
    /// Methods and their parameters
    Methods,
    /// Calibration systems: ours, and those that files of plug-ins declare
    Calibrators,
    /// Conventions of cameras, and what of them is verified
    Conventions,
    /// Formats of camera files, what of them is verified, and what `convert --to` can be told
    Formats,
    /// Published tables and the scenarios behind them
    Tables,
    /// Figures that records hold, with their groups, units and meanings
    Figures,
    /// What other tools' numbers mean, by version: RMS, sigmas, origins, orders, directions, and the scripts that asked them
    Peers,
}

mod items;

pub fn list(context: &Context<'_>, what: What, answered: As) -> Result<(), Failure> {
    if answered.json {
        return answer(&items::items(context, what)?);
    }
    print(&match what {
        What::Scenarios => scenarios(context)?,
        What::Methods => methods(context)?,
        What::Calibrators => calibrators(context)?,
        What::Conventions => conventions(),
        What::Formats => formats(),
        What::Tables => tables(context)?,
        What::Figures => figures(),
        What::Peers => peers()?,
    })
}

fn scenarios(context: &Context<'_>) -> Result<String, Failure> {
    let mut text = String::new();
    let catalogue = context.catalogue()?;
    for name in catalogue.names()? {
        let why = catalogue.why(&name).map_err(|error| project_failure(error.into()))?;
        let why: Vec<&str> = why.split_whitespace().collect();
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{name}\n    {}", why.join(" "));
    }
    Ok(text)
}

fn methods(context: &Context<'_>) -> Result<String, Failure> {
    let mut text = String::new();
    for method in context.registry()?.methods() {
        let _ = writeln!(text, "{} (version {})\n    {}\n    source: {}", method.name, method.version, method.about, method.source);
        for parameter in method.parameters {
            let _ = writeln!(
                text,
                "    {}={}: {}; {}",
                parameter.name,
                parameter.domain.setting(parameter.default),
                parameter.about,
                parameter.domain.describe()
            );
        }
        if let Build::Unavailable(why) = method.build {
            let _ = writeln!(text, "    unavailable: {why}");
        }
    }
    Ok(text)
}

fn calibrators(context: &Context<'_>) -> Result<String, Failure> {
    let mut text = String::new();
    for listed in context.tools()?.calibrators {
        let version = listed.calibrator.version();
        let version = version.map_or_else(|why| format!("unavailable: {why}"), |version| format!("version {version}"));
        let start = if listed.start { "; is given a start" } else { "" };
        let (models, source) = (listed.models.join(", "), &listed.source);
        let _ = writeln!(
            text,
            "{} ({} {version})\n    {}\n    models: {models}{start}\n    source: {source}",
            listed.name, listed.system, listed.about
        );
    }
    Ok(text)
}

fn conventions() -> String {
    let mut text = String::new();
    for convention in calibench_model::camera::conventions() {
        let Convention { name, about, version, direction, pixel_origin, y, order, normalisation, source, verification, .. } = convention;
        let _ = writeln!(text, "{name}: {about}");
        let _ = writeln!(text, "    {direction:?}, y {y:?}, origin {pixel_origin:?}, p1 and p2 in the order of {order:?}, {normalisation}");
        if !version.is_empty() {
            let _ = writeln!(text, "    versions: {version}");
        }
        let _ = writeln!(text, "    source: {source}");
        let _ = match verification {
            Verification::Verified(proof) => writeln!(text, "    verified: {proof}"),
            Verification::Unverified(open) => writeln!(text, "    unverified: {open}"),
            Verification::Definition => writeln!(text, "    a definition of its own"),
        };
    }
    text
}

fn formats() -> String {
    let mut text = String::from("file formats\n");
    for format in FORMATS {
        let access = if format.is_written() { "read and written" } else { "read" };
        let _ = writeln!(text, "  {} (.{}): {}, {}; {access}", format.name, format.extension, format.tool, format.versions);
        let _ = writeln!(text, "      {}", format.verified.map_or("unverified".to_owned(), |proof| format!("verified: {proof}")));
    }
    text.push_str("\ntargets of `convert --to`\n");
    for (name, about) in TARGETS {
        let _ = writeln!(text, "  {name}: {about}");
    }
    for format in FORMATS {
        let mut models: Vec<&str> = format.models(None).iter().map(|model| model.name).collect();
        models.dedup();
        if !models.is_empty() {
            let _ = writeln!(text, "  {}: {}; --model chooses among {}", format.name, format.tool, models.join(", "));
        }
    }
    text
}

fn figures() -> String {
    let mut text = String::new();
    for (group, name) in Group::ALL {
        let _ = writeln!(text, "{name}");
        for entry in Quantity::CATALOGUE.iter().filter(|entry| entry.group == group) {
            let better = if entry.better == Better::Neither { String::new() } else { format!(", {} is better", entry.better.text()) };
            let _ = writeln!(text, "    {} ({}{better})\n        {}", entry.pattern, entry.units.text(), entry.meaning);
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
