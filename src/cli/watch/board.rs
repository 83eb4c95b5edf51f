//! The state of the dashboard: the newest message of each topic, a short history of the bit, and held force peaks.

use std::borrow::Cow;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

use super::profile::HeldPeaks;
use crate::messages::{
    AlarmList, BitState, ContactForces, JointDeflections, Transfer, TwinStatus, WhirlState, WhirlWarning,
};
use flexdrill_core::units::rad_per_s_to_rpm;
use flexdrill_text::printable;

/// A heartbeat is lost after this time: ten beats at the default 5 Hz.
const HEARTBEAT_LOST: Duration = Duration::from_secs(2);
/// Length of the bit's history in model time (s).
pub(super) const HISTORY: f64 = 30.0;
/// Least model time between two points of the history (s).
const HISTORY_SPACING: f64 = 0.05;

/// One point of the bit's history.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BitPoint {
    /// Stamp (s).
    pub(super) time: f64,
    pub(super) speed_rpm: f64,
    pub(super) torque: f64,
}

pub(super) struct Board {
    started: Instant,
    status: Option<(TwinStatus, Instant)>,
    bit: Option<BitState>,
    transfer: Option<Transfer>,
    contacts: Option<ContactForces>,
    joints: Option<JointDeflections>,
    whirl: Option<WhirlState>,
    warning: Option<WhirlWarning>,
    alarms: Option<AlarmList>,
    history: VecDeque<BitPoint>,
    pipe_guide: HeldPeaks,
    guide_wall: HeldPeaks,
    unreadable: u64,
}

/// Whether the twin's heart beats.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Heartbeat {
    /// No message has been received for this time.
    Waiting(Duration),
    Beating,
    /// The last message is this old.
    Lost(Duration),
}

impl Board {
    pub(super) fn new(now: Instant) -> Self {
        Self {
            started: now,
            status: None,
            bit: None,
            transfer: None,
            contacts: None,
            joints: None,
            whirl: None,
            warning: None,
            alarms: None,
            history: VecDeque::new(),
            pipe_guide: HeldPeaks::default(),
            guide_wall: HeldPeaks::default(),
            unreadable: 0,
        }
    }

    pub(super) fn update_status(&mut self, mut status: TwinStatus, now: Instant) {
        for text in [
            &mut status.model_quality_cause,
            &mut status.last_rejection_cause,
            &mut status.recording_path,
            &mut status.version,
            &mut status.config_hash,
            &mut status.dds_restart_cause,
            &mut status.dds_stalled_reader,
            &mut status.recording_drops_cause,
        ] {
            escape(text);
        }
        let lists = [
            &mut status.input_name,
            &mut status.input_driver,
            &mut status.input_publishers,
            &mut status.input_source,
            &mut status.output_topic,
            &mut status.phase_name,
            &mut status.namesake,
            &mut status.changed_parameter,
        ];
        lists.into_iter().flatten().for_each(escape);
        // A heartbeat that counts from the start again belongs to another run, so that the state of the last one is void.
        if self
            .status
            .as_ref()
            .is_some_and(|(last, _)| status.sequence < last.sequence)
        {
            let (started, unreadable) = (self.started, self.unreadable);
            *self = Self::new(now);
            (self.started, self.unreadable) = (started, unreadable);
        }
        self.status = Some((status, now));
    }

    pub(super) fn update_bit(&mut self, bit: BitState) {
        let time = stamp(&bit.header);
        match self.history.back() {
            Some(last) if time < last.time => self.history.clear(),
            Some(last) if time - last.time < HISTORY_SPACING => {
                self.bit = Some(bit);
                return;
            }
            _ => {}
        }
        self.history.push_back(BitPoint {
            time,
            speed_rpm: rad_per_s_to_rpm(bit.rotary_speed),
            torque: bit.torque,
        });
        while self.history.front().is_some_and(|first| time - first.time > HISTORY) {
            self.history.pop_front();
        }
        self.bit = Some(bit);
    }

    pub(super) fn update_transfer(&mut self, transfer: Transfer) {
        self.transfer = Some(transfer);
    }

