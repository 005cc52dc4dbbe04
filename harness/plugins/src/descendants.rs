//! What a program started, wherever it went since.

use rustix::process::{Pid, Signal, kill_process};

/// So often those are looked for that were started meanwhile.
const ROUNDS: usize = 20;

/// Ends everything that comes from the process `root`, which lives; not itself.
///
/// Who loses its parent belongs to `root`, where that asked for it, so that a session or a group of one's own hides nothing.
pub fn end(root: Pid) {
    for _ in 0..ROUNDS {
        let found = of(root.as_raw_nonzero().get(), &processes());
        if found.is_empty() {
            return;
        }
        for pid in found.into_iter().filter_map(Pid::from_raw) {
            // One that has ended meanwhile is no error.
            kill_process(pid, Signal::KILL).ok();
        }
    }
}

/// The processor's time that the process `root` and all that comes from it have taken so far, s, in steps of the system's clock; `None` where the system
/// does not tell. Of those that have ended it counts what somebody waited for.
pub fn processor_seconds(root: Pid) -> Option<f64> {
    let (root, all) = (root.as_raw_nonzero().get(), processes());
    let ticks = all.iter().find(|process| process.pid == root)?.ticks;
    let below = of(root, &all);
    let others: u64 = all.iter().filter(|process| below.contains(&process.pid)).map(|process| process.ticks).sum();
    Some((ticks + others) as f64 / rustix::param::clock_ticks_per_second() as f64)
}

/// What the system says of a process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Told {
    pid: i32,
    parent: i32,
    /// The processor's time of it and of those that it waited for, in ticks of the system's clock.
    ticks: u64,
}

/// All processes that have not ended.
fn processes() -> Vec<Told> {
    let entries = std::fs::read_dir("/proc").into_iter().flatten().filter_map(Result::ok);
    entries.filter_map(|entry| parse(&std::fs::read_to_string(entry.path().join("stat")).ok()?)).collect()
}

/// A line of `stat`; the process's name may hold anything.
fn parse(line: &str) -> Option<Told> {
    let (pid, rest) = (line.split(' ').next()?.parse().ok()?, line.rsplit_once(") ")?.1);
    let mut fields = rest.split(' ');
    let state = fields.next()?;
    let parent = fields.next()?.parse().ok()?;
    // Of proc(5): the 14th to the 17th are utime, stime, cutime and cstime.
    let ticks = fields.skip(9).take(4).filter_map(|ticks| ticks.parse::<u64>().ok()).sum();
    if matches!(state, "Z" | "X") { None } else { Some(Told { pid, parent, ticks }) }
}

/// Children, their children, and so on.
fn of(root: i32, all: &[Told]) -> Vec<i32> {
    let mut found = Vec::new();
    let mut next = vec![root];
    while let Some(above) = next.pop() {
        let children =
            all.iter().filter(|told| told.parent == above && told.pid != root && !found.contains(&told.pid)).map(|told| told.pid);
        let children: Vec<i32> = children.collect();
        next.extend(&children);
        found.extend(children);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_generations_are_found_and_nobody_else() {
        let all = [(1, 0), (2, 1), (3, 2), (4, 3), (5, 1), (6, 4), (7, 2), (8, 5)].map(|(pid, parent)| Told { pid, parent, ticks: 0 });
        let mut found = of(2, &all);
        found.sort_unstable();
        assert_eq!(found, [3, 4, 6, 7]);
        assert_eq!(parse("12 (a) b (c) S 3 4 5"), Some(Told { pid: 12, parent: 3, ticks: 0 }));
        let line = "12 (a) R 3 12 12 0 -1 4194304 99 98 97 96 7 20 300 4000 20 0 1";
        assert_eq!(parse(line), Some(Told { pid: 12, parent: 3, ticks: 4327 }));
        assert_eq!((parse("12 (gone) Z 3 4"), parse("")), (None, None));
    }

    /// A child's work counts, waiting does not.
    #[test]
    fn the_processors_time_is_that_of_work() {
        use std::process::{Command, Stdio};
        let script = "sh -c 'i=0; while [ $i -lt 400000 ]; do i=$((i + 1)); done; echo done; exec sleep 31536125' & exec sleep 31536126";
        let mut root = Command::new("sh").args(["-c", script]).stdout(Stdio::piped()).spawn().unwrap();
        let pid = Pid::from_child(&root);
        let mut said = [0; 4];
        std::io::Read::read_exact(root.stdout.as_mut().unwrap(), &mut said).unwrap();
        let worked = processor_seconds(pid).unwrap();
        std::thread::sleep(std::time::Duration::from_millis(300));
        let waited = processor_seconds(pid).unwrap() - worked;
        end(pid);
        root.kill().unwrap();
        root.wait().unwrap();
        assert!(worked > 0.02 && (0.0..0.1).contains(&waited), "{worked} {waited}");
    }

    #[test]
    fn one_that_left_its_group_is_ended() {
        use std::process::Command;
        let mut root = Command::new("sh").args(["-c", "setsid sleep 31536124 & wait"]).spawn().unwrap();
        let pid = Pid::from_child(&root);
        let children = || of(pid.as_raw_nonzero().get(), &processes()).len();
        let begun = std::time::Instant::now();
        while children() == 0 && begun.elapsed().as_secs() < 10 {
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
        assert_eq!(children(), 1);
        end(pid);
        assert_eq!(children(), 0);
        root.wait().unwrap();
    }
}
