//! The two kinds of figure: an overview of an image, and panels that zoom in on points.

use calibench_images::photo::Levels;
use calibench_model::{Image, PixelPoint};
use plotters::style::{BLACK, RGBColor};

use super::canvas::{COLOURS, Canvas, METHOD_MARKS, Mark, OwnMark};

/// Marks of one kind: their name in the legend, their look.
#[derive(Clone, Debug)]
pub struct Layer {
    /// In the legend.
    pub name: String,
    /// Its shape.
    pub mark: Mark,
    /// Its colour.
    pub colour: RGBColor,
    /// Whether its name is that of a method.
    pub is_method: bool,
}

impl Layer {
    /// The truth.
    pub fn truth() -> Self {
        Self { name: "truth".into(), mark: Mark::Plus, colour: BLACK, is_method: false }
    }

    /// The truth where targets stand close together.
    pub fn truth_of_a_crowd() -> Self {
        Self { mark: Mark::Dot, colour: COLOURS[0], ..Self::truth() }
    }

    /// Approximate positions.
    pub fn start() -> Self {
        Self { name: "approximate position".into(), mark: Mark::Square, colour: BLACK, is_method: false }
    }

    /// The series that its marks belong to: they are hidden with all else of a method.
    fn series(&self) -> Option<&str> {
        self.is_method.then_some(&*self.name)
    }

    /// The results of methods: each has a look of its own, the same on every page as long as no other method of the picture claims it first.
    pub fn methods<'a>(labels: impl Iterator<Item = &'a str>) -> Vec<Self> {
        let mut taken = Vec::new();
        let layer = |label: &str| {
            let name = label.split(':').next().unwrap_or(label);
            let wanted = USUAL.iter().position(|usual| *usual == name).unwrap_or(0);
            let cycle = METHOD_MARKS.len();
            let usual = (0..cycle).map(|step| (wanted + step) % cycle);
            let place = usual.chain(cycle..=cycle + taken.len()).find(|place| !taken.contains(place)).unwrap_or(wanted);
            taken.push(place);
            // Another colour for a mark that comes again: no two of the first twelve look alike.
            let colour = COLOURS[(place + place / cycle) % COLOURS.len()];
            Self { name: label.to_owned(), mark: METHOD_MARKS[place % cycle], colour, is_method: true }
        };
        labels.map(layer).collect()
    }
}

/// The methods whose looks are reserved, by place.
const USUAL: [&str; 4] = ["forstner", "", "harris_paraboloid", "opencv_subpix"];

/// A point in a picture: which layer, and where.
#[derive(Clone, Debug)]
pub struct MarkAt {
    /// Index of the layer.
    pub layer: usize,
    /// Position in the image, px, y down.
    pub at: PixelPoint,
}

/// A panel: what it shows, and the marks on it.
pub struct Panel {
    /// Its title.
    pub title: String,
    /// The part of an image that it shows.
    pub window: Option<Window>,
    /// Its marks.
    pub marks: Vec<MarkAt>,
}

/// A square part of an image, cut out: of the image itself nothing has to be kept.
pub struct Window {
    /// What of it is inside the image.
    inside: Image<'static>,
    /// The first pixel of that, and of the window, in the image.
    from: [(i64, i64); 2],
    side: u32,
}

impl Window {
    /// The window of `side` px (odd) around a place; `None` around what is no place of an image.
    pub fn around(image: &Levels, centre: PixelPoint, side: u32) -> Option<Self> {
        let (column, row) = centre.nearest_pixel()?;
        let half = i64::from(side / 2);
        let first = (column.saturating_sub(half), row.saturating_sub(half));
        let within = |first: i64, size: usize| {
            let [from, to] = [first, first.saturating_add(i64::from(side))].map(|end| end.clamp(0, size as i64));
            (from, (to - from) as usize)
        };
        let ((left, columns), (top, rows)) = (within(first.0, image.width()), within(first.1, image.height()));
        let inside = image.part((left as usize, top as usize), (columns, rows));
        Some(Self { inside, from: [(left, top), first], side })
    }

    /// Draws it, each pixel `zoom` px wide.
    fn draw(&self, canvas: &mut Canvas, zoom: u32, at: (u32, u32)) {
        let [inside, first] = self.from;
        canvas.enlarge(&self.inside, (first.0 - inside.0, first.1 - inside.1), (self.side, self.side), zoom, at);
    }
}

/// Of larger images the upper left part of this size is shown, px.
const MOST_SHOWN: u32 = 6000;
const LINE: u32 = 26;
const GAP: u32 = 14;

/// Where `at` lies in a picture that shows the image from pixel (`left`, `top`) with `zoom`.
fn place(at: PixelPoint, (left, top): (i64, i64), zoom: u32, (x, y): (u32, u32)) -> (f64, f64) {
    let corner = at.to_corner();
    let zoom = f64::from(zoom);
    (f64::from(x) + (corner.x - left as f64) * zoom, f64::from(y) + (corner.y - top as f64) * zoom)
}

/// Marks as a canvas draws them.
fn drawn<'l>(layers: &'l [Layer], marks: &[MarkAt], place: impl Fn(PixelPoint) -> (f64, f64)) -> Vec<OwnMark<'l>> {
    let own = |layer: &'l Layer, at| (layer.series(), (layer.mark, layer.colour, place(at)));
    marks.iter().map(|mark| own(&layers[mark.layer], mark.at)).collect()
}

