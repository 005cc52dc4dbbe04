//! Figures of adjustments, summed and judged by hand.

use super::*;
use crate::{Cells, Coordinates};

fn numbers(value: f64, error: f64) -> Numbers {
    Numbers { value, sigma: Some(0.5), error: Some(error) }
}

fn sums(group: Group, trials: &[Numbers]) -> FigureSums {
    FigureSums(BTreeMap::from([((0, any(group)), FigureSum::of(trials.iter()))]))
}

/// A figure of each group.
fn any(group: Group) -> FigureName {
    match group {
        Group::Iop => Quantity::Parameter.of(&["c"]),
        Group::Eop => Quantity::Phi.of(&["6"]),
        Group::Network => Quantity::Sigma0.into(),
        Group::Frame => Quantity::OverFrame.into(),
        Group::Check => Quantity::RmseXy.into(),
        Group::Residual => Quantity::ImageResidual.of(&["6"]),
        Group::Point => Quantity::ResidualX.of(&["6", "left/3"]),
        Group::Object => Quantity::ObjectZ.of(&["left/3"]),
    }
}

fn verdicts(old: &FigureSums, new: &FigureSums) -> Vec<(Verdict, &'static str)> {
    let make = |verdict, metric, message| Finding::new(verdict, "f/s", "m", metric, message);
    old.compare(new, &make).iter().map(|found| (found.verdict, found.metric)).collect()
}

#[test]
fn sums_by_hand() {
    let sum = FigureSum::of([numbers(1.0, 0.3), numbers(3.0, -0.4)].iter());
    assert_eq!((sum.count, sum.mean, sum.scatter, sum.sigma), (2, 2.0, 1.0, Some(0.5)));
    assert!((sum.error.unwrap() - 0.125_f64.sqrt()).abs() < 1e-15);
}

#[test]
fn what_is_worse_fails_and_what_is_other_changed() {
    let with = |value: f64, error: f64, sigma: Option<f64>| {
        sums(Group::Iop, &[Numbers { value, sigma, error: Some(error) }, Numbers { value: value + 1.0, sigma, error: Some(-error) }])
    };
    let base = with(1.0, 0.5, Some(0.5));
    assert_eq!(verdicts(&base, &with(1.0 + 4e-5, 0.5, Some(0.5))), []);
    assert_eq!(verdicts(&base, &with(1.1, 0.5, Some(0.5))), [(Verdict::Changed, "figure")]);
    assert_eq!(verdicts(&base, &with(1.0, 0.505, Some(0.5))), [(Verdict::Changed, "figure")]);
    assert_eq!(verdicts(&base, &with(1.0, 0.515, Some(0.5))), [(Verdict::Fails, "error")]);
    assert_eq!(verdicts(&base, &with(1.0, 0.5, Some(0.4))), [(Verdict::Fails, "sigma")], "too sure by 25 %");
    assert_eq!(verdicts(&base, &with(1.0, 0.5, None)), [(Verdict::Fails, "sigma")]);
    assert_eq!(verdicts(&base, &with(1.0, f64::NAN, Some(0.5))).first(), Some(&(Verdict::Fails, "error")));
    assert_eq!(verdicts(&base, &sums(Group::Iop, &[numbers(1.0, 0.5)])).first(), Some(&(Verdict::Fails, "adjusted")));
    assert_eq!(verdicts(&base, &FigureSums::default()), [(Verdict::Fails, "figure")]);
}

#[test]
fn digits_of_a_value_that_stays_the_same_are_no_change() {
    let with = |value: f64| {
        let numbers = [Numbers { value, sigma: None, error: None }, Numbers { value: value + 1e-14, sigma: None, error: None }];
        sums(Group::Network, &numbers)
    };
    assert_eq!(verdicts(&with(6.163_170_733), &with(6.163_170_73)), []);
    assert_eq!(verdicts(&with(6.163_170_733), &with(6.163_171)), [(Verdict::Changed, "figure")]);
}

