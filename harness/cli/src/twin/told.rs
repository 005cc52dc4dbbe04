//! The answer: operators on photographs and twin, what both look like, what is in doubt.

use calibench_measure::Configured;
use calibench_report::json::{TwinAnswer, TwinCase, TwinCaseOperator, TwinCurves, TwinLook, TwinOperator, TwinPart};
use calibench_twin::look::Figure;
use calibench_twin::score::{Rms, best};
use calibench_twin::{Fitted, Look, made_of};

use super::MAKER;

/// Fewer photographs hold board and noise badly.
const ENOUGH: usize = 8;
/// Edges of both polarities may differ by this share of their spread.
const POLARITY: f64 = 0.1;
/// Root mean square difference of the profiles of edges, as a share of the contrast.
const PROFILE: f64 = 0.02;
/// Hold-out of the operator that made the twin, twin over photographs, and its inverse.
const MADE: f64 = 1.25;
/// Share of pixels at the ends of the scale.
const CLIPPED: f64 = 0.05;
/// How many times the operators' own errors the rest may be.
const FLOOR: f64 = 3.0;
/// A figure of the twin is that of the photographs within so many standard deviations and this share.
const LOOKS: [f64; 2] = [3.0, 0.1];

/// What photographs of a board cannot tell.
const UNTOLD: [&str; 4] = [
    "noise that is the same in all photographs (PRNU, DSNU): their boards move, and their noise is taken as new in each",
    "electrons and gain: noise is in grey levels; light is grey value, without gamma",
    "colour: demosaicing is there as smoothed noise and as what it does to the spread of edges",
    "what lies outside the board: its margin is a square wide, and what is behind it is grey",
];

/// What came of the operators.
pub struct Scored<'a> {
    pub methods: &'a [Configured],
    pub held_out: Vec<Rms>,
    pub twin_held_out: Vec<Rms>,
    pub errors: Vec<Rms>,
    /// What was asked for, what that is, and errors.
    pub cases: Vec<(String, String, Vec<Rms>)>,
}

/// The answer; `doubts` are those of the photographs and the calibration.
pub fn told(scored: &Scored<'_>, (real, found): (&Look, &Fitted), (model, square): (&str, f64), doubts: Vec<String>) -> TwinAnswer {
    let operators: Vec<TwinOperator> = (0..scored.methods.len()).map(|place| operator(scored, place)).collect();
    let views = real.spreads.iter().flatten().count();
    let of_looks = in_doubt(real, &found.look, views);
    let of_operators = of_operators(scored, &operators);
    let part = |part: calibench_twin::Part| TwinPart {
        key: part.key,
        what: part.what,
        unit: part.unit,
        value: part.value,
        from: part.interval.map(|ends| ends[0]),
        to: part.interval.map(|ends| ends[1]),
    };
    let case = |(asked, what, errors): &(String, String, Vec<Rms>)| TwinCase {
        asked: asked.clone(),
        what: what.clone(),
        operators: errors.iter().map(of_case).collect(),
    };
    TwinAnswer {
        photographs: real.spreads.len(),
        model: model.to_owned(),
        maker: MAKER.to_owned(),
        best: best(&scored.errors).into_iter().map(|place| scored.methods[place].label.clone()).collect(),
        operators,
        looks: looks(real, &found.look),
        made_of: made_of(real, found, square).into_iter().map(part).collect(),
        profile: TwinCurves { photographs: real.profile.points(), twin: found.look.profile.points() },
        noise: TwinCurves { photographs: noise(real), twin: noise(&found.look) },
        what_if: scored.cases.iter().map(case).collect(),
        doubts: doubts.into_iter().chain(of_looks).chain(of_operators).collect(),
        untold: UNTOLD.to_vec(),
    }
}

fn operator(scored: &Scored<'_>, place: usize) -> TwinOperator {
    let method = &scored.methods[place];
    let TwinCaseOperator { true_px, true_from_px, true_to_px } = of_case(&scored.errors[place]);
    TwinOperator {
        method: method.label.clone(),
        is_maker: method.label == MAKER,
        unavailable: method.operator.as_ref().err().cloned(),
        held_out_px: scored.held_out[place].px(),
        twin_held_out_px: scored.twin_held_out[place].px(),
        true_px,
        true_from_px,
        true_to_px,
    }
}

fn of_case(errors: &Rms) -> TwinCaseOperator {
    let estimate = errors.estimate();
    let interval = estimate.and_then(|estimate| estimate.interval);
    TwinCaseOperator {
        true_px: estimate.map(|estimate| estimate.px),
        true_from_px: interval.map(|ends| ends[0]),
        true_to_px: interval.map(|ends| ends[1]),
    }
}

/// Level and standard deviation of each bin, grey levels of 255.
fn noise(look: &Look) -> Vec<[f64; 2]> {
    look.bins.iter().map(|[level, variance, _]| [255.0 * level, 255.0 * variance.max(0.0).sqrt()]).collect()
}

/// What a figure is, its unit, and the figure.
type Named = (&'static str, &'static str, Option<Figure>);

