//! A declared plug-in among the methods.

use std::path::Path;
use std::sync::Arc;

use calibench_measure::{Build, Method, Operator, Outside, Settings};

use crate::declaration::{Declaration, Mode, leak};
use crate::operator::Asked;
use crate::program::{Launcher, Program};
use crate::told::short;

/// A declared plug-in as a method. `folder` is that of its file.
pub fn method(declaration: Declaration, folder: &Path, launcher: &Launcher) -> Method {
    let (name, about) = (leak(declaration.name.clone()), leak(declaration.about.clone()));
    let (source, parameters) = (leak(declaration.source.clone()), Box::leak(declaration.parameters.clone().into_boxed_slice()));
    let program = Arc::new(Program::new(declaration, folder, launcher.clone()));
    let files = program.files.clone();
    let asked = |program: &Arc<Program>, settings: &Settings| Box::new(Asked::new(program.clone(), settings.clone()));
    if let Mode::Folder { version } = &program.declaration.mode {
        // It is not started before there is an image.
        let version = format!("{} ({files})", short(version));
        let known = version.clone();
        let build = move |settings: &Settings| {
            let operator = program.lacking().map_or_else(|| Ok(asked(&program, settings) as Box<dyn Operator>), Err);
            Ok(Outside { version: known.clone(), operator })
        };
        return Method { name, about, source, version, parameters, build: Build::Outside(Arc::new(build)) };
    }
    let build = move |settings: &Settings| match program.process(settings) {
        Ok(started) => {
            let version = format!("{} ({})", started.version, program.files);
            program.keep(settings, started);
            Ok(Outside { version, operator: Ok(asked(&program, settings)) })
        }
        Err(fault) => Ok(Outside { version: format!("? ({})", program.files), operator: Err(short(&fault.message)) }),
    };
    Method { name, about, source, version: format!("? ({files})"), parameters, build: Build::Outside(Arc::new(build)) }
}
