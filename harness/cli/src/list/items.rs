//! What there is, for programs.

use calibench_cameras::FORMATS;
use calibench_cameras::target::TARGETS;
use calibench_measure::Parameter;
use calibench_measure::registry::Build;
use calibench_model::camera::{Convention, Verification};
use calibench_records::figures::{Better, Group, Quantity};
use calibench_report::json::{ListAnswer, Listed, ListedParameter};
use calibench_report::published;
use clap::ValueEnum;

use super::What;
use crate::context::Context;
use crate::failure::{Failure, project_failure};
use crate::peers::peer_rows;

/// All there is of a kind.
pub fn items(context: &Context<'_>, what: What) -> Result<ListAnswer, Failure> {
    let items = match what {
        What::Scenarios => scenarios(context)?,
        What::Methods => methods(context)?,
        What::Calibrators => calibrators(context)?,
        What::Conventions => conventions(),
        What::Formats => formats(),
        What::Tables => tables(context)?,
        What::Figures => figures(),
        What::Peers => peers()?,
    };
    Ok(ListAnswer { what: what.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned()), items })
}

fn scenarios(context: &Context<'_>) -> Result<Vec<Listed>, Failure> {
    let catalogue = context.catalogue()?;
    let one = |name: String| {
        let why = catalogue.why(&name).map_err(|error| project_failure(error.into()))?;
        Ok(Listed::new(name, why.split_whitespace().collect::<Vec<_>>().join(" "), []))
    };
    catalogue.names()?.into_iter().map(one).collect()
}

fn methods(context: &Context<'_>) -> Result<Vec<Listed>, Failure> {
    let parameter = |parameter: &Parameter| ListedParameter {
        name: parameter.name.to_owned(),
        default: parameter.domain.setting(parameter.default).to_string(),
        about: parameter.about.to_owned(),
        values: parameter.domain.describe(),
    };
    let methods = context.registry()?.methods().iter().map(|method| {
        let unavailable = if let Build::Unavailable(why) = method.build { why } else { "" };
        let facts = [("version", method.version.clone()), ("source", method.source.to_owned()), ("unavailable", unavailable.to_owned())];
        let parameters = method.parameters.iter().map(parameter).collect();
        Listed { parameters, ..Listed::new(method.name, method.about, facts) }
    });
    Ok(methods.collect())
}

fn calibrators(context: &Context<'_>) -> Result<Vec<Listed>, Failure> {
    let calibrators = context.tools()?.calibrators.iter().map(|listed| {
        let (version, unavailable) = match listed.calibrator.version() {
            Ok(version) => (version, String::new()),
            Err(why) => (String::new(), why),
        };
        let facts = [
            ("system", listed.system.clone()),
            ("version", version),
            ("models", listed.models.join(", ")),
            ("start", if listed.start { "is given one".to_owned() } else { String::new() }),
            ("source", listed.source.clone()),
            ("unavailable", unavailable),
        ];
        Listed::new(&*listed.name, &*listed.about, facts)
    });
    Ok(calibrators.collect())
}

fn conventions() -> Vec<Listed> {
    let one = |convention: Convention| {
        let Convention { name, about, version, direction, pixel_origin, y, order, normalisation, source, verification, .. } = convention;
        let (verified, unverified) = match verification {
            Verification::Verified(proof) => (proof, ""),
            Verification::Unverified(open) => ("", open),
            Verification::Definition => ("a definition of its own", ""),
        };
        let facts = [
            ("direction", format!("{direction:?}")),
            ("y", format!("{y:?}")),
            ("origin", format!("{pixel_origin:?}")),
            ("order", format!("{order:?}")),
            ("normalisation", normalisation.to_string()),
            ("versions", version.to_string()),
            ("source", source.to_string()),
            ("verified", verified.to_string()),
            ("unverified", unverified.to_string()),
        ];
        Listed::new(name, about, facts)
    };
    calibench_model::camera::conventions().iter().map(|convention| one(**convention)).collect()
}

fn formats() -> Vec<Listed> {
    let files = FORMATS.iter().map(|format| {
        let mut models: Vec<&str> = format.models(None).iter().map(|model| model.name).collect();
        models.dedup();
        let facts = [
            ("kind", "file format".to_owned()),
            ("ending", format.extension.to_string()),
            ("versions", format.versions.to_string()),
            ("access", if format.is_written() { "read and written" } else { "read" }.to_owned()),
            ("models", models.join(", ")),
            ("verified", format.verified.map_or_else(String::new, ToString::to_string)),
        ];
        Listed::new(format.name, format.tool, facts)
    });
    let targets = TARGETS.iter().map(|(name, about)| Listed::new(*name, *about, [("kind", "target of `convert --to`".to_owned())]));
    files.chain(targets).collect()
}

fn tables(context: &Context<'_>) -> Result<Vec<Listed>, Failure> {
    let places = context.places()?;
    let mut items = Vec::new();
    for paper in published::papers(&places.published) {
        for (name, table) in published::tables(&places.published, &paper)? {
            let facts = [("scenario", table.scenario), ("method", table.method), ("cells", table.cells.len().to_string())];
            items.push(Listed::new(format!("{paper}/{name}"), table.title, facts));
        }
    }
    Ok(items)
}

fn figures() -> Vec<Listed> {
    let group = |of: Group| Group::ALL.iter().find(|(group, _)| *group == of).map_or_else(String::new, |(_, name)| (*name).to_string());
    let one = |entry: &calibench_records::figures::Entry| {
        let better = if entry.better == Better::Neither { String::new() } else { entry.better.text().to_string() };
        let facts = [("group", group(entry.group)), ("unit", entry.units.text()), ("better", better)];
        Listed::new(entry.pattern, entry.meaning, facts)
    };
    let of = |group: Group| Quantity::CATALOGUE.iter().filter(move |entry| entry.group == group);
    Group::ALL.into_iter().flat_map(|(group, _)| of(group)).map(one).collect()
}

fn peers() -> Result<Vec<Listed>, Failure> {
    let one = |[tool, versions, question, answer, script, date]: [String; 6]| {
        let facts = [("versions", versions), ("question", question), ("script", format!("findings/{script}.sh")), ("date", date)];
        Listed::new(tool, answer, facts)
    };
    Ok(peer_rows()?.into_iter().map(one).collect())
}
