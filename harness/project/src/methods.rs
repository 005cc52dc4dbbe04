//! Methods by their names, as users write them.

use calibench_diagnostics::nearest;
use calibench_measure::coverage::distinct;
use calibench_measure::{Configured, KindsError, MethodError};
use calibench_model::TargetKind;

use crate::{Project, ProjectError};

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pictured {
    /// What a scenario renders: methods as published.
    Renders,
    /// Photographs, in which there is more than targets.
    Photographs,
}

impl Project<'_> {
    /// The method that `text` names.
    ///
    /// # Errors
    /// A text that names none, with the nearest name for a misspelt one.
    pub fn method(&self, text: &str, pictured: Pictured) -> Result<Configured, ProjectError> {
        let registry = self.registry_with(text)?;
        let parsed = match pictured {
            Pictured::Renders => registry.parse(text),
            Pictured::Photographs => registry.parse_for_photographs(text),
        };
        let method = parsed.map_err(|error| {
            let proposal = match &error {
                MethodError::UnknownMethod { name, known } => nearest(name, known.iter().map(String::as_str)),
                MethodError::Kinds { error: KindsError::Unknown(unknown), .. } => {
                    nearest(&unknown.0, TargetKind::ALL.map(TargetKind::name))
                }
                MethodError::UnknownParameter { key, known, .. } => nearest(key, known.iter().map(String::as_str)),
                _ => None,
            };
            let proposal = proposal.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            ProjectError::Asked(format!("-m {text}: {error}{proposal}"))
        })?;
        match pictured {
            Pictured::Photographs if method.recorded().is_some() => Err(ProjectError::Asked(format!(
                "-m {text}: a file of positions measures nothing; it is for `run` with the scenario of its images (`judge` and `calibrate` take positions of photographs by --points)"
            ))),
            Pictured::Photographs if method.board_finder().is_some() => Err(ProjectError::Asked(format!(
                "-m {text}: it finds boards in whole images and measures no point from a start; it is for `run`, where the truth is known (`calibench detect` finds boards in photographs, which any other method then measures)"
            ))),
            _ => Ok(method),
        }
    }

    /// As [`Self::method`], for the points of a board in photographs, which are of the kind `wanted`.
    ///
    /// # Errors
    /// As [`Self::method`]; one that is limited to other kinds of targets.
    pub fn method_of_boards(&self, text: &str, wanted: TargetKind) -> Result<Configured, ProjectError> {
        let method = self.method(text, Pictured::Photographs)?;
        match method.kinds.as_ref().filter(|_| !method.measures(Some(wanted))) {
            Some(kinds) => Err(ProjectError::Asked(format!(
                "-m {text}: limited to targets of the kind `{kinds}`, and a board has none; expected `{wanted}` among the kinds, or no kinds"
            ))),
            None => Ok(method),
        }
    }

    /// As [`Self::method_of_boards`], of these names, none of them twice.
    ///
    /// # Errors
    /// As [`Self::method_of_boards`]; one that is asked for twice.
    pub fn methods_of_boards(&self, texts: &[String], wanted: TargetKind) -> Result<Vec<Configured>, ProjectError> {
        let methods = texts.iter().map(|text| self.method_of_boards(text, wanted)).collect::<Result<Vec<_>, _>>()?;
        let twice = methods.iter().enumerate().find(|(i, method)| methods[..*i].iter().any(|earlier| earlier.label == method.label));
        match twice {
            Some((_, method)) => Err(ProjectError::Asked(format!("-m {}: asked for twice; expected each once", method.label))),
            None => Ok(methods),
        }
    }

    /// The methods of these names. None is there twice, and none measures a kind of target twice.
    ///
    /// # Errors
    /// As [`Self::method`]; methods that are in each other's way.
    pub fn methods(&self, texts: &[String], pictured: Pictured) -> Result<Vec<Configured>, ProjectError> {
        let mut found: Vec<Configured> = Vec::new();
        for text in texts {
            let method = self.method(text, pictured)?;
            if found.iter().any(|earlier| earlier.label == method.label) {
                return Err(ProjectError::Asked(format!("-m {text}: `{}` is asked for twice", method.label)));
            }
            distinct(&found, &method).map_err(|gap| ProjectError::Asked(format!("-m {text}: {gap}")))?;
            found.push(method);
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use calibench_measure::Registry;

    use super::*;
    use crate::Toolbox;

    /// What is wrong with a plug-in's file is nothing to whoever does not ask for it.
    #[test]
    fn plug_ins_are_looked_for_where_a_name_is_none_of_this_build() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["scenarios", "reference", "methods"] {
            std::fs::create_dir(folder.path().join(name)).unwrap();
        }
        std::fs::write(folder.path().join("methods/bad.toml"), "[[plugin]]\nnome = \"mine\"\n").unwrap();
        let toolbox = Toolbox { registry: Registry::builtin(), ..Toolbox::default() };
        let project = || Project { root: Some(folder.path().to_owned()), ..Project::new(&toolbox) };
        for text in ["forstner", "cross+corner=forstner:window=9", "forstner:window=9,kinds=cross"] {
            assert!(project().method(text, Pictured::Photographs).is_ok(), "{text}");
        }
        let asked = |project: &Project<'_>, text: &str| project.method(text, Pictured::Renders).err().map(|error| error.to_string());
        assert!(asked(&project(), "mine").unwrap().contains("nome"));
        // A folder that the user named is looked at.
        let named = Project { plugins: Some(folder.path().join("methods")), ..project() };
        assert!(asked(&named, "forstner").unwrap().contains("nome"));
    }
}
