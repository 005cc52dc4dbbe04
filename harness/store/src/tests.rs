use std::fs;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use super::{Key, Store};

fn key(name: &str) -> Key {
    Key::of("test", [("name", name)])
}

fn put(store: &Store, name: &str, content: &[u8]) {
    let mut entry = store.create(key(name)).unwrap();
    entry.write_all(content).unwrap();
    entry.finish().unwrap();
}

fn get(store: &Store, name: &str) -> Option<Vec<u8>> {
    let mut content = Vec::new();
    let mut found = store.find(key(name))?;
    let size = found.left();
    found.read_to_end(&mut content).unwrap();
    assert_eq!(content.len() as u64, size);
    Some(content)
}

fn place(folder: &Path, name: &str) -> PathBuf {
    let name = key(name).to_string();
    folder.join(&name[..2]).join(&name[2..])
}

#[test]
fn a_key_tells_apart_whatever_differs() {
    let keys = [
        Key::of("k", [("a", "b")]),
        Key::of("l", [("a", "b")]),
        Key::of("k", [("a", "c")]),
        Key::of("k", [("ab", "")]),
        Key::of("k", [("", "ab")]),
        Key::of("k", [("a", "b"), ("", "")]),
        Key::of("ka", [("b", "")]),
        Key::of("k", []),
    ];
    for (i, a) in keys.iter().enumerate() {
        assert!(keys.iter().skip(i + 1).all(|b| a != b), "{i}");
    }
    assert_eq!(keys[0], Key::of("k", [("a", "b")]));
}

#[test]
fn what_was_put_is_found_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(&folder.path().join("deep/store"), 1 << 20, false);
    assert_eq!(get(&store, "a"), None);
    store.trim().unwrap();
    let large: Vec<u8> = (0..300_000_u32).map(|i| (i.wrapping_mul(i) >> 3) as u8).collect();
    put(&store, "a", b"one");
    put(&store, "b", &large);
    put(&store, "empty", b"");
    assert_eq!(get(&store, "a").unwrap(), b"one");
    assert_eq!(get(&store, "b").unwrap(), large);
    assert_eq!(get(&store, "empty").unwrap(), b"");
    put(&store, "a", b"another");
    assert_eq!(get(&store, "a").unwrap(), b"another");
    assert_eq!((get(&store, "c"), store.broken()), (None, 0));
    assert_eq!(fs::read_to_string(folder.path().join("deep/store/.gitignore")).unwrap(), "*\n");
}

#[test]
fn any_changed_byte_is_noticed_and_so_is_any_cut() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(folder.path(), 1 << 20, false);
    put(&store, "a", b"some result");
    let path = place(folder.path(), "a");
    let whole = fs::read(&path).unwrap();
    let mut broken = 0;
    let mut refused = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        broken += 1;
        assert_eq!((get(&store, "a"), store.broken()), (None, broken));
    };
    for place in 0..whole.len() {
        let mut bytes = whole.clone();
        bytes[place] ^= 1;
        refused(&bytes);
    }
    for length in 0..whole.len() {
        refused(&whole[..length]);
    }
    refused(&[&whole[..], b"x"].concat());
    // Another's entry, whole.
    put(&store, "b", b"some result");
    refused(&fs::read(place(folder.path(), "b")).unwrap());
    put(&store, "a", b"done anew");
    assert_eq!(get(&store, "a").unwrap(), b"done anew");
}

#[test]
fn what_is_not_finished_is_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(folder.path(), 1 << 20, false);
    let mut begun = store.create(key("a")).unwrap();
    begun.write_all(b"half").unwrap();
    assert_eq!(get(&store, "a"), None);
    drop(begun);
    assert_eq!((get(&store, "a"), store.files().unwrap().len()), (None, 0));
    // One that a killed command left stays a day.
    std::mem::forget(store.create(key("a")).unwrap());
    store.trim().unwrap();
    let left = store.files().unwrap();
    assert_eq!(left.len(), 1);
    let file = fs::File::options().append(true).open(&left[0]).unwrap();
    file.set_modified(SystemTime::now() - Duration::from_hours(25)).unwrap();
    store.trim().unwrap();
    assert_eq!(store.files().unwrap().len(), 0);
}

#[test]
fn a_fresh_one_finds_what_it_has_put_there_itself() {
    let folder = tempfile::tempdir().unwrap();
    put(&Store::open(folder.path(), 1 << 20, false), "a", b"old");
    let fresh = Store::open(folder.path(), 1 << 20, true);
    assert_eq!(get(&fresh, "a"), None);
    put(&fresh, "a", b"new");
    assert_eq!(get(&fresh, "a").unwrap(), b"new");
    assert_eq!(get(&Store::open(folder.path(), 1 << 20, false), "a").unwrap(), b"new");
}

#[test]
fn what_was_used_longest_ago_goes_first() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(folder.path(), 3 * 172, false);
    for (age, name) in [(50, "a"), (40, "b"), (30, "c"), (20, "d")] {
        put(&store, name, &[7; 100]);
        let file = fs::File::options().append(true).open(place(folder.path(), name)).unwrap();
        file.set_modified(SystemTime::now() - Duration::from_secs(age)).unwrap();
    }
    assert!(get(&store, "a").is_some(), "used now");
    store.trim().unwrap();
    let there: Vec<bool> = ["a", "b", "c", "d"].iter().map(|name| get(&store, name).is_some()).collect();
    assert_eq!(there, [true, false, true, true]);
}

#[test]
fn many_at_once_find_whole_entries_or_none() {
    let folder = tempfile::tempdir().unwrap();
    let content = |name: usize| vec![name as u8; 20_000 + name];
    std::thread::scope(|scope| {
        for _ in 0..4 {
            // As different commands: nothing is shared but the folder.
            let store = Store::open(folder.path(), 90_000, false);
            scope.spawn(move || {
                for round in 0..60 {
                    let name = round % 7;
                    match get(&store, &name.to_string()) {
                        Some(found) => assert!(found == content(name)),
                        None => put(&store, &name.to_string(), &content(name)),
                    }
                    store.trim().unwrap();
                }
                assert_eq!(store.broken(), 0);
            });
        }
    });
}
