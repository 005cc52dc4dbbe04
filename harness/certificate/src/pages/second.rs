//! The second page: the uncertainty budget, the map, lengths and tasks, what is in doubt, the files.

use super::table::{self, Column, Side};
use super::{BOTTOM, DIGESTS, LEFT, NOTE, RIGHT, RULE, SMALL, Told, frame, paragraph, section};
use crate::budget::{Budget, Contribution};
use crate::digest::{digest_of, of_line};
use crate::digits::{three, with_uncertainty};
use crate::document::{Paper, Style};
use crate::record::Role;

/// Rows of lengths and tasks at most.
const MOST_TASKS: usize = 4;
/// Where the files begin at the latest, and the last lines.
const FILES: f64 = BOTTOM - 84.0;
const LAST: f64 = BOTTOM - 10.0;
/// Between sections, points.
const GAP: f64 = 10.0;
/// Where what is in doubt begins, behind its kind.
const INDENTED: f64 = 54.0;

pub(super) fn write(paper: &mut Paper, told: &Told<'_>) {
    let Some(calibrated) = told.answer.cameras.get(told.certificate.camera) else { return };
    let y = section(paper, 54.0, 5, "Uncertainty budget");
    let y = budget(paper, y, told.budget);
    let y = section(paper, y + GAP, 6, "Uncertainty over the frame");
    let y = frame::write(paper, y, told, &calibrated.camera.size);
    let y = section(paper, y + GAP, 7, "Lengths and tasks");
    let y = tasks(paper, y, told);
    let y = section(paper, y + GAP, 8, "In doubt, not tested, to be known");
    let y = doubts(paper, y, told);
    let y = section(paper, y + GAP, 9, "Files");
    files(paper, y, told);
    let version = &told.certificate.record.calibench;
    let words = format!(
        "Made by calibench {version} of the record and the digests that are attached to this document (certificate.json, files.sha256). The command calibench certificate --verify \
         computes the digests of the files anew, and the pages of the record."
    );
    paragraph(paper, LAST, NOTE, &words, 2);
}

fn budget(paper: &mut Paper, y: f64, budget: &Budget) -> f64 {
    let quantity = "Quantity: the place in the image of a point far away (a direction), RMS over the frame after the best rotation, as a distance in px. After JCGM 100:2008.";
    let y = paragraph(paper, y, Style::plain(7.5), quantity, 2) + 4.0;
    let columns: [Column<'_>; 5] = [
        ("source", Side::Left, LEFT, 178.0),
        ("standard uncertainty", Side::Left, LEFT + 182.0, 104.0),
        ("type, distribution", Side::Left, LEFT + 290.0, 96.0),
        ("sensitivity", Side::Right, LEFT + 434.0, 46.0),
        ("contribution", Side::Right, RIGHT, 58.0),
    ];
    let mut y = table::head(paper, y, &columns, ([LEFT, RIGHT], table::ROW));
    for source in &budget.sources {
        let contribution = match source.contribution {
            Contribution::Px(px) => format!("{} px", three(px)),
            Contribution::None => "0".into(),
            Contribution::Within => "in the first row".into(),
            Contribution::NotEvaluated => "not evaluated".into(),
        };
        let cells = [source.name.clone(), source.value.clone(), source.distribution.clone(), source.sensitivity.clone(), contribution];
        y = table::row(paper, y, &columns, (SMALL, table::ROW), &cells);
    }
    paper.line([LEFT, y - 7.0], [RIGHT, y - 7.0], (0.5, RULE));
    let freedom = if budget.freedom > 1e6 { "unlimited".to_owned() } else { format!("{:.0}", budget.freedom.floor()) };
    let strong = Style::bold(7.0);
    let known = |px: Option<f64>| px.map_or("not known".into(), |px| format!("{} px", three(px)));
    let rows = [
        (format!("Combined standard uncertainty, effective degrees of freedom {freedom}"), known(budget.combined_px)),
        (
            format!("Expanded uncertainty U, k = {:.2}: at least 95 % of errors are within it, as far as the rows above tell", budget.k),
            known(budget.expanded_px()),
        ),
    ];
    for (name, value) in rows {
        paper.write([LEFT, y + 1.5], strong, &name);
        paper.write_before([RIGHT, y + 1.5], strong, &value);
        y += table::ROW;
    }
    if budget.sources.iter().any(|source| source.contribution == Contribution::NotEvaluated) {
        y = paragraph(paper, y + 2.0, NOTE, "What is not evaluated is not in the sum: the uncertainty is larger by it.", 1);
    }
    y + 1.0
}

