//! `rig/measured` in the node: the newest value of each quantity, and the counts of what was refused. Several sources may
//! publish, such as the rig's surface sensors and a tool in the hole, so that each quantity has its own newest value.

use std::fmt;

use flexdrill_core::inputs::MeasuredKind;
use flexdrill_messages::RigMeasured;
use flexdrill_outputs::MeasuredValues as _;
use flexdrill_text::six_digits;

use super::time_zone::TimeZone;

/// Later than this (ns) a stamp of 0 is one that the sender has not set. A simulated clock begins at 0, and measurements of
/// its first hour may say so.
pub(super) const NO_STAMP: i64 = 3_600_000_000_000;

/// The newest good value of a quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredValue {
    /// In SI.
    pub value: f64,
    /// Its stamp (ns since 1970, on the clock of the stamps).
    pub stamp: i64,
    /// When the message arrived (s, the conditioner's clock).
    pub arrived: f64,
    /// The source doubts it.
    pub suspect: bool,
}

/// Why a message was refused.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MeasuredRefused {
    /// The source marks the values as bad, or the code is unknown.
    Bad {
        /// The code.
        quality: u8,
    },
    /// Its stamp is ahead of the clock.
    Ahead {
        /// By how much (s).
        ahead: f64,
        /// The most that is accepted (s).
        most: f64,
    },
    /// It does not state when it was measured: its stamp is 0.
    NoStamp,
    /// A value is infinite or implausible.
    Implausible {
        /// Which.
        kind: MeasuredKind,
        /// The value (SI).
        value: f64,
        /// Smallest and largest value (SI).
        range: [f64; 2],
    },
    /// An earlier message had a newer stamp for all of its quantities.
    Older {
        /// By how much (s).
        by: f64,
    },
}

impl MeasuredRefused {
    /// A number per reason, for the limits of log lines.
    pub fn index(&self) -> usize {
        match self {
            Self::Bad { .. } => 0,
            Self::Ahead { .. } => 1,
            Self::Older { .. } => 2,
            Self::NoStamp => 3,
            Self::Implausible { kind, .. } => 4 + kind.index(),
        }
    }
}

impl fmt::Display for MeasuredRefused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("rig/measured: a message was refused: ")?;
        match self {
            Self::Bad { quality } => write!(f, "its source marks the values as bad (quality {quality})"),
            Self::NoStamp => f.write_str(
                "its stamp is 0, so that nobody knows when it was measured; set header.stamp to the time of the measurement",
            ),
            Self::Ahead { ahead, most } => {
                write!(
                    f,
                    "its stamp is {ahead:.3} s ahead of the clock, at most {most} s are accepted; "
                )?;
                match TimeZone::ahead(*ahead) {
                    Some(zone) => write!(f, "{zone}"),
                    None => f.write_str("synchronise the clocks"),
                }
            }
            Self::Implausible {
                kind,
                value,
                range: [least, most],
            } => {
                write!(
                    f,
                    "{kind} = {} {}, outside {least} to {most} {}; check the unit and the sensor",
                    six_digits(*value),
                    kind.unit(),
                    kind.unit()
                )
            }
            Self::Older { by } => write!(f, "its stamp is {by:.3} s older than values that arrived before"),
        }
    }
}

/// The newest measured values and the counts of their messages.
#[derive(Debug, Clone)]
pub struct Measured {
    /// Largest plausible weight on bit (N).
    heaviest: f64,
    newest: [Option<MeasuredValue>; MeasuredKind::COUNT],
    received: u64,
    refused: u64,
    unreadable: u64,
    overrun: u64,
    newest_refusal: Option<MeasuredRefused>,
}

/// No message yet, and any weight that some rig can have.
impl Default for Measured {
    fn default() -> Self {
        let [_, heaviest] = MeasuredKind::DownholeWeightOnBit.plausible();
        Self::new(heaviest)
    }
}

impl Measured {
    /// No message yet; a weight on bit beyond `heaviest` (N) is implausible, such as one in a wrong unit.
    pub fn new(heaviest: f64) -> Self {
        Self {
            heaviest,
            newest: Default::default(),
            received: 0,
            refused: 0,
            unreadable: 0,
            overrun: 0,
            newest_refusal: None,
        }
    }

