//! The board's share of what is not predicted, in words.

use calibench_records::judgement::{BoardShare, Cell, FreedCorners};

use super::words::{chance, interval, listed};
use crate::plain;

/// What comes before all else where the board decides, or the file that was taken for it does not fit.
pub(super) fn first(share: &BoardShare, cell: &Cell) -> Option<String> {
    let own = cell.holdout?.value;
    if share.file_misfits() {
        return Some(
            "**That board file does not fit**: unseen corners are predicted better with nominal corners than with those of the file. It is of another board, of a board that \
             has changed since, or was measured with errors of its photographs."
                .into(),
        );
    }
    let beside = |px: f64| match share.operators_px {
        Some(operators) => format!("{} px, beside {} px that separate the operators", plain(px), plain(operators)),
        None => format!("{} px, more than all the rest", plain(px)),
    };
    if share.decides() {
        let again = if share.nominal.is_some() { "Measure your board again" } else { "Measure your board" };
        return Some(format!(
            "**{again}**: it decides. Its share of the error is {} (`calibench calibrate PHOTOS --board BOARD --save-board board.csv`, then `--board-file board.csv` with \
             these photographs and any later ones).",
            beside(share.board_px)
        ));
    }
    share.file_decides(own).then(|| {
        let px = share.file_px(own).unwrap_or_default();
        format!("**Take that board file**: it decides. With nominal corners the board's share of the error would be {}.", beside(px))
    })
}

/// The board beside operators, models and the rest.
pub(super) fn share(share: &BoardShare, cell: &Cell) -> Option<String> {
    let own = cell.holdout?.value;
    let freed = &share.freed;
    let mut text = format!(
        "**Board**: with its corners freed in the photographs that take part, unseen ones are predicted to {}",
        interval(&freed.holdout)
    );
    text.push_str(&match share.board_px {
        px if px > 0.0 => format!(" in place of {} px ({}): its share is {} px", plain(own), chance(freed.p_better), plain(px)),
        _ => format!(", no better than {} px: nothing is to be gained by measuring it", plain(own)),
    });
    text.push_str(&share.moved.filter(|_| share.board_px > 0.0).map_or_else(String::new, |moved| places(&moved)));
    let parts = [(share.operators_px, "the operators"), (share.models_px, "the models")];
    let parts: Vec<String> = parts
        .into_iter()
        .filter_map(|(px, what)| Some(format!("{} px separate the middle one of {what} from the best", plain(px?))))
        .collect();
    let rest = format!("{} px are the rest", plain(freed.holdout.value));
    text.push_str(&format!(". Beside it {}.", listed(&parts.into_iter().chain([rest]).collect::<Vec<_>>())));
    if let Some(nominal) = &share.nominal {
        text.push_str(&format!(
            " Its corners are those of the file, taken as exact; with nominal ones it would be {} ({}).",
            interval(&nominal.holdout),
            if nominal.p_worse <= nominal.p_better { chance(nominal.p_worse) + ", worse" } else { chance(nominal.p_better) + ", better" }
        ));
    }
    Some(text)
}

fn places(moved: &FreedCorners) -> String {
    format!(
        ", its corners are {} object units RMS off in the plane (known to {}) and {} across (known to {})",
        plain(moved.in_plane),
        plain(moved.sigma_in_plane),
        plain(moved.across),
        plain(moved.sigma_across)
    )
}
