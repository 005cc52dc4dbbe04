//! Reading `[blocks]` and `[[block]]`.

use calibench_diagnostics::Problem;
use calibench_measure::Configured;
use calibench_model::camera::{Camera, Ebner, Photogrammetric};
use toml::Spanned;

use super::wire::{BlockWire, BlocksWire, ResidualsWire};
use super::{Block, Blocks, RESIDUALS, ResidualPairs};
use crate::section::Section;
use crate::studies::{Seen, filled, matched, places};

/// Where gross errors begin if the scenario does not say, px.
const GROSS: f64 = 1.0;
/// Ebner's parameters.
const PARAMETERS: [&str; 12] = ["e1", "e2", "e3", "e4", "e5", "e6", "e7", "e8", "e9", "e10", "e11", "e12"];
/// Images that a network takes at least.
const LEAST_IMAGES: usize = 2;

/// Reads the tables of a scenario of `views`, whose methods are `methods`.
pub fn read(
    mut section: Section<'_>,
    listed: Vec<Section<'_>>,
    views: &Seen<'_>,
    methods: &[Configured],
    problems: &mut Vec<Problem>,
) -> Option<Blocks> {
    let before = problems.len();
    let span = section.span.clone();
    let residuals = section.take_table("residuals", "[blocks.residuals]", problems);
    let wire: Option<BlocksWire> = section.read(&["residuals"], problems);
    let Camera::Photogrammetric(truth) = *views.camera else {
        problems
            .push(Problem::new(span, "[blocks] needs a camera of the photogrammetric model").help("write its `size`, `pitch` and `c` out"));
        return None;
    };
    if views.redrawn {
        problems.push(Problem::new(span.clone(), "[blocks] with stations that are drawn anew in each trial: expected the same in all"));
    }
    if listed.is_empty() {
        problems.push(Problem::new(span, "[blocks] without a [[block]]: expected at least one"));
    }
    let mut names = Names::of(views, methods);
    let mut list: Vec<Block> = Vec::new();
    for section in listed {
        list.extend(block(section, &mut names, &list, problems));
    }
    let residuals = residuals.map(|section| compared(section, &names, &list, problems));
    let wire = wire?;
    if problems.len() > before {
        return None;
    }
    let width = f64::from(truth.size.width) * truth.pitch_um * 1e-3;
    let base = Photogrammetric { c: wire.c.0, x0: 0.0, y0: 0.0, k: [0.0; 3], p: [0.0; 2], b: [0.0; 2], ..truth };
    Some(Blocks {
        camera: Ebner { base, b_mm: wire.grid.map_or(0.4 * width, |grid| grid.0), parameters: [0.0; 12] },
        sigma_px: wire.sigma_px.0,
        gross_px: wire.gross_px.map_or(GROSS, |sigma| sigma.0),
        keep_points: wire.keep_points.unwrap_or(false),
        list,
        residuals: residuals.flatten(),
    })
}

/// What a block may name.
struct Names<'a> {
    targets: Vec<&'a str>,
    stations: Vec<&'a str>,
    methods: &'a [Configured],
    /// Blocks that have problems of their own: who names them has none.
    broken: Vec<String>,
}

impl<'a> Names<'a> {
    fn of(views: &Seen<'a>, methods: &'a [Configured]) -> Self {
        Self {
            targets: views.field.targets.iter().map(|target| target.id.as_str()).collect(),
            stations: views.stations.iter().map(|station| station.name.as_str()).collect(),
            methods,
            broken: Vec::new(),
        }
    }
}

