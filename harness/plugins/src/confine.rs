//! What a plug-in cannot do: read the project, write elsewhere, talk over a network, take all memory.

use std::ffi::OsString;
use std::io;
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
    if let Err(error) = limit_memory(confinement.memory) {
        return error;
    }
    match restrict(confinement) {
        Ok(lacking) => println!("{}", serde_json::json!({ "lacking": lacking })),
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
    setrlimit(Resource::Core, Rlimit { current: Some(0), maximum: Some(0) })?;
    Ok(())
}

/// Restricts this process by Landlock, as far as the kernel goes; what it does not keep.
#[cfg(target_os = "linux")]
fn restrict(confinement: &Confinement) -> io::Result<Vec<&'static str>> {
    use landlock::{
        ABI, Access, AccessFs, AccessNet, CompatLevel, Compatible, PathBeneath, PathFd, RestrictionStatus, Ruleset, RulesetAttr,
        RulesetCreated, RulesetCreatedAttr, RulesetError, RulesetStatus,
    };

    /// Version 4 knows the network.
    const NEWEST: ABI = ABI::V5;
    fn ruleset(confinement: &Confinement) -> Result<RulesetCreated, RulesetError> {
        let rules = Ruleset::default().set_compatibility(CompatLevel::BestEffort);
        let mut rules = rules.handle_access(AccessFs::from_all(NEWEST))?.handle_access(AccessNet::from_all(NEWEST))?.create()?;
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
    let status: RestrictionStatus = ruleset(confinement).and_then(RulesetCreated::restrict_self).map_err(io::Error::other)?;
    Ok(match status.ruleset {
        RulesetStatus::FullyEnforced => Vec::new(),
        RulesetStatus::PartiallyEnforced => vec!["network"],
        RulesetStatus::NotEnforced => vec!["reading the project", "writing", "network"],
    })
}

#[cfg(not(target_os = "linux"))]
fn restrict(_: &Confinement) -> io::Result<Vec<&'static str>> {
    Ok(vec!["reading the project", "writing", "network"])
}

/// Everything but the closed folder, and of that what is open: the folders beside it and beside each that it lies in.
fn readable(confinement: &Confinement) -> Vec<PathBuf> {
    let root = PathBuf::from("/");
    let Some(closed) = &confinement.closed else { return vec![root] };
    let mut found = confinement.open.clone();
    let mut inside: &Path = closed;
    while let Some(folder) = inside.parent() {
        let beside = std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok).map(|entry| entry.path());
        found.extend(beside.filter(|path| path != inside));
        inside = folder;
    }
    found
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
    }
}
