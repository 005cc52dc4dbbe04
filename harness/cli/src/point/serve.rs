//! `calibench point --serve`.

use std::path::Path;
use std::time::Duration;

use calibench_files::Inputs;
use calibench_model::ControlRow;
use calibench_point::{Content, Kept, Served, Server};

use super::{IDLE, POINTED, Point};
use crate::camera_files::CameraFiles;
use crate::context::{Context, Pictured};
use crate::deliver::print;
use crate::failure::Failure;
use crate::output;

impl Point {
    pub(super) fn serve(
        &self,
        context: &Context<'_>,
        content: &Content,
        photos: Vec<(String, &Path)>,
        control: &[ControlRow],
        inputs: &Inputs,
    ) -> Result<(), Failure> {
        let (asked, idle) = (self.method.as_deref().unwrap_or("forstner"), self.idle.unwrap_or(IDLE));
        let method = context.methods(&[asked.to_owned()], Pictured::Photographs)?.remove(0);
        let operator = method.operator.as_ref().map_err(|why| Failure::input(format!("-m {}: unavailable: {why}", method.label)))?;
        if operator.needs_kind() && self.kind.is_none() {
            return Err(Failure::input(format!("-m {}: must know what is pictured; give --kind", method.label)));
        }
        if !method.measures(self.kind) {
            return Err(Failure::input(format!("-m {}: measures other kinds of targets; give --kind", method.label)));
        }
        let names: Vec<String> = photos.iter().map(|(name, _)| name.clone()).collect();
        let place = self.points.clone().unwrap_or_else(|| self.photos[0].with_file_name(POINTED));
        let file = output::table("--points", Some(&place), inputs)?.ok_or_else(|| Failure::input("--points: expected a table"))?;
        if !file.is_file() {
            return Err(Failure::input(format!("--points {}: is no regular file, and is read again and replaced", place.display())));
        }
        let kept = Kept::open(file, names.clone(), self.kind).map_err(Failure::input)?;
        let mut served = Served::new(content, photos, (&method, operator.as_ref()), self.kind, control, &kept)?;
        if !self.cameras.is_empty() {
            let size = |image: &str| names.iter().position(|name| name == image).and_then(|place| served.sizes().get(place).copied());
            let cameras = CameraFiles::new(self.cameras.clone(), None, self.same_camera).of_images(&names, size)?;
            served = served.with_cameras(cameras);
        }
        let server = Server::open().map_err(|error| Failure::input(format!("--serve: {error}")))?;
        print(&format!("{}\n", server.url()))?;
        if !context.quiet {
            say!(
                "open this address in a browser on this machine; whoever knows it sees the photographs. Ctrl-C ends it, or {idle} minutes without use"
            );
            say!("points are kept in {}", place.display());
        }
        server.run(&served, Duration::from_secs_f64(idle * 60.0))?;
        if !context.quiet {
            say!("ended: nobody used the page for {idle} minutes");
        }
        Ok(())
    }
}
