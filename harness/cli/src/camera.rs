//! `calibench camera`: what is in a camera file.

use std::path::PathBuf;

use calibench_model::camera::CameraModel;
use calibench_model::{NamedCamera, escape};
use calibench_report::camera_card;
use calibench_report::json::{CameraFileAnswer, CameraFileFormat};
use clap::Args;

use super::reading::Reading;
use crate::deliver::{As, answer, print};
use crate::failure::Failure;

#[derive(Args)]
pub struct CameraCommand {
    /// A camera file of any known format
    file: PathBuf,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    answered: As,
}

impl CameraCommand {
    pub fn run(&self) -> Result<(), Failure> {
        let opened = self.reading.opened(&self.file)?;
        let (file, count) = opened.file(if self.answered.json { usize::MAX } else { MOST_LISTED })?;
        let format = file.format;
        let camera = self.reading.one_of(&self.file, opened)?;
        let doubt = || if camera.implausible { Err(Failure::Doubt) } else { Ok(()) };
        if self.answered.json {
            let format = CameraFileFormat {
                name: format.name.into(),
                tool: format.tool.into(),
                versions: format.versions.into(),
                verified: format.verified.map(str::to_owned),
            };
            answer(&CameraFileAnswer::new(&self.file.display().to_string(), format, &file.cameras, &camera))?;
            return doubt();
        }
        let verified = format.verified.map_or("unverified".to_owned(), |proof| format!("verified: {proof}"));
        let cameras = if count == 1 { "1 camera".to_owned() } else { format!("{count} cameras") };
        let mut text = format!(
            "{}\n  format      {} ({}, {}), {verified}\n  holds       {cameras}\n",
            escape::name(&self.file.display().to_string()),
            format.name,
            format.tool,
            format.versions
        );
        text.push_str(&index(&file.cameras, count));
        text.push_str(&camera_card(&camera));
        print(&text)?;
        doubt()
    }
}

/// Cameras that are listed at most.
const MOST_LISTED: usize = 200;

/// Place, name and model of each camera of a file that holds several.
fn index(cameras: &[NamedCamera], count: usize) -> String {
    if count < 2 {
        return String::new();
    }
    let line = |(place, named): (usize, &NamedCamera)| {
        let size = named.camera.size();
        let name = if named.name.is_empty() { "-".into() } else { escape::name(&named.name) };
        format!("  {:>9}   {name}: {}, {} x {} px\n", place + 1, named.camera.convention().name, size.width, size.height)
    };
    let mut text: String = cameras.iter().enumerate().take(MOST_LISTED).map(line).collect();
    if count > MOST_LISTED {
        text.push_str(&format!("        ...   and {} more\n", count - MOST_LISTED));
    }
    text
}
