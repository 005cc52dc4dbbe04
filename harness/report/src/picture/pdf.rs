//! A picture as PDF: a page of its size, a pixel three quarters of a point.

use std::fmt::Write;

use calibench_prints::{Font, Lettering, deflated};
use pdf_writer::{Filter, Finish, Name, Pdf, Rect, Ref, TextStr};
use plotters::style::FontTransform;
use plotters_backend::text_anchor::HPos;
use plotters_backend::{BackendColor, BackendCoord};

use crate::Canvas;
use crate::canvas::{EM, Pen, Run, STEP, Stroke, Written, ring, row, runs};
use crate::html::{Embedded, Kind, dots, part};

/// Points in a pixel.
const POINTS: f32 = 0.75;
/// Control points of a quarter of a circle as a Bézier curve, radii: 2.7e-4 of one off at most.
const ROUND: f64 = 0.552_284_75;

/// The document.
pub(super) fn pdf(canvas: &Canvas) -> Vec<u8> {
    let (width, height) = (canvas.width() as f32, canvas.height() as f32);
    let mut page = Page::new();
    // From here on px of the picture, y down.
    let _ = writeln!(page.content, "{POINTS} 0 0 -{POINTS} 0 {} cm 1 1 1 rg 0 0 {width} {height} re f", height * POINTS);
    page.strokes(canvas.strokes());

    let mut last = 0;
    let mut next = || {
        last += 1;
        Ref::new(last)
    };
    let [catalog, tree, info, id, content, font] = std::array::from_fn(|_| next());
    let mut pdf = Pdf::new();
    pdf.catalog(catalog).pages(tree);
    pdf.pages(tree).kids([id]).count(1);
    pdf.document_info(info).producer(TextStr(concat!("calibench ", env!("CARGO_PKG_VERSION"))));
    let images: Vec<Ref> = page.images.iter().map(|_| next()).collect();
    let mut leaf = pdf.page(id);
    leaf.parent(tree).media_box(Rect::new(0.0, 0.0, width * POINTS, height * POINTS)).contents(content);
    let mut resources = leaf.resources();
    resources.fonts().pair(Name(b"F"), font);
    let mut placed = resources.x_objects();
    for (index, image) in images.iter().enumerate() {
        placed.pair(Name(format!("I{index}").as_bytes()), *image);
    }
    placed.finish();
    let mut states = resources.ext_g_states();
    for percent in &page.opacities {
        let part = f32::from(*percent) / 100.0;
        states
            .insert(Name(format!("A{percent}").as_bytes()))
            .start::<pdf_writer::writers::ExtGraphicsState<'_>>()
            .stroking_alpha(part)
            .non_stroking_alpha(part);
    }
    states.finish();
    resources.finish();
    leaf.finish();
    pdf.stream(content, &deflated(page.content.as_bytes())).filter(Filter::FlateDecode);
    for (image, embedded) in images.into_iter().zip(&page.images) {
        put(&mut pdf, image, embedded, &mut next);
    }
    page.lettering.write(&mut pdf, font, &mut next);
    pdf.finish()
}

/// Adds an image; what is transparent in it as a mask.
fn put(pdf: &mut Pdf, id: Ref, embedded: &Embedded, next: &mut impl FnMut() -> Ref) {
    let raster = &embedded.raster;
    let (width, height) = (raster.size.0 as i32, raster.size.1 as i32);
    if raster.kind != Kind::Rgba {
        let data = deflated(&raster.samples);
        let mut image = pdf.image_xobject(id, &data);
        image.width(width).height(height).bits_per_component(8).filter(Filter::FlateDecode);
        image.color_space().device_gray();
        return;
    }
    let mask = next();
    let pixels = raster.samples.as_chunks::<4>().0;
    let colours = deflated(&pixels.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect::<Vec<u8>>());
    let opacity = deflated(&pixels.iter().map(|[.., alpha]| *alpha).collect::<Vec<u8>>());
    let mut image = pdf.image_xobject(id, &colours);
    image.width(width).height(height).bits_per_component(8).s_mask(mask).filter(Filter::FlateDecode);
    image.color_space().device_rgb();
    image.finish();
    let mut image = pdf.image_xobject(mask, &opacity);
    image.width(width).height(height).bits_per_component(8).filter(Filter::FlateDecode);
    image.color_space().device_gray();
}

/// What a page is made of.
struct Page {
    content: String,
    images: Vec<Embedded>,
    /// Opacities that are used, percent; 100 at first.
    opacities: Vec<u8>,
    lettering: Lettering,
    opacity: u8,
}

impl Page {
    fn new() -> Self {
        Self { content: String::new(), images: Vec::new(), opacities: vec![100], lettering: Lettering::new(Font::Regular), opacity: 100 }
    }

    fn strokes(&mut self, strokes: &[Stroke]) {
        for run in runs(strokes) {
            match run {
                Run::Scale(rows) => rows.chunks(STEP).for_each(|rows| self.band(rows)),
                Run::Dots(pixels) => {
                    let dot =
                        |stroke: &Stroke| if let Stroke::Dots(at, count, colour) = stroke { Some((*at, *count, *colour)) } else { None };
                    self.image(dots(pixels.iter().filter_map(dot)));
                }
                Run::One(stroke) => self.draw(stroke),
            }
        }
    }

