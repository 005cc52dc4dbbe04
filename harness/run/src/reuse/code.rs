//! Which code results depend on. The build script takes digests of it where it lies beside this crate; elsewhere, as in a package, all of it is the program.

/// Digests by name, as `points=...;adjusted=...;all=...;forstner=...`.
const CODE: Option<&str> = option_env!("CALIBENCH_CODE");

/// The code that points depend on: scenarios, rendering, what operators share.
pub const POINTS: &str = "points";
/// The code that adjustments depend on beside it.
pub const ADJUSTED: &str = "adjusted";
/// All of it, with every operator.
pub const ALL: &str = "all";

/// The digest of this name, or of the operator of this name; `None` where it is not known.
fn known(name: &str) -> Option<&'static str> {
    CODE?.split(';').filter_map(|pair| pair.split_once('=')).find(|(known, _)| *known == name).map(|(_, digest)| digest)
}

/// Whether digests were taken, so that not everything depends on the whole program.
pub fn is_known() -> bool {
    CODE.is_some()
}

/// The digest of this name or operator, else that of the `program`.
pub fn digest<'p>(name: &str, program: &'p str) -> &'p str {
    known(name).unwrap_or(program)
}

#[cfg(test)]
mod tests {
    use calibench_measure::Registry;

    use super::*;

    /// Those of OpenCV are in a crate above.
    #[test]
    fn every_operator_has_code_of_its_own() {
        let methods = Registry::builtin();
        let digests: Vec<_> = methods.methods().iter().map(|method| (method.name, known(method.name))).collect();
        assert!(digests.iter().all(|(_, digest)| digest.is_some()), "{digests:?}");
        let of = |name: &str| known(name).unwrap();
        assert_eq!(of("centroid"), of("centroid_binary"), "one file");
        for (a, b) in
            [("forstner", "lsm"), ("pixel", "saddle"), (POINTS, ADJUSTED), (POINTS, ALL), ("parametric_corner", "parametric_circle")]
        {
            assert_ne!(of(a), of(b));
        }
        assert_eq!((digest("no such operator", "p"), digest("pixel", "p")), ("p", of("pixel")));
    }
}
