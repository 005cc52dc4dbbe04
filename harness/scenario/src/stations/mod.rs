//! The `[stations]` and `[[station]]` tables: where the cameras of a scenario stand.

use calibench_diagnostics::Problem;
use calibench_model::camera::Camera;
use calibench_model::{Pose, Testfield};
use calibench_random::Key;
use calibench_synth::sensor::{Gradient, Per};
use calibench_synth::stations::{
    Aim, Arc, BoardViews, Own, RandomViews, Ring, Stand, StandBend, Station, StationError, check_names, check_sight, sees,
};
use nalgebra::{Point3, Vector3};

use super::imaging::Imaging;
use super::optics::motion;
use super::section::Section;
use super::testfield::{Spans, take_kind, wire::Degrees};

/// What the names of images before the sensor end in.
pub const NOISE_FREE: &str = "-noise-free";

pub mod wire;

use wire::{ArcWire, BoardWire, CommonWire, ConvergentWire, RandomWire, StandWire, StationWire};

/// The kinds of generators.
pub const KINDS: [&str; 5] = ["convergent", "arc", "board", "random", "stand"];
/// The keys of `[stations]` that every kind has.
const COMMON: [&str; 5] = ["sees", "middle", "facing", "up", "each_trial"];
/// The files that are written beside the images, without their endings.
const TAKEN: [&str; 7] = ["stations", "control", "camera", "starts", "rendered", LOCAL_DISTORTION, "records"];
/// The file of the camera's local distortion, without its ending.
pub const LOCAL_DISTORTION: &str = "local-distortion";

/// What makes stations.
#[derive(Clone, Debug, PartialEq)]
pub enum Generator {
    /// On a ring.
    Convergent(Ring),
    /// On an arc.
    Arc(Arc),
    /// At given tilts.
    Board(BoardViews),
    /// At random.
    Random(RandomViews),
    /// Before a stand.
    Stand(Stand),
}

/// How a given station is turned.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Attitude {
    /// omega, phi, kappa, radians.
    Angles([f64; 3]),
    /// Looking at a point.
    Towards { target: Point3<f64>, up: Option<Vector3<f64>>, roll: f64 },
}

#[derive(Clone, Debug)]
struct Given {
    name: String,
    at: Point3<f64>,
    attitude: Attitude,
    own: Own,
}

/// Checked `[stations]` and `[[station]]` tables.
#[derive(Clone, Debug)]
pub struct StationPlan {
    /// What makes stations beside the given ones.
    pub generator: Option<Generator>,
    /// The fraction of the targets that every station must see, 0 to 1.
    pub sees: f64,
    /// Whether they are drawn anew in each trial.
    pub each_trial: bool,
    given: Vec<Given>,
    aim: [Option<[f64; 3]>; 3],
    spans: Spans,
}

impl StationPlan {
    /// Whether places are drawn by chance.
    pub fn is_random(&self) -> bool {
        matches!(self.generator, Some(Generator::Random(_)))
    }

    /// The stations, the given ones first, each of which sees the field.
    ///
    /// # Errors
    /// What does not fit together, and a station that does not see enough of the field, by name.
    pub fn generate(&self, field: &Testfield, camera: &Camera, key: Key<'_>) -> Result<Vec<Station>, StationError> {
        let aim = self.aim(field);
        let mut stations: Vec<Station> = self.given.iter().map(|given| given.station(aim.as_ref())).collect::<Result<_, _>>()?;
        if let Some(generator) = &self.generator {
            let aim = aim.ok_or_else(|| StationError::Undetermined("stations".into()))?;
            let least = self.sees;
            stations.extend(match generator {
                Generator::Convergent(ring) => ring.generate(&aim)?,
                Generator::Arc(arc) => arc.generate(&aim)?,
                Generator::Board(views) => views.generate(&aim)?,
                Generator::Stand(stand) => stand.generate(&aim, field)?,
                Generator::Random(views) => views.generate(&aim, key, |pose| {
                    let seen = sees(camera, pose, field);
                    seen > 0.0 && seen >= least
                })?,
            });
        }
        check_names(&stations)?;
        check_sight(camera, &stations, field, self.sees)?;
        Ok(stations)
    }

    /// An error of [`Self::generate`] at its place in the file.
    pub fn problem(&self, error: &StationError) -> Problem {
        let span = match error {
            StationError::Parameter { parameter, .. } | StationError::Many { parameter, .. } | StationError::Empty(parameter) => {
                self.spans.of_key(parameter)
            }
            StationError::Plates(_) | StationError::BentTwice(_) => self.spans.of_key("bend"),
            StationError::Undetermined(name)
            | StationError::Twice(name)
            | StationError::Unseen { name, .. }
            | StationError::NoneSees { name, .. } => self.spans.of_id(name),
        };
        Problem::new(span.unwrap_or_else(|| self.spans.whole.clone()), error.to_string())
    }

