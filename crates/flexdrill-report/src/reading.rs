//! Reads a bag in one pass.

use std::path::{Path, PathBuf};

use crate::ReportError;
use crate::balances::Balances;
use crate::drive::Drive;
use crate::figures::FigureHistories;
use crate::health::Health;
use crate::hole::HoleHistory;
use crate::incidents::Incidents;
use crate::life::JointLives;
use crate::locations::Locations;
use crate::roles::{OUTPUTS, Roles};
use crate::tools::PlausibleTools;
use crate::transfer::TransferHistory;
use crate::weight::SteadyDrilling;
use flexdrill_bag::{BagError, BagMessage, Gap, Gaps};
use flexdrill_config::Config;
use flexdrill_core::inputs::InputKind;
use flexdrill_field_log::LogRows;
use flexdrill_life::Lives;
use flexdrill_messages::std_msgs::{Float64, Header};
use flexdrill_messages::topics::TopicInfo;
use flexdrill_messages::{
    Ageing, AlarmEvent, AlarmList, AppliedInputs, Bands, BitState, ContactForces, HoleAhead, JointDeflections, Message,
    Reactions, RigInputs, SessionInfo, Transfer, TwinStatus, WhirlState,
};
use flexdrill_outputs::figures::BIT_STATE;
use flexdrill_text::counted;

/// Largest number of damaged parts listed.
const NAMED: usize = 20;
/// A stamp further than this before the beginning belongs to another run (ns): a second.
const BEFORE: i64 = 1_000_000_000;

/// Summary of a recording.
#[derive(Debug)]
pub struct Summary {
    pub(crate) path: PathBuf,
    pub(crate) namespace: String,
    /// First and last instant of the model on the rig's clock (ns).
    pub(crate) start: i64,
    pub(crate) end: i64,
    pub(crate) messages: u64,
    pub(crate) session: Option<SessionInfo>,
    /// Number of runs in the bag: of different sessions.
    pub(crate) runs: u64,
    /// The session's configuration, if this version can read it.
    pub(crate) config: Option<Config>,
    pub(crate) config_problem: Option<String>,
    pub(crate) drive: Drive,
    /// The figures of `twin/bit_state`.
    pub(crate) bit: FigureHistories<BitState>,
    pub(crate) transfer: TransferHistory,
    pub(crate) steady: SteadyDrilling,
    pub(crate) tools: PlausibleTools,
    pub(crate) hole: HoleHistory,
    pub(crate) life: JointLives,
    pub(crate) balances: Balances,
    pub(crate) incidents: Incidents,
    /// The rows of the field log that drove the run; none of another run.
    pub(crate) log_rows: LogRows,
    pub(crate) locations: Locations,
    pub(crate) health: Health,
    /// Missing or incomplete data, each as a sentence.
    pub(crate) missing: Vec<String>,
}

/// Messages of a topic that could not be read.
#[derive(Debug)]
struct Unreadable {
    known: &'static TopicInfo,
    count: u64,
    first: String,
}

impl Summary {
    /// Adds the table of all runs of the joints, whose ranking the page then has.
    #[must_use]
    pub fn with_lives(mut self, lives: Lives) -> Self {
        self.life.lives = Some(lives);
        self
    }

    /// Missing or incomplete data, each as a sentence.
    pub fn missing(&self) -> impl Iterator<Item = &str> {
        self.missing.iter().map(String::as_str)
    }
}

struct Reader {
    summary: Summary,
    /// Origin of all times (ns), once it is known.
    origin: Option<i64>,
    unreadable: Vec<Unreadable>,
    backwards: u64,
}