    /// Smallest and largest plausible value (SI). A string can pull at a sensor above the bit as much as it presses.
    fn plausible(&self, kind: MeasuredKind) -> [f64; 2] {
        match kind {
            MeasuredKind::DownholeWeightOnBit => [-self.heaviest, self.heaviest],
            _ => kind.plausible(),
        }
    }

    /// Accepts a message that arrived at `time` (s, the conditioner's clock). `now` is the present instant of the stamps
    /// (ns), `max_skew` how far ahead of it a stamp may be (s).
    ///
    /// # Errors
    /// When its stamp, its quality or one of its values is refused; no value of it is kept then.
    pub fn accept(&mut self, message: &RigMeasured, now: i64, time: f64, max_skew: f64) -> Result<(), MeasuredRefused> {
        self.received += 1;
        let accepted = self.judge(message, now, max_skew);
        match accepted {
            Err(refused) => {
                self.refused += 1;
                self.newest_refusal = Some(refused);
                Err(refused)
            }
            Ok(stamp) => {
                let suspect = message.quality == RigMeasured::SUSPECT;
                for kind in MeasuredKind::ALL {
                    let newest = &mut self.newest[kind.index()];
                    if let Some(value) = message.value(kind)
                        && newest.is_none_or(|newest| newest.stamp <= stamp)
                    {
                        *newest = Some(MeasuredValue {
                            value,
                            stamp,
                            arrived: time,
                            suspect,
                        });
                    }
                }
                Ok(())
            }
        }
    }

    /// The stamp of an acceptable message (ns).
    fn judge(&self, message: &RigMeasured, now: i64, max_skew: f64) -> Result<i64, MeasuredRefused> {
        let stamp = message.header.stamp.to_nanoseconds();
        if !matches!(message.quality, RigMeasured::GOOD | RigMeasured::SUSPECT) {
            return Err(MeasuredRefused::Bad {
                quality: message.quality,
            });
        }
        if stamp == 0 && now > NO_STAMP {
            return Err(MeasuredRefused::NoStamp);
        }
        let ahead = stamp.saturating_sub(now) as f64 * 1e-9;
        if ahead > max_skew {
            return Err(MeasuredRefused::Ahead { ahead, most: max_skew });
        }
        let given = || {
            MeasuredKind::ALL
                .into_iter()
                .filter_map(|kind| Some((kind, message.value(kind)?)))
        };
        for (kind, value) in given() {
            let range @ [least, most] = self.plausible(kind);
            if !(least..=most).contains(&value) {
                return Err(MeasuredRefused::Implausible { kind, value, range });
            }
        }
        let newest = given().map(|(kind, _)| self.newest[kind.index()].map_or(i64::MIN, |newest| newest.stamp));
        match newest.min() {
            Some(newest) if newest > stamp => Err(MeasuredRefused::Older {
                by: newest.saturating_sub(stamp) as f64 * 1e-9,
            }),
            _ => Ok(stamp),
        }
    }

    /// The newest good value of a quantity.
    pub fn newest(&self, kind: MeasuredKind) -> Option<MeasuredValue> {
        self.newest[kind.index()]
    }

    /// Messages received, messages refused, messages whose bytes could not be read, and messages dropped unread.
    pub fn counts(&self) -> [u64; 4] {
        [self.received, self.refused, self.unreadable, self.overrun]
    }

    /// Why the newest refused message was refused, since the start.
    pub fn newest_refusal(&self) -> Option<MeasuredRefused> {
        self.newest_refusal
    }

    /// Counts a message whose bytes could not be read.
    pub fn count_unreadable(&mut self) {
        self.unreadable += 1;
    }

    /// Counts messages that were dropped unread because they came faster than the node reads them.
    pub fn count_overrun(&mut self, messages: u64) {
        self.overrun += messages;
    }

