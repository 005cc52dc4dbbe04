//! Cameras of several files as those of one: names that tell them apart, and poses where the files state them in one world.

use std::collections::HashSet;
use std::path::Path;

use calibench_model::NamedCamera;
use calibench_model::named_camera::PoseFrame;

/// The cameras of several files together.
#[derive(Clone, Debug, PartialEq)]
pub struct Joined {
    /// The cameras, file by file.
    pub cameras: Vec<NamedCamera>,
    /// What is known of the poses between them, in words.
    pub poses: String,
}

/// The cameras of `files` as those of one. A camera without a name, or with one that another has too, is called after its file. Poses stay where every camera has one in the
/// same world: files do not name their world, so that it is taken to be one, unless two cameras would sit at the same place, which none do. Else none is left.
pub fn joined<'a>(files: impl IntoIterator<Item = (&'a Path, Vec<NamedCamera>)>) -> Joined {
    let files: Vec<_> = files.into_iter().collect();
    let all = || files.iter().flat_map(|(_, cameras)| cameras);
    let taken = |name: &str| name.is_empty() || all().filter(|named| named.name == name).count() > 1;
    let names: Vec<String> = files
        .iter()
        .flat_map(|(path, cameras)| {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            cameras.iter().map(move |named| (stem.clone(), cameras.len() > 1, named.name.clone()))
        })
        .map(|(stem, many, name)| match (taken(&name), many && !name.is_empty()) {
            (false, _) => name,
            (true, true) => format!("{stem}-{name}"),
            (true, false) => stem,
        })
        .collect();
    let why = without_common_world(&files);
    let poses = why.clone().map_or_else(
        || "poses between the cameras as the files state them, in one world".to_owned(),
        |why| format!("no poses between the cameras are known: {why}"),
    );
    let mut seen = HashSet::new();
    let mut cameras: Vec<NamedCamera> = files.into_iter().flat_map(|(_, cameras)| cameras).collect();
    for (index, (named, name)) in cameras.iter_mut().zip(names).enumerate() {
        named.name = if seen.insert(name.clone()) { name } else { format!("{name}-{}", index + 1) };
        seen.insert(named.name.clone());
        if why.is_some() {
            (named.pose, named.pose_frame) = (None, PoseFrame::World);
        }
    }
    Joined { cameras, poses }
}

/// Why the poses are not known to be in one world; `None` where they are taken to be.
fn without_common_world(files: &[(&Path, Vec<NamedCamera>)]) -> Option<String> {
    let shown = |path: &Path| path.display().to_string();
    let all: Vec<(&Path, &NamedCamera)> =
        files.iter().flat_map(|(path, cameras)| cameras.iter().map(move |named| (*path, named))).collect();
    if let Some((path, _)) = all.iter().find(|(_, named)| named.pose.is_none()) {
        return Some(format!("{} states none", shown(path)));
    }
    let first = all.first()?.1.pose_frame;
    if let Some((path, _)) = all.iter().find(|(_, named)| named.pose_frame != first) {
        return Some(format!("{} states them in another frame than {}", shown(path), shown(all[0].0)));
    }
    if matches!(first, PoseFrame::FirstCamera | PoseFrame::Rig) && files.len() > 1 {
        return Some("each file has them in the frame of its own rig".to_owned());
    }
    let twice = |(index, (path, named)): (usize, &(&Path, &NamedCamera))| {
        let (other, _) = all[..index].iter().find(|(_, other)| other.pose == named.pose)?;
        Some(format!("{} and {} state the same pose, and no two cameras have the same", shown(other), shown(path)))
    };
    all.iter().enumerate().find_map(twice)
}

#[cfg(test)]
mod tests {
    use calibench_model::camera::{Camera, ImageSize, OpenCv};
    use calibench_model::named_camera::Pose;

    use super::*;
    use crate::{ReadOptions, camera_text, format_named, parse_camera};

    fn camera(name: &str, at: Option<[f64; 3]>) -> NamedCamera {
        let size = ImageSize { width: 640, height: 480 };
        let camera = Camera::from(OpenCv { size, fx: 500.0, fy: 501.0, cx: 320.0, cy: 240.0, distortion: [0.0; 14], coefficients: 4 });
        NamedCamera { pose: at.map(|position| Pose { position, ..Pose::IDENTITY }), ..NamedCamera::new(name, camera) }
    }

    fn of(cameras: [NamedCamera; 3]) -> Joined {
        let [a, b, c] = cameras;
        joined([(Path::new("x/left.json"), vec![a]), (Path::new("middle.json"), vec![b]), (Path::new("right.json"), vec![c])])
    }

    fn names(joined: &Joined) -> Vec<&str> {
        joined.cameras.iter().map(|named| named.name.as_str()).collect()
    }

    #[test]
    fn cameras_are_called_after_their_files_where_names_do_not_tell_them_apart() {
        assert_eq!(names(&of([camera("", None), camera("a", None), camera("a", None)])), ["left", "middle", "right"]);
        assert_eq!(names(&of([camera("l", None), camera("m", None), camera("r", None)])), ["l", "m", "r"]);
        let rigs = [vec![camera("cam0", None), camera("cam1", None)], vec![camera("cam0", None)]];
        let [a, b] = rigs;
        assert_eq!(names(&joined([(Path::new("a.yaml"), a), (Path::new("b.yaml"), b)])), ["a-cam0", "cam1", "b"]);
        let [a, b] = [vec![camera("", None)], vec![camera("", None)]];
        assert_eq!(names(&joined([(Path::new("1/c.yaml"), a), (Path::new("2/c.yaml"), b)])), ["c", "c-2"]);
    }

    #[test]
    fn poses_make_a_chain_and_come_back_from_it() {
        let places = [[0.5, 0.0, 0.0], [0.6, 0.0, 0.1], [0.9, 0.2, 0.0]];
        let found = of(places.map(|at| camera("", Some(at))));
        assert!(found.poses.starts_with("poses between the cameras as the files state them"), "{}", found.poses);
        let kalibr = format_named("kalibr").unwrap();
        let text = camera_text(kalibr, &found.cameras).unwrap();
        let read = parse_camera("chain.yaml", text.as_bytes(), &ReadOptions::default()).unwrap().cameras;
        for (camera, place) in read.iter().zip(places) {
            let expected: [f64; 3] = std::array::from_fn(|i| place[i] - places[0][i]);
            let found = camera.pose.unwrap().position;
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} {expected:?}\n{text}");
        }
    }

    #[test]
    fn poses_that_cannot_be_in_one_world_are_none() {
        let at = |x: f64| camera("", Some([x, 0.0, 0.0]));
        let rig = |x: f64| NamedCamera { pose_frame: PoseFrame::FirstCamera, ..at(x) };
        for (cameras, expected) in [
            ([at(0.0), camera("", None), at(2.0)], "no poses between the cameras are known: middle.json states none"),
            ([at(0.0), at(1.0), at(0.0)], "x/left.json and right.json state the same pose"),
            ([at(0.0), rig(1.0), at(2.0)], "middle.json states them in another frame than x/left.json"),
            ([rig(0.0), rig(1.0), rig(2.0)], "each file has them in the frame of its own rig"),
        ] {
            let found = of(cameras);
            assert!(found.poses.contains(expected), "{}", found.poses);
            assert!(found.cameras.iter().all(|named| named.pose.is_none()));
        }
    }
}
