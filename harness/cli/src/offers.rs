//! Values that shells offer where an option takes a name: of methods, of camera models, of what `convert` writes.

use calibench_calibrate::MODELS;
use calibench_cameras::FORMATS;
use calibench_cameras::target::TARGETS;
use calibench_measure::Registry;
use clap::Command;
use clap::builder::PossibleValuesParser;

/// Options that take a method, by command and by what the option is called within it.
const METHODS: [(&str, &str); 6] =
    [("calibrate", "method"), ("judge", "methods"), ("measure", "methods"), ("point", "method"), ("run", "methods"), ("speed", "methods")];
/// Options that take what a camera file is converted to.
const CONVENTIONS: [(&str, &str); 3] = [("calibrate", "to"), ("convert", "to"), ("undistort", "camera_format")];
/// Options that take a camera model.
const CAMERAS: [(&str, &str); 2] = [("calibrate", "model"), ("judge", "models")];
/// Options with words of their own.
const OWN: [(&str, &str, &[&str]); 2] =
    [("calibrate", "board_shape", &["tested", "flat", "bent", "bent-axes", "free"]), ("calibrate", "datum", &["control", "fixed", "free"])];

/// `command` with values to offer. Only to be asked for completions: what an option takes may be more than these, as a method with parameters is.
pub fn with_offers(command: Command, registry: &Registry) -> Command {
    let methods: Vec<&'static str> = registry.methods().iter().map(|method| method.name).collect();
    let mut conventions: Vec<&'static str> = TARGETS.iter().map(|(name, _)| *name).collect();
    conventions.extend(FORMATS.iter().filter(|format| format.is_written()).map(|format| format.name));
    conventions.sort_unstable();
    conventions.dedup();
    let all = METHODS.iter().map(|(command, option)| (*command, *option, methods.clone()));
    let all = all.chain(CONVENTIONS.iter().map(|(command, option)| (*command, *option, conventions.clone())));
    let all = all.chain(CAMERAS.iter().map(|(command, option)| (*command, *option, MODELS.to_vec())));
    let all = all.chain(OWN.iter().map(|(command, option, words)| (*command, *option, words.to_vec())));
    all.fold(command, |command, (name, option, values)| {
        command.mut_subcommand(name, |one| one.mut_arg(option, |option| option.value_parser(PossibleValuesParser::new(values))))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command_line;

    #[test]
    fn shells_are_told_names() {
        let offered = with_offers(command_line(), &Registry::builtin());
        let values = |command: &str, option: &str| {
            let command = offered.find_subcommand(command).unwrap();
            let option = command.get_arguments().find(|argument| argument.get_long() == Some(option)).unwrap();
            option.get_possible_values().iter().map(|value| value.get_name().to_owned()).collect::<Vec<_>>()
        };
        for (command, option, name) in [
            ("measure", "method", "forstner"),
            ("judge", "method", "parametric_corner"),
            ("run", "method", "lsm"),
            ("convert", "to", "kalibr"),
            ("calibrate", "to", "opencv8"),
            ("calibrate", "model", "opencv5"),
            ("calibrate", "board-shape", "bent"),
        ] {
            assert!(values(command, option).contains(&name.to_owned()), "{command} --{option}: {:?}", values(command, option));
        }
    }
}
