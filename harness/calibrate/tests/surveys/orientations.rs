//! Exterior orientations of images whose points are right, wrong or other points' own.

use calibench_calibrate::Survey;
use calibench_calibrate::orientation::{Orientations, StatedPrecision, resect_images};
use calibench_exchange::points::parse_points;
use calibench_model::Pose;
use nalgebra::{Point3, Vector3};

use crate::network::{Scene, board, lens, wall};

/// Image points as rows: image, target, x, y.
type Rows = Vec<(String, String, f64, f64)>;

fn rows(scene: &Scene) -> Rows {
    let points = scene.points();
    let name =
        |index: usize| (points.images().get(points.image_of(index)).to_owned(), points.targets().get(points.target_of(index)).to_owned());
    (0..points.len()).map(|index| (name(index), points.position(index))).map(|((image, target), at)| (image, target, at.x, at.y)).collect()
}

fn oriented(scene: &Scene, rows: &Rows, tolerance: Option<f64>, sigma: Option<f64>) -> (Survey, Orientations) {
    let text: String = rows.iter().map(|(image, target, x, y)| format!("{image},{target},{x},{y}\n")).collect();
    let points = parse_points("points.csv", format!("image,target,x,y\n{text}").as_bytes()).unwrap().points;
    let survey = Survey::new(points, &scene.known()).unwrap();
    let found =
        resect_images(&survey, &vec![scene.camera; survey.images.len()], StatedPrecision { tolerance_px: tolerance, sigma_px: sigma });
    assert!(found.failed.is_empty(), "{:?}", found.failed);
    (survey, found)
}

/// Names of the targets that do not fit, of each image, in order.
fn misfits(survey: &Survey, found: &Orientations) -> Vec<Vec<String>> {
    let names = |targets: &[usize]| {
        let mut names: Vec<String> = targets.iter().map(|&target| survey.target(target).to_owned()).collect();
        names.sort();
        names
    };
    found.found.iter().map(|one| one.misfit.as_ref().map_or_else(Vec::new, |misfit| names(&misfit.targets))).collect()
}

/// Of 5 images of a wall and 7 of a board, of all points and of few, by normal noise, one in 10,000 may be called wrong.
#[test]
fn points_that_are_right_are_not_in_doubt() {
    let (mut doubts, mut images) = (0, 0);
    for seed in 0..60 {
        for share in [1, 4, 7] {
            for scene in [Scene { sigma: 0.3, seed, ..wall(lens()) }, Scene { sigma: 0.3, seed, ..board(lens()) }] {
                let some: Rows = rows(&scene).into_iter().enumerate().filter(|(place, _)| place % share == 0).map(|(_, row)| row).collect();
                let (survey, found) = oriented(&scene, &some, None, Some(0.3));
                let said = found.doubts(&survey);
                doubts += said.iter().flatten().filter(|doubt| !doubt.starts_with("another pose")).count();
                images += said.len();
            }
        }
    }
    assert!(images == 60 * 3 * 12 && doubts <= 2, "{doubts} of {images}");
}

#[test]
fn names_that_were_swapped_are_told() {
    for pairs in 1..=9 {
        let scene = Scene { sigma: 0.2, ..wall(lens()) };
        let mut swapped = rows(&scene);
        let first: Vec<usize> = (0..swapped.len()).filter(|&index| swapped[index].0 == "image_1.png").collect();
        let mut expected = Vec::new();
        for pair in first.chunks_exact(2).step_by(2).take(pairs) {
            let (name, other) = (swapped[pair[0]].1.clone(), swapped[pair[1]].1.clone());
            expected.extend([name.clone(), other.clone()]);
            (swapped[pair[0]].1, swapped[pair[1]].1) = (other, name);
        }
        expected.sort();
        let (survey, found) = oriented(&scene, &swapped, None, None);
        let told = misfits(&survey, &found);
        assert!(told.iter().enumerate().all(|(image, names)| *names == if image == 1 { expected.clone() } else { Vec::new() }), "{told:?}");
        let doubts = found.doubts(&survey);
        let begin = format!("{} of {} points do not fit: ", 2 * pairs, first.len());
        assert!(doubts[1][0].starts_with(&begin) && doubts[1][1].contains("in the middle of all images"), "{doubts:?}");
        assert!(doubts.iter().enumerate().all(|(image, doubts)| image == 1 || doubts.is_empty()), "{doubts:?}");
        // The same points are left out if that is asked for, and the others fit.
        let (survey, found) = oriented(&scene, &swapped, Some(1.5), None);
        let mut left_out: Vec<&str> = found.found[1].rejected.iter().map(|&target| survey.target(target)).collect();
        left_out.sort_unstable();
        assert_eq!(left_out, expected);
        assert!(misfits(&survey, &found).concat().is_empty() && found.doubts(&survey).concat().is_empty());
    }
}