    pub(super) fn update_contacts(&mut self, contacts: ContactForces) {
        let time = stamp(&contacts.header);
        self.pipe_guide.take(time, &contacts.pipe_guide_normal_peak);
        self.guide_wall.take(time, &contacts.guide_wall_normal_peak);
        self.contacts = Some(contacts);
    }

    pub(super) fn update_joints(&mut self, joints: JointDeflections) {
        self.joints = Some(joints);
    }

    pub(super) fn update_whirl(&mut self, whirl: WhirlState) {
        self.whirl = Some(whirl);
    }

    /// A latched topic may deliver old samples too: the highest sequence counts.
    pub(super) fn update_warning(&mut self, mut warning: WhirlWarning) {
        escape(&mut warning.message);
        if self
            .warning
            .as_ref()
            .is_none_or(|last| warning.sequence >= last.sequence)
        {
            self.warning = Some(warning);
        }
    }

    /// As with warnings; of lists with the same sequence the newest counts.
    pub(super) fn update_alarms(&mut self, mut alarms: AlarmList) {
        for alarm in &mut alarms.alarms {
            for text in [
                &mut alarm.id,
                &mut alarm.name,
                &mut alarm.unit,
                &mut alarm.evidence,
                &mut alarm.cause,
                &mut alarm.consequence,
                &mut alarm.what_to_do,
                &mut alarm.what_the_engineer_can_do,
                &mut alarm.follows,
            ] {
                escape(text);
            }
        }
        let newer = |last: &AlarmList| {
            (alarms.sequence, alarms.header.stamp.to_nanoseconds())
                >= (last.sequence, last.header.stamp.to_nanoseconds())
        };
        if self.alarms.as_ref().is_none_or(newer) {
            self.alarms = Some(alarms);
        }
    }

    pub(super) fn add_unreadable(&mut self, count: u64) {
        self.unreadable += count;
    }

    pub(super) fn status(&self) -> Option<&TwinStatus> {
        self.status.as_ref().map(|(status, _)| status)
    }

    pub(super) fn heartbeat(&self, now: Instant) -> Heartbeat {
        match &self.status {
            None => Heartbeat::Waiting(now - self.started),
            Some((_, at)) if now - *at > HEARTBEAT_LOST => Heartbeat::Lost(now - *at),
            Some(_) => Heartbeat::Beating,
        }
    }

    pub(super) fn bit(&self) -> Option<&BitState> {
        self.bit.as_ref()
    }

    pub(super) fn transfer(&self) -> Option<&Transfer> {
        self.transfer.as_ref()
    }

    pub(super) fn contacts(&self) -> Option<&ContactForces> {
        self.contacts.as_ref()
    }

    pub(super) fn joints(&self) -> Option<&JointDeflections> {
        self.joints.as_ref()
    }

    pub(super) fn whirl(&self) -> Option<&WhirlState> {
        self.whirl.as_ref()
    }

    pub(super) fn warning(&self) -> Option<&WhirlWarning> {
        self.warning.as_ref()
    }

    pub(super) fn alarms(&self) -> Option<&AlarmList> {
        self.alarms.as_ref()
    }

    pub(super) fn history(&self) -> &VecDeque<BitPoint> {
        &self.history
    }

    /// Held peaks between pipe and guide, and between guide and wall.
    pub(super) fn peaks(&self) -> [&HeldPeaks; 2] {
        [&self.pipe_guide, &self.guide_wall]
    }

    /// Samples that could not be decoded, because the versions of twin and dashboard differ.
    pub(super) fn unreadable(&self) -> u64 {
        self.unreadable
    }

    /// Whether every periodic topic of a twin has been received.
    pub(super) fn is_complete(&self) -> bool {
        self.missing().is_empty()
    }

    pub(super) fn missing(&self) -> Vec<&'static str> {
        use crate::messages::topics;
        [
            (self.status.is_some(), topics::STATUS),
            (self.bit.is_some(), topics::BIT_STATE),
            (self.transfer.is_some(), topics::TRANSFER),
            (self.contacts.is_some(), topics::CONTACT_FORCES),
            (self.joints.is_some(), topics::JOINT_DEFLECTIONS),
            (self.whirl.is_some(), topics::WHIRL),
        ]
        .into_iter()
        .filter_map(|(received, topic)| (!received).then_some(topic.name))
        .collect()
    }
}