/// The same adjustment of OpenCV 4.6 on processors with and without AVX-512: 7e-8 of an error of check points, which is known to a hundredth at best.
#[test]
fn errors_are_known_no_better_than_their_number_allows() {
    for (group, is_error) in Group::ALL.map(|(group, _)| (group, matches!(group, Group::Check | Group::Frame))) {
        let with = |value: f64| sums(group, &[Numbers { value, sigma: None, error: None }]);
        let said = |change: f64| verdicts(&with(7.67e-4), &with(7.67e-4 * (1.0 + change)));
        assert_eq!(said(0.99e-8), []);
        assert_eq!((said(1.1e-8).is_empty(), said(-0.99e-6).is_empty()), (is_error, is_error), "{}", group.name());
        assert_eq!(said(1.02e-6), [(Verdict::Changed, "figure")]);
    }
}

#[test]
fn a_large_value_hides_no_change_of_its_error() {
    // Stations in a national grid, in m, known to a tenth of a millimetre.
    let with = |error: f64, sigma: f64| sums(Group::Eop, &[Numbers { value: 4e6, sigma: Some(sigma), error: Some(error) }]);
    let base = with(1e-4, 1e-4);
    assert_eq!(verdicts(&base, &base), []);
    assert_eq!(verdicts(&base, &with(1.1e-4, 1e-4)), [(Verdict::Fails, "error"), (Verdict::Fails, "sigma")]);
    assert_eq!(verdicts(&base, &with(0.99e-4, 1e-4)), [(Verdict::Changed, "figure")]);
    assert_eq!(verdicts(&base, &with(1e-4, 0.8e-4)), [(Verdict::Fails, "sigma")]);
}

#[test]
fn distances_of_cameras_are_errors() {
    let with = |value: f64| sums(Group::Frame, &[Numbers { value, sigma: None, error: None }]);
    assert_eq!(verdicts(&with(0.1), &with(0.103)), [(Verdict::Fails, "error")]);
    assert_eq!(verdicts(&with(0.1), &with(0.09)), [(Verdict::Changed, "figure")]);
}

/// Beside an error of 0.2 one of 1e-15 is nothing, and so is five times as much; what grows out of that is an error, and what is large by itself.
#[test]
fn what_is_zero_but_for_rounding_is_not_worse() {
    let with = |group: Group, small: f64, count: usize| {
        let of = |value: f64| Numbers { value, sigma: None, error: None };
        let mut sums = sums(group, &vec![of(small); count]);
        let largest = if group == Group::Check { Quantity::RmseZ.into() } else { Quantity::Parameter.of(&["x0"]) };
        sums.0.insert((0, largest), FigureSum::of([of(0.2)].iter()));
        sums
    };
    let check = |small: f64, count: usize| with(Group::Check, small, count);
    assert_eq!(verdicts(&check(1e-15, 3), &check(5e-15, 3)), []);
    assert_eq!(verdicts(&check(1e-15, 3), &check(-1e-13, 3)), []);
    assert_eq!(verdicts(&check(1e-15, 3), &check(3e-13, 3)), [(Verdict::Fails, "error")]);
    assert_eq!(verdicts(&check(3e-13, 3), &check(4e-13, 3)), [(Verdict::Fails, "error")]);
    assert_eq!(verdicts(&check(1e-15, 3), &check(-0.1, 3)), [(Verdict::Changed, "figure")]);
    assert_eq!(verdicts(&check(1e-15, 3), &check(1e-15, 2)), [(Verdict::Fails, "adjusted")]);
    // Alone there is nothing to compare it with; parameters have units of their own.
    let alone = |value: f64| sums(Group::Check, &[Numbers { value, sigma: None, error: None }]);
    assert_eq!(verdicts(&alone(1e-15), &alone(5e-15)), [(Verdict::Fails, "error")]);
    let parameter = |value: f64| with(Group::Iop, value, 3);
    assert_eq!(verdicts(&parameter(1e-15), &parameter(5e-15)), [(Verdict::Changed, "figure")]);
}

fn sum(mean: f64, scatter: f64, error: Option<f64>, sigma: Option<f64>) -> FigureSum {
    FigureSum { count: 10, mean, scatter, error, sigma }
}

