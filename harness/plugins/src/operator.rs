//! A plug-in as an operator.

use std::sync::Arc;

use calibench_measure::{BoardFinder, BoardPointFound, Operator, Settings, Sought};
use calibench_model::boards::Board;
use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start, Told};
use calibench_random::{Key, Purpose, stream};
use rand::seq::SliceRandom;

use crate::answer::{Answer, Fault, read};
use crate::boards::points_of;
use crate::declaration::Mode;
use crate::folder;
use crate::patience::{self, Patience};
use crate::program::Program;
use crate::request::{Wanted, body, head, rounds};
use crate::starts::{Boards, Starts};

/// Bytes of an answer for each position.
const BYTES_A_POSITION: usize = 400;
/// Detections in one image, at most.
const MOST_DETECTED: usize = 100_000;

/// The longest answer.
fn bytes(wanted: Wanted<'_>) -> usize {
    wanted.count().unwrap_or(MOST_DETECTED) * BYTES_A_POSITION + 4096
}

/// A plug-in with its parameters set.
pub struct Asked {
    program: Arc<Program>,
    settings: Settings,
    patience: Arc<Patience>,
}

type Measured = Result<Measurement, Rejection>;

impl Asked {
    pub fn new(program: Arc<Program>, settings: Settings) -> Self {
        let patience = program.patience(&settings);
        Self { program, settings, patience }
    }

    /// Asks once and tells what the answer tells; a process that failed is ended, and the next image gets a new one.
    fn ask(&self, image: &Image, wanted: Wanted<'_>) -> Result<Answer, Fault> {
        let grey = self.program.declaration.grey;
        if rounds(image, grey) {
            self.program.told.tell(&format!("grey values were rounded or clipped for it: its images are `{}`", grey.name()));
        }
        if self.patience.is_over() {
            return Err(Fault::new(Rejection::TooSlow, patience::TOLD));
        }
        let answer = match self.program.declaration.mode {
            Mode::Stream => self.by_stream(image, wanted),
            Mode::Folder { .. } => folder::ask(&self.program, &self.settings, image, wanted, (MOST_DETECTED, bytes(wanted) as u64)),
        };
        self.patience.image(answer.as_ref().is_err_and(|fault| fault.rejection == Rejection::TooSlow));
        let answer = answer?;
        answer.told.iter().for_each(|what| self.program.told.tell(what));
        Ok(answer)
    }

    fn by_stream(&self, image: &Image, wanted: Wanted<'_>) -> Result<Answer, Fault> {
        let grey = self.program.declaration.grey;
        let body = body(image, grey);
        let mut started = self.program.process(&self.settings)?;
        started.asked += 1;
        let head = head(started.asked, image, grey, wanted);
        let line = started.process.ask(&[&head, &body], self.program.limit(), bytes(wanted));
        let answer = read(&line?, started.asked, wanted.count(), MOST_DETECTED)?;
        self.program.keep(&self.settings, started);
        Ok(answer)
    }

    /// Answers to starts that are finite.
    fn of_finite(&self, image: &Image, starts: &[Start]) -> Vec<Measured> {
        if starts.is_empty() {
            return Vec::new();
        }
        let asked = match self.program.declaration.starts {
            Starts::Given => self.each(image, starts),
            Starts::None { radius } => self.nearest(image, starts, radius),
            // Of which board they are is not known here.
            Starts::Board(_) => Ok(vec![Err(Rejection::NotDetected); starts.len()]),
        };
        asked.unwrap_or_else(|fault| vec![Err(self.failed(&fault)); starts.len()])
    }

    /// Tells what failed.
    fn failed(&self, fault: &Fault) -> Rejection {
        let tell = |message: &str| self.program.told.tell(&format!("{}: {message}", fault.rejection.meaning()));
        tell(&fault.message);
        if fault.rejection == Rejection::TooSlow {
            tell(patience::TOLD);
        }
        fault.rejection
    }