/// Reads the recording of the twin in `namespace`, which may be `None` if the bag has one twin. `progress` receives the
/// share of the recorded time that has been read (0 to 1).
///
/// # Errors
/// When the bag cannot be read, has no twin, or has several. Damaged parts are left out and listed.
pub fn read(path: &Path, namespace: Option<&str>, mut progress: impl FnMut(f64)) -> Result<Summary, ReportError> {
    let mut bag = flexdrill_bag::open(path)?;
    let roles = Roles::find(path, &bag, namespace)?;
    let used: Vec<bool> = (0..bag.topics().len()).map(|index| roles.of(index).is_some()).collect();
    let names: Vec<_> = bag.topics().to_vec();
    bag.select(|topic| names.iter().zip(&used).any(|(known, used)| *used && **known == *topic));
    let bounds = bag.bounds();
    let mut reader = Reader::new(path, &roles);
    let (mut gaps, mut damaged) = (Gaps::default(), Vec::new());
    for message in bag.by_ref() {
        let message = match message {
            Err(error @ BagError::Damaged { .. }) => {
                damaged.push(error.to_string());
                continue;
            }
            message => message?,
        };
        gaps.observe(&message);
        if let Some((start, end)) = bounds.filter(|(start, end)| end > start) {
            progress((message.log_time.saturating_sub(start)) as f64 / (end.saturating_sub(start)) as f64);
        }
        if let Some(known) = roles.of(message.topic_index) {
            reader.add(known, &message);
        }
    }
    let cuts = bag.cuts().map(|cut| {
        format!(
            "{} was cut short ({}): the report covers it up to byte {}.",
            cut.path.display(),
            cut.reason,
            cut.offset
        )
    });
    let faults = bag.faults().iter().map(|fault| format!("{fault}."));
    let cuts: Vec<String> = faults.chain(cuts).collect();
    Ok(reader.finish(&roles, cuts, &damaged, &gaps.found()))
}

impl Reader {
    fn new(path: &Path, roles: &Roles) -> Self {
        Self {
            summary: Summary {
                path: path.to_owned(),
                namespace: roles.namespace.clone(),
                start: 0,
                end: 0,
                messages: 0,
                session: None,
                runs: 0,
                config: None,
                config_problem: None,
                drive: Drive::default(),
                bit: FigureHistories::of(BIT_STATE),
                transfer: TransferHistory::default(),
                steady: SteadyDrilling::default(),
                tools: PlausibleTools::default(),
                hole: HoleHistory::default(),
                life: JointLives::default(),
                balances: Balances::default(),
                incidents: Incidents::default(),
                log_rows: LogRows::default(),
                locations: Locations::default(),
                health: Health::default(),
                missing: Vec::new(),
            },
            origin: None,
            unreadable: Vec::new(),
            backwards: 0,
        }
    }

    fn add(&mut self, known: &'static TopicInfo, message: &BagMessage) {
        self.summary.messages += 1;
        if let Err(error) = self.decode(known, message) {
            match self.unreadable.iter_mut().find(|unreadable| unreadable.known == known) {
                Some(unreadable) => unreadable.count += 1,
                None => self.unreadable.push(Unreadable {
                    known,
                    count: 1,
                    first: error.to_string(),
                }),
            }
        }
    }

    /// Time from the beginning (s) of an instant of the rig's clock (ns).
    fn time(&mut self, nanoseconds: i64) -> f64 {
        let origin = *self.origin.get_or_insert(nanoseconds);
        if nanoseconds < origin.saturating_sub(BEFORE) {
            self.backwards += 1;
        }
        self.summary.end = self.summary.end.max(nanoseconds);
        nanoseconds.saturating_sub(origin) as f64 * 1e-9
    }

    fn stamp(&mut self, header: &Header) -> f64 {
        self.time(header.stamp.to_nanoseconds())
    }