    /// Whether lens and sensor can be what each station says; mistakes are added to `problems`.
    pub fn check_imaging(&self, imaging: &Imaging, problems: &mut Vec<Problem>) {
        for given in &self.given {
            if let Err(error) = imaging.with(&given.own) {
                let span = self.spans.of_id(&given.name).unwrap_or_else(|| self.spans.whole.clone());
                problems.push(Problem::new(span, format!("station `{}`: {error}", given.name)));
            }
        }
    }

    /// The field's own aim with what the file gives instead.
    fn aim(&self, field: &Testfield) -> Option<Aim> {
        let own = Aim::of(field);
        let [middle, facing, up] = self.aim;
        let middle = middle.map(Point3::from).or(own.map(|aim| aim.middle))?;
        let facing = facing.map(Vector3::from).or(own.map(|aim| aim.facing.into_inner()))?;
        let up = up.map(Vector3::from).or(own.map(|aim| aim.up.into_inner()))?;
        Aim::new(middle, facing, up)
    }
}

impl Given {
    fn station(&self, aim: Option<&Aim>) -> Result<Station, StationError> {
        let pose = match self.attitude {
            Attitude::Angles(angles) => Some(Pose::from_angles(self.at, angles)),
            Attitude::Towards { target, up, roll } => {
                let up = up.or(aim.map(|aim| aim.up.into_inner()));
                up.and_then(|up| Pose::looking_at(self.at, target, up, roll))
            }
        };
        let pose = pose.ok_or_else(|| StationError::Undetermined(self.name.clone()))?;
        Ok(Station { own: self.own, ..Station::new(self.name.clone(), pose) })
    }
}

/// Reads `[stations]` and the `[[station]]` tables; mistakes are added to `problems`. `None` if there are neither.
pub fn read(stations: Option<Section<'_>>, given: Vec<Section<'_>>, problems: &mut Vec<Problem>) -> Option<StationPlan> {
    let before = problems.len();
    let mut spans = stations.as_ref().or(given.first()).map(Spans::of)?;
    given.iter().for_each(|section| spans.add(section));
    let mut common = None;
    let mut generator = None;
    if let Some(mut section) = stations {
        common = section.take_keys(&COMMON).read::<CommonWire>(&[], problems);
        generator = read_generator(section, problems);
    }
    let given: Vec<Given> = given.into_iter().filter_map(|section| read_given(section, problems)).collect();
    if problems.len() > before {
        return None;
    }
    let random = matches!(generator, Some(Generator::Random(_)));
    let least = common.as_ref().and_then(|common| common.sees).map_or(f64::from(u8::from(random)), |fraction| fraction.0);
    let each_trial = common.as_ref().and_then(|common| common.each_trial).unwrap_or(false);
    if each_trial && !random {
        problems.push(Problem::new(spans.whole, "`each_trial` without `kind = \"random\"`: the stations are the same in every trial"));
        return None;
    }
    if let (Some(Generator::Stand(_)), Some(span)) = (&generator, spans.of_key("facing")) {
        problems.push(Problem::new(span, "`facing` with `kind = \"stand\"`: the field faces as its sheet does, expected none"));
        return None;
    }
    let aim = common.map_or([None; 3], |common| [common.middle, common.facing, common.up].map(|tuple| tuple.map(|tuple| tuple.0)));
    Some(StationPlan { generator, sees: least, each_trial, given, aim, spans })
}

fn read_generator(mut section: Section<'_>, problems: &mut Vec<Problem>) -> Option<Generator> {
    let angle = |angle: Option<Degrees>| angle.map_or(0.0, radian);
    match take_kind(&mut section, "[stations]", &KINDS, problems)? {
        "convergent" => {
            let wire: ConvergentWire = section.read(&COMMON, problems)?;
            let distances = wire.distances.iter().map(|length| length.0).collect();
            let (start, rolls) = (angle(wire.start), radians(wire.rolls));
            Some(Generator::Convergent(Ring { count: wire.count.0, angle: wire.angle.0.to_radians(), start, distances, rolls }))
        }
        "arc" => {
            let wire: ArcWire = section.read(&COMMON, problems)?;
            Some(Generator::Arc(Arc {
                count: wire.count.0,
                convergence: wire.convergence.0.to_radians(),
                distances: wire.distances.iter().map(|length| length.0).collect(),
                heights: wire.heights.map_or(vec![0.0], |heights| heights.iter().map(|height| height.0).collect()),
                rolls: radians(wire.rolls),
            }))
        }
        "board" => {
            let wire: BoardWire = section.read(&COMMON, problems)?;
            let tilts = wire.tilts.iter().map(|tilt| tilt.0.map(f64::to_radians)).collect();
            let distances = wire.distances.iter().map(|length| length.0).collect();
            Some(Generator::Board(BoardViews { tilts, distances, rolls: radians(wire.rolls) }))
        }
        "stand" => read_stand(section, problems).map(Generator::Stand),
        _ => {
            let wire: RandomWire = section.read(&COMMON, problems)?;
            Some(Generator::Random(RandomViews {
                count: wire.count.0,
                distance: wire.distance.0,
                tilt: wire.tilt.0.to_radians(),
                roll: angle(wire.roll),
                aside: wire.aside.map_or([0.0; 2], |aside| aside.0),
            }))
        }
    }
}

