//! What a set of images looks like, in figures.

use calibench_model::median;

use super::light::Light;
use super::noise::{NoiseLine, binned, noise_line};
use super::spread::{Spread, spreads, variance_sigma};
use super::{EdgeFit, Profile, SquareFit, ViewLook, cumulative};
use crate::tone::Tone;

/// Fewer views tell no scatter.
const FEWEST: usize = 3;

/// A figure of a set, with its standard deviation from the scatter of views.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figure {
    /// The figure.
    pub value: f64,
    /// Its standard deviation; infinite where too few views tell it.
    pub sigma: f64,
}

impl Figure {
    /// The mean of what views say.
    fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        let values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        let n = values.len() as f64;
        let middle = values.iter().sum::<f64>() / n;
        let scatter = values.iter().map(|value| (value - middle).powi(2)).sum::<f64>() / (n - 1.0);
        let sigma = if values.len() < FEWEST { f64::INFINITY } else { (scatter / n).sqrt() };
        (!values.is_empty()).then_some(Self { value: middle, sigma })
    }
}

/// What a set of images looks like.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// Columns and rows, px.
    pub size: [f64; 2],
    /// The edges of each view.
    pub edges: Vec<Vec<EdgeFit>>,
    /// The squares of all views.
    pub squares: Vec<SquareFit>,
    /// The spread of edges of each view in the middle of the frame.
    pub spreads: Vec<Option<Spread>>,
    /// How much larger the variance of the spread is in the frame's corners, px^2.
    pub corner: f64,
    /// The mean variance of the spread over views and directions, px^2.
    pub variance: Option<Figure>,
    /// Standard deviation of the noise in the middle of the levels, fraction of full scale.
    pub noise_middle: Figure,
    /// Correlation of noise with the next pixel, mean of both directions.
    pub correlation: Option<Figure>,
    /// How far edges overshoot (positive: sharpening) or tail off (negative), share of the contrast.
    pub halo: Option<Figure>,
    /// Edges stand so far towards the bright side, as a share of a square.
    pub shift: Option<Figure>,
    /// Root mean square of where pieces of edges of 2 px are about a straight line, as a variance, px^2.
    pub raggedness: Option<Figure>,
    /// The same of edges along rows or columns, and of those askew.
    pub raggedness_by: [Option<Figure>; 2],
    /// How much more profiles have on their bright side than their dark side lacks, share of the contrast: white that is full, or a bent curve.
    pub asymmetry: Option<Figure>,
    /// Edges whose bright side is to the right or below, less the others: difference of their spreads, px.
    pub polarity: Option<Figure>,
    /// Share of pixels in squares at the ends of the scale.
    pub clipped: f64,
    /// The median level of squares, fraction of full scale.
    pub level: f64,
    /// Level, variance and number of squares in bins of level.
    pub bins: Vec<[f64; 3]>,
    /// The mean profile.
    pub profile: Profile,
    /// Pixels to a square: the median side, px.
    pub side: f64,
}

impl Look {
    /// That of `views` of a `size`, px; `sides` are the lengths of edges by view, px.
    pub fn of(views: &[ViewLook], size: [f64; 2], sides: &[f64]) -> Option<Self> {
        let edges: Vec<&[_]> = views.iter().map(|view| view.edges.as_slice()).collect();
        let (by_view, corner) = spreads(&edges, size);
        let variance = mean_variance(&edges, &by_view, corner, size);
        let mut profile = Profile::default();
        views.iter().for_each(|view| profile.join(&view.profile));
        let all: Vec<SquareFit> = views.iter().flat_map(|view| view.squares.iter().copied()).collect();
        let squares = || all.iter();
        let level = median(squares().map(|square| square.level))?;
        let noise = noise_line(&all, Tone::default())?;
        let of_views = |figure: &dyn Fn(&ViewLook) -> f64| Figure::of(views.iter().map(figure));
        let noise_of = |view: &ViewLook| noise_line(&view.squares, Tone::default()).map_or(f64::NAN, |line| line.at(level).sqrt());
        let middle = |values: Vec<f64>| median(values.into_iter().filter(|value| value.is_finite())).unwrap_or(f64::NAN);
        let shifts = views.iter().zip(sides).map(|(view, side)| middle(view.edges.iter().map(|edge| edge.shift).collect()) / side);
        Some(Self {
            size,
            edges: views.iter().map(|view| view.edges.clone()).collect(),
            spreads: by_view,
            corner,
            variance,
            noise_middle: Figure { value: noise.at(level).sqrt(), ..of_views(&noise_of)? },
            correlation: of_views(&correlation),
            halo: of_views(&halo),
            shift: Figure::of(shifts),
            raggedness: of_views(&|view| middle(view.edges.iter().map(|edge| edge.raggedness).collect())),
            raggedness_by: [false, true].map(|askew| {
                of_views(&|view| middle(view.edges.iter().filter(|edge| is_askew(edge) == askew).map(|edge| edge.raggedness).collect()))
            }),
            asymmetry: of_views(&asymmetry),
            polarity: of_views(&polarity),
            clipped: mean(squares().map(|square| square.clipped)),
            level,
            bins: binned(squares()),
            squares: all.clone(),
            profile,
            side: median(sides.iter().copied())?,
        })
    }

