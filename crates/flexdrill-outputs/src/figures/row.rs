//! What a row of the table says.

use flexdrill_core::inputs::Dimension;
use flexdrill_core::twin::Snapshot;
use flexdrill_core::units::{m_per_s_to_m_per_h, n_to_kn, rad_per_s_to_rpm, rad_to_deg};
use flexdrill_messages::Message;

/// A scalar of the message `M`.
#[derive(Debug)]
pub struct Figure<M: 'static> {
    /// Name of the field in the message.
    pub field: &'static str,
    /// What it measures.
    pub kind: Kind,
    /// The time that it covers.
    pub window: Window,
    /// Where tables show it; `None` where no table does.
    pub shown: Option<Shown>,
    /// Its name on the protocols of the bridges; `None` where they do not send it.
    pub bridge: Option<&'static str>,
    /// Its value in a snapshot (SI); `None` in a message that is made from more than a snapshot.
    pub source: Option<fn(&Snapshot) -> f64>,
    /// Its value in a message (SI).
    pub read: fn(&M) -> f64,
    /// Sets its value in a message (SI).
    pub write: fn(&mut M, f64),
}

impl<M> Figure<M> {
    /// Name of its column in recordings of the Python package: the field with the unit at its end. A mean over the
    /// publishing interval has `mean_` before it, because a recording has the value of the sample's instant too.
    pub fn column(&self) -> String {
        let mean = if self.window == Window::Mean { "mean_" } else { "" };
        let unit = self.kind.si().to_lowercase().replace(' ', "").replace('/', "_per_");
        let separator = if unit.is_empty() { "" } else { "_" };
        format!("{mean}{}{separator}{unit}", self.field)
    }

    /// Smallest and largest value that it can have (SI): what has a size alone is not below 0, a share of the time within 0
    /// and 1.
    pub const fn range(&self) -> [f64; 2] {
        let is_size = matches!(self.kind, Kind::Number | Kind::Bend | Kind::Cut)
            || matches!(self.window, Window::Largest | Window::Rms | Window::LongRms);
        match self.kind {
            Kind::TimeShare => [0.0, 1.0],
            _ if is_size => [0.0, f64::INFINITY],
            _ => [f64::NEG_INFINITY, f64::INFINITY],
        }
    }
}

impl<M: Message> Figure<M> {
    /// What it is: the comment above its field in the message's definition.
    pub fn text(&self) -> String {
        M::INFO.comment(self.field)
    }
}

/// A row in the tables of reports and of the rig page.
#[derive(Debug, Clone, Copy)]
pub struct Shown {
    /// The table, or the part of one.
    pub group: Group,
    /// Label where the row stands alone.
    pub label: &'static str,
    /// Label under the heading of its group. Two groups that a table has side by side share a row where these agree.
    pub short: &'static str,
}

/// Rows that stand together, in the order of the tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// The bit: what acts on it, and how it moves.
    Bit,
    /// Torque along the tool.
    Torque,
    /// Torque that friction takes.
    Friction,
    /// Weight along the tool.
    Weight,
    /// Axial drag.
    Drag,
    /// What the whole tool does: load on the hook, limit of the drive, advance.
    Whole,
    /// Power put in.
    PutIn,
    /// Power taken.
    Taken,
}

/// The time that a value covers. The publishing interval is the time since the message before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Window {
    /// The instant of the header's stamp, or a span that the figure's text names.
    Instant,
    /// Mean over the publishing interval.
    Mean,
    /// Root mean square over the publishing interval.
    Rms,
    /// Largest value in the publishing interval.
    Largest,
    /// Integral over the publishing interval.
    Integral,
    /// Mean over `transfer.window`.
    LongMean,
    /// Root mean square over `transfer.window`.
    LongRms,
}

impl Window {
    /// A sentence that follows the figure's text; empty for an instant.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Instant => "",
            Self::Mean => "Mean over the publishing interval.",
            Self::Rms => "Root mean square over the publishing interval.",
            Self::Largest => "Largest value in the publishing interval.",
            Self::Integral => "Integral over the publishing interval.",
            Self::LongMean => "Mean over `transfer.window`.",
            Self::LongRms => "Root mean square over `transfer.window`.",
        }
    }
}

macro_rules! kinds {
    ($($(#[doc = $doc:literal])* $kind:ident in $dimension:expr, sent in $si:literal, shown in $unit:literal times $factor:expr;)*) => {
        /// What a figure measures: its unit in messages (SI), and the one in which reports and the rig page show it.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Kind {
            $($(#[doc = $doc])* $kind,)*
        }

        impl Kind {
            /// Its dimension; `None` for a power, which no input has.
            pub const fn dimension(self) -> Option<Dimension> {
                use Dimension::*;
                match self { $(Self::$kind => $dimension,)* }
            }

            /// The SI unit, in which messages have it; empty for a number alone.
            pub const fn si(self) -> &'static str {
                match self { $(Self::$kind => $si,)* }
            }

            /// The unit in reports, and the factor from SI.
            pub fn unit(self) -> (&'static str, f64) {
                match self { $(Self::$kind => ($unit, $factor),)* }
            }
        }
    };
}

kinds! {
    /// Torque (N m).
    Torque in Some(Torque), sent in "N m", shown in "N m" times 1.0;
    /// Force (N).
    Force in Some(Force), sent in "N", shown in "kN" times n_to_kn(1.0);
    /// Weight, and axial drag, which takes of it (N).
    Weight in Some(Force), sent in "N", shown in "kN" times n_to_kn(1.0);
    /// Rotary speed (rad/s).
    RotarySpeed in Some(RotarySpeed), sent in "rad/s", shown in "r/min" times rad_per_s_to_rpm(1.0);
    /// Rate of penetration (m/s).
    Advance in Some(Speed), sent in "m/s", shown in "m/h" times m_per_s_to_m_per_h(1.0);
    /// Depth of cut (m per turn).
    Cut in Some(Length), sent in "m", shown in "mm per turn" times 1e3;
    /// Speed (m/s).
    Speed in Some(Speed), sent in "m/s", shown in "m/s" times 1.0;
    /// Acceleration (m/s2).
    Acceleration in Some(Acceleration), sent in "m/s2", shown in "m/s²" times 1.0;
    /// Size of a bend (rad).
    Bend in Some(Angle), sent in "rad", shown in "deg" times rad_to_deg(1.0);
    /// Length (m).
    Length in Some(Length), sent in "m", shown in "m" times 1.0;
    /// Turn of the hole per metre (rad/m).
    TurnRate in Some(TurnRate), sent in "rad/m", shown in "deg/m" times rad_to_deg(1.0);
    /// Time (s).
    Time in Some(Time), sent in "s", shown in "s" times 1.0;
    /// Power (W).
    Power in None, sent in "W", shown in "W" times 1.0;
    /// Share of a whole, 0 to 1.
    Share in Some(Number), sent in "", shown in "%" times 100.0;
    /// Share of the time, 0 to 1.
    TimeShare in Some(Number), sent in "", shown in "% of the time" times 100.0;
    /// A number alone.
    Number in Some(Number), sent in "", shown in "" times 1.0;
}