fn read_stand(section: Section<'_>, problems: &mut Vec<Problem>) -> Option<Stand> {
    let spans = Spans::of(&section);
    let wire: StandWire = section.read(&COMMON, problems)?;
    let needs = [
        ("bend", wire.bend.is_some(), "bend_reach", wire.bend_reach.is_some()),
        ("bend_reach", wire.bend_reach.is_some(), "bend", wire.bend.is_some()),
        ("bend_across", wire.bend_across.is_some(), "bend", wire.bend.is_some()),
    ];
    for (key, _, needed, _) in needs.into_iter().filter(|(_, given, _, there)| *given && !there) {
        let span = spans.of_key(key).unwrap_or_else(|| spans.whole.clone());
        problems.push(Problem::new(span, format!("`{key}` without `{needed}`: expected both or none")));
    }
    let across = wire.bend_across.map_or(0.0, radian);
    let bend = wire.bend.zip(wire.bend_reach).filter(|(peak, _)| peak.0 != 0.0);
    let bend = bend.map(|(peak, reach)| StandBend { peak: peak.0, reach: reach.0, across });
    Some(Stand { phis: radians(Some(wire.phis)), turns: radians(wire.turns), rolls: radians(wire.rolls), distance: wire.distance.0, bend })
}

fn radian(angle: Degrees) -> f64 {
    angle.0.to_radians()
}

/// Angles; 0 alone where the file gives none.
fn radians(angles: Option<Vec<Degrees>>) -> Vec<f64> {
    angles.map_or(vec![0.0], |all| all.into_iter().map(radian).collect())
}

/// Whether images can be called by this name on any file system.
fn names_a_file(name: &str) -> bool {
    !name.starts_with('.') && name.len() <= 100 && !name.contains(['/', '\\', ':', '*', '?', '"', '<', '>', '|'])
}

fn read_given(section: Section<'_>, problems: &mut Vec<Problem>) -> Option<Given> {
    let wire: StationWire = section.read(&[], problems)?;
    let name = wire.name.get_ref().clone();
    let mut wrong = |message: &str, help: &str| {
        problems.push(Problem::new(wire.name.span(), format!("station `{name}` {message}")).help(help));
        None
    };
    if name.trim().is_empty() || name.chars().any(char::is_control) {
        return wrong("has a name that cannot be read", "expected a word");
    }
    if !names_a_file(&name) {
        return wrong("is no plain file name", "its image is the file of that name");
    }
    if TAKEN.contains(&name.to_lowercase().as_str()) || name.ends_with(NOISE_FREE) {
        return wrong("has the name of another file that is written", "expected another name");
    }
    let attitude = match (wire.angles, wire.towards) {
        (Some(_), None) if wire.up.is_some() || wire.roll.is_some() => {
            return wrong("has `up` or `roll` beside `angles`", "they belong to `towards`");
        }
        (Some(angles), None) => Attitude::Angles(angles.0.map(f64::to_radians)),
        (None, Some(target)) => Attitude::Towards {
            target: Point3::from(target.0),
            up: wire.up.map(|up| Vector3::from(up.0)),
            roll: wire.roll.map_or(0.0, |roll| roll.0.to_radians()),
        },
        (Some(_), Some(_)) => return wrong("has both `angles` and `towards`", "expected one of them"),
        (None, None) => return wrong("does not say how it is turned", "give `angles` or `towards`"),
    };
    let gradient = wire.gradient_across.map(|numbers| Gradient { x: numbers.0[0].0, y: numbers.0[1].0, per: Per::Frame });
    let own = Own {
        blur: wire.blur.map(|blur| blur.0),
        motion: wire.motion.map(motion),
        exposure: wire.exposure.map(|factor| factor.0),
        veil: wire.veil.map(|veil| veil.0),
        gradient,
    };
    Some(Given { at: Point3::from(wire.at.0), name, attitude, own })
}

#[cfg(test)]
mod tests;
