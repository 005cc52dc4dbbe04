//! A picture of what recognition makes of an image on its way.

use calibench_model::Image;
use calibench_records::names::recognition_step;

use crate::canvas::Canvas;
use crate::load::Loaded;

/// Side of a panel, px of the picture, at most.
const SIDE: u32 = 600;
const MARGIN: u32 = 40;
const TOP: u32 = 80;

/// The image, the squares as seen from the front, and of one of them the enlarged grey values, the dark areas and their contours; `None` where they were not kept.
pub fn steps(loaded: &Loaded) -> Option<Canvas> {
    let (views, _) = loaded.scenario.in_blocks()?;
    let step = |view: &str, step: &str| loaded.image(&recognition_step(view, step));
    let view = views.stations.iter().map(|station| station.name.as_str()).find(|view| step(view, "normal").is_some())?;
    let panels = [
        ("image", loaded.image(view)?),
        ("its whole squares as seen from the front", step(view, "normal")?),
        ("a square, enlarged by two", step(view, "enlarged")?),
        ("its dark areas", step(view, "binary")?),
        ("their contours", step(view, "contours")?),
    ];
    let zoom = |image: &Image| (SIDE / image.width().max(image.height()).max(1) as u32).max(1);
    let size = |image: &Image| [image.width() as u32 * zoom(image), image.height() as u32 * zoom(image)];
    let rows = [&panels[..2], &panels[2..]];
    let width = rows.iter().map(|row| row.iter().map(|(_, image)| size(image)[0] + MARGIN).sum::<u32>()).max()? + MARGIN;
    let heights = rows.map(|row| row.iter().map(|(_, image)| size(image)[1]).max().unwrap_or(0));
    let mut canvas = Canvas::new(width, TOP + heights.iter().map(|height| height + TOP).sum::<u32>());
    canvas.text(&format!("Recognition in image {view}"), 20, (MARGIN, 20));
    let mut y = TOP;
    for (row, height) in rows.into_iter().zip(heights) {
        let mut x = MARGIN;
        for (caption, image) in row {
            let [w, h] = size(image);
            canvas.text(caption, 16, (x, y - 24));
            canvas.enlarge(image, (0, 0), (image.width() as u32, image.height() as u32), zoom(image), (x, y));
            canvas.frame((x, y), (w, h));
            x += w + MARGIN;
        }
        y += height + TOP;
    }
    Some(canvas)
}