/// The figures of a look.
fn figures(look: &Look) -> Vec<Named> {
    let root = |figure: Option<Figure>, scale: f64| {
        figure.map(|figure| {
            let value = figure.value.max(0.0).sqrt();
            Figure { value: scale * value, sigma: scale * figure.sigma / (2.0 * value).max(1e-9) }
        })
    };
    let times = |figure: Option<Figure>, by: f64| figure.map(|figure| Figure { value: by * figure.value, sigma: by * figure.sigma });
    vec![
        ("spread of edges with the pixel's own", "px", root(look.variance, 1.0)),
        ("noise in the middle of the levels", "grey levels of 255", times(Some(look.noise_middle), 255.0)),
        ("correlation of noise with the next pixel", "", look.correlation),
        ("overshoot of edges (below 0: tails)", "% of the contrast", times(look.halo, 100.0)),
        ("raggedness: edges in pieces of 2 px about a straight line", "px RMS", root(look.raggedness, 1.0)),
        ("raggedness of edges along rows or columns", "px RMS", root(look.raggedness_by[0], 1.0)),
        ("raggedness of edges askew", "px RMS", root(look.raggedness_by[1], 1.0)),
        ("asymmetry of edges: white is full, or the curve is bent", "% of the contrast", times(look.asymmetry, 100.0)),
        ("edges stand towards the bright side by", "% of a square", times(look.shift, 100.0)),
        ("edges bright to the right or below, less the others: spread", "px", look.polarity),
    ]
}

fn looks(real: &Look, twin: &Look) -> Vec<TwinLook> {
    let both = figures(real).into_iter().zip(figures(twin));
    let one = |((what, unit, real), (.., twin)): (Named, Named)| {
        let (real, twin) = (real?, twin?);
        Some(TwinLook { what, unit, photographs: real.value, sigma: Some(real.sigma).filter(|sigma| sigma.is_finite()), twin: twin.value })
    };
    both.filter_map(one).collect()
}

/// What is in doubt of how the photographs look, and of how far the twin follows.
fn in_doubt(real: &Look, twin: &Look, views: usize) -> Vec<String> {
    let mut doubts = Vec::new();
    if views < ENOUGH {
        doubts.push(format!("the twin is made of {views} photographs: {ENOUGH} or more hold its board and its noise well"));
    }
    if let Some(polarity) = real.polarity {
        let most = POLARITY * real.spread() + LOOKS[0] * polarity.sigma.min(1.0);
        if polarity.value.abs() > most {
            doubts.push(format!(
                "edges that are bright to the right or below are spread by {:.3} px more than the others (limit {most:.3} px): no twin has that; readout or processing make it",
                polarity.value
            ));
        }
    }
    let distance = real.profile.distance(&twin.profile);
    if distance > PROFILE {
        doubts.push(format!(
            "the profile of edges differs from the twin's by {:.1} % of the contrast (RMS; limit {:.0} %)",
            100.0 * distance,
            100.0 * PROFILE
        ));
    }
    if real.clipped > CLIPPED {
        doubts.push(format!(
            "{:.0} % of the pixels in squares are at the ends of the scale: their noise and their levels are not told",
            100.0 * real.clipped
        ));
    }
    for ((what, unit, own), (.., twin)) in figures(real).into_iter().zip(figures(twin)) {
        // Polarity has a limit of its own, and no twin has it.
        let Some((own, twin)) = own.zip(twin).filter(|_| !what.starts_with("edges bright")) else { continue };
        let sigma = own.sigma.hypot(twin.sigma);
        let scale = if unit.starts_with('%') { 1.0 } else { own.value.abs() };
        if sigma.is_finite() && (own.value - twin.value).abs() > LOOKS[0] * sigma + LOOKS[1] * scale {
            doubts.push(format!("{what}: {:.3} {unit} in the photographs, {:.3} in the twin", own.value, twin.value));
        }
    }
    doubts
}

/// What is in doubt of what operators do; of hold-outs only that of the operator that made the twin is looked at.
fn of_operators(scored: &Scored<'_>, operators: &[TwinOperator]) -> Vec<String> {
    let mut doubts = Vec::new();
    let maker = operators.iter().find(|operator| operator.is_maker);
    let Some((own, twin, error)) = maker.and_then(|maker| Some((maker.held_out_px?, maker.twin_held_out_px?, maker.true_px?))) else {
        return vec![format!("{MAKER}, which makes the twin, has no hold-out")];
    };
    let ratio = own / twin;
    if !(1.0 / MADE..=MADE).contains(&ratio) {
        doubts.push(format!(
            "photographs are predicted to {own:.3} px with the corners of {MAKER} and the twin to {twin:.3} px: what else there is in the photographs, the twin does not have"
        ));
    }
    // What is no operator's: the lens beyond its model, the board, the paper, photographs that are not of one moment.
    let floor = (own * own - error * error).max(0.0).sqrt();
    let typical = calibench_model::median(scored.errors.iter().filter_map(Rms::px)).unwrap_or(0.0);
    if floor > FLOOR * typical {
        doubts.push(format!(
            "what no operator makes ({floor:.3} px of the hold-out) is more than {FLOOR:.0} times what operators make ({typical:.3} px in the median): operators cannot be told apart"
        ));
    }
    doubts
}