    /// The light of each view under a curve; `None` where its edges do not tell.
    pub fn lights(&self, tone: Tone) -> Vec<Option<Light>> {
        self.edges.iter().map(|edges| Light::of(edges, self.size, tone)).collect()
    }

    /// Noise against light under a curve.
    pub fn noise(&self, tone: Tone) -> NoiseLine {
        noise_line(&self.squares, tone).unwrap_or_default()
    }

    /// The median spread of edges over views, with the pixel's own, px.
    pub fn spread(&self) -> f64 {
        median(self.spreads.iter().flatten().map(|[xx, _, yy]| (0.5 * (xx + yy)).max(0.0).sqrt())).unwrap_or(f64::NAN)
    }
}

/// The mean over views, each with what its own edges scatter: views differ by more, as by their focus.
fn mean_variance(edges: &[&[EdgeFit]], spreads: &[Option<Spread>], corner: f64, size: [f64; 2]) -> Option<Figure> {
    let views = edges.iter().zip(spreads).filter_map(|(edges, spread)| Some((edges, spread.as_ref()?)));
    let of = |(edges, spread): (&&[EdgeFit], &Spread)| (0.5 * (spread[0] + spread[2]), variance_sigma(edges, spread, corner, size).powi(2));
    let (value, variance, count) = views.map(of).fold((0.0, 0.0, 0.0), |(v, s, n), (value, square)| (v + value, s + square, n + 1.0));
    (count > 0.0).then(|| Figure { value: value / count, sigma: f64::sqrt(variance) / count })
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
    sum / f64::from(count.max(1))
}

fn correlation(view: &ViewLook) -> f64 {
    let both =
        view.squares.iter().filter(|square| square.clipped < 0.01).map(|square| 0.5 * (square.correlation[0] + square.correlation[1]));
    median(both).unwrap_or(f64::NAN)
}

/// Edges nearer to rows or columns than this cross few pixels' borders, as the sine of the angle.
const ASKEW: f64 = 0.06;

fn is_askew(edge: &EdgeFit) -> bool {
    edge.normal[0].abs().min(edge.normal[1].abs()) > ASKEW
}

/// The mean over both sides of the profile of what they have more than a step that is the same on both.
fn asymmetry(view: &ViewLook) -> f64 {
    let Some(spread) = median(view.edges.iter().map(|edge| edge.spread)) else { return f64::NAN };
    let near = [0.6 * spread, 2.0 * spread];
    let misfits = view.profile.points().into_iter().filter(|[across, _]| (near[0]..=near[1]).contains(&across.abs()));
    let (sum, count) = misfits.fold((0.0, 0.0), |(sum, count), [across, level]| (sum + level - cumulative(across / spread), count + 1.0));
    if count > 0.0 { sum / count } else { f64::NAN }
}

/// The mean misfit of the profile to a Gaussian step where overshoot shows, towards the bright side and, turned about, the dark one.
fn halo(view: &ViewLook) -> f64 {
    let Some(spread) = median(view.edges.iter().map(|edge| edge.spread)) else { return f64::NAN };
    let near = [1.4 * spread, 1.4 * spread + 1.5];
    let (mut sum, mut count) = (0.0, 0.0);
    for [across, level] in view.profile.points() {
        if (near[0]..=near[1]).contains(&across.abs()) {
            sum += across.signum() * (level - cumulative(across / spread));
            count += 1.0;
        }
    }
    if count > 0.0 { sum / count } else { f64::NAN }
}

fn polarity(view: &ViewLook) -> f64 {
    let side = |positive: bool| {
        let towards = |normal: [f64; 2]| if normal[0].abs() > normal[1].abs() { normal[0] } else { normal[1] };
        median(view.edges.iter().filter(|edge| (towards(edge.normal) > 0.0) == positive).map(|edge| edge.spread))
    };
    side(true).zip(side(false)).map_or(f64::NAN, |(one, other)| one - other)
}