    /// Rows of a scale of colours, in the colour of the middle one.
    fn band(&mut self, rows: &[Stroke]) {
        if let (Some((left, right, top, _)), Some((.., colour))) = (row(&rows[0]), row(&rows[rows.len() / 2])) {
            self.fill(colour, &rectangle((left, top), (right, top + rows.len() as i32)));
        }
    }

    fn draw(&mut self, stroke: &Stroke) {
        match stroke {
            Stroke::Line([from, to], pen) => self.line(pen, &path(&[*from, *to])),
            Stroke::Path(places, pen) => {
                self.line(pen, &ring(places).map_or_else(|| path(places), |(centre, radius)| circle(centre, radius)));
            }
            Stroke::Polygon(corners, colour) => self.fill(*colour, &format!("{} h", path(corners))),
            Stroke::Rectangle([from, to], pen, true) => self.fill(pen.colour, &rectangle(*from, *to)),
            Stroke::Rectangle([from, to], pen, false) => self.line(pen, &rectangle(*from, *to)),
            Stroke::Circle(centre, radius, pen, true) => self.fill(pen.colour, &circle(*centre, *radius)),
            Stroke::Circle(centre, radius, pen, false) => self.line(pen, &circle(*centre, *radius)),
            Stroke::Text(text) => self.write(text),
            Stroke::Pixels { at, columns, zoom, levels } => self.image(part(*at, (*columns, *zoom), levels)),
            // The first are runs; no line shows the others.
            Stroke::Dots(..) | Stroke::Belongs(_) | Stroke::Said(..) => {}
        }
    }

    fn opaque_by(&mut self, alpha: f64) {
        let percent = (100.0 * alpha).round().clamp(0.0, 100.0) as u8;
        if percent == self.opacity {
            return;
        }
        if !self.opacities.contains(&percent) {
            self.opacities.push(percent);
        }
        self.opacity = percent;
        self.say(&format!("/A{percent} gs"));
    }

    fn say(&mut self, line: &str) {
        self.content.push_str(line);
        self.content.push('\n');
    }

    fn fill(&mut self, colour: BackendColor, path: &str) {
        self.opaque_by(colour.alpha);
        self.say(&format!("{} rg {path} f", rgb(colour)));
    }

    fn line(&mut self, pen: &Pen, path: &str) {
        self.opaque_by(pen.colour.alpha);
        self.say(&format!("{} RG {} w {path} S", rgb(pen.colour), pen.width));
    }

    fn image(&mut self, embedded: Embedded) {
        let ((x, y), (width, height)) = (embedded.at, embedded.size);
        self.opaque_by(1.0);
        self.say(&format!("q {width} 0 0 -{height} {x} {} cm /I{} Do Q", y + height as i32, self.images.len()));
        self.images.push(embedded);
    }

    fn write(&mut self, text: &Written) {
        let (letters, width) = self.lettering.set(&text.text);
        let size = text.size * EM;
        let before = match text.anchor.h_pos {
            HPos::Left => 0.0,
            HPos::Center => -0.5,
            HPos::Right => -1.0,
        };
        let (along, down) = (before * width * size, text.baseline());
        let (cosine, sine) = match text.transform {
            FontTransform::None => (1.0, 0.0),
            FontTransform::Rotate90 => (0.0, 1.0),
            FontTransform::Rotate180 => (-1.0, 0.0),
            FontTransform::Rotate270 => (0.0, -1.0),
        };
        let (x, y) = (f64::from(text.at.0) + along * cosine - down * sine, f64::from(text.at.1) + along * sine + down * cosine);
        self.opaque_by(text.colour.alpha);
        let place = format!("/F {size:.3} Tf {cosine} {sine} {sine} {} {x:.2} {y:.2} Tm <{letters}> Tj ET", -cosine);
        if text.has_rim {
            self.say(&format!("BT 1 Tr 1 1 1 RG 2 w 1 j {place} 0 j"));
        }
        self.say(&format!("BT 0 Tr {} rg {place}", rgb(text.colour)));
    }
}

fn rgb(colour: BackendColor) -> String {
    let (r, g, b) = colour.rgb;
    [r, g, b].map(|part| format!("{:.3}", f64::from(part) / 255.0)).join(" ")
}

fn path(places: &[BackendCoord]) -> String {
    let mut text = String::new();
    for (index, (x, y)) in places.iter().enumerate() {
        // Writing to a String cannot fail.
        let _ = write!(text, "{x} {y} {} ", if index == 0 { "m" } else { "l" });
    }
    text
}

fn rectangle((ax, ay): BackendCoord, (bx, by): BackendCoord) -> String {
    format!("{ax} {ay} {} {} re", bx - ax, by - ay)
}

fn circle((x, y): BackendCoord, radius: u32) -> String {
    let (x, y, r) = (f64::from(x), f64::from(y), f64::from(radius));
    let at = |(dx, dy): (f64, f64)| format!("{:.3} {:.3}", x + r * dx, y + r * dy);
    let mut text = format!("{} m", at((1.0, 0.0)));
    for quarter in 0..4 {
        let turned = |(dx, dy): (f64, f64)| (0..quarter).fold((dx, dy), |(dx, dy), _| (-dy, dx));
        let _ = write!(text, " {} {} {} c", at(turned((1.0, ROUND))), at(turned((ROUND, 1.0))), at(turned((0.0, 1.0))));
    }
    text + " h"
}
