use std::fs;
use std::io;
use std::path::Path;

use super::{MANIFEST, NewFolder, OutputFolder};

fn write(text: &'static str) -> impl FnOnce(&NewFolder) -> io::Result<()> {
    move |folder| folder.write("page", |file| file.write_all(text.as_bytes()))
}

fn replace(path: &Path, text: &'static str) -> io::Result<()> {
    OutputFolder::open(path)?.replace(write(text))
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_folder_is_replaced_whole_or_not_at_all() {
    let parent = tempfile::tempdir().unwrap();
    let place = parent.path().join("a/b");
    let failing = |folder: &NewFolder| {
        write("half")(folder)?;
        Err::<(), _>(io::Error::other("interrupted"))
    };
    assert!(OutputFolder::open(&place).unwrap().replace(failing).is_err());
    assert!(names(parent.path()).is_empty(), "the folder above was made for nothing");
    replace(&place, "old").unwrap();
    assert!(OutputFolder::open(&place).unwrap().replace(failing).is_err());
    assert_eq!(fs::read_to_string(place.join("page")).unwrap(), "old");
    replace(&place, "new").unwrap();
    assert_eq!(fs::read_to_string(place.join("page")).unwrap(), "new");
    assert_eq!((names(parent.path()), names(&parent.path().join("a"))), (vec!["a".to_owned()], vec!["b".to_owned()]));
    assert_eq!(names(&place), [MANIFEST, "page"]);
}

/// What is done to a folder of ours, and how the refusal names it.
type Change = (fn(&Path), &'static str);

#[test]
fn what_is_not_ours_is_named_and_kept() {
    let changes: [Change; 6] = [
        (|folder| fs::write(folder.join("notes.txt"), "mine").unwrap(), "since: notes.txt;"),
        (|folder| fs::write(folder.join("page"), "corrected").unwrap(), "since: page (changed);"),
        (|folder| fs::create_dir_all(folder.join("sub/sub")).unwrap(), "since: sub (a folder), sub/sub (a folder);"),
        (|folder| fs::write(folder.join("a\u{1b}[2J"), "").unwrap(), "since: a\\u{1b}[2J;"),
        (|folder| fs::write(folder.join(MANIFEST), "anything").unwrap(), "line 1: expected a digest"),
        (|folder| fs::remove_file(folder.join(MANIFEST)).unwrap(), "did not write: page;"),
    ];
    for (change, expected) in changes {
        let parent = tempfile::tempdir().unwrap();
        let place = parent.path().join("out");
        replace(&place, "old").unwrap();
        change(&place);
        let before: Vec<_> = names(&place).into_iter().map(|name| (fs::read(place.join(&name)).ok(), name)).collect();
        for error in [OutputFolder::open(&place).unwrap_err(), replace(&place, "new").unwrap_err()] {
            assert!(error.to_string().contains(expected), "{error}: {expected}");
        }
        let after: Vec<_> = names(&place).into_iter().map(|name| (fs::read(place.join(&name)).ok(), name)).collect();
        assert!(before == after && names(parent.path()) == ["out"], "{expected}");
    }
}

#[test]
fn what_comes_while_the_new_folder_is_filled_is_kept() {
    let parent = tempfile::tempdir().unwrap();
    let place = parent.path().join("out");
    replace(&place, "old").unwrap();
    let result = OutputFolder::open(&place).unwrap().replace(|folder| {
        fs::write(place.join("notes.txt"), "mine")?;
        write("new")(folder)
    });
    assert!(result.unwrap_err().to_string().contains("notes.txt"));
    assert_eq!(fs::read_to_string(place.join("page")).unwrap(), "old");
    assert_eq!(names(&place), [MANIFEST, "notes.txt", "page"]);
}

#[test]
fn names_lead_nowhere_else_and_are_there_once() {
    let parent = tempfile::tempdir().unwrap();
    let place = parent.path().join("out");
    for name in ["../page", "/page", "a/../../page", "", ".", "..", "a\nb", "a\\b", MANIFEST, "a/.calibench-manifest"] {
        let result = OutputFolder::open(&place).unwrap().replace(|folder| folder.write(name, |_| Ok::<_, io::Error>(())));
        let error = result.unwrap_err().to_string();
        assert!(error.contains("out: `") && error.contains("cannot be the name of a file"), "{name}: {error}");
    }
    let twice = |folder: &NewFolder| write("one")(folder).and_then(|()| write("two")(folder));
    let error = OutputFolder::open(&place).unwrap().replace(twice).unwrap_err().to_string();
    assert!(error.contains("out/page: two results have this name"), "{error}");
    assert!(names(parent.path()).is_empty());
    let below = |folder: &NewFolder| write("one")(folder).and_then(|()| write("two")(&folder.folder("cell")?));
    OutputFolder::open(&place).unwrap().replace(below).unwrap();
    replace(&place, "new").unwrap();
    assert_eq!(names(&place), [MANIFEST, "page"]);
}

#[test]
fn many_files_are_counted_and_a_few_named() {
    let parent = tempfile::tempdir().unwrap();
    (0..30).for_each(|i| fs::write(parent.path().join(format!("photo{i:02}.jpg")), "").unwrap());
    let error = OutputFolder::open(parent.path()).unwrap_err().to_string();
    assert!(error.contains("did not write: photo00.jpg, photo01.jpg, photo02.jpg, photo03.jpg, photo04.jpg and 25 more;"), "{error}");
}

#[cfg(unix)]
#[test]
fn links_are_followed_to_the_folder_and_never_in_it() {
    use std::os::unix::fs::symlink;
    let parent = tempfile::tempdir().unwrap();
    let at = |name: &str| parent.path().join(name);
    fs::create_dir(at("real")).unwrap();
    symlink("real", at("link")).unwrap();
    replace(&at("link"), "old").unwrap();
    assert!(at("link").is_symlink());
    assert_eq!(fs::read_to_string(at("real/page")).unwrap(), "old");
    // A link in the place of a file of ours, or of a folder, leads nowhere.
    fs::write(at("outside"), "old").unwrap();
    fs::remove_file(at("real/page")).unwrap();
    symlink(at("outside"), at("real/page")).unwrap();
    assert!(replace(&at("link"), "new").unwrap_err().to_string().contains("page (no regular file)"));
    assert_eq!(fs::read_to_string(at("outside")).unwrap(), "old");
    symlink("nowhere", at("dangling")).unwrap();
    assert!(replace(&at("dangling"), "new").unwrap_err().to_string().contains("link to nothing"));
}

#[cfg(unix)]
#[test]
fn what_is_write_protected_stays_and_other_permissions_are_kept() {
    use std::os::unix::fs::PermissionsExt;
    let parent = tempfile::tempdir().unwrap();
    let place = parent.path().join("out");
    let protect = |path: &Path, mode| fs::set_permissions(path, fs::Permissions::from_mode(mode)).unwrap();
    replace(&place, "old").unwrap();
    protect(&place.join("page"), 0o444);
    assert!(replace(&place, "new").unwrap_err().to_string().contains("page (write-protected)"));
    protect(&place.join("page"), 0o644);
    protect(&place, 0o555);
    assert!(replace(&place, "new").unwrap_err().to_string().contains("is write-protected"));
    protect(&place, 0o700);
    replace(&place, "new").unwrap();
    assert_eq!(fs::metadata(&place).unwrap().permissions().mode() & 0o777, 0o700);
}

#[test]
fn folders_of_older_versions_are_known() {
    for files in [&[".calibench-output", "page"][..], &["records.csv", "scenario.toml", "view.png"]] {
        let parent = tempfile::tempdir().unwrap();
        files.iter().for_each(|name| fs::write(parent.path().join(name), "").unwrap());
        let error = replace(parent.path(), "new").unwrap_err().to_string();
        assert!(error.contains("older calibench"), "{error}");
    }
}

#[test]
fn two_write_side_by_side_and_nothing_of_them_stays() {
    let parent = tempfile::tempdir().unwrap();
    let at = |name: &str| parent.path().join(name);
    let outer = OutputFolder::open(&at("a")).unwrap().replace(|folder| {
        replace(&at("b"), "b")?;
        write("a")(folder)
    });
    outer.unwrap();
    assert_eq!(names(parent.path()), ["a", "b"]);
    assert_eq!(fs::read_to_string(at("a/page")).unwrap(), "a");
}

#[test]
fn the_folder_that_the_process_is_in_stays() {
    let error = OutputFolder::open(Path::new(".")).unwrap_err().to_string();
    assert!(error.contains("the folder that you are in"), "{error}");
    assert!(OutputFolder::open(Path::new("/")).is_err());
}

#[test]
fn what_is_filled_waits_until_it_is_put_or_is_gone() {
    let parent = tempfile::tempdir().unwrap();
    let (a, b) = (parent.path().join("a"), parent.path().join("b"));
    replace(&a, "old").unwrap();
    let fill = |path: &Path| OutputFolder::open(path).unwrap().filled(write("new")).unwrap();
    let page = || fs::read_to_string(a.join("page")).unwrap();
    drop((fill(&a), fill(&b)));
    assert_eq!((page().as_str(), names(parent.path())), ("old", vec!["a".to_owned()]));
    let both = [fill(&a), fill(&b)];
    assert_eq!(page(), "old");
    both.into_iter().for_each(|filled| filled.put().unwrap());
    assert_eq!((page().as_str(), names(parent.path())), ("new", vec!["a".to_owned(), "b".to_owned()]));
    // What comes in between is seen.
    let filled = fill(&a);
    fs::write(a.join("notes.txt"), "mine").unwrap();
    assert!(filled.put().unwrap_err().to_string().contains("notes.txt"));
    assert_eq!(names(&a), [MANIFEST, "notes.txt", "page"]);
}
