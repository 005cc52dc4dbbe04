//! Progress: a bar on a terminal, a line elsewhere, nothing when quiet. All on standard error.

use std::io::IsTerminal;
use std::sync::LazyLock;

use indicatif::{MultiProgress, ProgressBar, ProgressStyle};

/// The bars of all tasks that run side by side, one below the other.
static BARS: LazyLock<MultiProgress> = LazyLock::new(MultiProgress::new);

/// The progress of one task.
pub struct Progress {
    bar: Option<ProgressBar>,
    line: Option<String>,
}

impl Progress {
    /// Starts a task of `steps` steps.
    pub fn start(name: &str, steps: u64, quiet: bool) -> Self {
        if quiet {
            return Self { bar: None, line: None };
        }
        if !std::io::stderr().is_terminal() {
            return Self { bar: None, line: Some(name.to_owned()) };
        }
        let style = ProgressStyle::with_template("{msg:40} {bar:30} {pos}/{len} {eta}").unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = BARS.add(ProgressBar::new(steps).with_style(style).with_message(name.to_owned()));
        Self { bar: Some(bar), line: None }
    }

    /// Starts a task of which nobody knows how many steps it has.
    pub fn counting(name: &str, quiet: bool) -> Self {
        let progress = Self::start(name, 0, quiet);
        let style = ProgressStyle::with_template("{msg:40} {spinner} {pos}").unwrap_or_else(|_| ProgressStyle::default_spinner());
        progress.bar.iter().for_each(|bar| {
            bar.unset_length();
            bar.set_style(style.clone());
        });
        progress
    }

    /// There are so many steps more.
    pub fn more(&self, steps: u64) {
        self.bar.iter().for_each(|bar| bar.inc_length(steps));
    }

    /// A step is done; from any thread.
    pub fn step(&self) {
        self.bar.iter().for_each(|bar| bar.inc(1));
    }

    /// The task is done, with this to say of it.
    pub fn finish(self, result: &str) {
        if let Some(bar) = self.bar {
            let name = bar.message();
            bar.finish_and_clear();
            BARS.suspend(|| say!("{name}: {result}"));
        }
        if let Some(name) = self.line {
            say!("{name}: {result}");
        }
    }
}
