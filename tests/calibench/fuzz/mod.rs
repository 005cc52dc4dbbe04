//! Readers and files that are not quite what they should be: none panics, hangs, or answers with words that command a terminal.
//!
//! A short run is a test. `just fuzz` runs longer: `CALIBENCH_FUZZ_SECONDS` for each reader, from `CALIBENCH_FUZZ_SEED`, of which the same gives the same
//! files; `CALIBENCH_FUZZ_READER` names one alone. A file that a reader failed at is kept in the folder that the message names; as a new file in `seeds/`
//! it is tried by every run.

mod mutate;
mod readers;

use std::env;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use readers::{READERS, Reader};

/// Files for a reader in a short run.
const SHORT: usize = 400;
/// The seed without another one.
const SEED: u64 = 15;
/// A reader that takes longer for a file hangs.
const HANGS: Duration = Duration::from_secs(20);

fn variable(name: &str) -> Option<u64> {
    let text = env::var(format!("CALIBENCH_FUZZ_{name}")).ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("CALIBENCH_FUZZ_{name}: expected a whole number, found `{text}`")))
}

/// The files below `seeds/` of a reader, by name.
fn seeds(reader: &Reader) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("calibench/fuzz/seeds").join(reader.seeds);
    let mut files: Vec<PathBuf> = fs::read_dir(&folder).expect("seeds").map(|entry| entry.expect("a seed").path()).collect();
    files.sort();
    files.into_iter().map(|path| (path.clone(), fs::read(path).expect("a seed"))).collect()
}

/// What is wrong with how a reader takes a file, in words.
fn fault(reader: &Reader, bytes: &[u8], folder: &Path) -> Option<String> {
    match catch_unwind(AssertUnwindSafe(|| (reader.read)(bytes, folder))) {
        Err(_) => Some("panics".to_owned()),
        Ok(Err(words)) if words.chars().any(|c| c.is_control() && !"\n\t".contains(c)) => Some(format!("commands a terminal: {words:?}")),
        Ok(Err(words)) if words.trim().is_empty() => Some("fails without a word".to_owned()),
        Ok(_) => None,
    }
}

/// Files of a reader one after the other, until `most` or the end of the time.
fn files(reader: &Reader, seed: u64, most: Option<usize>, until: Instant) -> impl Iterator<Item = Vec<u8>> {
    let seeds: Vec<Vec<u8>> = seeds(reader).into_iter().map(|(_, bytes)| bytes).collect();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mutated = std::iter::repeat_with({
        let seeds = seeds.clone();
        move || {
            let [one, other] = [0; 2].map(|_| &seeds[random.random_range(0..seeds.len())]);
            mutate::mutated(&mut random, one, other)
        }
    });
    seeds.into_iter().chain(mutated).take(most.unwrap_or(usize::MAX)).take_while(move |_| Instant::now() < until)
}

/// Keeps a file that a reader fails at, and says where.
fn keep(reader: &Reader, bytes: &[u8], why: &str) -> String {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz");
    let name = format!(
        "{}-{:016x}",
        reader.name,
        bytes.iter().fold(0xcbf2_9ce4_8422_2325_u64, |h, b| (h ^ u64::from(*b)).wrapping_mul(0x0100_0000_01b3))
    );
    fs::create_dir_all(&folder).and_then(|()| fs::write(folder.join(&name), bytes)).expect("a file");
    format!("{} {why}: {}", reader.name, folder.join(name).display())
}

/// Runs one reader on a thread of its own, so that a file at which it hangs is known. Returns how many files there were, and the faults.
fn run(reader: &'static Reader, seed: u64, most: Option<usize>, time: Duration) -> (usize, Vec<String>) {
    let (sender, receiver) = channel::<Option<Vec<u8>>>();
    let (found, faults) = channel();
    thread::spawn(move || {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let until = Instant::now() + time;
        for bytes in files(reader, seed, most, until) {
            sender.send(Some(bytes.clone())).ok();
            fault(reader, &bytes, folder.path()).into_iter().for_each(|why| drop(found.send((bytes.clone(), why))));
        }
        sender.send(None).ok();
    });
    let (mut count, mut last) = (0, Vec::new());
    let mut wrong = Vec::new();
    loop {
        match receiver.recv_timeout(HANGS) {
            Ok(Some(bytes)) => (count, last) = (count + 1, bytes),
            Ok(None) | Err(RecvTimeoutError::Disconnected) => break,
            Err(RecvTimeoutError::Timeout) => {
                wrong.push(keep(reader, &last, "hangs"));
                break;
            }
        }
    }
    wrong.extend(faults.try_iter().map(|(bytes, why)| keep(reader, &bytes, &why)));
    (count, wrong)
}

#[test]
fn no_reader_panics_or_hangs() {
    let seconds = variable("SECONDS");
    let (most, time) = seconds.map_or((Some(SHORT), Duration::from_mins(10)), |seconds| (None, Duration::from_secs(seconds)));
    let alone = env::var("CALIBENCH_FUZZ_READER").ok();
    let chosen: Vec<&Reader> = READERS.iter().filter(|reader| alone.as_ref().is_none_or(|name| name == reader.name)).collect();
    let known: Vec<&str> = READERS.iter().map(|reader| reader.name).collect();
    assert!(!chosen.is_empty(), "CALIBENCH_FUZZ_READER: expected one of {}", known.join(", "));
    let mut wrong = Vec::new();
    for reader in chosen {
        let (count, faults) = run(reader, variable("SEED").unwrap_or(SEED), most, time);
        println!("{}: {count} files, {} faults", reader.name, faults.len());
        wrong.extend(faults);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Files that are refused at the door would test nothing.
#[test]
fn every_reader_has_seeds_that_it_reads() {
    let folder = tempfile::tempdir().unwrap();
    for reader in &READERS {
        let read = seeds(reader).iter().filter(|(_, bytes)| (reader.read)(bytes, folder.path()).is_ok()).count();
        assert!(read > 0, "{}: none of its seeds is read", reader.name);
    }
    let formats: Vec<&str> = seeds(&READERS[0])
        .iter()
        .filter_map(|(_, bytes)| {
            let sized = calibench_cameras::ReadOptions {
                size: Some(calibench_model::camera::ImageSize { width: 640, height: 480 }),
                ..calibench_cameras::ReadOptions::default()
            };
            calibench_cameras::parse_camera("f", bytes, &sized).ok().map(|file| file.format.name)
        })
        .collect();
    for format in calibench_cameras::FORMATS {
        assert!(formats.contains(&format.name), "no seed of {}", format.name);
    }
}

/// The same seed, the same files: a fault can be looked for again.
#[test]
fn files_are_the_same_again() {
    let later = Instant::now() + Duration::from_mins(10);
    let all = |seed| files(&READERS[0], seed, Some(200), later).collect::<Vec<_>>();
    assert!(all(1) == all(1) && all(1) != all(2));
}
