//! The trainings of a study as a queue: the most telling first, each kept when it is finished, so that the work can be stopped at
//! any time, gone on with, and divided among machines.

use super::dataset::{CharGlyph, Dataset};
use super::experiment::Experiment;
use super::family::{STYLES, WEIGHTS};
use super::interpolation;
use super::memorisation::{self, Member};
use super::network_variant::{Ablation, NetworkVariant};
use super::study::{SHARE, StudyPlan};
use nfr_convert::error::Error;

/// A training of a study.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Job {
    /// A network learns a character of the font with this number.
    Memorise {
        /// The number of the font in the plan.
        font: usize,
        /// The character.
        glyph: char,
        /// The network.
        model: NetworkVariant,
    },
    /// One network learns a character of two weights.
    Weights(char),
    /// One network learns a character of two typefaces.
    Styles(char),
}

/// The jobs of a plan, in their order: both networks for the shown characters on the first font, the ablations, the
/// weights, the typefaces, and the rest of the characters by turns of the fonts.
pub fn jobs(plan: &StudyPlan<'_>) -> Vec<Job> {
    let both = |font: usize, glyph: char| {
        let models = [NetworkVariant::Implicit(Vec::new()), NetworkVariant::Masked];
        models.map(|model| Job::Memorise { font, glyph, model })
    };
    let mut jobs: Vec<Job> = plan.shown.chars().flat_map(|glyph| both(0, glyph)).collect();
    for glyph in plan.ablated.chars() {
        jobs.extend(Ablation::ALL.map(|part| {
            let model = NetworkVariant::Implicit(vec![part]);
            Job::Memorise { font: 0, glyph, model }
        }));
    }
    jobs.extend(plan.weighted.chars().map(Job::Weights));
    jobs.extend(plan.styled.chars().map(Job::Styles));
    let rest = plan.glyphs.chars().filter(|glyph| !plan.shown.contains(*glyph));
    for glyph in plan.shown.chars().chain(rest) {
        jobs.extend((0..plan.fonts.len()).flat_map(|font| both(font, glyph)));
    }
    let mut queue: Vec<Job> = Vec::new();
    for job in jobs {
        if !queue.contains(&job) {
            queue.push(job);
        }
    }
    queue
}

/// How far a queue has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct QueueState {
    /// Jobs with results.
    pub finished: usize,
    /// All jobs.
    pub jobs: usize,
}

/// Does the jobs in their order, as many at once as the context says, until all are done or the time is up.
///
/// # Errors
///
/// As the trainings'. What is finished by then is kept.
pub fn run(plan: &StudyPlan<'_>, context: &Experiment<'_>, part: QueuePart) -> Result<QueueState, Error> {
    let all: Vec<Job> = jobs(plan).into_iter().filter(|job| part.networks.contains(job)).collect();
    let mine: Vec<&Job> = all.iter().skip(part.share.number - 1).step_by(part.share.of).collect();
    let portions = portions(plan, context, &mine)?;
    let done = context.each(&portions, |portion| {
        let done = match portion {
            Portion::One(job) => train(plan, context, job),
            Portion::Together(members) => match memorisation::train_together(context, members) {
                Ok(true) => Ok(()),
                Ok(false) => Err(Error::TimeLimit),
                Err(error) => Err(error),
            },
        };
        match done {
            Ok(()) => Ok(portion.jobs()),
            Err(Error::TimeLimit) => Ok(0),
            Err(error) => Err(error),
        }
    })?;
    Ok(QueueState { finished: done.into_iter().sum(), jobs: mine.len() })
}

/// What is trained at once.
enum Portion<'p> {
    One(&'p Job),
    /// Networks in lockstep.
    Together(Vec<Member<'p>>),
}

impl Portion<'_> {
    fn jobs(&self) -> usize {
        match self {
            Self::One(_) => 1,
            Self::Together(members) => members.len(),
        }
    }
}

