//! The program, and what it takes.

use std::error::Error;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// What a run took.
#[derive(Clone, Copy, Debug)]
pub struct Spent {
    /// Seconds.
    pub seconds: f64,
    /// Most memory that was resident, bytes; zero where the system does not say.
    pub peak: u64,
}

/// Between two looks at a running program: its peak is the last that was seen.
const PAUSE: Duration = Duration::from_millis(5);

/// Runs the program in `folder`.
///
/// # Errors
/// A program that fails, with what it said.
pub fn run(arguments: &[String], folder: &Path) -> Result<Spent, Box<dyn Error>> {
    let said = std::fs::File::create(folder.join("said.txt"))?;
    let started = Instant::now();
    let mut command = Command::new(env!("CARGO_BIN_EXE_calibench-light"));
    let mut child = command.args(arguments).current_dir(folder).stdout(Stdio::null()).stderr(said).spawn()?;
    let mut peak = 0;
    let status = loop {
        peak = peak.max(high_water(child.id()).unwrap_or(0));
        if let Some(status) = child.try_wait()? {
            break status;
        }
        std::thread::sleep(PAUSE);
    };
    if !status.success() {
        let said = std::fs::read_to_string(folder.join("said.txt"))?;
        return Err(format!("{}: {status}\n{said}", arguments.join(" ")).into());
    }
    Ok(Spent { seconds: started.elapsed().as_secs_f64(), peak })
}

/// The most memory that was resident in a running process, bytes.
fn high_water(process: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(1024 * line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?)
}