    /// Forgets all values, after the clock was set: their stamps belong to the time before.
    pub fn clock_set(&mut self) {
        self.newest = Default::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_messages::builtin_interfaces::Time;
    use flexdrill_messages::std_msgs::Header;

    const NOW: i64 = 1_700_000_000_000_000_000;

    fn message(stamp: i64, values: &[(MeasuredKind, f64)]) -> RigMeasured {
        let header = Header {
            stamp: Time::from_nanoseconds(stamp),
            ..Header::default()
        };
        let mut message = RigMeasured::not_given(header, RigMeasured::GOOD, "test".into());
        for (kind, value) in values {
            message.set(*kind, *value);
        }
        message
    }

    #[test]
    fn each_quantity_keeps_its_newest_value_of_any_source() {
        use MeasuredKind::{DownholeTorque, HookLoad, SurfaceTorque};
        let mut measured = Measured::default();
        let surface = message(NOW, &[(SurfaceTorque, 9e3), (HookLoad, 4e5)]);
        measured.accept(&surface, NOW, 1.0, 0.5).unwrap();
        // The tool in the hole sends late, but nothing newer of this quantity has arrived.
        let hole = message(NOW - 20_000_000_000, &[(DownholeTorque, 2e3)]);
        measured.accept(&hole, NOW, 1.1, 0.5).unwrap();
        assert_eq!(measured.newest(DownholeTorque).unwrap().value, 2e3);
        let again = measured.accept(&message(NOW - 1, &[(SurfaceTorque, 1.0)]), NOW, 1.2, 0.5);
        assert!(matches!(again, Err(MeasuredRefused::Older { .. })));
        let newest = measured.newest(SurfaceTorque).unwrap();
        assert_eq!((newest.value, newest.arrived, newest.suspect), (9e3, 1.0, false));
        assert_eq!(measured.counts(), [3, 1, 0, 0]);
        measured.clock_set();
        assert_eq!(measured.newest(HookLoad), None);
    }

    #[test]
    fn bad_and_implausible_messages_are_refused_whole_with_the_reason() {
        use MeasuredKind::{HookLoad, SurfaceTorque};
        let mut measured = Measured::default();
        let mut bad = message(NOW, &[(HookLoad, 1e5)]);
        bad.quality = RigMeasured::BAD;
        assert!(measured.accept(&bad, NOW, 0.0, 0.5).is_err());
        for value in [f64::INFINITY, 2e6] {
            let wrong = message(NOW, &[(HookLoad, 1e5), (SurfaceTorque, value)]);
            let refused = measured.accept(&wrong, NOW, 0.0, 0.5).unwrap_err();
            assert!(refused.to_string().contains("surface_torque"), "{refused}");
        }
        let ahead = measured.accept(&message(NOW + 1_000_000_000, &[(HookLoad, 1e5)]), NOW, 0.0, 0.5);
        assert!(matches!(ahead, Err(MeasuredRefused::Ahead { .. })));
        let words = |ahead| MeasuredRefused::Ahead { ahead, most: 0.5 }.to_string();
        assert!(words(7199.2).contains("; 2 h is a time zone"), "{}", words(7199.2));
        assert!(words(7206.0).contains("; synchronise"), "{}", words(7206.0));
        let unset = measured.accept(&message(0, &[(HookLoad, 1e5)]), NOW, 0.0, 0.5);
        assert_eq!(unset, Err(MeasuredRefused::NoStamp));
        assert_eq!(measured.newest(HookLoad), None);
        assert_eq!(measured.counts(), [5, 5, 0, 0]);
        // A simulated clock begins at 0.
        measured
            .accept(&message(0, &[(HookLoad, 1e5)]), 1_000_000_000, 0.0, 0.5)
            .unwrap();
        // The hard limit of the configuration bounds the weight in the hole too: 210 kN may be klbf taken for kdaN.
        let mut measured = Measured::new(200e3);
        let heavy = message(NOW, &[(MeasuredKind::DownholeWeightOnBit, 210e3)]);
        let refused = measured.accept(&heavy, NOW, 0.0, 0.5).unwrap_err();
        assert!(refused.to_string().contains("outside -200000 to 200000 N"), "{refused}");
    }
}