/// The portions of a queue. Jobs that can be done in lockstep are done with the next ones that can, at the place of the first.
fn portions<'p>(
    plan: &'p StudyPlan<'p>,
    context: &Experiment<'_>,
    queue: &[&'p Job],
) -> Result<Vec<Portion<'p>>, Error> {
    let mut portions: Vec<Portion<'p>> = Vec::new();
    let mut open = None;
    for job in queue {
        let member = if context.together > 1 { member(plan, job)? } else { None };
        let member = match member {
            Some(member) if memorisation::is_waiting(context, &member)? => member,
            _ => {
                portions.push(Portion::One(job));
                continue;
            }
        };
        match open.and_then(|at: usize| portions.get_mut(at)) {
            Some(Portion::Together(members)) if members.len() < context.together => members.push(member),
            _ => {
                open = Some(portions.len());
                portions.push(Portion::Together(vec![member]));
            }
        }
    }
    Ok(portions)
}

/// A job as a network of one glyph, if it is one.
fn member<'p>(plan: &'p StudyPlan<'p>, job: &Job) -> Result<Option<Member<'p>>, Error> {
    let Job::Memorise { font, glyph, model } = job else { return Ok(None) };
    let dataset = &plan.fonts[*font];
    // A network that is stored in a font is needed after its training.
    let keep_network =
        *font == 0 && plan.stored.contains(*glyph) && *model == NetworkVariant::Implicit(Vec::new());
    let glyph = glyph_of(dataset, *glyph)?;
    Ok(Some(Member { dataset, glyph, model: model.clone(), keep_network }))
}

/// The part of a queue that a run does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct QueuePart {
    /// The networks that it trains.
    pub networks: QueueNetworks,
    /// Its share of their jobs.
    pub share: QueueShare,
}

/// The networks that a run trains: a device may be good for one of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum QueueNetworks {
    /// Both.
    All,
    /// The implicit one, with the experiments on families.
    Implicit,
    /// The masked one.
    Masked,
}

impl QueueNetworks {
    fn contains(self, job: &Job) -> bool {
        let masked = matches!(job, Job::Memorise { model: NetworkVariant::Masked, .. });
        match self {
            Self::All => true,
            Self::Implicit => !masked,
            Self::Masked => masked,
        }
    }
}

impl std::str::FromStr for QueueNetworks {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        match name {
            "all" => Ok(Self::All),
            "implicit" => Ok(Self::Implicit),
            "masked" => Ok(Self::Masked),
            _ => Err(format!("unknown network {name:?}; use all, implicit or masked")),
        }
    }
}

/// The part of a queue that one of several runs does: every job whose number in the queue is `number`, counted from 1, or that and a
/// multiple of `of`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct QueueShare {
    /// Which part, from 1.
    pub number: usize,
    /// How many parts there are.
    pub of: usize,
}

impl QueueShare {
    /// All of it.
    pub const WHOLE: Self = Self { number: 1, of: 1 };
}

impl std::str::FromStr for QueueShare {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts =
            text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match parts {
            Some((number, of)) if 1 <= number && number <= of => Ok(Self { number, of }),
            _ => Err(format!("{text:?} is no part of a whole; write it as 2/3, the second of three")),
        }
    }
}

fn train(plan: &StudyPlan<'_>, context: &Experiment<'_>, job: &Job) -> Result<(), Error> {
    match job {
        Job::Memorise { .. } => {
            let Some(member) = member(plan, job)? else { return Ok(()) };
            let context = context.keeping_networks(member.keep_network);
            memorisation::trained(&context, member.dataset, member.glyph, &member.model).map(drop)
        }
        Job::Weights(glyph) => {
            interpolation::trained(context, WEIGHTS, &plan.weights, SHARE, *glyph).map(drop)
        }
        Job::Styles(glyph) => interpolation::trained(context, STYLES, &plan.styles, SHARE, *glyph).map(drop),
    }
}

fn glyph_of(dataset: &Dataset, glyph: char) -> Result<CharGlyph, Error> {
    dataset.glyphs(glyph.encode_utf8(&mut [0; 4]))?.pop().ok_or(Error::MissingGlyph(0))
}
