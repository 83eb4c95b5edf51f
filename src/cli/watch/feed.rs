//! The topics that the dashboard listens to.

use std::time::Instant;

use super::board::Board;
use crate::dds::network::Network;
use crate::messages::topics;
use crate::messages::{
    AlarmList, BitState, ContactForces, JointDeflections, Transfer, TwinStatus, WhirlState, WhirlWarning,
};
use crate::ros::subscriber::{Listener, ListenerBuilder, TopicReader};
use flexdrill_ros2::JoinError;

pub(super) struct Feed {
    status: TopicReader<TwinStatus>,
    bit: TopicReader<BitState>,
    transfer: TopicReader<Transfer>,
    contacts: TopicReader<ContactForces>,
    joints: TopicReader<JointDeflections>,
    whirl: TopicReader<WhirlState>,
    warning: TopicReader<WhirlWarning>,
    alarms: TopicReader<AlarmList>,
    status_topic: String,
    _listener: Listener,
}

impl Feed {
    pub(super) fn new(network: &Network, namespace: &str) -> Result<Self, JoinError> {
        let mut listener = ListenerBuilder::new(network, namespace, "flexdrill_watch")?;
        Ok(Self {
            status: listener.subscribe(&topics::STATUS)?,
            bit: listener.subscribe(&topics::BIT_STATE)?,
            transfer: listener.subscribe(&topics::TRANSFER)?,
            contacts: listener.subscribe(&topics::CONTACT_FORCES)?,
            joints: listener.subscribe(&topics::JOINT_DEFLECTIONS)?,
            whirl: listener.subscribe(&topics::WHIRL)?,
            warning: listener.subscribe(&topics::WHIRL_WARNINGS)?,
            alarms: listener.subscribe(&topics::ALARMS)?,
            status_topic: listener.topic_name(&topics::STATUS)?,
            _listener: listener.start()?,
        })
    }

    pub(super) fn status_topic(&self) -> &str {
        &self.status_topic
    }

    /// Puts all that has arrived on the board.
    pub(super) fn drain(&mut self, board: &mut Board, now: Instant) {
        let unreadable = self.status.drain(|message| board.update_status(message, now))
            + self.bit.drain(|message| board.update_bit(message))
            + self.transfer.drain(|message| board.update_transfer(message))
            + self.contacts.drain(|message| board.update_contacts(message))
            + self.joints.drain(|message| board.update_joints(message))
            + self.whirl.drain(|message| board.update_whirl(message))
            + self.warning.drain(|message| board.update_warning(message))
            + self.alarms.drain(|message| board.update_alarms(message));
        board.add_unreadable(unreadable);
    }
}
