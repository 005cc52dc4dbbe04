//! The page of a judgement, its pictures and its numbers.

use calibench_files::NewFolder;
use calibench_images::Reading;
use calibench_judge::{CornerFile, Material, Options, Remaining, remaining};
use calibench_model::boards::{Board, Chessboard};
use calibench_model::escape::{self, code};
use calibench_model::views::photo_of;
use calibench_photographs::names::names;
use calibench_records::judgement::{JUDGEMENT, Row, Summary, Trusted, write_rows};
use calibench_records::points::RunInfo;
use calibench_report::Corner;
use calibench_report::judgement::{Measured, in_use as in_words, page, section};

use super::Judge;

impl Judge {
    pub fn write(
        &self,
        folder: &NewFolder,
        (material, options, doubts, reading): (&Material, &Options, &[String], Reading),
        rows: &[Row],
        summary: &Summary,
    ) -> std::io::Result<()> {
        let info = RunInfo { scenario: "judge".into(), seed: self.seed, revision: env!("CARGO_PKG_VERSION").into(), detector: None };
        folder.write(JUDGEMENT, |file| write_rows(file, &info, rows))?;
        let (text, pictures) = section(summary);
        let trusted = summary.trusted();
        let found = trusted.as_ref().and_then(|trusted| self.in_use(trusted));
        let in_use = found.as_ref().map_or_else(String::new, |found| format!("{}\n\n", in_words(found)));
        let in_doubt: String = doubts.iter().map(|doubt| format!("**In doubt**: {}.\n\n", escape::markdown(doubt))).collect();
        for (name, picture) in &pictures {
            folder.write(name, |file| picture.encode(file))?;
        }
        let text = format!(
            "{} Everything here is in `{JUDGEMENT}`, a row for each figure.\n\n{in_doubt}{in_use}{}\n",
            if self.points.is_empty() { self.of_photographs() } else { self.of_files(material) },
            text.trim_end()
        );
        folder.write("README.md", |file| file.write_all(text.as_bytes()))?;
        let title = if self.points.is_empty() { "Photographs judged" } else { "Corners judged" };
        let names = names(&self.photos);
        let whole = || names.iter().zip(&self.photos).map(|(name, path)| (name.as_str(), path.as_path(), reading));
        // Of several boards in a photograph each is a view.
        let of_view = |view: &str| whole().find(|(name, ..)| photo_of(view) == Some(*name)).map(|(_, path, reading)| (path, reading));
        let views = material.views.iter().filter_map(|view| Some((&**view, of_view(view)?)));
        let photos = whole().chain(views.map(|(view, (path, reading))| (view, path, reading))).collect();
        let corners = trusted.as_ref().map_or_else(Vec::new, |trusted| left((material, options), summary, trusted));
        let measured = Measured { corners, photos, size: Some(material.size) };
        let page = page(title, &text, (summary, trusted.as_ref()), (found.as_ref(), doubts), measured);
        folder.write("report.html", |file| file.write_all(page.as_bytes()))
    }

    fn of_photographs(&self) -> String {
        format!(
            "# Which operator and which model to trust on these photographs\n\nMade by `calibench judge` from {} photographs of {}.",
            self.photos.len(),
            self.field()
        )
    }

    fn of_files(&self, material: &Material) -> String {
        let file = |(operator, file): (usize, &CornerFile)| {
            format!("- {}: {}, {} corners\n", code(&file.name), code(&file.path.display().to_string()), material.measured(operator))
        };
        let files: String = self.points.iter().enumerate().map(file).collect();
        format!(
            "# Which file of corners and which model to trust\n\nMade by `calibench judge` from corners that were measured beforehand, of {}, in {} \
             photographs of {} x {} px. Each file stands for an operator:\n\n{files}\nCovariances in the files are not used.",
            self.field(),
            material.views.len(),
            material.size.width,
            material.size.height
        )
    }

    fn field(&self) -> String {
        let named = match (&self.control, self.board) {
            (Some(control), _) => format!("the points of {}", code(&control.display().to_string())),
            (None, Some(Board::Chessboard(Chessboard { columns, rows, square }))) => {
                format!("a chessboard of {columns} x {rows} inner corners, squares of {square}")
            }
            (None, Some(board)) => format!("the board `{board}`"),
            (None, None) => "a chessboard".into(),
        };
        match &self.board_file {
            Some(path) => format!("{named}, whose corners are those of {}, taken as exact", code(&path.display().to_string())),
            None => named,
        }
    }
}

/// The corners with what is left of them by the operator and the model to be trusted. Where that cannot be adjusted there is nothing to be shown: what stands in its way is in the rows.
fn left<'m>((material, options): (&'m Material, &Options), summary: &Summary, trusted: &Trusted<'_>) -> Vec<Corner<'m>> {
    let operator = material.operators.iter().position(|corners| corners.method == trusted.cell.method);
    let model = options.models.iter().find(|model| *model.label == *trusted.cell.model);
    let found = operator.zip(model).and_then(|(operator, model)| remaining(material, operator, model, options).ok()).unwrap_or_default();
    let corner = |one: Remaining| {
        let name = &material.views[one.view];
        let image = summary.views.iter().position(|view| view == name)?;
        Some(Corner::new((image, &**name), material.field.name(one.corner), one.at, one.v))
    };
    found.into_iter().filter_map(corner).collect()
}
