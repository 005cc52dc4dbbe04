//! Photographs and their twin, side by side.

mod pictures;

use calibench_model::escape::{self, code};

use crate::json::{TwinAnswer, TwinCase, TwinOperator};
use crate::markdown::{MarkdownTable, fixed, plain};

pub use pictures::pictures;

/// The verdict in a few lines, with a table of the operators.
pub fn verdict(twin: &TwinAnswer) -> String {
    let doubts: String = twin.doubts.iter().map(|doubt| format!("in doubt: {doubt}\n")).collect();
    format!("{}\n\n{}\n{doubts}", first(twin), operators(twin))
}

/// The page in Markdown.
pub fn page(twin: &TwinAnswer, scenario: &str) -> String {
    let doubts: String = twin.doubts.iter().map(|doubt| format!("**In doubt**: {}.\n\n", escape::markdown(doubt))).collect();
    let pictures: String = pictures(twin).iter().map(|(name, said, _)| format!("![{said}]({name})\n\n{said}\n\n")).collect();
    let untold: String = twin.untold.iter().map(|what| format!("- {what}\n")).collect();
    format!(
        "# The twin of {} photographs\n\n{}\n\n{doubts}{}\n{HOW}\n\n## What would change\n\n{}\n## Photographs beside their twin\n\n{}\n{pictures}## What the twin is made \
         of\n\n{}\n{}\n\nNot told by photographs of a board, and left out of the twin:\n\n{untold}",
        twin.photographs,
        first(twin),
        operators(twin),
        what_if(twin),
        looks(twin),
        made_of(twin),
        format_args!(
            "It is the scenario `{scenario}`: `calibench render {scenario} -o images` makes more of its images, `calibench run` runs it with any methods."
        ),
    )
}

/// How columns come about.
const HOW: &str = "Hold-out: a photograph is predicted by a camera from the others, RMS (2D). The twin was made without looking at it, but for that of the operator that \
made camera, board and poses. The true error is that of the twin, whose corners are known exactly, with its interval of 95 % over views; the truth that nobody has of the photographs.";

/// The answer in a sentence or two.
fn first(twin: &TwinAnswer) -> String {
    let named = |method: &String| code(method);
    let error = |method: &String| {
        let own = twin.operators.iter().find(|operator| operator.method == *method)?;
        Some(format!("{} px RMS{}", fixed(own.true_px?, 3), interval(own.true_from_px, own.true_to_px)))
    };
    match twin.best.as_slice() {
        [] => "No operator measured the twin.".to_owned(),
        [best] => format!("Nearest to the truth on these photographs: {}, {}.", named(best), error(best).unwrap_or_default()),
        [best, ties @ ..] => format!(
            "Nearest to the truth on these photographs: {}, {}; chance does not tell {} from it.",
            named(best),
            error(best).unwrap_or_default(),
            ties.iter().map(named).collect::<Vec<_>>().join(", ")
        ),
    }
}

fn interval(from: Option<f64>, to: Option<f64>) -> String {
    from.zip(to).map_or_else(String::new, |(from, to)| format!(" ({} to {})", fixed(from, 3), fixed(to, 3)))
}

fn px(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| fixed(value, 3))
}

fn operators(twin: &TwinAnswer) -> String {
    let mut table =
        MarkdownTable::new(&["operator", "hold-out, px", "of the twin", "twin / photographs", "true error in the twin, px", "95 %", ""]);
    for operator in &twin.operators {
        let ratio = operator.held_out_px.zip(operator.twin_held_out_px).map_or_else(String::new, |(own, twin)| fixed(twin / own, 2));
        let range = operator
            .true_from_px
            .zip(operator.true_to_px)
            .map_or_else(String::new, |(from, to)| format!("{} to {}", fixed(from, 3), fixed(to, 3)));
        table.row([
            code(&operator.method),
            px(operator.held_out_px),
            px(operator.twin_held_out_px),
            ratio,
            px(operator.true_px),
            range,
            remark(twin, operator),
        ]);
    }
    table.render()
}

fn remark(twin: &TwinAnswer, operator: &TwinOperator) -> String {
    let unavailable = operator.unavailable.as_ref().map(|why| format!("unavailable: {}", escape::markdown(why)));
    let best = twin.best.contains(&operator.method).then(|| if twin.best.len() > 1 { "best, a tie" } else { "best" }.to_owned());
    let maker = operator.is_maker.then(|| "made the twin".to_owned());
    unavailable.into_iter().chain(best).chain(maker).collect::<Vec<_>>().join("; ")
}

fn what_if(twin: &TwinAnswer) -> String {
    let heads: Vec<&str> = ["operator", "as it is"].into_iter().chain(twin.what_if.iter().map(|case| case.what.as_str())).collect();
    let mut table = MarkdownTable::new(&heads);
    for (place, operator) in twin.operators.iter().enumerate() {
        let of = |case: &TwinCase| {
            case.operators
                .get(place)
                .map_or_else(String::new, |own| format!("{}{}", px(own.true_px), interval(own.true_from_px, own.true_to_px)))
        };
        let own = format!("{}{}", px(operator.true_px), interval(operator.true_from_px, operator.true_to_px));
        table.row([code(&operator.method), own].into_iter().chain(twin.what_if.iter().map(of)));
    }
    format!(
        "True errors in the twin with one thing changed, px RMS (2D), with intervals of 95 %; `--what-if KEY=VALUE` asks for others.\n\n{}",
        table.render()
    )
}

fn looks(twin: &TwinAnswer) -> String {
    let mut table = MarkdownTable::new(&["what images look like", "unit", "photographs", "sigma", "twin"]);
    for look in &twin.looks {
        let sigma = look.sigma.map_or_else(String::new, plain);
        table.row([look.what.to_owned(), look.unit.to_owned(), plain(look.photographs), sigma, plain(look.twin)]);
    }
    table.render()
}

fn made_of(twin: &TwinAnswer) -> String {
    let mut table = MarkdownTable::new(&["key", "what", "unit", "value", "95 %"]);
    for part in &twin.made_of {
        let range = part.from.zip(part.to).map_or_else(String::new, |(from, to)| format!("{} to {}", plain(from), plain(to)));
        table.row([format!("`{}`", part.key), part.what.to_owned(), part.unit.to_owned(), plain(part.value), range]);
    }
    table.render()
}
