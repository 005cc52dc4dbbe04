//! The linear algebra behind OpenCV's solvers.

/// Names that the libraries have in which OpenCV may find LAPACK.
const LIBRARIES: [&str; 4] = ["liblapack", "libopenblas", "libmkl", "libatlas"];

/// The LAPACK that this process uses, as folder and file, as in `lapack/liblapack.so.3.11.0`; `None` where it cannot be told.
///
/// Systems exchange it under OpenCV (Debian: `update-alternatives`), and with it the last digits of where a solver stops: of `calibrateCamera` on ten views of a board
/// 1e-7 of its error between the reference LAPACK and OpenBLAS, which takes other ways on other processors, too.
pub fn lapack() -> Option<String> {
    of_maps(&std::fs::read_to_string("/proc/self/maps").ok()?)
}

fn of_maps(maps: &str) -> Option<String> {
    let path = |line: &str| line.find('/').map(|at| line[at..].to_owned());
    let named = |path: &String| path.rsplit('/').next().is_some_and(|file| LIBRARIES.iter().any(|library| file.starts_with(library)));
    let path = maps.lines().filter_map(path).find(named)?;
    let mut parts = path.rsplit('/');
    let (file, folder) = (parts.next()?, parts.next()?);
    Some(format!("{folder}/{file}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_library_is_named_by_folder_and_file() {
        let maps = "7f00-7f01 r--p 00000000 fe:00 1 /usr/lib/x86_64-linux-gnu/libopencv_core.so.4.6.0\n\
                    7f02-7f03 r--p 00000000 fe:00 2    /usr/lib/x86_64-linux-gnu/openblas-pthread/liblapack.so.3\n\
                    7f04-7f05 r--p 00000000 00:00 0\n";
        assert_eq!(of_maps(maps).as_deref(), Some("openblas-pthread/liblapack.so.3"));
        assert_eq!(of_maps("7f04-7f05 r--p 00000000 00:00 0 [heap]\n"), None);
    }

    #[test]
    fn this_process_has_one_if_opencv_was_built_with_it() {
        let built = opencv::core::get_build_information().unwrap_or_default();
        let uses = built.lines().any(|line| line.trim_start().starts_with("Lapack:") && line.contains("YES"));
        assert!(!uses || lapack().is_some(), "{:?}", lapack());
    }
}
