//! The tables that say what is recognised in views, and what is made of their points.

use std::borrow::Cow;

use calibench_diagnostics::Problem;
use calibench_measure::Configured;

use super::section::Section;
use super::studies::{Seen, blocks, calibrators, network, networks, recognition, tasks};
use super::subject::{Study, ViewsSubject};

/// A study that has tables of its own beside those of the views.
struct Reader {
    /// What messages call it.
    name: &'static str,
    /// Its table, as a key and as it is written.
    table: [&'static str; 2],
    /// The list beside its table, if it has one, alike, and what the table says of all in it.
    list: Option<([&'static str; 2], &'static str)>,
    /// Whether `[acceptance]` may stand beside it.
    accepts: bool,
    /// Reads them.
    read: fn(Tables<'_>, &Seen<'_>, &[Configured], &mut Vec<Problem>) -> Option<Study>,
}

/// A study's table and what stands beside it.
struct Tables<'i> {
    table: Section<'i>,
    list: Vec<Section<'i>>,
    acceptance: Option<Section<'i>>,
}

/// The key and the name of what a study must keep.
const ACCEPTANCE: [&str; 2] = ["acceptance", "[acceptance]"];

/// Those studies, of which a scenario has one at most. A new one is a line here.
const READERS: [Reader; 6] = [
    Reader {
        name: "[calibration]",
        table: ["calibration", "[calibration]"],
        list: None,
        accepts: true,
        read: |Tables { table, acceptance, .. }, seen, methods, problems| {
            Some(Study::Network(Box::new(network::read(table, acceptance, seen, methods, problems)?)))
        },
    },
    Reader {
        name: "blocks",
        table: ["blocks", "[blocks]"],
        list: Some((["block", "[[block]]"], "[blocks] says `c` and `sigma_px` of all blocks")),
        accepts: false,
        read: |Tables { table, list, .. }, seen, methods, problems| {
            Some(Study::Blocks(Box::new(blocks::read(table, list, seen, methods, problems)?)))
        },
    },
    Reader {
        name: "[calibrators]",
        table: ["calibrators", "[calibrators]"],
        list: Some((["calibrator", "[[calibrator]]"], "[calibrators] says `model`, `start_f` and `distance` for all calibrators")),
        accepts: false,
        read: |Tables { table, list, .. }, _, methods, problems| {
            Some(Study::Calibrators(Box::new(calibrators::read(table, list, methods, problems)?)))
        },
    },
    Reader {
        name: "[free_network]",
        table: ["free_network", "[free_network]"],
        list: Some((["distance", "[[distance]]"], "[free_network] says `model` and `noise_px`")),
        accepts: true,
        read: |Tables { table, list, acceptance }, seen, methods, problems| {
            Some(Study::Networks(Box::new(networks::read_free((table, list, acceptance), seen, methods, problems)?)))
        },
    },
    Reader {
        name: "[rig]",
        table: ["rig", "[rig]"],
        list: Some((["mount", "[[mount]]"], "[rig] says `model` and `noise_px` of all cameras")),
        accepts: false,
        read: |Tables { table, list, .. }, _, methods, problems| {
            Some(Study::Networks(Box::new(networks::read_rig(table, list, methods, problems)?)))
        },
    },
    Reader {
        name: "[tasks]",
        table: ["tasks", "[tasks]"],
        list: None,
        accepts: false,
        read: |Tables { table, .. }, seen, methods, problems| Some(Study::Tasks(Box::new(tasks::read(table, seen, methods, problems)?))),
    },
];

/// The keys of the top level that say what is made of points.
pub fn keys() -> impl Iterator<Item = &'static str> {
    let keys = |reader: &Reader| [Some(reader.table[0]), reader.list.map(|([key, _], _)| key)];
    READERS.iter().flat_map(keys).flatten().chain([ACCEPTANCE[0]])
}

/// The names of the studies that must keep something, as messages say them.
fn accepting() -> String {
    READERS.iter().filter(|reader| reader.accepts).map(|reader| reader.name).collect::<Vec<_>>().join(" or ")
}

