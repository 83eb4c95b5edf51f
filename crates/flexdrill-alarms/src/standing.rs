//! The state of one alarm and its changes.

use serde::{Deserialize, Serialize};

use crate::Time;

flexdrill_base::listed! {
    /// How soon an operator must act.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum Priority: 1 {
        /// As time permits.
        Low: "low";
        /// Soon.
        Medium: "medium";
        /// At once.
        High: "high";
    }
}

impl Priority {
    /// The name in ISA-18.2.
    pub fn name(self) -> &'static str {
        self.row()[0]
    }
}

flexdrill_base::listed! {
    /// The name of a state in ISA-18.2.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    #[repr(u8)]
    pub enum State: 1 {
        /// No action required.
        Normal = 0: "normal";
        /// The condition stands and is not yet acknowledged.
        ActiveUnacknowledged = 1: "active, unacknowledged";
        /// The condition stands and is acknowledged.
        ActiveAcknowledged = 2: "active, acknowledged";
        /// The condition ended before it was acknowledged.
        ReturnedUnacknowledged = 3: "returned, unacknowledged";
        /// An operator has shelved the alarm for a time.
        Shelved = 4: "shelved";
        /// The condition has no meaning in the present state of the plant.
        SuppressedByDesign = 5: "suppressed by design";
        /// Switched off by the configuration.
        OutOfService = 6: "out of service";
    }
}

impl State {
    /// The name for a person.
    pub fn name(self) -> &'static str {
        self.row()[0]
    }
}

/// A shelving.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shelf {
    /// The latest end.
    pub until: Time,
    /// Whether the shelving ends with the condition, or with the next occurrence of one that does not stand.
    pub one_shot: bool,
    /// The highest priority that the shelving covers.
    pub covers: Priority,
}

/// Why a shelving ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Unshelving {
    /// An operator ended it.
    Asked,
    /// Its time expired, or the clock was set back.
    Expired,
    /// One shot: the condition ended.
    Returned,
    /// The priority rose above the covered one.
    Raised,
}

/// A change of an alarm.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Change {
    /// The condition has stood for the on-delay.
    Activated(Priority),
    /// The priority of the condition has been higher for the on-delay.
    Raised(Priority),
    /// The priority of the condition has been lower for the off-delay.
    Lowered(Priority),
    /// The condition has been absent for the off-delay.
    Returned,
    /// An operator acknowledged the alarm.
    Acknowledged,
    /// An operator shelved the alarm.
    Shelved(Shelf),
    /// The shelving ended.
    Unshelved(Unshelving),
    /// The condition has no meaning in the present state of the plant.
    Suppressed,
    /// The condition has a meaning again.
    Released,
    /// The configuration switches it off.
    TakenOut,
    /// The configuration switches it on again.
    PutBack,
    /// What the condition is judged against was adjusted, for which the event has the reason. The state stays.
    Adjusted,
}

impl Change {
    /// The name of the change.
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
            Change::Adjusted => "adjusted",
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

    /// The highest priority that is not yet acknowledged.
    pub fn unacknowledged(&self) -> Option<Priority> {
        self.unacknowledged
    }

    /// The shelving, if any.
    pub fn shelf(&self) -> Option<Shelf> {
        self.shelf
    }

    /// Whether the condition has no meaning in the present state of the plant.
    pub fn is_suppressed(&self) -> bool {
        self.suppressed
    }

    /// Whether the configuration has switched it off.
    pub fn is_out_of_service(&self) -> bool {
        self.out_of_service
    }

    /// The published priority: the higher of the condition's and the unacknowledged one.
    pub fn priority(&self) -> Option<Priority> {
        self.active.max(self.unacknowledged)
    }

    /// The name of the state. A state that covers more of the alarm precedes one that covers less.
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

    /// Applies a change.
    pub fn apply(&mut self, change: &Change) {
        match *change {
            Change::Activated(priority) | Change::Raised(priority) => {
                self.active = Some(priority);
                // The operator who shelved the alarm knows of it.
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
            Change::Adjusted => {}
        }
    }
}
