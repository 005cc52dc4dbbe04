//! The commands by what a person wants, in the help of the program.

use clap::Command;

/// What a person wants, and the commands for it. Every command is in one group.
const GROUPS: [(&str, &[&str]); 5] = [
    ("Look at photographs", &["judge", "calibrate", "twin", "detect", "measure", "point", "undistort", "print"]),
    (
        "Work with cameras and points",
        &["camera", "convert", "diff", "stmap", "control", "resect", "intersect", "orient", "accept", "task", "certificate"],
    ),
    ("Compare methods", &["run", "report", "plot", "records", "show", "render", "merge", "league", "speed"]),
    ("Keep accuracy from regressing", &["check", "bless", "init", "gate-power", "plugin"]),
    ("Learn more", &["demo", "list", "schema", "completions", "man", "help"]),
];

/// What to begin with.
const FIRST: &str = "\
Begin with photographs of a board, six or more, in a folder:
  calibench judge photos --board 9x6:25 --report judged
  calibench calibrate photos --board 9x6:25 -o camera.yaml --report calibrated
9x6:25 is a chessboard of 9 x 6 inner corners whose squares have sides of 25; `calibench print --board 9x6:25` writes one.
`calibench COMMAND --help` shows the options of a command, and examples.";

/// `command` with a help that has its commands in groups.
pub fn with_groups(command: Command) -> Command {
    let template =
        format!("{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{}Options:\n{{options}}{{after-help}}", listed(&command));
    command.help_template(template).after_help(FIRST)
}

/// A line for each command, in groups.
fn listed(command: &Command) -> String {
    let about = |name: &str| match command.find_subcommand(name).and_then(Command::get_about) {
        Some(about) => about.to_string(),
        // clap's own.
        None => "Print this message or the help of a command".into(),
    };
    let line = |name: &&str| format!("  {name:11} {}\n", about(name));
    GROUPS.map(|(title, names)| format!("{title}:\n{}\n", names.iter().map(line).collect::<String>())).concat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command_line;

    #[test]
    fn every_command_is_in_one_group() {
        let line = command_line();
        let shown = line.get_subcommands().filter(|one| !one.is_hide_set()).map(Command::get_name);
        let mut named: Vec<&str> = GROUPS.iter().flat_map(|(_, names)| names.iter().copied()).collect();
        assert_eq!(named[..2], ["judge", "calibrate"]);
        let mut all: Vec<&str> = shown.chain(["help"]).collect();
        named.sort_unstable();
        all.sort_unstable();
        assert_eq!(named, all);
    }

    #[test]
    fn a_line_is_a_command_and_fits_a_terminal() {
        let help = command_line().render_help().to_string();
        for (title, names) in GROUPS {
            let place = help.find(&format!("{title}:\n")).unwrap_or_else(|| panic!("{title}: {help}"));
            let lines: Vec<&str> = help[place..].lines().skip(1).take(names.len()).collect();
            for (line, name) in lines.iter().zip(names) {
                assert!(line.starts_with(&format!("  {name} ")) && line.len() <= 100, "{line}");
            }
        }
        assert!(!help.contains('{') && help.contains("  calibench judge photos --board 9x6:25 --report judged\n"), "{help}");
    }
}
