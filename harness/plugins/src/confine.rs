//! What a plug-in cannot do: read the project or what other processes were called with, write elsewhere, talk over TCP, signal others, take all memory.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::io::{self, Write};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::Command;

use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};

/// The restrictions of a plug-in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Confinement {
    /// The folder that it may write in, and in no other.
    pub scratch: PathBuf,
    /// The folder that it may not read, if there is one: the project, with its scenarios and truth.
    pub closed: Option<PathBuf>,
    /// What it may read below that folder: its own files.
    pub open: Vec<PathBuf>,
    /// How much memory it may have, bytes.
    pub memory: u64,
}

/// Restricts this process, says on standard output in one line what it could not keep, and becomes `command`.
///
/// # Errors
/// Only of failing: what the system says of the restriction, or of the program that cannot be started.
pub fn confine_and_execute(confinement: &Confinement, command: &[OsString]) -> io::Error {
    let [program, arguments @ ..] = command else { return io::Error::other("no program") };
    if let Err(error) = limit_memory(confinement.memory).and_then(|()| keep_children()) {
        return error;
    }
    match restrict(confinement) {
        Ok(lacking) => {
            if let Err(error) = writeln!(io::stdout(), "{}", serde_json::json!({ "lacking": lacking })) {
                return error;
            }
        }
        Err(error) => return error,
    }
    Command::new(program).args(arguments).exec()
}

fn limit_memory(bytes: u64) -> io::Result<()> {
    let within = |limit: Rlimit| Rlimit {
        current: Some(limit.maximum.map_or(bytes, |most| most.min(bytes))),
        maximum: Some(limit.maximum.map_or(bytes, |most| most.min(bytes))),
    };
    setrlimit(Resource::Data, within(getrlimit(Resource::Data)))?;
    // Files that lie in memory count as files.
    setrlimit(Resource::Fsize, within(getrlimit(Resource::Fsize)))?;
    setrlimit(Resource::Core, Rlimit { current: Some(0), maximum: Some(0) })?;
    Ok(())
}

/// Who loses the process that started it belongs to this one: it is found when all of them are ended.
#[cfg(target_os = "linux")]
fn keep_children() -> io::Result<()> {
    Ok(rustix::process::set_child_subreaper(Some(rustix::process::getpid()))?)
}

#[cfg(not(target_os = "linux"))]
fn keep_children() -> io::Result<()> {
    Ok(())
}

/// Restricts this process by Landlock, as far as the kernel goes; what it does not keep.
#[cfg(target_os = "linux")]
fn restrict(confinement: &Confinement) -> io::Result<Vec<&'static str>> {
    use landlock::{
        ABI, Access, AccessFs, AccessNet, CompatLevel, Compatible, PathBeneath, PathFd, Ruleset, RulesetAttr, RulesetCreated,
        RulesetCreatedAttr, RulesetError, Scope,
    };

    /// Version 4 knows the network, version 6 signals and sockets without a file.
    const NEWEST: ABI = ABI::V6;
    /// What is not kept: of what this kernel would have to be asked for.
    fn lacking() -> Vec<&'static str> {
        let hard = || Ruleset::default().set_compatibility(CompatLevel::HardRequirement);
        let kept = [
            ("reading the project and other processes", hard().handle_access(AccessFs::from_all(ABI::V1)).is_ok()),
            // The third can keep files from being cut off.
            ("writing", hard().handle_access(AccessFs::from_all(ABI::V3)).is_ok()),
            ("network", hard().handle_access(AccessNet::from_all(ABI::V4)).is_ok()),
            ("signals and abstract sockets", hard().scope(Scope::from_all(ABI::V6)).is_ok()),
        ];
        kept.iter().filter(|(_, kept)| !kept).map(|(what, _)| *what).collect()
    }
    fn ruleset(confinement: &Confinement) -> Result<RulesetCreated, RulesetError> {
        let rules = Ruleset::default().set_compatibility(CompatLevel::BestEffort);
        let rules = rules.handle_access(AccessFs::from_all(NEWEST))?.handle_access(AccessNet::from_all(NEWEST))?;
        let mut rules = rules.scope(Scope::from_all(NEWEST))?.create()?;
        let read = AccessFs::from_read(NEWEST);
        let readable = readable(confinement).into_iter().map(|path| (path, read));
        let writable = [(confinement.scratch.clone(), AccessFs::from_all(NEWEST))];
        let devices = ["/dev/null", "/dev/zero", "/dev/full"].map(|path| (PathBuf::from(path), read | AccessFs::WriteFile));
        for (path, access) in readable.chain(writable).chain(devices) {
            // What cannot be opened cannot be read either.
            let Ok(fd) = PathFd::new(&path) else { continue };
            let access = if path.is_dir() { access } else { access & AccessFs::from_file(NEWEST) };
            rules = rules.add_rule(PathBeneath::new(fd, access))?;
        }
        Ok(rules)
    }
    // Asked before anything is restricted.
    let lacking = lacking();
    ruleset(confinement).and_then(RulesetCreated::restrict_self).map_err(io::Error::other)?;
    Ok(lacking)
}

#[cfg(not(target_os = "linux"))]
fn restrict(_: &Confinement) -> io::Result<Vec<&'static str>> {
    Ok(vec!["reading the project and other processes", "writing", "network", "signals and abstract sockets"])
}

/// Where the system shows its processes: the command line of each, which names scenarios.
const PROCESSES: &str = "/proc";

/// Everything but the closed folder and other processes: what is open, the folders beside what is closed, and those beside each folder that it lies in. Of processes
/// only this one can be read, which becomes the program.
fn readable(confinement: &Confinement) -> Vec<PathBuf> {
    let processes = Path::new(PROCESSES);
    let closed: Vec<&Path> = confinement.closed.as_deref().into_iter().chain([processes]).collect();
    let above: BTreeSet<&Path> = closed.iter().flat_map(|closed| closed.ancestors().skip(1)).collect();
    let listed = |folder: &Path| std::fs::read_dir(folder).into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path()));
    let beside = above.iter().flat_map(|folder| listed(folder)).filter(|path| !above.contains(&**path) && !closed.contains(&&**path));
    let is_process = |path: &PathBuf| path.file_name().is_some_and(|name| name.to_string_lossy().bytes().all(|byte| byte.is_ascii_digit()));
    beside.chain(listed(processes).filter(|path| !is_process(path))).chain(confinement.open.iter().cloned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_but_the_closed_folder_can_be_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().canonicalize().unwrap();
        for name in ["project/scenarios", "project/methods", "beside"] {
            std::fs::create_dir_all(path.join(name)).unwrap();
        }
        let closed = Some(path.join("project"));
        let confinement = Confinement { scratch: path.clone(), closed, open: vec![path.join("project/methods")], memory: 1 };
        let found = readable(&confinement);
        assert!(found.contains(&path.join("project/methods")) && found.contains(&path.join("beside")));
        assert!(found.contains(&PathBuf::from("/usr")), "what lies further off");
        assert!(!found.iter().any(|open| path.join("project/scenarios").starts_with(open)), "{found:?}");
        let parent = PathBuf::from(format!("/proc/{}", rustix::process::getpid()));
        for confinement in [Confinement { closed: None, ..confinement.clone() }, confinement] {
            let found = readable(&confinement);
            assert!(!found.iter().any(|open| parent.starts_with(open)), "{found:?}");
            assert!(found.iter().any(|open| path.join("beside").starts_with(open)), "{found:?}");
        }
    }
}
