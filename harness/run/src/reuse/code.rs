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
#[path = "../../operators.rs"]
mod operators;

#[cfg(test)]
mod tests {
    use calibench_measure::Registry;

    use super::operators::{Sources, of_modules, parted};
    use super::*;

    fn texts(files: &[(&str, &str)]) -> Sources {
        files.iter().map(|(path, text)| ((*path).to_owned(), (*text).to_owned())).collect()
    }

    /// `a` calls `b` by a path, `b` calls `c` in a list, `d` is named in words alone, the code of all calls `e`, and the list names them all.
    #[test]
    fn the_code_of_an_operator_is_its_own_and_what_it_calls() {
        let at = |name: &str| format!("measure/src/operators/{name}");
        let list = (at("mod.rs"), "pub mod a;\npub mod b;\nlet all = [\n    a::method(),\n];\n".to_owned());
        let mut points = texts(&[
            ("synth/src/lib.rs", "// d::is a word\nlet x = e::help();\nlet bold = embolden::a_b();"),
            ("measure/src/lib.rs", "pub use operators::a;"),
        ]);
        points.extend([list]);
        for (file, text) in [
            ("a.rs", "name: \"first\" b::fit()"),
            ("b/mod.rs", "use super::{\n    c,\n};\nname: \"second\""),
            ("b/inner.rs", "/// a, and d"),
            ("c.rs", "name: \"third\" let abc = 1;\n// a::fit"),
            ("d.rs", "name: \"fourth\""),
            ("e.rs", "name: \"fifth\" name: \"sixth\""),
        ] {
            points.insert(at(file), text.to_owned());
        }
        let parted = parted(points);
        let of = |method: &str| parted.methods[method].iter().map(String::as_str).collect::<String>();
        assert_eq!(["first", "second", "third", "fourth", "fifth", "sixth"].map(of), ["abc", "bc", "c", "d", "e", "e"]);
        let files = |sources: &Sources| sources.keys().map(|path| path.rsplit_once("src/").unwrap().1.to_owned()).collect::<Vec<_>>();
        assert_eq!(
            files(&of_modules(&parted.operators, &parted.methods["second"])),
            ["operators/b/inner.rs", "operators/b/mod.rs", "operators/c.rs"]
        );
        assert_eq!(files(&parted.shared), ["lib.rs", "operators/e.rs", "operators/mod.rs", "lib.rs"]);
        assert_eq!(parted.shared[&at("mod.rs")], "let all = [];", "whatever stands on the list");
    }

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
