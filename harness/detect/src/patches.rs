//! Dark areas, by runs of dark pixels.

use calibench_model::{Image, stop};

use crate::ground::{Ground, TILE};

/// A run of dark pixels in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    pub y: u32,
    /// Its first column.
    pub from: u32,
    /// The column after its last.
    pub to: u32,
}

/// Dark areas, each a list of runs in reading order: pixels that touch by their sides.
pub(crate) struct Patches {
    runs: Vec<Run>,
    starts: Vec<usize>,
}

/// The extent of an area, px.
#[derive(Clone, Copy, Debug)]
struct Extent {
    x: [u32; 2],
    y: [u32; 2],
}

impl Extent {
    fn holds(self, sides: [u32; 2]) -> bool {
        let (width, height) = (self.x[1] - self.x[0], self.y[1] + 1 - self.y[0]);
        width.min(height) >= sides[0] && width.max(height) <= sides[1]
    }

    fn is_inside(self, image: &Image) -> bool {
        self.x[0] > 0 && self.y[0] > 0 && (self.x[1] as usize) < image.width() && (self.y[1] as usize + 1) < image.height()
    }
}

impl Patches {
    /// The areas darker than `level` between the dark (0) and the light (1) around, whose sides are in `sides` px and that lie inside the image.
    pub(crate) fn new(image: &Image, ground: &Ground, level: f32, sides: [u32; 2]) -> Self {
        Self::of(image, ground, level, |extent| extent.holds(sides) && extent.is_inside(image))
    }

    /// The same with those that the border of the image cuts off.
    pub(crate) fn with_cut(image: &Image, ground: &Ground, level: f32, sides: [u32; 2]) -> Self {
        Self::of(image, ground, level, |extent| extent.holds(sides))
    }

    fn of(image: &Image, ground: &Ground, level: f32, is_kept: impl Fn(&Extent) -> bool) -> Self {
        let (runs, mut parents) = connected(image, ground, level);
        let mut extents: Vec<Extent> = Vec::new();
        let mut areas = vec![0_u32; runs.len()];
        for (index, run) in runs.iter().enumerate() {
            let root = root(&mut parents, index as u32) as usize;
            if root == index {
                areas[index] = extents.len() as u32;
                extents.push(Extent { x: [run.from, run.to], y: [run.y, run.y] });
            } else {
                areas[index] = areas[root];
                let extent = &mut extents[areas[root] as usize];
                extent.x = [extent.x[0].min(run.from), extent.x[1].max(run.to)];
                extent.y[1] = run.y;
            }
        }
        let kept: Vec<bool> = extents.iter().map(is_kept).collect();
        sorted(&runs, &areas, &kept)
    }

    /// Each area's runs.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &[Run]> {
        self.starts.windows(2).map(|ends| &self.runs[ends[0]..ends[1]])
    }
}

/// The runs by the areas that are kept.
fn sorted(runs: &[Run], areas: &[u32], kept: &[bool]) -> Patches {
    let mut counts = vec![0; kept.len()];
    areas.iter().for_each(|area| counts[*area as usize] += usize::from(kept[*area as usize]));
    let (mut starts, mut next) = (vec![0], vec![0; kept.len()]);
    let mut total = 0;
    for (area, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
        next[area] = total;
        total += count;
        starts.push(total);
    }
    let mut placed = vec![Run { y: 0, from: 0, to: 0 }; total];
    for (run, area) in runs.iter().zip(areas).filter(|(_, area)| kept[**area as usize]) {
        placed[next[*area as usize]] = *run;
        next[*area as usize] += 1;
    }
    Patches { runs: placed, starts }
}

fn root(parents: &mut [u32], mut index: u32) -> u32 {
    while parents[index as usize] != index {
        let above = parents[parents[index as usize] as usize];
        parents[index as usize] = above;
        index = above;
    }
    index
}

/// All runs in reading order, and of each the one that it is joined to: itself if it is its area's first.
fn connected(image: &Image, ground: &Ground, level: f32) -> (Vec<Run>, Vec<u32>) {
    let thresholds: Vec<f32> =
        ground.around.iter().map(|window| window.map_or(f32::NEG_INFINITY, |[low, high]| low + level * (high - low))).collect();
    let (mut runs, mut parents): (Vec<Run>, Vec<u32>) = (Vec::new(), Vec::new());
    let mut above = 0..0;
    for y in 0..image.height() {
        stop::point();
        let start = runs.len();
        let tiles = y / TILE * ground.columns..(y / TILE + 1) * ground.columns;
        row_runs(image.row(y), &ground.own[tiles.clone()], &thresholds[tiles], y as u32, &mut runs);
        parents.extend(start as u32..runs.len() as u32);
        let mut upper = above.start;
        for lower in start..runs.len() {
            while upper < above.end && runs[upper].to <= runs[lower].from {
                upper += 1;
            }
            let mut touching = upper;
            while touching < above.end && runs[touching].from < runs[lower].to {
                let (a, b) = (root(&mut parents, touching as u32), root(&mut parents, lower as u32));
                parents[a.max(b) as usize] = a.min(b);
                touching += 1;
            }
        }
        above = start..runs.len();
    }
    (runs, parents)
}

/// The runs of a row. Tiles that are wholly dark or light are told by their extremes.
fn row_runs(row: &[f32], own: &[[f32; 2]], thresholds: &[f32], y: u32, runs: &mut Vec<Run>) {
    let mut from = None;
    let mut turn = |dark: bool, x: usize| match (dark, from) {
        (true, None) => from = Some(x as u32),
        (false, Some(start)) => {
            runs.push(Run { y, from: start, to: x as u32 });
            from = None;
        }
        _ => {}
    };
    for (tile, (own, threshold)) in own.iter().zip(thresholds).enumerate() {
        let x = tile * TILE;
        if own[1] < *threshold {
            turn(true, x);
        } else if own[0] >= *threshold {
            turn(false, x);
        } else {
            row[x..row.len().min(x + TILE)].iter().enumerate().for_each(|(step, grey)| turn(grey < threshold, x + step));
        }
    }
    turn(false, row.len());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_that_touch_by_corners_are_apart_and_those_at_the_border_are_none() {
        let squares = [[10, 10, 20], [30, 30, 15], [45, 45, 11], [0, 60, 12]];
        let within = |x: usize, y: usize| squares.iter().any(|[u, v, side]| (*u..u + side).contains(&x) && (*v..v + side).contains(&y));
        let hole = |x: usize, y: usize| (14..25).contains(&x) && (14..25).contains(&y);
        let image = Image::from_fn(90, 80, |x, y| if within(x, y) && !hole(x, y) { 0.1 } else { 0.9 });
        let patches = Patches::new(&image, &Ground::new(&image), 0.5, [8, 50]);
        let found: Vec<(u32, u32)> = patches.iter().map(|runs| (runs[0].from, runs.iter().map(|run| run.to - run.from).sum())).collect();
        assert_eq!(found, [(10, 400 - 121), (30, 225), (45, 121)]);
    }
}
