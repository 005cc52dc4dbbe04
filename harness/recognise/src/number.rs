//! Which of two equal targets is the first.

use calibench_model::TargetKind;

use crate::bank::KINDS;

/// A target of a square by what is seen of it: kind, whether large, and its place.
pub(crate) type Told = (TargetKind, bool, [f64; 2]);

/// For each of some targets whether it is the second of its pair: the one farther from the middle of the pair of its kind and the other size. `None` for one
/// that has no pair, or whose counterpart has none.
pub(crate) fn seconds(targets: &[Told]) -> Vec<Option<bool>> {
    let pair = |kind: TargetKind, large: bool| {
        let of: Vec<usize> = (0..targets.len()).filter(|&i| targets[i].0 == kind && targets[i].1 == large).collect();
        <[usize; 2]>::try_from(of).ok()
    };
    let mut seconds = vec![None; targets.len()];
    for (kind, large) in KINDS.into_iter().flat_map(|kind| [(kind, false), (kind, true)]) {
        let (Some(own), Some([c, d])) = (pair(kind, large), pair(kind, !large)) else { continue };
        let middle = [0, 1].map(|i| 0.5 * (targets[c].2[i] + targets[d].2[i]));
        let off = own.map(|i| (targets[i].2[0] - middle[0]).hypot(targets[i].2[1] - middle[1]));
        seconds[own[0]] = Some(off[0] > off[1]);
        seconds[own[1]] = Some(off[0] <= off[1]);
    }
    seconds
}

#[cfg(test)]
mod tests {
    use calibench_random::Key;
    use calibench_synth::testfield::Coded;

    use super::*;

    /// The names of the field's targets say the same.
    #[test]
    fn seconds_are_those_of_the_field() {
        let key = Key { seed: 4, of: "number", trial: 0, view: "", target: "" };
        let field = Coded::paper().generate(key).unwrap();
        for square in field.targets.chunks(16) {
            let told: Vec<Told> = square.iter().map(|t| (t.kind, t.id.contains("large"), t.at)).collect();
            for (second, target) in seconds(&told).into_iter().zip(square) {
                assert_eq!(second, Some(target.id.ends_with("-2")), "{}", target.id);
            }
        }
    }

    #[test]
    fn three_of_a_kind_are_no_pair() {
        let told = [(TargetKind::Disc, false, [0.0, 0.0]); 3];
        assert_eq!(seconds(&told), [None; 3]);
    }
}