    fn decode(&mut self, known: &'static TopicInfo, message: &BagMessage) -> Result<(), BagError> {
        // The type decides, since each output has its own. Plain inputs
        // share one type and are distinguished by their topic.
        match known.kind.ros_type {
            SessionInfo::ROS_TYPE => {
                let session: SessionInfo = message.decode()?;
                let summary = &mut self.summary;
                let same =
                    |known: &SessionInfo| known.start == session.start && known.config_hash == session.config_hash;
                // A session may be in the bag several times; only another start or configuration is another run.
                if !summary.session.as_ref().is_some_and(same) {
                    summary.runs += 1;
                    if summary.session.is_none() {
                        // A configuration that this version does not read is no error:
                        // the report then lacks what depends on it.
                        match Config::from_text("the recorded configuration", &session.configuration) {
                            Ok(config) => {
                                summary.balances.tool(&config);
                                summary.steady.tool(&config);
                                summary.config = Some(config);
                            }
                            Err(error) => summary.config_problem = Some(error.to_string()),
                        }
                        summary.session = Some(session);
                    }
                }
            }
            AppliedInputs::ROS_TYPE => {
                let inputs: AppliedInputs = message.decode()?;
                // Stamps are the twin's time; the first one is the origin of the report.
                let time = self.stamp(&inputs.header);
                self.summary.drive.applied(time, &inputs);
                self.summary.balances.applied(time, &inputs);
            }
            BitState::ROS_TYPE => {
                let bit: BitState = message.decode()?;
                let time = self.stamp(&bit.header);
                self.summary.drive.bit(time, &bit);
                self.summary.bit.push(time, &bit);
                self.summary.balances.bit(time, &bit);
            }
            JointDeflections::ROS_TYPE => {
                let joints: JointDeflections = message.decode()?;
                let time = self.stamp(&joints.header);
                self.summary.drive.joints(time, &joints);
                self.summary.locations.joints(time, joints);
            }
            ContactForces::ROS_TYPE => {
                let contacts: ContactForces = message.decode()?;
                let time = self.stamp(&contacts.header);
                self.summary.locations.contacts(time, contacts);
            }
            WhirlState::ROS_TYPE => {
                let whirl: WhirlState = message.decode()?;
                let time = self.stamp(&whirl.header);
                self.summary.locations.whirl(time, &whirl);
            }
            Transfer::ROS_TYPE => {
                let transfer: Transfer = message.decode()?;
                let time = self.stamp(&transfer.header);
                self.summary.transfer.push(time, &transfer);
                self.summary.steady.push(time, &transfer);
                self.summary.balances.transfer(time, &transfer);
            }
            Bands::ROS_TYPE => {
                let bands: Bands = message.decode()?;
                let time = self.stamp(&bands.header);
                self.summary.tools.push(time, &bands);
            }
            HoleAhead::ROS_TYPE => {
                let hole: HoleAhead = message.decode()?;
                let time = self.stamp(&hole.header);
                self.summary.hole.push(time, &hole);
            }
            Ageing::ROS_TYPE => {
                let ageing: Ageing = message.decode()?;
                let _ = self.stamp(&ageing.header);
                let start = self
                    .summary
                    .session
                    .as_ref()
                    .map(|session| session.start.to_nanoseconds());
                self.summary.life.push(&ageing, start);
            }
            Reactions::ROS_TYPE => {
                let reactions: Reactions = message.decode()?;
                let time = self.stamp(&reactions.header);
                self.summary.balances.reactions(time, &reactions);
            }
            AlarmList::ROS_TYPE => {
                let list: AlarmList = message.decode()?;
                // The list moves the report's end, though its alarms have their own times.
                let _ = self.stamp(&list.header);
                let origin = self.origin.unwrap_or_default();
                self.summary
                    .incidents
                    // `since` is the twin's time as well, and counts from the same origin.
                    .alarms(list, |alarm| alarm.since.to_nanoseconds().saturating_sub(origin));
            }
            AlarmEvent::ROS_TYPE => {
                let event: AlarmEvent = message.decode()?;
                let time = self.stamp(&event.header);
                self.summary.incidents.event((1e9 * time).round() as i64, &event);
            }
            TwinStatus::ROS_TYPE => {
                let status: TwinStatus = message.decode()?;
                let time = self.stamp(&status.header);
                self.summary.health.status(time, status);
            }
            RigInputs::ROS_TYPE => {
                // Inputs have no stamp of the twin, so their time of reception stands for it.
                let inputs: RigInputs = message.decode()?;
                self.summary.log_rows.push(message.log_time, &inputs.source);
                if let Some(time) = self.received_at(message) {
                    self.summary.drive.rig_inputs(time, &inputs);
                }
            }
            _ => {
                let value = message.decode::<Float64>()?.data;
                if let Some(time) = self.received_at(message) {
                    let drive = &mut self.summary.drive;
                    match InputKind::ALL.into_iter().find(|kind| kind.topic() == known.name) {
                        Some(InputKind::RotarySpeed) => drive.received_speed(time, value),
                        Some(InputKind::WeightOnBit) => drive.received_weight(time, value),
                        Some(InputKind::RateOfPenetration) => drive.received_rate(time, value),
                        Some(InputKind::StandpipePressure) => drive.received_pressure(time, value),
                        None => {}
                    }
                }
            }
        }
        Ok(())
    }

