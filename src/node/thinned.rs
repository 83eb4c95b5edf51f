//! Outputs on DDS whose rate was lowered while the twin runs. Recordings and viewers keep the rates with which the run
//! began, so that no parameter removes an output from a recording.
//!
//! Means, peaks and root mean squares of a message cover the time since the previous message. A message on DDS therefore combines
//! the statistics of all messages that were recorded since the previous message on DDS.

use flexdrill_config::Config;
use flexdrill_core::twin::{Frame, Output, Schedule};
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_messages::{BitState, CdrError, ContactForces, from_cdr, to_cdr};
use flexdrill_outputs::figures::{BIT_STATE, Window};
use flexdrill_outputs::published;

/// Outputs with a rate, and their topics.
const THINNED: [(Output, &TopicInfo); 9] = [
    (Output::JointDeflections, &topics::JOINT_DEFLECTIONS),
    (Output::JointStates, &topics::JOINT_STATES),
    (Output::ContactForces, &topics::CONTACT_FORCES),
    (Output::BitState, &topics::BIT_STATE),
    (Output::Whirl, &topics::WHIRL),
    (Output::ToolShape, &topics::TOOL_SHAPE),
    (Output::Ageing, &topics::AGEING),
    (Output::Reactions, &topics::REACTIONS),
    (Output::Transfer, &topics::TRANSFER),
];

/// The form in which a recorded message is published on DDS.
#[derive(Debug, PartialEq)]
pub enum Share {
    /// Unchanged.
    Same,
    /// Not at all.
    Nothing,
    /// As these bytes: the same instant, with the statistics since the previous message on DDS.
    Combined(Vec<u8>),
}

/// Decides which recorded messages are published on DDS.
#[derive(Debug)]
pub struct Thinned {
    /// Of recordings and viewers.
    recorded: Schedule,
    /// Of DDS.
    published: Schedule,
    /// Interval of `published` in which each of [`THINNED`] was published last.
    last: [Option<u64>; THINNED.len()],
    contacts: Combined<ContactForces>,
    bit: Combined<BitState>,
    /// Step at which the present statistics of the contacts began, and those of the bit.
    interval_begin: [u64; 2],
}

impl Thinned {
    /// The outputs of a run that begins with this configuration.
    pub fn new(config: &Config) -> Self {
        let schedule = published(config);
        Self {
            recorded: schedule,
            published: schedule,
            last: [None; THINNED.len()],
            contacts: Combined::default(),
            bit: Combined::default(),
            interval_begin: [0; 2],
        }
    }

    /// Adopts changed rates: `recorded` for recordings and viewers, those of `config` for DDS.
    pub fn reconfigure(&mut self, recorded: Schedule, config: &Config) {
        self.recorded = recorded;
        self.published = published(config);
    }

    /// The form of a message of `frame` on DDS. To be called once per message, in order.
    ///
    /// # Errors
    /// When the message cannot be read or written.
    pub fn share(&mut self, frame: &Frame, topic: &TopicInfo, cdr: &[u8]) -> Result<Share, CdrError> {
        let Some(index) = THINNED.iter().position(|(_, known)| known.name == topic.name) else {
            return Ok(Share::Same);
        };
        let (output, _) = THINNED[index];
        let (recorded, published) = (self.recorded.interval(output), self.published.interval(output));
        if published == recorded {
            self.forget(output);
            return Ok(Share::Same);
        }
        let step = frame.snapshot.step;
        // The intervals need not be multiples of each other: the first message in each interval is published.
        let number = step.checked_div(published);
        let publish = number.is_some() && number != self.last[index];
        self.last[index] = number;
        let [contacts, bit] = self.interval_begin.map(|begin| step.saturating_sub(begin) as f64);
        let ends = frame.ends_interval;
        match output {
            Output::ContactForces => self.contacts.share(cdr, contacts, publish, ends.contacts),
            Output::BitState => self.bit.share(cdr, bit, publish, ends.bit),
            _ if publish => Ok(Share::Same),
            _ => Ok(Share::Nothing),
        }
    }

    /// To be called after the messages of a frame.
    pub fn end_frame(&mut self, frame: &Frame) {
        let (step, ends) = (frame.snapshot.step, frame.ends_interval);
        for (begin, ends) in self.interval_begin.iter_mut().zip([ends.contacts, ends.bit]) {
            if ends || step < *begin {
                *begin = step;
            }
        }
    }

    fn forget(&mut self, output: Output) {
        match output {
            Output::ContactForces => self.contacts = Combined::default(),
            Output::BitState => self.bit = Combined::default(),
            _ => {}
        }
    }
}

/// The statistics of messages that were not published on DDS.
#[derive(Debug)]
struct Combined<M> {
    /// The combined statistics, if there was a message.
    earlier: Option<M>,
    /// Steps that they cover.
    steps: f64,
}

