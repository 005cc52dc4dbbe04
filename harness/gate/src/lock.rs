//! One lock on a folder of baselines: many compare with them at once, one blesses.

use std::fs::{File, TryLockError};
use std::io;
use std::path::Path;

/// What is to be done with the baselines while they are locked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Comparing, as others may.
    Compare,
    /// Replacing, alone.
    Bless,
}

/// A lock on a folder, until it is dropped. The system lets go of it with the process, however that ends.
#[derive(Debug)]
pub struct Lock {
    _folder: Option<File>,
}

impl Lock {
    /// Locks the existing `folder` itself, which no write replaces. Waits for others, having said so by `waiting`. Where a folder cannot be locked, as on some file
    /// systems, it stays unlocked.
    ///
    /// # Errors
    /// A wait that the system ends.
    pub fn take(folder: &Path, access: Access, waiting: impl FnOnce()) -> io::Result<Self> {
        let Ok(file) = File::open(folder) else { return Ok(Self { _folder: None }) };
        let tried = match access {
            Access::Compare => file.try_lock_shared(),
            Access::Bless => file.try_lock(),
        };
        match tried {
            Ok(()) => Ok(Self { _folder: Some(file) }),
            Err(TryLockError::Error(_)) => Ok(Self { _folder: None }),
            Err(TryLockError::WouldBlock) => {
                waiting();
                match access {
                    Access::Compare => file.lock_shared()?,
                    Access::Bless => file.lock()?,
                }
                Ok(Self { _folder: Some(file) })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;
    use std::time::Duration;

    use super::*;

    #[test]
    fn many_compare_at_once_and_who_blesses_is_alone() {
        let folder = tempfile::tempdir().unwrap();
        let take = |access| Lock::take(folder.path(), access, || ()).unwrap();
        for (held, wanted) in [(Access::Bless, Access::Bless), (Access::Compare, Access::Bless), (Access::Bless, Access::Compare)] {
            let first = take(held);
            let (sent, said) = channel();
            std::thread::scope(|scope| {
                let path = folder.path();
                scope.spawn(move || {
                    let waiting = sent.clone();
                    let lock = Lock::take(path, wanted, || waiting.send("waits").unwrap());
                    sent.send(if lock.is_ok() { "has it" } else { "failed" }).unwrap();
                });
                assert_eq!(said.recv_timeout(Duration::from_mins(1)), Ok("waits"), "{held:?} {wanted:?}");
                assert!(said.recv_timeout(Duration::from_millis(50)).is_err(), "{held:?} {wanted:?}: not while it is held");
                drop(first);
                assert_eq!(said.recv_timeout(Duration::from_mins(1)), Ok("has it"), "{held:?} {wanted:?}");
            });
        }
        let _both = [take(Access::Compare), Lock::take(folder.path(), Access::Compare, || panic!("nobody waits for readers")).unwrap()];
    }
}
