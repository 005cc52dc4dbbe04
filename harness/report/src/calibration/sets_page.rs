//! Sets of parameters beside each other, for the page, the terminal and as CSV.

use std::io;

use calibench_calibrate::{Compared, ComparedSet, SetResult};
use calibench_files::NewFolder;

use super::csv::table;
use super::limits::{BASIC, DOUBTFUL};
use crate::markdown::MarkdownTable;
use crate::plain;

/// The table for a reader, and what its columns mean.
pub(super) fn section(compared: &Compared) -> String {
    let best = least(compared);
    let columns =
        ["set", "solved for", "redundancy", "sigma0 px", "dAICc", "against", "F", "p", "change px, RMS (most)", "t of the additional ones"];
    let mut table = MarkdownTable::new(&columns);
    for (index, set) in compared.sets.iter().enumerate() {
        table.row(row(index, set, best));
    }
    format!(
        "{}\ndAICc: Akaike's criterion, corrected for few observations, above that of the best set: 2 is little, 10 is decisive. F and p test what a set has \
         more than the one named under `against`, its largest part: p is the chance of such an F if the additional parameters were zero. Change: the set's \
         camera against the calibration's, over the frame, after the best rotation. `(!)`: not told from zero at {DOUBTFUL}.\n",
        table.render()
    )
}

fn least(compared: &Compared) -> f64 {
    compared.sets.iter().filter_map(|set| set.result.as_ref().ok()).map(|result| result.aicc).fold(f64::INFINITY, f64::min)
}

fn row(index: usize, set: &ComparedSet, best: f64) -> Vec<String> {
    let mut row = vec![(index + 1).to_string(), set.names.join(", ")];
    let result = match &set.result {
        Ok(result) => result,
        Err(why) => {
            row.extend(vec![String::new(); 7]);
            row.push(why.clone());
            return row;
        }
    };
    let (observed, unknown) = result.counts;
    row.extend([(observed as i64 - unknown as i64).to_string(), plain(result.sigma0_px), format!("{:.1}", result.aicc - best)]);
    row.extend(match &set.against {
        Some((other, test)) => [(other + 1).to_string(), plain(test.f), probability(test.p)],
        None => [String::new(), String::new(), String::new()],
    });
    row.push(result.change_px.map_or(String::new(), |[rms, most]| format!("{} ({})", plain(rms), plain(most))));
    row.push(tests(result));
    row
}

fn probability(p: f64) -> String {
    if p < 1e-4 { "<0.0001".into() } else { format!("{p:.4}") }
}

fn tests(result: &SetResult) -> String {
    let additional = result.tests.iter().filter(|(_, test)| !BASIC.contains(&test.parameter));
    let said = additional.map(|(name, test)| format!("{name} {:.1}{}", test.t, if test.p > DOUBTFUL { " (!)" } else { "" }));
    said.collect::<Vec<_>>().join(", ")
}

/// Writes `sets.csv`: a row for each set and parameter, with what holds of the whole set; one row with a reason for a set that is not determined.
pub(super) fn write(compared: &Compared, folder: &NewFolder) -> io::Result<()> {
    let columns = [
        "set",
        "parameter",
        "value",
        "sigma",
        "t",
        "p",
        "observations",
        "unknowns",
        "redundancy",
        "sigma0_px",
        "aicc",
        "against",
        "f",
        "f_p",
        "change_rms_px",
        "change_max_px",
        "status",
        "reason",
    ];
    let rows = compared.sets.iter().enumerate().flat_map(|(index, set)| csv_rows(index, set));
    table(folder, "sets.csv", &columns, rows)
}

fn csv_rows(index: usize, set: &ComparedSet) -> Vec<Vec<String>> {
    let number = (index + 1).to_string();
    let result = match &set.result {
        Ok(result) => result,
        Err(why) => {
            let mut row = vec![number, set.names.join(" ")];
            row.extend(vec![String::new(); 14]);
            row.extend(["undetermined".to_owned(), why.clone()]);
            return vec![row];
        }
    };
    let (observed, unknown) = result.counts;
    let against = set
        .against
        .map_or_else(|| vec![String::new(); 3], |(other, test)| vec![(other + 1).to_string(), test.f.to_string(), test.p.to_string()]);
    let change = result.change_px.map_or_else(|| vec![String::new(); 2], |change| change.map(|px| px.to_string()).to_vec());
    let of = |(name, test): &(String, calibench_adjust::Significance)| {
        let mut row = vec![number.clone(), name.clone()];
        row.extend([test.value, test.sigma, test.t, test.p].map(|value| value.to_string()));
        row.extend([observed.to_string(), unknown.to_string(), (observed as i64 - unknown as i64).to_string()]);
        row.extend([result.sigma0_px, result.aicc].map(|value| value.to_string()));
        row.extend(against.iter().cloned().chain(change.iter().cloned()));
        row.extend(["adjusted".to_owned(), String::new()]);
        row
    };
    result.tests.iter().map(of).collect()
}