#[test]
fn sums_of_figures_with_gaps() {
    let with = |value: f64, sigma, error| Numbers { value, sigma, error };
    let all = [with(1.0, Some(3.0), None), with(2.0, Some(4.0), None), with(6.0, None, Some(-0.5))];
    let found = FigureSum::of(all.iter());
    assert_eq!((found.count, found.mean, found.error, found.sigma), (3, 3.0, Some(0.5), Some(12.5_f64.sqrt())));
    assert!((found.scatter - (14.0_f64 / 3.0).sqrt()).abs() < 1e-15, "deviations -2, -1 and 3");
    assert_eq!(FigureSum::of([].iter()), FigureSum::default());
}

#[test]
fn last_bits_of_figures_are_a_ten_thousandth_of_their_scale() {
    let same = |old: FigureSum, new: FigureSum| {
        assert_eq!(old.same(&new, Group::Iop), new.same(&old, Group::Iop), "{old:?} {new:?}");
        old.same(&new, Group::Iop)
    };
    // The scale is the largest of scatter, error and standard deviation; the value itself has its digits.
    for (scatter, error, sigma) in
        [(2.0, Some(1.0), Some(1.0)), (1.0, Some(2.0), Some(1.0)), (1.0, Some(1.0), Some(2.0)), (2.0, None, None)]
    {
        let at = |mean: f64| sum(mean, scatter, error, sigma);
        assert!(same(at(0.0), at(1.99e-4)) && !same(at(0.0), at(2.01e-4)), "{scatter} {error:?} {sigma:?}");
        let of = |by: f64| sum(0.0, scatter - by, error.map(|e| e - by), sigma.map(|s| s - by));
        assert!(same(at(0.0), of(1e-4)) && !same(at(0.0), of(2.1e-4)));
    }
    let bare = |mean: f64, scatter: f64| sum(mean, scatter, None, None);
    assert!(same(bare(100.0, 0.0), bare(100.0 + 0.99e-6, 0.0)) && !same(bare(100.0, 0.0), bare(100.0 + 1.01e-6, 0.0)));
    assert!(same(bare(-100.0, 0.0), bare(-100.0, 0.99e-6)) && !same(bare(-100.0, 0.0), bare(-100.0, 1.01e-6)), "its own rounding");
    // Digits of an error and of a standard deviation: a hundred-millionth of themselves beside the ten-thousandth of the scale.
    let nan = bare(f64::NAN, f64::NAN);
    assert!(nan.same(&nan, Group::Iop) && !nan.same(&bare(1.0, 0.0), Group::Iop) && !bare(1.0, 0.0).same(&nan, Group::Iop));
    let both = sum(1.0, 1.0, Some(1.0), Some(1.0));
    for other in [
        FigureSum { count: 11, ..both },
        FigureSum { error: None, ..both },
        FigureSum { sigma: None, ..both },
        FigureSum { error: Some(1.001), ..both },
        FigureSum { sigma: Some(1.001), ..both },
        FigureSum { scatter: 1.001, ..both },
        FigureSum { mean: 1.001, ..both },
    ] {
        assert!(!both.same(&other, Group::Iop) && !other.same(&both, Group::Iop), "{other:?}");
    }
    assert!(both.same(&both, Group::Iop));
}

#[test]
fn the_misfit_is_the_logarithm_of_error_over_standard_deviation() {
    let misfit = |error, sigma| sum(0.0, 0.0, error, sigma).misfit();
    for (error, sigma) in [(2.0, 1.0), (1.0, 2.0)] {
        assert!((misfit(Some(error), Some(sigma)).unwrap() - 2.0_f64.ln()).abs() < 1e-15);
    }
    for (error, sigma) in [(Some(0.0), Some(1.0)), (Some(1.0), Some(0.0)), (None, Some(1.0)), (Some(1.0), None)] {
        assert_eq!(misfit(error, sigma), None, "{error:?} {sigma:?}");
    }
}

fn found(group: Group, old: FigureSum, new: FigureSum) -> Vec<(Verdict, &'static str, Option<f64>, Option<f64>)> {
    let make = |verdict, metric, message| Finding::new(verdict, "f/s", "m", metric, message);
    judged(&any(group), &old, &new, &make).map(|f| (f.verdict, f.metric, f.baseline, f.now)).collect()
}

