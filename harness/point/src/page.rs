//! The page: one file with the photographs in it, or one that asks the server for them.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use calibench_images::PhotoError;
use calibench_model::Rejection;
use calibench_model::camera::ImageSize;
use calibench_report::{HELPERS, POLICY, STYLE, escaped, in_script};
use rayon::prelude::*;
use serde::Serialize;
use serde_json::json;

use crate::shown::{Shown, TILE};

/// The script, in the order in which its parts build on each other.
const SCRIPT: [&str; 13] = [
    HELPERS,
    include_str!("assets/base.js"),
    include_str!("assets/csv.js"),
    include_str!("assets/keep.js"),
    include_str!("assets/store.js"),
    include_str!("assets/tiles.js"),
    include_str!("assets/measured.js"),
    include_str!("assets/served.js"),
    include_str!("assets/view.js"),
    include_str!("assets/loupe.js"),
    include_str!("assets/input.js"),
    include_str!("assets/panel.js"),
    include_str!("assets/start.js"),
];
const OWN_STYLE: &str = include_str!("assets/point.css");

/// What the policy of a page that a server sends allows beside [`POLICY`]: requests to that server.
const TO_SERVER: &str = "; connect-src 'self'";

/// What a page holds beside its photographs.
#[derive(Clone, Debug, Default)]
pub struct Content {
    /// Names that are offered, in this order; empty where there is no control.
    pub targets: Vec<String>,
    /// Files of measured points that are shown from the beginning.
    pub measured: Vec<Loaded>,
    /// What the targets are: a column of the points that the page saves.
    pub kind: Option<&'static str>,
}

/// A file of measured points as it is, which was read without a mistake.
#[derive(Clone, Debug, Serialize)]
pub struct Loaded {
    /// Its name.
    pub name: String,
    /// CSV.
    pub text: String,
}

/// A photograph as the script knows it.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Pictured {
    name: String,
    width: usize,
    height: usize,
    levels: usize,
    shown: String,
}

impl Pictured {
    pub(crate) fn new(name: &str, shown: &Shown) -> Self {
        let [width, height] = shown.size();
        Self { name: name.to_owned(), width, height, levels: shown.levels(), shown: shown.stretch.to_string() }
    }

    pub(crate) fn size(&self) -> ImageSize {
        ImageSize { width: self.width as u32, height: self.height as u32 }
    }
}

/// Writes the page of `photos` (what points call each, and its file) as one file, one photograph in memory at a time; `step` is called after each.
///
/// The page keeps what is pointed at under a key of the photographs and the names that are offered: the same page, written again, finds it again.
///
/// # Errors
/// A photograph that cannot be read; what the output refuses.
pub fn write_page(output: &mut dyn Write, content: &Content, photos: &[(String, &Path)], step: &dyn Fn()) -> Result<(), PhotoError> {
    output.write_all(head(POLICY, photos.len()).as_bytes())?;
    let mut pictured = Vec::new();
    let mut key = blake3::Hasher::new();
    for (index, (name, path)) in photos.iter().enumerate() {
        let shown = Shown::read(path)?.0;
        // Some at a time: not all of them have to be in memory twice.
        for places in shown.places().chunks(64) {
            let tiles: Vec<_> = places.par_iter().map(|&place| (place, shown.tile(place))).collect();
            for ([level, column, row], tile) in tiles {
                let tile = tile.map_err(io::Error::other)?.unwrap_or_default();
                key.update(&tile);
                let text = STANDARD.encode(&tile);
                writeln!(output, "<script type=\"text/plain\" id=\"t-{index}-{level}-{column}-{row}\">{text}</script>")?;
            }
        }
        pictured.push(Pictured::new(name, &shown));
        step();
    }
    Ok(output.write_all(foot(content, &pictured, &mut key, None).as_bytes())?)
}

/// The page that a server sends: photographs come from it, tile by tile. `method` is what measures.
pub(crate) fn served_page(content: &Content, pictured: &[Pictured], method: &str) -> String {
    let mut key = blake3::Hasher::new();
    head(&format!("{POLICY}{TO_SERVER}"), pictured.len()) + &foot(content, pictured, &mut key, Some(method))
}

fn head(policy: &str, count: usize) -> String {
    let title = if count == 1 { "Pointing in one photograph".to_owned() } else { format!("Pointing in {count} photographs") };
    let title = escaped(&title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta name=\"referrer\" content=\"no-referrer\">\n<link rel=\"icon\" href=\"data:,\">\n\
         <title>{title}</title>\n<style>\n{STYLE}{OWN_STYLE}</style>\n</head>\n<body class=\"pointing\">\n<header><h1>{title}</h1></header>\n\
         <main><noscript><p class=\"verdict doubt\">This page takes JavaScript to point at targets.</p></noscript></main>\n\
         <footer>Made by calibench {}.</footer>\n",
        env!("CARGO_PKG_VERSION")
    )
}

fn foot(content: &Content, pictured: &[Pictured], key: &mut blake3::Hasher, method: Option<&str>) -> String {
    let identity = json!([pictured, content.targets]);
    key.update(identity.to_string().as_bytes());
    let content = json!({
        "key": key.finalize().to_hex().as_str(),
        "tile": TILE,
        "photos": pictured,
        "targets": content.targets,
        "measured": content.measured,
        "kind": content.kind,
        "reasons": Rejection::ALL.iter().map(|why| (why.name(), why.meaning())).collect::<BTreeMap<_, _>>(),
        "method": method,
    });
    format!(
        "<script type=\"application/json\" id=\"content\">{}</script>\n<script>(() => {{\n\"use strict\";\n{}}})();</script>\n</body>\n</html>\n",
        in_script(&content),
        SCRIPT.concat()
    )
}

#[cfg(test)]
mod tests {
    use calibench_images::write_png;
    use calibench_model::Image;

    use super::*;

    #[test]
    fn a_page_is_its_photographs_and_escapes_names() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        write_png(&path, &Image::from_fn(600, 20, |x, _| x as f32 / 600.0), false).unwrap();
        let content = |text: &str| Content {
            targets: vec!["</script><b>".to_owned()],
            measured: vec![Loaded { name: "m<".to_owned(), text: text.to_owned() }],
            kind: None,
        };
        let page = |text: &str, name: &str| {
            let mut bytes = Vec::new();
            write_page(&mut bytes, &content(text), &[(name.to_owned(), path.as_path())], &|| ()).unwrap();
            String::from_utf8(bytes).unwrap()
        };
        let one = page("x", "<img src=x onerror=alert(1)>.png");
        assert!(!one.contains("<img") && !one.contains("</script><b>") && one.contains("id=\"t-0-1-0-0\""), "{one}");
        let key = |page: &str| page.split("\"key\":\"").nth(1).unwrap()[..64].to_owned();
        assert_eq!(key(&one), key(&page("y", "<img src=x onerror=alert(1)>.png")), "measured points do not change where points are kept");
        assert_ne!(key(&one), key(&page("x", "b.png")));
        assert!(served_page(&content("x"), &[], "forstner").contains("connect-src 'self'") && !one.contains("connect-src"));
        for (script, lines) in SCRIPT.iter().map(|script| (script, script.lines().count())) {
            assert!(lines < 400, "{}", script.lines().next().unwrap());
        }
    }
}
