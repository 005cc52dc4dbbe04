//! `calibench certificate`: two pages for the file, of what `calibrate` found; and whether all is still as it was.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use calibench_calibrate::few;
use calibench_certificate::{Certificate as Certified, LIST_FILE, Pages, RECORD_FILE, Record, Verified, verify};
use calibench_files::{Inputs, at, bounded};
use clap::Args;

use super::calibrate::certificate::{Said, certify};
use super::output;
use crate::deliver::print;
use crate::failure::Failure;

/// The largest certificate that is read, bytes.
const LARGEST: u64 = 256 << 20;

#[derive(Args)]
pub struct Certificate {
    /// The folder of a report, as `calibrate --report` writes it; with --verify folders where the files are looked for [default: the current folder, then that of the certificate]
    #[arg(value_name = "DIR", required_unless_present = "verify")]
    folders: Vec<PathBuf>,
    /// The certificate to write, as PDF
    #[arg(short, long, value_name = "PDF", required_unless_present = "verify")]
    output: Option<PathBuf>,
    /// Of several cameras this one
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    #[command(flatten)]
    said: Said,
    /// Compute the digests of the files, and the pages, anew: exit code 1 where they are not those of the certificate
    #[arg(long, value_name = "PDF", conflicts_with_all = ["output", "camera", "by", "place", "date", "body", "lens"])]
    verify: Option<PathBuf>,
}

impl Certificate {
    pub fn run(&self) -> Result<(), Failure> {
        match (&self.verify, self.folders.as_slice(), &self.output) {
            (Some(path), folders, _) => verified(path, folders),
            (None, [folder], Some(output)) => self.write(folder, output),
            (None, folders, _) => Err(Failure::input(format!(
                "{} folders; expected that of one report, and -o with the name of the certificate",
                folders.len()
            ))),
        }
    }

    fn write(&self, folder: &Path, output: &Path) -> Result<(), Failure> {
        let fields = self.said.fields()?;
        let [record, list] = [RECORD_FILE, LIST_FILE].map(|name| folder.join(name));
        let output = output::document("-o", output, &Inputs::new([&record, &list]))?;
        if !record.is_file() {
            let what = "holds no certificate.json; expected a folder that `calibrate --report` of this version wrote";
            return Err(Failure::input(format!("{}: {what}", folder.display())));
        }
        // What was changed since is no report of the program.
        calibench_files::folder::intact(folder)?;
        let read = |path: &Path| bounded::text(path).map_err(|error| at(path, &error));
        let (text, list) = (read(&record)?, read(&list)?);
        let record: Record =
            serde_json::from_str(&text).map_err(|error| Failure::input(format!("{}: {error}; calibrate again", record.display())))?;
        let camera = self.which(&record)?;
        if certify(&Certified { fields, camera, record }, &list, &output)? { Err(Failure::Doubt) } else { Ok(()) }
    }

    /// The camera that was asked for, or the only one.
    fn which(&self, record: &Record) -> Result<usize, Failure> {
        let cameras = record.calibration["cameras"].as_array().map_or(&[][..], Vec::as_slice);
        let names: Vec<String> = cameras.iter().filter_map(|camera| camera["name"].as_str().map(str::to_owned)).collect();
        match &self.camera {
            None if names.len() < 2 => Ok(0),
            None => Err(Failure::input(format!(
                "{} cameras, and a certificate is of one; expected --camera with one of {}",
                names.len(),
                few(&names)
            ))),
            Some(wanted) => {
                let found = names.iter().position(|name| name == wanted);
                found.ok_or_else(|| Failure::input(format!("--camera: no camera is called `{wanted}`; there are {}", few(&names))))
            }
        }
    }
}

fn verified(path: &Path, folders: &[PathBuf]) -> Result<(), Failure> {
    let mut pdf = Vec::new();
    let mut file = File::open(path).map_err(|error| at(path, &error))?;
    file.by_ref().take(LARGEST).read_to_end(&mut pdf).map_err(|error| at(path, &error))?;
    let beside = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned();
    let usual = [PathBuf::from("."), beside];
    let found = verify(&pdf, if folders.is_empty() { &usual[..] } else { folders })
        .map_err(|error| Failure::input(format!("{}: {error}", path.display())))?;
    print(&told(&found))?;
    let is_same =
        found.changed.is_empty() && found.pages != Pages::Changed && found.found.as_ref().is_none_or(|digest| *digest == found.stated);
    if !is_same {
        return Err(Failure::Gate);
    }
    if !found.missing.is_empty() {
        return Err(Failure::input(format!(
            "{} of {} files are not found: {}; name the folders that hold them behind the certificate",
            found.missing.len(),
            found.files,
            few(&found.missing)
        )));
    }
    if found.pages == Pages::Same { Ok(()) } else { Err(Failure::Doubt) }
}

/// What was found, in lines.
fn told(found: &Verified) -> String {
    let Verified { stated, found: digest, changed, missing, files, pages, calibench } = found;
    let mut text = format!("stated    {stated}\ncomputed  {}\n", digest.as_deref().unwrap_or("cannot be: files are missing"));
    text += &format!("files     {} of {files} are as they were\n", files - changed.len() - missing.len());
    text += &changed.iter().map(|path| format!("changed   {path}\n")).collect::<String>();
    let pages = match pages {
        Pages::Same => "those that the record gives, byte for byte".into(),
        Pages::Added(bytes) => format!(
            "as they were written, and {bytes} bytes behind them that another program added (a signature, remarks): look at them there"
        ),
        Pages::Changed if calibench != env!("CARGO_PKG_VERSION") => {
            format!("not those that the record gives here; calibench {calibench} wrote them: let that version verify them")
        }
        Pages::Changed => "changed: not those that the record gives".into(),
    };
    text + &format!("pages     {pages}\n")
}
