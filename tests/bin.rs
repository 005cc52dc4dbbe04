//! The full program, built beside the tests so that they find it.

use std::process::ExitCode;

fn main() -> ExitCode {
    calibench_opencv::main()
}