/// Lengths that the adjustment has, and what tasks cost, where somebody asked.
fn tasks(paper: &mut Paper, y: f64, told: &Told<'_>) -> f64 {
    let (tasks, lengths, k) = (&told.certificate.record.tasks, &told.answer.lengths, told.budget.k);
    let rows = tasks.iter().map(|task| {
        let numbers = [task.sigma, task.half_95].map(|number| format!("{} {}", three(number), task.unit));
        [vec![task.what.clone(), String::new()], numbers.to_vec(), vec![task.largest.clone()]].concat()
    });
    let rows: Vec<Vec<String>> = rows
        .chain(lengths.iter().map(|length| {
            let what = format!("length {} to {}", length.targets[0], length.targets[1]);
            let measured = length.measured.map_or("asked for".to_owned(), |measured| format!("measured {measured}"));
            // Between points that are held nothing is adjusted.
            if length.sigma <= 0.0 {
                return vec![what, format!("{:.6}", length.length), "exact".into(), "-".into(), "taken as exact".into()];
            }
            let (value, u) = with_uncertainty(length.length, length.sigma);
            vec![what, value, u, with_uncertainty(0.0, k * length.sigma).1, measured]
        }))
        .collect();
    if rows.is_empty() {
        return paragraph(paper, y, SMALL, "None was asked for (calibrate --length).", 1);
    }
    let expanded = format!("U (95 %, k = {k:.2})");
    let columns: [Column<'_>; 5] = [
        ("what", Side::Left, LEFT, 200.0),
        ("value, object units", Side::Right, LEFT + 282.0, 76.0),
        ("u", Side::Right, LEFT + 334.0, 48.0),
        (&expanded, Side::Right, LEFT + 402.0, 64.0),
        ("remark", Side::Left, LEFT + 412.0, RIGHT - LEFT - 412.0),
    ];
    let mut y = table::head(paper, y, &columns, ([LEFT, RIGHT], table::ROW));
    for row in rows.iter().take(MOST_TASKS) {
        y = table::row(paper, y, &columns, (SMALL, table::ROW), row);
    }
    if rows.len() > MOST_TASKS {
        y = paragraph(paper, y, NOTE, &format!("and {} more in the attached record", rows.len() - MOST_TASKS), 1);
    }
    y
}

/// As many as have room; the rest is counted.
fn doubts(paper: &mut Paper, mut y: f64, told: &Told<'_>) -> f64 {
    let answer = told.answer;
    let all: Vec<(&str, &String)> = [
        ("In doubt", told.doubts.iter().collect::<Vec<_>>()),
        ("Suspected", answer.suspected.iter().map(|one| &one.what).collect()),
        ("Not tested", answer.untested.iter().collect()),
        ("No digest", told.certificate.record.without_digest.iter().collect()),
        ("To be known", answer.warnings.iter().collect()),
    ]
    .into_iter()
    .flat_map(|(kind, all)| all.into_iter().map(move |one| (kind, one)))
    .collect();
    if all.is_empty() {
        return paragraph(paper, y, SMALL, "Nothing: every check was made and found no doubt.", 1);
    }
    let width = RIGHT - LEFT - INDENTED;
    for (index, (kind, words)) in all.iter().enumerate() {
        let lines = paper.lines(words, SMALL, width).len().min(3);
        let is_last = index + 1 == all.len();
        if y + 9.1 * (lines + usize::from(!is_last)) as f64 > FILES - 14.0 {
            return paragraph(paper, y, Style::bold(7.0), &format!("and {} more in the attached record", all.len() - index), 1);
        }
        paper.write([LEFT, y], if *kind == "In doubt" { Style::bold(7.0) } else { NOTE }, kind);
        y = super::bounded(paper, [LEFT + INDENTED, y], (SMALL, width, 9.1), words, 3);
    }
    y
}

/// Every file with its digest where there is room, else those that are no photographs, and one digest over the list.
fn files(paper: &mut Paper, mut y: f64, told: &Told<'_>) {
    let entries = &told.certificate.record.files;
    let lines: Vec<&str> = told.list.lines().collect();
    let room = ((LAST - 8.0 - y) / 9.2).max(0.0) as usize;
    let style = Style::plain(6.8);
    let photographs = entries.iter().filter(|entry| entry.role == Role::Photograph).count();
    let all_fit = entries.len() <= room;
    if entries.is_empty() {
        paper.write([LEFT, y], SMALL, "None.");
        return;
    }
    if !all_fit {
        let over: String =
            entries.iter().zip(&lines).filter(|(entry, _)| entry.role == Role::Photograph).map(|(_, line)| format!("{line}\n")).collect();
        let what = format!("{photographs} photographs; SHA-256 of the list of their digests:");
        paper.write([LEFT, y], style, &what);
        paper.write([DIGESTS, y], style, &digest_of(over.as_bytes()));
        y += 9.2;
    }
    let shown: Vec<_> = entries.iter().zip(&lines).filter(|(entry, _)| all_fit || entry.role != Role::Photograph).collect();
    let most = if all_fit { shown.len() } else { room.saturating_sub(2) };
    for (entry, line) in shown.iter().take(most) {
        let digest = of_line(line).unwrap_or_default();
        let size = format!("{} bytes", entry.bytes);
        paper.write_within([LEFT, y], style, &entry.path, DIGESTS - LEFT - 72.0);
        paper.write_before([DIGESTS - 12.0, y], style, &size);
        paper.write([DIGESTS, y], style, digest);
        y += 9.2;
    }
    if shown.len() > most {
        paper.write([LEFT, y], style, &format!("and {} more in the attached list", shown.len() - most));
    }
}
