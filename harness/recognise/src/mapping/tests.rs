use super::*;

fn mapping(bend: f64) -> Mapping {
    let unit = Unit::of(240, 200);
    Mapping::new(unit, Matrix3::new(3.0, 0.4, 0.2, -0.5, 2.6, 0.7, 0.2, -0.15, 1.0), bend).unwrap()
}

#[test]
fn there_and_back() {
    for bend in [0.0, -0.12, 0.08] {
        let mapping = mapping(bend);
        for at in [[0.0, 0.0], [239.0, 10.0], [120.0, 199.0], [33.3, 71.0]] {
            let again = mapping.image(mapping.grid(at).unwrap()).unwrap();
            assert!((again[0] - at[0]).hypot(again[1] - at[1]) < 1e-9, "{at:?} {again:?}");
        }
    }
}

#[test]
fn derivatives_are_those_of_differences() {
    let h = 1e-5;
    for bend in [0.0, -0.12, 0.08] {
        let mapping = mapping(bend);
        for at in [[0.3, -0.2], [1.5, 2.0], [-1.0, 0.4]] {
            let by = mapping.by_grid(at).unwrap();
            for axis in 0..2 {
                let moved =
                    |d: f64| mapping.image([at[0] + if axis == 0 { d } else { 0.0 }, at[1] + if axis == 1 { d } else { 0.0 }]).unwrap();
                let (a, b) = (moved(-h), moved(h));
                for row in 0..2 {
                    assert!(((b[row] - a[row]) / (2.0 * h) - by[(row, axis)]).abs() < 1e-5, "{bend} {at:?}");
                }
            }
        }
        let p = Vector2::new(0.4, -0.7);
        let by_bend = by_bend(p, bend);
        let difference = (straight(p, bend + h) - straight(p, bend - h)) / (2.0 * h);
        assert!((difference - by_bend).norm() < 1e-9);
    }
}

#[test]
fn the_homography_maps_as_the_mapping_without_bend() {
    let mapping = mapping(0.0);
    let h = mapping.homography() * Vector3::new(0.7, 0.2, 1.0);
    let [x, y] = mapping.image([0.7, 0.2]).unwrap();
    assert!((h.x / h.z - x).abs() < 1e-9 && (h.y / h.z - y).abs() < 1e-9);
}

#[test]
fn places_turn_shift_and_mirror() {
    let mapping = mapping(-0.05);
    for (turns, mirrored) in (0..4).flat_map(|turns| [(turns, false), (turns, true)]) {
        let place = Place { turns, mirrored, shift: [3, -2] };
        let moved = mapping.moved(&place).unwrap();
        let on_field = place.of([0.6, 1.3]);
        let (a, b) = (mapping.image([0.6, 1.3]).unwrap(), moved.image(on_field).unwrap());
        assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-9);
        assert_eq!(place.square([0, 1]), [on_field[1].floor() as i64, on_field[0].floor() as i64]);
        let area = |m: &Mapping, at| m.by_grid(at).unwrap().determinant();
        assert_eq!(area(&mapping, [0.6, 1.3]) * area(&moved, on_field) < 0.0, mirrored);
    }
    let quarter = Place { turns: 1, mirrored: false, shift: [0, 0] };
    assert_eq!(quarter.of([1.0, 0.0]), [0.0, 1.0]);
}