/// The whole image with marks, and a label beside each of `labels`.
pub fn overview(image: &Image, zoom: u32, layers: &[Layer], marks: &[MarkAt], labels: &[(String, PixelPoint)]) -> Canvas {
    let size = ((image.width() as u32).min(MOST_SHOWN), (image.height() as u32).min(MOST_SHOWN));
    let (width, height) = (size.0 * zoom, size.1 * zoom);
    let (legend_rows, columns) = legend_size(layers, width);
    let mut canvas = Canvas::new(width + 2 * GAP, height + 2 * GAP + legend_rows * LINE);
    canvas.enlarge(image, (0, 0), size, zoom, (GAP, GAP));
    canvas.frame((GAP, GAP), (width, height));
    canvas.marks_of(&drawn(layers, marks, |at| place(at, (0, 0), zoom, (GAP, GAP))));
    let mut taken: Vec<(u32, u32, u32)> = Vec::new();
    for (text, at) in labels {
        let (x, y) = place(*at, (0, 0), zoom, (GAP, GAP));
        // Below right of the mark, or to its left near the right side.
        let room = 9 * text.chars().count() as u32 + 14;
        let left = if x as u32 + room > width { (x as u32).saturating_sub(room + 4) } else { x as u32 + 12 };
        // Above the mark where another label is in the way.
        let free = |top: u32| !taken.iter().any(|(from, to, other)| left < *to && *from < left + room && top.abs_diff(*other) < 20);
        let (below, above) = (y as u32 + 20, (y as u32).saturating_sub(20));
        let top = if free(below) || !free(above) { below } else { above };
        taken.push((left, left + room, top));
        canvas.label(text, 20, (left, top));
    }
    legend(&mut canvas, layers, columns, height + GAP + GAP / 2);
    canvas
}

/// Panels side by side, each showing a window of `side` px enlarged `zoom` times, `across` in a row, with a legend below.
pub fn panels(panels: &[Panel], layers: &[Layer], side: u32, zoom: u32, across: usize) -> Canvas {
    let across = across.min(panels.len().max(1));
    let edge = side * zoom;
    let rows = panels.len().div_ceil(across) as u32;
    let width = across as u32 * (edge + GAP) + GAP;
    let (legend_rows, columns) = legend_size(layers, width - 2 * GAP);
    let mut canvas = Canvas::new(width, rows * (edge + LINE + GAP) + GAP + legend_rows * LINE);
    for (index, panel) in panels.iter().enumerate() {
        let x = GAP + (index % across) as u32 * (edge + GAP);
        let y = GAP + (index / across) as u32 * (edge + LINE + GAP);
        canvas.text(&panel.title, 16, (x, y + LINE / 2 - 4));
        let Some(window) = &panel.window else { continue };
        window.draw(&mut canvas, zoom, (x, y + LINE));
        canvas.frame((x, y + LINE), (edge, edge));
        let (left, right) = (f64::from(x), f64::from(x + edge));
        let (top, bottom) = (f64::from(y + LINE), f64::from(y + LINE + edge));
        let mut marks = drawn(layers, &panel.marks, |at| place(at, window.from[1], zoom, (x, y + LINE)));
        marks.retain(|(_, (_, _, at))| at.0 >= left && at.0 <= right && at.1 >= top && at.1 <= bottom);
        canvas.marks_of(&marks);
    }
    legend(&mut canvas, layers, columns, rows * (edge + LINE + GAP) + GAP);
    canvas
}

/// Rows of the legend, and the width of one of its columns.
fn legend_size(layers: &[Layer], width: u32) -> (u32, u32) {
    let longest = layers.iter().map(|layer| layer.name.chars().count() as u32).max().unwrap_or(0);
    let column = longest * 9 + 44;
    let across = (width / column).max(1);
    ((layers.len() as u32).div_ceil(across), column)
}

fn legend(canvas: &mut Canvas, layers: &[Layer], column: u32, top: u32) {
    let across = (canvas.width() / column).max(1);
    for (index, layer) in (0_u32..).zip(layers) {
        let (x, y) = (GAP + index % across * column, top + index / across * LINE + LINE / 2);
        canvas.of(layer.series(), |canvas| {
            canvas.marks(&[(layer.mark, layer.colour, (f64::from(x) + 14.0, f64::from(y)))]);
            canvas.text(&layer.name, 16, (x + 36, y));
        });
    }
}

#[cfg(test)]
mod tests {
    use calibench_images::photo::read_levels;
    use calibench_images::write_png;

    use super::*;

    fn png(canvas: &Canvas) -> Vec<u8> {
        let mut png = Vec::new();
        canvas.encode(&mut png).unwrap();
        png
    }

    /// Inside, across each side, and beyond the image.
    #[test]
    fn a_window_shows_what_the_whole_image_does() {
        let image = Image::from_fn(20, 14, |x, y| ((7 * x + 11 * y) % 256) as f32 / 255.0);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("image.png");
        write_png(&path, &image, false).unwrap();
        let levels = read_levels(&path).unwrap();
        for (x, y) in [(9.4, 6.6), (1.0, 1.0), (19.0, 7.0), (8.0, 13.0), (-2.0, 5.0), (40.0, 40.0)] {
            let (mut cut, mut whole) = (Canvas::new(40, 40), Canvas::new(40, 40));
            let window = Window::around(&levels, PixelPoint::new(x, y), 7).unwrap();
            window.draw(&mut cut, 3, (5, 6));
            let first = (f64::round(x) as i64 - 3, f64::round(y) as i64 - 3);
            assert_eq!(window.from[1], first);
            whole.enlarge(&image, first, (7, 7), 3, (5, 6));
            assert_eq!(png(&cut), png(&whole), "({x}, {y})");
        }
        assert!(Window::around(&levels, PixelPoint::new(f64::NAN, 0.0), 7).is_none());
    }
}
