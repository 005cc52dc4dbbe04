//! ROS: a `sensor_msgs/CameraInfo` message as `rostopic echo` and `ros2 topic echo` print it.

use calibench_model::NamedCamera;
use calibench_model::camera::tool_conventions;

use super::PLAIN;
use super::opencv_yaml::tree;
use super::ros::{check, of_model, rectified};
use crate::number::pixels;
use crate::source::Source;
use crate::tree::Entry;
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "ros-message",
    tool: "ROS",
    versions: "sensor_msgs/CameraInfo of ROS 1 and 2, as it is printed",
    extension: "yaml",
    words: "header frame_id seq stamp distortion_model D K R P binning_x binning_y roi x_offset y_offset do_rectify",
    recognise,
    read,
    convention: Some(&tool_conventions::ROS),
    ..PLAIN
};

/// In ROS 1 large, in ROS 2 small.
const D: [&str; 2] = ["D", "d"];
const K: [&str; 2] = ["K", "k"];
const R: [&str; 2] = ["R", "r"];
const P: [&str; 2] = ["P", "p"];

fn recognise(source: &Source<'_>) -> Result<(), String> {
    let has = |key: &str| source.text.lines().any(|line| line.split_once(':').is_some_and(|(name, _)| name == key));
    let found = [K, D].iter().all(|names| names.iter().any(|name| has(name))) && has("distortion_model");
    if source.xml.is_none() && found && !source.text.contains("!!opencv") {
        return Ok(());
    }
    Err("no `distortion_model:` with `D:` and `K:`".into())
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    // Messages stand one after another, and say the same; lines before the first are a separator's.
    let root = tree(source.text)?;
    let size = options.size_or(Some(root.size_of("width", "height")?))?;
    let (name, entry) = root.get(&K)?.ok_or_else(|| root.wrong("has no `K`"))?;
    let k: [f64; 9] = root.row_of(name)?;
    check(name, entry, &k).map_err(|error| error.on_line(entry.line))?;
    let (name, entry) = root.get(&D)?.ok_or_else(|| root.wrong("has no `D`"))?;
    let d = entry.row().map_err(|error| error.of(name))?;
    let camera = of_model(root.text_of("distortion_model")?, size, [k[0], k[4], k[2], k[5]], &d);
    let camera = camera.map_err(|error| error.on_line(entry.line).of(name))?;
    let known = [&["width", "height", "distortion_model", "header", "binning_x", "binning_y", "roi"][..], &D, &K, &R, &P].concat();
    let mut notes = root.of_file(&known, options)?;
    notes.extend(binned(&root)?);
    notes.extend(root.key("roi")?.map_or(Ok(None), cropped)?);
    let (r, p) = (root.get(&R)?, root.get(&P)?);
    let rectification = r.map(|(name, _)| root.row_of(name)).transpose()?;
    let projection = p.map(|(name, _)| root.row_of(name)).transpose()?;
    notes.extend(rectified([r.map_or(R[0], |r| r.0), p.map_or(P[0], |p| p.0)], &k, rectification, projection));
    Ok(vec![NamedCamera { notes, ..NamedCamera::new("", camera) }])
}

/// A whole number from 0; without the key 0.
fn whole(root: &Entry, name: &str) -> Result<u32, CameraFileError> {
    let Some(entry) = root.key(name)? else { return Ok(0) };
    entry.text()?.parse().map_err(|_| entry.wrong("expected a whole number from 0").of(name))
}

/// The message's definition: size and K are of the whole sensor, whatever binning the driver was at.
fn binned(root: &Entry) -> Result<Option<String>, CameraFileError> {
    let [x, y] = [whole(root, "binning_x")?.max(1), whole(root, "binning_y")?.max(1)];
    let side = |name: &str| root.required(name).and_then(|entry| pixels(entry.text()?));
    let (width, height) = (side("width")?, side("height")?);
    Ok((x > 1 || y > 1).then(|| {
        format!(
            "`binning_x: {x}`, `binning_y: {y}`: the images have {} x {} px; size and `K` are by the message's definition those of the whole sensor, of which this is \
             the camera",
            width / x,
            height / y
        )
    }))
}

fn cropped(roi: &Entry) -> Result<Option<String>, CameraFileError> {
    let [x, y, width, height] = [whole(roi, "x_offset")?, whole(roi, "y_offset")?, whole(roi, "width")?, whole(roi, "height")?];
    let is_part = [x, y, width, height].iter().any(|&value| value > 0);
    Ok(is_part.then(|| {
        format!("`roi`: the images are {width} x {height} px of the whole sensor, from column {x} and row {y} on; the camera is that of the whole sensor")
    }))
}