fn block(section: Section<'_>, names: &mut Names<'_>, earlier: &[Block], problems: &mut Vec<Problem>) -> Option<Block> {
    let before = problems.len();
    let wire: BlockWire = section.read(&[], problems)?;
    let name = wire.name.get_ref().clone();
    if name == RESIDUALS || earlier.iter().any(|other| other.name == name) {
        problems.push(Problem::new(wire.name.span(), format!("the name `{name}` is taken: expected each once, and not `{RESIDUALS}`")));
    }
    filled("targets", wire.targets.as_ref(), problems);
    filled("methods", wire.methods.as_ref(), problems);
    filled("each", wire.each.as_ref(), problems);
    let before_images = problems.len();
    let all_images = || (0..names.stations.len()).collect::<Vec<_>>();
    let (images, several) = match (&wire.images, &wire.each) {
        (Some(_), Some(each)) => {
            problems.push(Problem::new(each.span(), "`each` beside `images`: expected one of them"));
            (Vec::new(), true)
        }
        (Some(images), None) => (vec![matched("station", images.get_ref(), &names.stations, problems)], false),
        (None, Some(each)) => {
            let choice = |patterns: &Spanned<Vec<Spanned<String>>>| matched("station", patterns.get_ref(), &names.stations, &mut *problems);
            (each.get_ref().iter().map(choice).collect(), true)
        }
        (None, None) => (vec![all_images()], false),
    };
    let at = wire.each.as_ref().map(Spanned::span).or_else(|| wire.images.as_ref().map(Spanned::span)).unwrap_or_else(|| wire.name.span());
    if problems.len() == before_images && images.iter().any(|choice| choice.len() < LEAST_IMAGES) {
        problems.push(Problem::new(at, format!("a block takes at least {LEAST_IMAGES} images")));
    }
    let targets = match &wire.targets {
        Some(patterns) => matched("target", patterns.get_ref(), &names.targets, problems),
        None => (0..names.targets.len()).collect(),
    };
    let groups = match &wire.groups {
        Some(groups) => grouped(groups, &images, names, problems),
        None => vec![0; names.stations.len()],
    };
    let corrected_by = wire.corrected_by.as_ref().and_then(|other| {
        let found = earlier.iter().position(|block| block.name == *other.get_ref());
        if found.is_none() && !names.broken.contains(other.get_ref()) {
            let message = format!("no earlier block is called `{}`", other.get_ref());
            problems.push(Problem::new(other.span(), message).nearest(other.get_ref(), earlier.iter().map(|block| block.name.as_str())));
        }
        found
    });
    let chosen = wire.methods.as_ref().map(|listed| {
        let labels: Vec<&str> = names.methods.iter().map(|method| method.label.as_str()).collect();
        let called = |name: &Spanned<String>| {
            let label = names.methods.iter().find(|method| method.is_called(name.get_ref())).map_or(name.get_ref(), |method| &method.label);
            Spanned::new(name.span(), label.clone())
        };
        places("method", &listed.get_ref().iter().map(called).collect::<Vec<_>>(), &labels, problems)
    });
    let parameters = wire.parameters.as_ref().map(|listed| places("parameter", listed.get_ref(), &PARAMETERS, problems));
    if let (Some(by), Some(listed)) = (&wire.corrected_by, &wire.parameters)
        && !listed.get_ref().is_empty()
    {
        problems.push(Problem::new(by.span(), "`corrected_by` beside `parameters`: expected one of them"));
    }
    if problems.len() > before {
        names.broken.push(name);
        return None;
    }
    Some(Block {
        name,
        targets,
        images,
        several,
        parameters: parameters.into_iter().flatten().map(|index| PARAMETERS[index].to_owned()).collect(),
        groups,
        corrected_by,
        height_sigma: wire.height_sigma.map(|sigma| sigma.0),
        points_per_image: wire.points_per_image.map(|count| count.0),
        bend_over: wire.bend_over.map(|over| over.0),
        methods: chosen.unwrap_or_else(|| (0..names.methods.len()).collect()),
    })
}

/// The group of each station; every image of the block must be in one group.
fn grouped(
    written: &Spanned<Vec<Spanned<Vec<Spanned<String>>>>>,
    images: &[Vec<usize>],
    names: &Names<'_>,
    problems: &mut Vec<Problem>,
) -> Vec<usize> {
    let mut found = vec![None; names.stations.len()];
    for (group, patterns) in written.get_ref().iter().enumerate() {
        for station in matched("station", patterns.get_ref(), &names.stations, problems) {
            if found[station].replace(group).is_some_and(|other| other != group) {
                problems.push(Problem::new(patterns.span(), format!("image `{}` is in two groups", names.stations[station])));
            }
        }
    }
    if let Some(&lone) = images.iter().flatten().find(|&&image| found[image].is_none()) {
        problems.push(Problem::new(written.span(), format!("image `{}` is in no group", names.stations[lone])));
    }
    found.into_iter().map(|group| group.unwrap_or(0)).collect()
}

fn compared(section: Section<'_>, names: &Names<'_>, blocks: &[Block], problems: &mut Vec<Problem>) -> Option<ResidualPairs> {
    let before = problems.len();
    let wire: ResidualsWire = section.read(&[], problems)?;
    let known: Vec<&str> = blocks.iter().map(|block| block.name.as_str()).collect();
    filled("blocks", Some(&wire.blocks), problems);
    filled("pairs", Some(&wire.pairs), problems);
    let whole = wire.blocks.get_ref().iter().filter(|name| !names.broken.contains(name.get_ref())).cloned();
    let of = places("block", &whole.collect::<Vec<_>>(), &known, problems);
    let mut pairs = Vec::new();
    for pair in wire.pairs.get_ref() {
        let found = places("station", pair, &names.stations, problems);
        if let [first, second] = found[..] {
            pairs.push([first, second]);
        }
    }
    (problems.len() == before).then_some(ResidualPairs { blocks: of, pairs })
}