/// One point of six that is 30 standard deviations off.
#[test]
fn one_point_of_few_is_told() {
    let scene = Scene { sigma: 0.1, ..wall(lens()) };
    let mut told = 0;
    for start in 0..6 {
        let mut few: Rows = rows(&scene).into_iter().filter(|row| row.0 == "image_2.png").skip(start).step_by(4).take(10).collect();
        few[start].2 += 12.0;
        let (survey, found) = oriented(&scene, &few, None, None);
        let names = misfits(&survey, &found).concat();
        told += usize::from(!names.is_empty());
        assert!(names.is_empty() || names == [few[start].1.clone()], "{names:?}");
        let worst = found.found[0].misfit.as_ref().and_then(|misfit| misfit.worst);
        assert!(worst.is_none_or(|worst| (worst - 12.0).abs() < 1.5), "{worst:?}");
    }
    assert_eq!(told, 6);
}

/// Of 2000 targets 300 are searched, and all are asked.
#[test]
fn the_few_of_many_are_told_by_name() {
    let target = |i: u32| Point3::new(60.0 * f64::from(i % 50), 60.0 * f64::from(i / 50), 300.0 * f64::from(i * 7 % 5));
    let few = wall(lens());
    let scene = Scene { targets: (0..2000).map(target).collect(), poses: vec![few.poses[2]], control: 2000, sigma: 0.2, ..few };
    let mut many = rows(&scene);
    let (survey, found) = oriented(&scene, &many, None, None);
    assert!(many.len() > 1000 && found.found[0].misfit.is_none(), "{:?}", misfits(&survey, &found));
    let mut wrong: Vec<String> = Vec::new();
    for place in (3..many.len()).step_by(177) {
        many[place].2 += 3.0;
        wrong.push(many[place].1.clone());
    }
    let worst = 3 + 4 * 177;
    many[worst].2 += 6.0;
    wrong.sort();
    let (survey, found) = oriented(&scene, &many, None, None);
    // The worst comes first.
    let first = found.found[0].misfit.as_ref().map(|misfit| (survey.target(misfit.targets[0]), misfit.worst.unwrap().round()));
    assert_eq!(first, Some((many[worst].1.as_str(), 9.0)));
    let told = misfits(&survey, &found).concat();
    // One right point in a thousand is left out with them.
    assert!(wrong.len() >= 6 && wrong.iter().all(|name| told.contains(name)) && told.len() <= wrong.len() + 6, "{told:?}");
}

/// What a generous tolerance leaves in is told all the same.
#[test]
fn what_is_left_in_is_looked_at() {
    let scene = Scene { sigma: 0.1, ..wall(lens()) };
    let mut few: Rows = rows(&scene).into_iter().filter(|row| row.0 == "image_2.png").collect();
    few[3].3 += 300.0;
    few[9].2 -= 30.0;
    let (survey, found) = oriented(&scene, &few, Some(60.0), None);
    let left_out: Vec<&str> = found.found[0].rejected.iter().map(|&target| survey.target(target)).collect();
    assert_eq!((left_out, misfits(&survey, &found).concat()), (vec![few[3].1.as_str()], vec![few[9].1.clone()]));
    let expected = format!("1 of {} points do not fit: {} (the first is ", few.len() - 1, few[9].1);
    assert!(found.doubts(&survey)[0][0].starts_with(&expected), "{:?}", found.doubts(&survey));
}

