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

/// All processes that have not ended: each with its parent.
fn processes() -> Vec<(i32, i32)> {
    let entries = std::fs::read_dir("/proc").into_iter().flatten().filter_map(Result::ok);
    entries.filter_map(|entry| parse(&std::fs::read_to_string(entry.path().join("stat")).ok()?)).collect()
}

/// Process and parent of a line of `stat`; its name may hold anything.
fn parse(line: &str) -> Option<(i32, i32)> {
    let (pid, rest) = (line.split(' ').next()?.parse().ok()?, line.rsplit_once(") ")?.1);
    let mut fields = rest.split(' ');
    let state = fields.next()?;
    if matches!(state, "Z" | "X") { None } else { Some((pid, fields.next()?.parse().ok()?)) }
}

/// Children, their children, and so on.
fn of(root: i32, all: &[(i32, i32)]) -> Vec<i32> {
    let mut found = Vec::new();
    let mut next = vec![root];
    while let Some(parent) = next.pop() {
        let children = all.iter().filter(|(pid, of)| *of == parent && *pid != root && !found.contains(pid)).map(|(pid, _)| *pid);
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
        let mut found = of(2, &[(1, 0), (2, 1), (3, 2), (4, 3), (5, 1), (6, 4), (7, 2), (8, 5)]);
        found.sort_unstable();
        assert_eq!(found, [3, 4, 6, 7]);
        assert_eq!(parse("12 (a) b (c) S 3 4 5"), Some((12, 3)));
        assert_eq!((parse("12 (gone) Z 3 4"), parse("")), (None, None));
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
