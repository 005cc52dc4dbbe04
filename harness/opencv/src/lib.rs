//! OpenCV's methods: the operators of `calibench-measure` with OpenCV's beside them, and a chessboard detector.

pub mod boards;
pub mod calibrate_camera;
pub mod chessboard;
pub mod chessboard_sb;
mod lapack;
pub mod subpix;

use calibench_measure::{BoardDetector, Registry};
pub use lapack::lapack;

/// Every method of this build: ours and OpenCV's.
pub fn registry() -> Registry {
    let own = [subpix::method(), chessboard_sb::method()];
    own.into_iter().chain(boards::methods()).fold(Registry::builtin(), Registry::with)
}

/// The detector of chessboards.
pub fn detector() -> impl BoardDetector {
    chessboard::ChessboardDetector
}

/// OpenCV's own version, as in `4.6.0`: that of the library in use.
pub fn version() -> String {
    opencv::core::get_version_string().unwrap_or_else(|_| "unknown".into())
}

/// Binds OpenCV's own threads, those of the whole process, to `threads`; a version that cannot be bound stays as it is.
pub fn bind_threads(threads: usize) {
    if let Ok(threads) = i32::try_from(threads) {
        opencv::core::set_num_threads(threads).ok();
    }
}

/// The command line with everything that this build can do.
pub fn main() -> std::process::ExitCode {
    calibench_cli::main(&calibench_cli::Toolbox {
        registry: registry(),
        detector: Some(Box::new(detector())),
        solver: Some(Box::new(calibrate_camera::CalibrateCamera)),
        bind_threads: Some(bind_threads),
        code: option_env!("CALIBENCH_OPENCV_CODE"),
    })
}

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opencv_starts_as_many_threads_as_it_may() {
        let before = opencv::core::get_num_threads().unwrap();
        for threads in [1, 2, 1] {
            bind_threads(threads);
            assert_eq!(opencv::core::get_num_threads().unwrap(), threads as i32);
        }
        bind_threads(before as usize);
    }
}