impl<M> Default for Combined<M> {
    fn default() -> Self {
        Self {
            earlier: None,
            steps: 0.0,
        }
    }
}

impl<M: Statistics> Combined<M> {
    /// `steps` is the length of the message's own statistics; `ends` means that they restart after it.
    fn share(&mut self, cdr: &[u8], steps: f64, publish: bool, ends: bool) -> Result<Share, CdrError> {
        if !publish && !ends {
            return Ok(Share::Nothing);
        }
        let mut message: M = from_cdr(cdr)?;
        if let Some(earlier) = &self.earlier {
            message.combine(steps, earlier, self.steps);
        }
        if publish {
            *self = Self::default();
            return Ok(Share::Combined(to_cdr(&message)?));
        }
        self.steps += steps;
        self.earlier = Some(message);
        Ok(Share::Nothing)
    }
}

/// A message with statistics over the time since the previous message.
trait Statistics: flexdrill_messages::Message {
    /// Adds the statistics of `earlier`, which cover `earlier_steps`; its own cover `steps`.
    fn combine(&mut self, steps: f64, earlier: &Self, earlier_steps: f64);
}

/// The mean over both times.
fn combined_mean(value: f64, steps: f64, earlier: f64, earlier_steps: f64) -> f64 {
    let all = steps + earlier_steps;
    if all > 0.0 {
        (value * steps + earlier * earlier_steps) / all
    } else {
        value
    }
}

/// The root mean square over both times.
fn combined_rms(value: f64, steps: f64, earlier: f64, earlier_steps: f64) -> f64 {
    let all = steps + earlier_steps;
    if all > 0.0 {
        ((value * value * steps + earlier * earlier * earlier_steps) / all).sqrt()
    } else {
        value
    }
}

impl Statistics for ContactForces {
    fn combine(&mut self, steps: f64, earlier: &Self, earlier_steps: f64) {
        for (peaks, before) in [
            (&mut self.pipe_guide_normal_peak, &earlier.pipe_guide_normal_peak),
            (&mut self.guide_wall_normal_peak, &earlier.guide_wall_normal_peak),
            (&mut self.pipe_guide_shock, &earlier.pipe_guide_shock),
            (&mut self.guide_wall_shock, &earlier.guide_wall_shock),
        ] {
            for (peak, before) in peaks.iter_mut().zip(before) {
                *peak = peak.max(*before);
            }
        }
        for (values, before) in [
            (&mut self.pipe_guide_normal_rms, &earlier.pipe_guide_normal_rms),
            (&mut self.guide_wall_normal_rms, &earlier.guide_wall_normal_rms),
        ] {
            for (value, before) in values.iter_mut().zip(before) {
                *value = combined_rms(*value, steps, *before, earlier_steps);
            }
        }
        if earlier.max_pipe_guide_force > self.max_pipe_guide_force {
            self.max_pipe_guide_force = earlier.max_pipe_guide_force;
            self.max_pipe_guide_station = earlier.max_pipe_guide_station;
        }
        if earlier.max_guide_wall_force > self.max_guide_wall_force {
            self.max_guide_wall_force = earlier.max_guide_wall_force;
            self.max_guide_wall_station = earlier.max_guide_wall_station;
        }
    }
}

