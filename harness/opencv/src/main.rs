//! The `calibench` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    calibench_opencv::main()
}