/// Escapes control characters: any publisher may have written the text, and it must not control the terminal.
fn escape(text: &mut String) {
    if let Cow::Owned(escaped) = printable(text) {
        *text = escaped;
    }
}

fn stamp(header: &crate::messages::std_msgs::Header) -> f64 {
    header.stamp.to_nanoseconds() as f64 * 1e-9
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::messages::Message;
    use crate::messages::builtin_interfaces::Time;

    fn status(sequence: u64) -> TwinStatus {
        TwinStatus {
            sequence,
            ..TwinStatus::default()
        }
    }

    fn bit(seconds: f64, speed: f64) -> BitState {
        let mut bit = BitState {
            rotary_speed: speed,
            ..BitState::default()
        };
        bit.header.stamp = Time::from_nanoseconds((seconds * 1e9) as i64);
        bit
    }

    #[test]
    fn heartbeat_is_missed_and_a_restart_clears_the_board() {
        let start = Instant::now();
        let mut board = Board::new(start);
        assert!(matches!(board.heartbeat(start), Heartbeat::Waiting(_)));
        board.update_status(status(7), start);
        board.update_warning(WhirlWarning {
            sequence: 9,
            ..WhirlWarning::default()
        });
        board.update_warning(WhirlWarning {
            sequence: 3,
            ..WhirlWarning::default()
        });
        assert_eq!(board.warning().map(|warning| warning.sequence), Some(9));
        assert_eq!(board.heartbeat(start + Duration::from_secs(1)), Heartbeat::Beating);
        let late = start + Duration::from_secs(5);
        assert_eq!(board.heartbeat(late), Heartbeat::Lost(Duration::from_secs(5)));
        board.update_status(status(1), late);
        assert_eq!(board.heartbeat(late), Heartbeat::Beating);
        assert!(board.warning().is_none());
    }

    /// A message of which every text would clear the terminal and forge a line.
    fn evil<M: Message + Default>() -> M {
        let text = serde_json::json!("\x1b[2J\u{202e}\nalarms     none");
        let mut message = serde_json::to_value(M::default()).unwrap();
        let own = M::SCHEMA.split("====").next().unwrap();
        let fields = own.lines().filter_map(|line| line.split('#').next()?.split_once(' '));
        let mut set = 0;
        for (kind, name) in fields {
            let value = match kind {
                "string" => text.clone(),
                "string[]" => serde_json::json!([text]),
                _ => continue,
            };
            set += 1;
            message[name.trim()] = value;
        }
        assert!(set > 0, "{} has texts", M::NAME);
        serde_json::from_value(message).unwrap()
    }

    fn is_escaped(message: &impl serde::Serialize) {
        // JSON writes control characters as its own escapes, and each backslash of ours as two.
        let text = serde_json::to_string(message).unwrap();
        assert!(text.contains("\\\\u{1b}[2J"), "{text}");
        assert!(
            !text.contains("\\u001b") && !text.contains('\u{202e}'),
            "not escaped: {text}"
        );
    }

    #[test]
    fn texts_of_others_do_not_act_on_the_terminal() {
        let now = Instant::now();
        let mut board = Board::new(now);
        board.update_status(evil(), now);
        board.update_warning(evil());
        let list = AlarmList {
            alarms: vec![evil()],
            ..AlarmList::default()
        };
        board.update_alarms(list);
        is_escaped(board.status().unwrap());
        // The frame's name is in no picture.
        is_escaped(&board.warning().unwrap().message);
        is_escaped(&board.alarms().unwrap().alarms[0]);
    }

    #[test]
    fn history_is_bounded_and_follows_a_reset() {
        let mut board = Board::new(Instant::now());
        for step in 0..5000 {
            board.update_bit(bit(f64::from(step) * 0.02, 4.0));
        }
        let (first, last) = (board.history()[0].time, board.history()[board.history().len() - 1].time);
        assert!(last - first <= HISTORY && board.history().len() <= 601);
        board.update_bit(bit(0.0, 4.0));
        assert_eq!(board.history().len(), 1);
    }
}