    /// Time at which a sample of the rig was recorded (s from the beginning); `None` before the first output.
    fn received_at(&self, message: &BagMessage) -> Option<f64> {
        Some(message.log_time.saturating_sub(self.origin?) as f64 * 1e-9)
    }

    fn finish(mut self, roles: &Roles, cuts: Vec<String>, damaged: &[String], gaps: &[Gap]) -> Summary {
        let summary = &mut self.summary;
        // All times are relative by now. The absolute ones remain for the head of the page.
        summary.start = self.origin.unwrap_or_default();
        summary.end = summary.end.max(summary.start);
        summary.locations.finish();
        summary.incidents.finish(summary.end.saturating_sub(summary.start));
        // Whatever is missing is listed in words on the page: a report
        // without a note must mean that nothing is missing.
        let missing = &mut summary.missing;
        missing.extend(cuts);
        missing.extend(damaged.iter().take(NAMED).map(|damage| format!("Left out: {damage}.")));
        if damaged.len() > NAMED {
            missing.push(format!(
                "Left out: {} more.",
                counted((damaged.len() - NAMED) as u64, "damaged part")
            ));
        }
        missing.extend(gaps.iter().map(|gap| format!("Lost during the recording: {gap}.")));
        // An output that the bag never had is another matter than one that was lost.
        for known in OUTPUTS.iter().filter(|known| !roles.has(known)) {
            missing.push(format!("The bag has no {}: {}.", known.name, without(known)));
        }
        missing.extend(self.unreadable.iter().map(|unreadable| {
            format!(
                "Left out: {} of {} that cannot be read; the first: {}.",
                counted(unreadable.count, "message"),
                unreadable.known.name,
                unreadable.first
            )
        }));
        // Stamps before the origin come from another run or a clock that was set back.
        if self.backwards > 0 {
            missing.push(format!(
                "Left out of the curves: {} with a stamp from before the beginning.",
                counted(self.backwards, "message")
            ));
        }
        if summary.locations.other_mesh > 0 {
            missing.push(format!(
                "Left out: {} with another mesh than the first.",
                counted(summary.locations.other_mesh, "message")
            ));
        }
        if summary.runs > 1 {
            missing.push(format!(
                "The bag has {} runs; the report treats them as one, with the configuration of the first.",
                summary.runs
            ));
        }
        self.summary
    }
}

/// The gap in the report when a topic is missing.
fn without(known: &TopicInfo) -> &'static str {
    match known.kind.ros_type {
        SessionInfo::ROS_TYPE => "configuration and version of the run are not known",
        AppliedInputs::ROS_TYPE => "the inputs that the model accepted are not known",
        BitState::ROS_TYPE => "the bit's motion and torque are not known",
        JointDeflections::ROS_TYPE => "moments along the tool and orbits are not known",
        ContactForces::ROS_TYPE => "contact forces are not known",
        WhirlState::ROS_TYPE => "whirl is not known",
        Transfer::ROS_TYPE => "transfer from the surface to the bit is not known (older versions do not publish it)",
        Reactions::ROS_TYPE => "the balance of forces is not known",
        AlarmList::ROS_TYPE => "alarms that stood before it began are not known",
        AlarmEvent::ROS_TYPE => "alarms and incidents are not known",
        // A replay has no status, because it does not run in real time.
        TwinStatus::ROS_TYPE => "pace and health of the model are not known (a replay has none)",
        _ => "its content is not known",
    }
}