#[test]
fn an_image_whose_points_are_all_wrong_stands_out() {
    let scene = Scene { sigma: 0.2, ..wall(lens()) };
    let mut shifted = rows(&scene);
    let third: Vec<usize> = (0..shifted.len()).filter(|&index| shifted[index].0 == "image_3.png").collect();
    let names: Vec<String> = third.iter().map(|&index| shifted[index].1.clone()).collect();
    third.iter().enumerate().for_each(|(place, &index)| shifted[index].1 = names[(place + 5) % names.len()].clone());
    let (survey, found) = oriented(&scene, &shifted, None, None);
    let doubts = found.doubts(&survey);
    assert!(doubts[3].iter().any(|doubt| doubt.contains("in the middle of all images")), "{doubts:?}");
    assert!(doubts.iter().enumerate().all(|(image, doubts)| image == 3 || doubts.is_empty()), "{doubts:?}");
    // Alone it is held against what is stated.
    let alone: Rows = shifted.into_iter().filter(|row| row.0 == "image_3.png").collect();
    let (survey, found) = oriented(&scene, &alone, None, Some(0.2));
    assert!(found.doubts(&survey)[0].iter().any(|doubt| doubt.ends_with("--sigma 0.2")) && !found.agree_with_stated());
    let (survey, found) = oriented(&scene, &alone, None, None);
    assert!(found.doubts(&survey)[0].iter().any(|doubt| doubt.contains("at half of the points are no operator's")));
    // Where nearly all were left out what is left is no proof.
    let (survey, found) = oriented(&scene, &alone, Some(20.0), None);
    let left_out = found.found[0].rejected.len();
    let expected = format!("{left_out} of {} points were left out, and what is left need not be the right part", alone.len());
    assert!(left_out > alone.len() / 2 && found.doubts(&survey)[0].contains(&expected), "{:?}", found.doubts(&survey));
}

/// A small plane far away, seen somewhat from aside, has two poses; near by it has one.
#[test]
fn a_pose_that_has_a_rival_is_told() {
    let scene = Scene { sigma: 0.3, ..board(lens()) };
    let small: Vec<Point3<f64>> = scene.targets.iter().map(|point| point * 0.1).collect();
    let station = |away: [f64; 3]| Pose::looking_at(small[31] + Vector3::from(away), small[31], Vector3::y(), 0.3).unwrap();
    let scene = Scene { poses: vec![station([300.0, 120.0, 1000.0]), station([20.0, 0.0, 25.0])], targets: small.clone(), ..scene };
    let (survey, found) = oriented(&scene, &rows(&scene), None, Some(0.3));
    assert_eq!(found.doubts(&survey), [vec!["another pose fits nearly as well".to_owned()], vec![]]);
    let mut table = Vec::new();
    found.write(&survey, &found.doubts(&survey), &mut table).unwrap();
    let notes: Vec<String> = String::from_utf8(table).unwrap().lines().map(|line| line.rsplit(',').next().unwrap().to_owned()).collect();
    assert_eq!(notes, ["note", "another pose fits nearly as well", ""]);
}

/// x and y exchanged, as they are in some files, of a frame that is wider than high.
#[test]
fn points_outside_of_the_image_are_told() {
    let scene = Scene { sigma: 0.2, ..wall(lens()) };
    let exchanged: Rows = rows(&scene).into_iter().map(|(image, target, x, y)| (image, target, y, x)).collect();
    let count = exchanged.iter().filter(|row| row.0 == "image_0.png" && row.3 > 1199.5).count();
    let (survey, found) = oriented(&scene, &exchanged, None, None);
    let expected = format!("{count} points lie outside the image: ");
    assert!(count > 0 && found.doubts(&survey)[0][0].starts_with(&expected), "{:?}", found.doubts(&survey)[0]);
}

#[test]
fn residuals_are_held_against_what_was_stated() {
    let scene = Scene { sigma: 0.2, ..wall(lens()) };
    for (stated, agrees) in [(0.2, true), (0.1, false), (0.4, false)] {
        let (survey, found) = oriented(&scene, &rows(&scene), None, Some(stated));
        assert_eq!(found.agree_with_stated(), agrees, "{stated}: {:?}", found.pooled());
        let too_large = found.doubts(&survey).into_iter().filter(|doubts| !doubts.is_empty()).count();
        assert_eq!(too_large, if stated == 0.1 { 5 } else { 0 }, "{stated}");
    }
    let exact = wall(lens());
    let (survey, found) = oriented(&exact, &rows(&exact), None, None);
    assert!(found.doubts(&survey).concat().is_empty());
}
