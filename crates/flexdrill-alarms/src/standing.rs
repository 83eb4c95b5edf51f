//! The state of one alarm, and what can happen to it.

use serde::{Deserialize, Serialize};

use crate::Time;

/// How soon somebody must act.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Priority {
    /// When there is time.
    Low,
    /// Soon.
    Medium,
    /// At once.
    High,
}

impl Priority {
    /// All of them, rising.
    pub const ALL: [Priority; 3] = [Priority::Low, Priority::Medium, Priority::High];

    /// As ISA-18.2 says it.
    pub fn name(self) -> &'static str {
        match self {
            Priority::Low => "low",
            Priority::Medium => "medium",
            Priority::High => "high",
        }
    }
}

/// The state in one word: the states of ISA-18.2.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[repr(u8)]
pub enum State {
    /// Nothing to do.
    Normal = 0,
    /// The condition stands, and nobody has said that he knows.
    ActiveUnacknowledged = 1,
    /// The condition stands, and somebody knows.
    ActiveAcknowledged = 2,
    /// The condition has gone before somebody said that he knew.
    ReturnedUnacknowledged = 3,
    /// An operator has put it aside for a time.
    Shelved = 4,
    /// The plant is in a state in which the condition means nothing.
    SuppressedByDesign = 5,
    /// Switched off by the configuration.
    OutOfService = 6,
}

impl State {
    /// All of them, by their codes.
    pub const ALL: [State; 7] = [
        State::Normal,
        State::ActiveUnacknowledged,
        State::ActiveAcknowledged,
        State::ReturnedUnacknowledged,
        State::Shelved,
        State::SuppressedByDesign,
        State::OutOfService,
    ];

    /// For a person.
    pub fn name(self) -> &'static str {
        match self {
            State::Normal => "normal",
            State::ActiveUnacknowledged => "active, unacknowledged",
            State::ActiveAcknowledged => "active, acknowledged",
            State::ReturnedUnacknowledged => "returned, unacknowledged",
            State::Shelved => "shelved",
            State::SuppressedByDesign => "suppressed by design",
            State::OutOfService => "out of service",
        }
    }
}

/// An alarm put aside.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shelf {
    /// When it ends at the latest.
    pub until: Time,
    /// It ends when the condition goes, or for a condition that is not there, when it has come and gone.
    pub one_shot: bool,
    /// What rises above this is not covered.
    pub covers: Priority,
}

/// Why a shelving ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Unshelving {
    /// An operator wanted it back.
    Asked,
    /// The time was over, or the clock was set back.
    Expired,
    /// One shot: the condition has gone.
    Returned,
    /// The priority rose above what was covered.
    Raised,
}

/// What can happen to an alarm.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Change {
    /// The condition has stood for the on-delay.
    Activated(Priority),
    /// It has become worse, for the on-delay.
    Raised(Priority),
    /// It has become better, for the off-delay, but stands.
    Lowered(Priority),
    /// The condition has been gone for the off-delay.
    Returned,
    /// An operator knows.
    Acknowledged,
    /// An operator has put it aside.
    Shelved(Shelf),
    /// It is back.
    Unshelved(Unshelving),
    /// The plant's state takes the condition its meaning.
    Suppressed,
    /// The plant is back in a state in which the condition means something.
    Released,
    /// The configuration switches it off.
    TakenOut,
    /// The configuration switches it on again.
    PutBack,
}

impl Change {
    /// In one word.
    pub fn name(&self) -> &'static str {
        match self {
            Change::Activated(_) => "activated",
            Change::Raised(_) => "raised",
            Change::Lowered(_) => "lowered",
            Change::Returned => "returned",
            Change::Acknowledged => "acknowledged",
            Change::Shelved(_) => "shelved",
            Change::Unshelved(_) => "unshelved",
            Change::Suppressed => "suppressed",
            Change::Released => "released",
            Change::TakenOut => "out of service",
            Change::PutBack => "in service",
        }
    }
}

/// The state of an alarm: what OPC UA Part 9 keeps as ActiveState, AckedState, ShelvingState, SuppressedState and
/// OutOfServiceState. It changes by [`Standing::apply`] only.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Standing {
    active: Option<Priority>,
    unacknowledged: Option<Priority>,
    shelf: Option<Shelf>,
    suppressed: bool,
    out_of_service: bool,
}

impl Standing {
    /// The priority of the condition while it stands, under a shelf too.
    pub fn active(&self) -> Option<Priority> {
        self.active
    }

    /// The highest priority that nobody has acknowledged.
    pub fn unacknowledged(&self) -> Option<Priority> {
        self.unacknowledged
    }

    /// How it is shelved.
    pub fn shelf(&self) -> Option<Shelf> {
        self.shelf
    }

    /// Whether the plant's state takes the condition its meaning.
    pub fn is_suppressed(&self) -> bool {
        self.suppressed
    }

    /// Whether the configuration has switched it off.
    pub fn is_out_of_service(&self) -> bool {
        self.out_of_service
    }

    /// The priority to show: that of the condition, or of what is to be acknowledged, whichever is higher.
    pub fn priority(&self) -> Option<Priority> {
        self.active.max(self.unacknowledged)
    }

    /// The state in one word. What covers more goes before what covers less.
    pub fn state(&self) -> State {
        if self.out_of_service {
            State::OutOfService
        } else if self.suppressed {
            State::SuppressedByDesign
        } else if self.shelf.is_some() {
            State::Shelved
        } else {
            match (self.active, self.unacknowledged) {
                (None, None) => State::Normal,
                (Some(_), Some(_)) => State::ActiveUnacknowledged,
                (Some(_), None) => State::ActiveAcknowledged,
                (None, Some(_)) => State::ReturnedUnacknowledged,
            }
        }
    }

    /// Takes over a change.
    pub fn apply(&mut self, change: &Change) {
        match *change {
            Change::Activated(priority) | Change::Raised(priority) => {
                self.active = Some(priority);
                // Who shelved it knows of it.
                if self.shelf.is_none() {
                    self.unacknowledged = self.unacknowledged.max(self.active);
                }
            }
            Change::Lowered(priority) => self.active = Some(priority),
            Change::Returned => self.active = None,
            Change::Acknowledged => self.unacknowledged = None,
            Change::Shelved(shelf) => {
                self.shelf = Some(shelf);
                self.unacknowledged = None;
            }
            Change::Unshelved(_) => {
                self.shelf = None;
                self.unacknowledged = self.active;
            }
            Change::Suppressed => {
                self.suppressed = true;
                self.active = None;
            }
            Change::Released => self.suppressed = false,
            Change::TakenOut => {
                *self = Self {
                    out_of_service: true,
                    ..Self::default()
                };
            }
            Change::PutBack => self.out_of_service = false,
        }
    }
}
