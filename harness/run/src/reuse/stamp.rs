//! Records that are as a run would write them.

use std::fs;
use std::io::{Read, Write};
use std::path::Path;

use calibench_files::at;
use calibench_files::folder::{MANIFEST, digest, intact};
use calibench_scenario::Subject;
use calibench_store::Key;

use super::{Reuse, keys};
use crate::Plan;

/// What the records of a run in a folder depend on.
#[derive(Clone, Copy)]
pub struct Stamp<'a> {
    reuse: Reuse<'a>,
    key: Key,
}

/// Digests of files that are kept with the records, or that a judgement reads.
fn files(plan: &Plan<'_>) -> String {
    let file = match &plan.scenario.subject {
        Subject::Views(views) => return views.files().map(|file| digest(file).unwrap_or_else(|_| "none".into())).collect(),
        Subject::Photographs(subject) => {
            let published = subject.judgement.as_ref().and_then(|judgement| judgement.published.as_ref());
            published.map(|file| plan.folder_of(subject).join(file))
        }
        Subject::Scene(_) | Subject::Printed(_) => None,
    };
    // One that is not there is told by the judgement, and may come.
    file.map_or_else(String::new, |file| digest(&file).unwrap_or_else(|_| "none".into()))
}

impl<'a> Stamp<'a> {
    /// Of a run of `plans`, one or those of cells, that writes into `folder` with the words of the scenario's `text` and from the file `origin`. `None` without a store, and
    /// where a method is asked for of which nobody knows when it changes.
    pub fn of(folder: &Path, (text, origin): (&str, Option<&str>), reuse: Option<Reuse<'a>>, plans: &[Plan<'_>]) -> Option<Self> {
        let reuse = reuse?;
        let folder = std::path::absolute(folder).ok()?;
        let mut parts = vec![
            ("folder", folder.to_str()?.to_owned()),
            ("text", text.to_owned()),
            ("origin", format!("{origin:?}")),
            ("all", super::code::digest(super::code::ALL, reuse.program).to_owned()),
        ];
        for plan in plans {
            let keys = keys::of(plan, &reuse)?;
            parts.push(("images", keys.images.to_string()));
            parts.push(("files", files(plan)));
            parts.push(("methods", format!("{:?}", plan.method_infos())));
            for method in &keys.methods {
                parts.push(("points", method.points?.to_string()));
                parts.push(("more", format!("{:?} {:?}", method.bounds, method.adjusted)));
            }
        }
        let key = Key::of("records", parts.iter().map(|(name, value)| (*name, value.as_str())));
        Some(Self { reuse, key })
    }

    /// How many points were measured by the run whose records are in `folder` now, whole, if it was this one.
    pub fn measured(&self, folder: &Path) -> Option<u64> {
        let mut content = Vec::new();
        self.reuse.store.find(self.key)?.read_to_end(&mut content).ok()?;
        let (measured, manifest) = content.split_first_chunk::<8>()?;
        (fs::read(folder.join(MANIFEST)).ok()? == manifest && intact(folder).is_ok()).then_some(u64::from_le_bytes(*measured))
    }

    /// Notes that the records in `folder` are those of this run, which measured so many points.
    pub fn put(&self, folder: &Path, measured: u64) {
        let put = || {
            let mut entry = self.reuse.store.create(self.key)?;
            entry.write_all(&measured.to_le_bytes())?;
            entry.write_all(&fs::read(folder.join(MANIFEST)).map_err(|error| at(folder, &error))?)?;
            entry.finish()
        };
        self.reuse.tally.unless_refused(put());
    }
}