#[test]
fn errors_may_grow_by_a_fiftieth() {
    let with = |error: f64| sum(5.0, 0.1, Some(error), None);
    assert_eq!(found(Group::Iop, with(0.5), with(0.509)), [(Verdict::Changed, "figure", Some(5.0), Some(5.0))]);
    assert_eq!(found(Group::Iop, with(0.5), with(0.511)), [(Verdict::Fails, "error", Some(0.5), Some(0.511))]);
    assert_eq!(found(Group::Iop, with(0.5), with(0.1)), [(Verdict::Changed, "figure", Some(5.0), Some(5.0))]);
    assert_eq!(found(Group::Iop, with(0.0), with(0.0)).first().unwrap().0, Verdict::Changed, "as large");
    // Of check points and of the frame the value is the error.
    for group in [Group::Check, Group::Frame] {
        let with = |value: f64| sum(value, 0.1, None, None);
        assert_eq!(found(group, with(5.0), with(5.11)), [(Verdict::Fails, "error", Some(5.0), Some(5.11))]);
        assert_eq!(found(group, with(5.0), with(5.09)), [(Verdict::Changed, "figure", Some(5.0), Some(5.09))]);
    }
    let network = |value: f64| sum(value, 0.1, None, None);
    assert_eq!(found(Group::Network, network(5.0), network(9.0)), [(Verdict::Changed, "figure", Some(5.0), Some(9.0))]);
}

#[test]
fn errors_may_move_from_standard_deviations_by_a_twentieth() {
    let with = |sigma: f64| sum(5.0, 0.1, Some(0.5), Some(sigma));
    let of = |by: f64| found(Group::Iop, with(0.5), with(0.5 * by.exp()));
    for by in [0.049, -0.049] {
        assert_eq!(of(by), [(Verdict::Changed, "figure", Some(5.0), Some(5.0))], "{by}");
    }
    for by in [0.051_f64, -0.051] {
        assert_eq!(of(by), [(Verdict::Fails, "sigma", Some(0.5), Some(0.5 * by.exp()))], "{by}");
    }
    assert_eq!(found(Group::Iop, with(0.25), with(0.5)), [(Verdict::Changed, "figure", Some(5.0), Some(5.0))], "it fits now");
    let [(verdict, metric, old, new)] = found(Group::Iop, with(0.5), with(f64::NAN))[..] else { panic!("one finding") };
    assert!((verdict, metric, old) == (Verdict::Fails, "sigma", Some(0.5)) && new.unwrap().is_nan());
    assert_eq!(found(Group::Iop, with(0.5), sum(5.0, 0.1, Some(0.5), None)), [(Verdict::Fails, "sigma", Some(0.5), Some(0.0))]);
    assert_eq!(found(Group::Iop, sum(5.0, 0.1, Some(0.5), None), with(0.1))[0].0, Verdict::Changed, "there was none");
}

/// Mean squares of errors in stated standard deviations are better near one, on either side; to be wrong without a word is never better.
#[test]
fn what_is_stated_is_held_to_the_errors() {
    let of = |quantity: Quantity, old: f64, new: f64| {
        let [old, new] = [old, new].map(|mean| sum(mean, 0.0, None, None));
        let finding = |verdict, metric, message| Finding::new(verdict, "f/s", "m", metric, message);
        let found: Vec<_> = judged(&quantity.into(), &old, &new, &finding).collect();
        (found.len(), found[0].verdict, found[0].metric)
    };
    for (old, new) in [(1.26, 11.3), (1.26, 0.14), (1.0, 1.12), (1.0, 0.9), (1.0, 0.0), (1.2, f64::NAN)] {
        assert_eq!(of(Quantity::SquareOverStated, old, new), (1, Verdict::Fails, "stated"), "{old} {new}");
    }
    for (old, new) in [(1.26, 1.1), (11.3, 1.26), (0.9, 1.1), (1.0, 1.09)] {
        assert_eq!(of(Quantity::SquareOverStatedParameters, old, new), (1, Verdict::Changed, "figure"), "{old} {new}");
    }
    assert_eq!(of(Quantity::IsWrongAndSilent, 0.0, 0.1), (1, Verdict::Fails, "silent"));
    assert_eq!(of(Quantity::IsWrongAndSilent, 0.7, 0.1), (1, Verdict::Changed, "figure"));
}