impl Statistics for BitState {
    fn combine(&mut self, steps: f64, earlier: &Self, earlier_steps: f64) {
        // The time that a figure covers decides how two of its values combine.
        for figure in BIT_STATE {
            let [value, before] = [&*self, earlier].map(figure.read);
            let combined = match figure.window {
                Window::Mean => combined_mean(value, steps, before, earlier_steps),
                Window::Rms => combined_rms(value, steps, before, earlier_steps),
                Window::Largest => value.max(before),
                Window::Integral => value + before,
                Window::Instant | Window::LongMean | Window::LongRms => value,
            };
            (figure.write)(self, combined);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_core::twin::EndsInterval;
    use flexdrill_outputs::schedule;

    /// Contact forces of two stations at 50 Hz: `force` at the first, half of it at the second.
    fn contacts(force: f64) -> Vec<u8> {
        to_cdr(&ContactForces {
            max_pipe_guide_force: force,
            pipe_guide_normal: vec![1.0, 2.0],
            pipe_guide_normal_peak: vec![force, force / 2.0],
            pipe_guide_normal_rms: vec![force, 0.0],
            ..ContactForces::default()
        })
        .unwrap()
    }

    fn frame(step: u64) -> Frame {
        let mut frame = Frame::default();
        frame.snapshot.step = step;
        frame.ends_interval = EndsInterval::ALL;
        frame
    }

    fn config(rate: f64) -> Config {
        let text = include_str!("../../config/default.yaml");
        let config = Config::from_text("default.yaml", text).unwrap();
        config.with_value("outputs.rates.contact_forces", rate).unwrap()
    }

    /// Steps at which DDS gets something of 50 Hz for half a second, and what.
    fn run(live: f64) -> Vec<(u64, Share)> {
        let begun = config(50.0);
        let mut thinned = Thinned::new(&begun);
        let changed = config(live);
        thinned.reconfigure(schedule(&changed, &begun.outputs.rates), &changed);
        let mut got = Vec::new();
        for step in (40..=1000).step_by(40) {
            // One collision, in a message that only the recording gets at 10 Hz.
            let force = if step == 320 { 900.0 } else { 100.0 };
            let frame = frame(step);
            let share = thinned
                .share(&frame, &topics::CONTACT_FORCES, &contacts(force))
                .unwrap();
            thinned.end_frame(&frame);
            if share != Share::Nothing {
                got.push((step, share));
            }
        }
        got
    }

    #[test]
    fn an_unchanged_rate_publishes_what_is_recorded() {
        let got = run(50.0);
        assert_eq!(got.len(), 25);
        assert!(got.iter().all(|(_, share)| *share == Share::Same));
    }

    #[test]
    fn an_output_that_is_switched_off_is_recorded_all_the_same() {
        assert!(run(0.0).is_empty());
        let (begun, off) = (config(50.0), config(0.0));
        let made = schedule(&off, &begun.outputs.rates);
        assert_eq!(made.rate(Output::ContactForces, 0.5e-3), 50.0);
        assert_eq!(published(&off).rate(Output::ContactForces, 0.5e-3), 0.0);
    }

    #[test]
    fn a_lower_rate_loses_no_collision() {
        let got = run(10.0);
        assert_eq!(
            got.iter().map(|(step, _)| *step).collect::<Vec<_>>(),
            [40, 200, 400, 600, 800, 1000]
        );
        let Share::Combined(bytes) = &got[2].1 else {
            panic!("{:?}", got[2])
        };
        // From step 200 to 400: five messages of 20 ms, one with the collision.
        let message: ContactForces = from_cdr(bytes).unwrap();
        assert_eq!(message.pipe_guide_normal_peak, [900.0, 450.0]);
        assert_eq!(message.max_pipe_guide_force, 900.0);
        let mean_square: f64 = (4.0 * 100.0_f64.powi(2) + 900.0_f64.powi(2)) / 5.0;
        assert!((message.pipe_guide_normal_rms[0] - mean_square.sqrt()).abs() < 1e-9);
        // The state is that of the instant.
        assert_eq!(message.pipe_guide_normal, [1.0, 2.0]);
        // The next message does not repeat it.
        let Share::Combined(bytes) = &got[3].1 else {
            panic!("{:?}", got[3])
        };
        assert_eq!(from_cdr::<ContactForces>(bytes).unwrap().max_pipe_guide_force, 100.0);
    }

    /// Means of the bit at a lower rate are those of all its intervals, whose statistics end with its own messages.
    #[test]
    fn a_lower_rate_has_the_mean_of_every_step() {
        let text = include_str!("../../config/default.yaml");
        let begun = Config::from_text("default.yaml", text).unwrap();
        let changed = begun.with_value("outputs.rates.bit_state", 10.0).unwrap();
        let mut thinned = Thinned::new(&begun);
        thinned.reconfigure(schedule(&changed, &begun.outputs.rates), &changed);
        let mut got = Vec::new();
        for step in (40..=600_u64).step_by(40) {
            let mut frame = frame(step);
            frame.ends_interval.contacts = step.is_multiple_of(80);
            let torque = step as f64;
            let message = to_cdr(&BitState {
                torque,
                ..BitState::default()
            })
            .unwrap();
            let share = thinned.share(&frame, &topics::BIT_STATE, &message).unwrap();
            thinned.end_frame(&frame);
            if let Share::Combined(bytes) = share {
                got.push((step, from_cdr::<BitState>(&bytes).unwrap().torque));
            }
        }
        // The messages since the one before: 80 to 200 in steps of 40, then 240 to 400.
        assert_eq!(got, [(40, 40.0), (200, 140.0), (400, 320.0), (600, 520.0)]);
    }

    /// 30 Hz is every 67 steps, which no message of every 40 steps meets.
    #[test]
    fn rates_that_do_not_divide_each_other_are_kept_on_average() {
        let got = run(30.0);
        assert!((14..=16).contains(&got.len()), "{} in half a second", got.len());
    }

    #[test]
    fn a_higher_rate_is_recorded_and_published() {
        let (begun, higher) = (config(50.0), config(100.0));
        let made = schedule(&higher, &begun.outputs.rates);
        assert_eq!(made.rate(Output::ContactForces, 0.5e-3), 100.0);
        assert_eq!(made, published(&higher));
    }
}