    /// Answers to `starts`, which are shown in an order that says nothing.
    fn each(&self, image: &Image, starts: &[Start]) -> Result<Vec<Measured>, Fault> {
        let order = shuffled(starts.len());
        let shown: Vec<Start> = order.iter().map(|&place| starts[place]).collect();
        let points = self.ask(image, Wanted::Each(&shown))?.points;
        let mut results = vec![Err(Rejection::Malformed); starts.len()];
        for (place, point) in order.into_iter().zip(points) {
            results[place] = point;
        }
        Ok(results)
    }

    /// What it finds in the whole image, and of that the nearest to each start.
    fn nearest(&self, image: &Image, starts: &[Start], radius: f64) -> Result<Vec<Measured>, Fault> {
        let found: Vec<Measurement> = self.ask(image, Wanted::Anything)?.points.into_iter().filter_map(Result::ok).collect();
        let distance = |at: PixelPoint, one: &Measurement| one.position.distance(at);
        let near = |start: &Start| {
            let nearest = found.iter().min_by(|a, b| distance(start.position, a).total_cmp(&distance(start.position, b)));
            nearest.filter(|one| distance(start.position, one) <= radius).copied().ok_or(Rejection::NotDetected)
        };
        Ok(starts.iter().map(near).collect())
    }
}

impl Asked {
    /// What it says of boards, if it finds them.
    fn boards(&self) -> Option<&Boards> {
        if let Starts::Board(boards) = &self.program.declaration.starts { Some(boards) } else { None }
    }
}

impl BoardFinder for Asked {
    fn unfit(&self, board: &Board) -> Option<String> {
        let kinds = &self.boards()?.kinds;
        if board.to_string().parse() != Ok(*board) {
            return Some(format!("it is told boards in a word, and `{board}` does not tell all of this one"));
        }
        (!kinds.is_empty() && !kinds.iter().any(|known| known == board.kind()))
            .then(|| format!("it finds these alone: {}", kinds.join(", ")))
    }

    fn outwards(&self, board: &Board) -> f64 {
        self.boards().and_then(|boards| boards.outwards.get(board.kind())).copied().unwrap_or(0.0)
    }

    fn find(&self, image: &Image, sought: &Sought) -> Result<Vec<BoardPointFound>, Rejection> {
        let from_corner = self.boards().is_some_and(|boards| boards.from_corner);
        let found = self.ask(image, Wanted::Board(sought)).and_then(|answer| points_of(&answer, sought, from_corner));
        let found = found.map_err(|fault| self.failed(&fault))?;
        if found.is_empty() { Err(Rejection::NotDetected) } else { Ok(found) }
    }
}

/// The places of `count` starts in an order that is the same whenever there are as many.
fn shuffled(count: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    let key = Key { seed: 0, of: "", trial: count as u64, view: "", target: "" };
    order.shuffle(&mut stream(key, Purpose::Shown));
    order
}

impl Operator for Asked {
    fn measure(&self, image: &Image, start: &Start) -> Measured {
        self.measure_all(image, &[*start]).pop().unwrap_or(Err(Rejection::Malformed))
    }

    fn measure_all(&self, image: &Image, starts: &[Start]) -> Vec<Measured> {
        // JSON has no other numbers.
        let finite = |start: &&Start| start.position.is_finite();
        let shown: Vec<Start> = starts.iter().filter(finite).copied().collect();
        let mut results = self.of_finite(image, &shown).into_iter();
        let result = |start: &Start| if start.position.is_finite() { results.next() } else { Some(Err(Rejection::NotFinite)) };
        starts.iter().map(result).map(|one| one.unwrap_or(Err(Rejection::Malformed))).collect()
    }

    fn is_local(&self) -> bool {
        // An image goes over once.
        false
    }

    fn board_finder(&self) -> Option<&dyn BoardFinder> {
        self.boards().map(|_| self as &dyn BoardFinder)
    }

    fn told(&self) -> Told {
        self.program.told.all()
    }
}