#[test]
fn fewer_adjustments_fail() {
    let with = |count| FigureSum { count, ..sum(5.0, 0.1, None, None) };
    assert_eq!(found(Group::Iop, with(10), with(9)), [(Verdict::Fails, "adjusted", Some(10.0), Some(9.0))]);
    assert_eq!(found(Group::Iop, with(9), with(10)), [(Verdict::Changed, "figure", Some(5.0), Some(5.0))]);
}

fn two(first: f64, second: f64) -> MethodTable {
    let mut method = MethodTable::new("1".into());
    for (set, figure, value) in [(0, any(Group::Iop), first), (2, any(Group::Eop), second)] {
        let numbers = |value: f64| Numbers { value, sigma: Some(0.5), error: (set == 0).then_some(0.25) };
        method.figures.insert((set, figure), [(0, numbers(value)), (1, numbers(value + 2.0))].into());
    }
    method
}

#[test]
fn figures_have_their_sets_from_one_and_their_digits() {
    let all = FigureSums::of(&two(10.0, -0.125));
    assert_eq!(all.count(), 2);
    let rows: Vec<String> = all.rows().iter().map(|row| row.join(",")).collect();
    let expected = ["1,iop,c,2,1.100000000e1,1.000000e0,2.500000e-1,5.000000e-1", "3,eop,6/phi,2,8.750000000e-1,1.000000e0,,5.000000e-1"];
    assert_eq!(rows, expected);
    let make = |verdict, metric, message| Finding::new(verdict, "f/s", "m", metric, message);
    let found = all.compare(&FigureSums::of(&two(10.0, 0.125)), &make);
    assert_eq!(found.iter().map(|f| f.target.as_deref().unwrap()).collect::<Vec<_>>(), ["set 3 eop 6/phi"]);
    let first = FigureSums(all.0.iter().take(1).map(|(key, sum)| (key.clone(), *sum)).collect());
    let fewer = all.compare(&first, &make);
    assert!(fewer.len() == 1 && fewer[0].fails() && fewer[0].target.as_deref() == Some("set 3 eop 6/phi"), "{fewer:?}");
    let more = first.compare(&all, &make);
    assert!(more.len() == 1 && more[0].verdict == Verdict::Unblessed, "{more:?}");
    assert_eq!(more[0].message, "not blessed yet: 1 figures of adjustments");
}

/// A method without targets in a cell, or whose adjustments all fail, has nothing there that could be blessed; once it has, that is new.
#[test]
fn what_is_idle_in_a_cell_is_nothing_to_bless() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("f.csv");
    let cells = |second: MethodTable| {
        let mut cells: Cells<FigureSums> = Cells::new("f/s", "text", 7, Coordinates::Errors);
        cells.add("a", &crate::tests::holding(Coordinates::Errors, two(10.0, -0.125)));
        cells.add("b", &crate::tests::holding(Coordinates::Errors, second));
        cells
    };
    let idle = cells(MethodTable::new("1".into()));
    idle.write(&path).unwrap();
    let (blessed, _) = Cells::read(&path, "f/s").unwrap().unwrap();
    assert_eq!(blessed.compare(&idle), []);
    let found = blessed.compare(&cells(two(10.0, -0.125)));
    assert!(found.len() == 1 && found[0].verdict == Verdict::Unblessed && found[0].scenario == "f/s@b", "{found:?}");
}

#[test]
fn figures_are_read_as_they_were_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("f.csv");
    let mut cells: Cells<FigureSums> = Cells::new("f/s", "text", 7, Coordinates::Errors);
    cells.add("", &crate::tests::holding(Coordinates::Errors, two(10.0, -0.125)));
    let sum = cells.write(&path).unwrap();
    assert_eq!(Cells::read(&path, "f/s").unwrap(), Some((cells, sum)));
    let text = std::fs::read_to_string(&path).unwrap();
    let read = |old: &str, new: &str| {
        assert!(text.contains(old));
        std::fs::write(&path, text.replace(old, new)).unwrap();
        Cells::<FigureSums>::read(&path, "f/s").err().unwrap().to_string()
    };
    assert!(read("1,1,1,iop", "1,1,0,iop").contains("column `set`: found `0`, expected 1 or more"));
    assert!(read(",iop,", ",oip,").contains("column `group`: found `oip`, expected a group of figures"));
    assert!(read("3,eop,6/phi", "1,iop,c").contains("column `name`: found `c`, the figure is there twice"));
}