/// The tables as they stand in the file, not read yet.
pub struct StudyTables<'i> {
    /// In the order of [`READERS`].
    found: Vec<(Option<Section<'i>>, Vec<Section<'i>>)>,
    acceptance: Option<Section<'i>>,
    recognition: Option<Section<'i>>,
}

impl<'i> StudyTables<'i> {
    /// Takes them out of the file.
    pub fn take(root: &mut Section<'i>, problems: &mut Vec<Problem>) -> Self {
        let found = READERS.iter().map(|reader| {
            let [key, name] = reader.table;
            let list = reader.list.and_then(|([key, name], _)| root.take_tables(key, name, problems));
            (root.take_table(key, name, problems), list.unwrap_or_default())
        });
        let found = found.collect();
        let [key, name] = ACCEPTANCE;
        let acceptance = root.take_table(key, name, problems);
        Self { found, acceptance, recognition: root.take_table("recognition", "[recognition]", problems) }
    }

    /// Those that are there, without lists.
    pub fn tables(&self) -> impl Iterator<Item = &Section<'i>> {
        self.found.iter().filter_map(|(table, _)| table.as_ref()).chain(&self.acceptance).chain(&self.recognition)
    }

    /// Says what cannot be without a field.
    pub fn without_field(&self, problems: &mut Vec<Problem>) {
        let needs = |name: &str, section: &Section<'_>, field: &str| {
            Problem::new(section.span.clone(), format!("{name} without [testfield]: expected {field} with [camera] and stations"))
        };
        for (reader, (table, list)) in READERS.iter().zip(&self.found) {
            problems.extend(table.as_ref().or(list.first()).map(|section| needs(reader.name, section, "one")));
        }
        problems.extend(self.recognition.as_ref().map(|section| needs("[recognition]", section, "a coded one")));
    }

    /// `views` with what is done with their points.
    pub fn read(self, views: ViewsSubject, methods: &[Configured], problems: &mut Vec<Problem>) -> Option<ViewsSubject> {
        let ViewsSubject { camera, field, stations, redraw, survey_sigma, .. } = &views;
        let recognition = self.recognition.map(|section| recognition::read(section, field, stations, problems));
        let recognition = recognition.map_or(Some(None), |read| read.map(Some))?;
        let seen = Seen { camera, field, stations, redrawn: redraw.is_some(), survey_sigma: *survey_sigma };
        let mut chosen = READERS.iter().zip(self.found).filter(|(_, (table, list))| table.is_some() || !list.is_empty());
        let Some((reader, (table, mut list))) = chosen.next() else {
            problems.extend(self.acceptance.map(|section| not_accepting(&section, "alone")));
            return Some(ViewsSubject { recognition, ..views });
        };
        if let Some((other, (table, mut list))) = chosen.next() {
            let at = table.unwrap_or_else(|| list.swap_remove(0)).span;
            problems.push(Problem::new(at, format!("{} beside {}: expected one of them", other.name, reader.name)));
            return None;
        }
        let Some(table) = table else {
            let (([_, list_name], says), [_, name]) = (reader.list?, reader.table);
            problems.push(Problem::new(list.swap_remove(0).span, format!("{list_name} without {name}")).help(says));
            return None;
        };
        if let Some(section) = self.acceptance.as_ref().filter(|_| !reader.accepts) {
            problems.push(not_accepting(section, &format!("beside {}", reader.name)));
        }
        let study = (reader.read)(Tables { table, list, acceptance: self.acceptance }, &seen, methods, problems)?;
        let stations = study.cameras_at(Cow::Owned(views.stations)).into_owned();
        Some(ViewsSubject { stations, recognition, study, ..views })
    }
}

/// Of `[acceptance]` that stands where nothing keeps it.
fn not_accepting(section: &Section<'_>, where_it_is: &str) -> Problem {
    Problem::new(section.span.clone(), format!("{} {where_it_is}: expected it beside {}", ACCEPTANCE[1], accepting()))
}
