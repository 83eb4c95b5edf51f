//! Advice from look-aheads, between the publisher's thread, which owns the alarms, and the thread that looks ahead.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crate::alarms::{AlarmId, Tested};

/// Time for which the same alarm leads at the same speed and weight before a search begins.
const SETTLED: Duration = Duration::from_secs(2);
/// Part of a value by which it may change while it counts as the same.
const SAME: f64 = 0.02;

/// What a search is for.
#[derive(Debug, Clone, PartialEq)]
pub struct Asked {
    /// The alarm that leads.
    pub alarm: AlarmId,
    /// All alarms of the tool's motion that stand.
    pub standing: Vec<AlarmId>,
    /// Speed (r/min) and weight (kN) that act.
    at: [f64; 2],
    since: Instant,
}

impl Asked {
    fn is_for(&self, alarm: AlarmId, at: [f64; 2]) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs().max(b.abs());
        self.alarm == alarm && near(self.at[0], at[0]) && near(self.at[1], at[1])
    }
}

#[derive(Debug, Default)]
struct Exchange {
    asked: Option<Asked>,
    /// The last search that came to its end, and what it found.
    answered: Option<(Asked, Option<Tested>)>,
    /// Ends the running search.
    stop: Option<Arc<AtomicBool>>,
    /// Ends the running forecast, which yields to goals and searches.
    forecast: Option<Arc<AtomicBool>>,
}

/// What is asked and what was found.
#[derive(Debug, Default)]
pub struct Advisor(Mutex<Exchange>);

impl Advisor {
    fn lock(&self) -> MutexGuard<'_, Exchange> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes the alarm that leads, with those that stand, at the speed (r/min) and weight (kN) that act. Returns what was
    /// found for it. A search for anything else stops.
    pub fn follow(&self, leading: Option<(AlarmId, Vec<AlarmId>)>, at: [f64; 2]) -> Option<Tested> {
        let mut exchange = self.lock();
        let Some((alarm, standing)) = leading else {
            exchange.interrupt();
            (exchange.asked, exchange.answered) = (None, None);
            return None;
        };
        if !exchange.asked.as_ref().is_some_and(|asked| asked.is_for(alarm, at)) {
            exchange.interrupt();
            exchange.asked = Some(Asked {
                alarm,
                standing,
                at,
                since: Instant::now(),
            });
        }
        if exchange.stop.is_none() && exchange.search().is_some() {
            stop(&mut exchange.forecast);
        }
        let (asked, tested) = exchange.answered.as_ref()?;
        tested.filter(|tested| asked.alarm == alarm && tested.holds_at(at))
    }

    /// What is to be searched now, with the flag that stops the search.
    pub fn due(&self) -> Option<(Asked, Arc<AtomicBool>)> {
        let mut exchange = self.lock();
        let asked = exchange.search()?.clone();
        let stop = Arc::new(AtomicBool::new(false));
        exchange.stop = Some(Arc::clone(&stop));
        Some((asked, stop))
    }

    /// Takes what a search found that was not stopped.
    pub fn answer(&self, asked: Asked, tested: Option<Tested>) {
        let mut exchange = self.lock();
        exchange.stop = None;
        exchange.answered = Some((asked, tested));
    }

    /// Stops the search and the forecast that run; they begin again later if they are due.
    pub fn interrupt(&self) {
        let mut exchange = self.lock();
        exchange.interrupt();
        stop(&mut exchange.forecast);
    }

    /// The flag that stops a forecast that begins now.
    pub fn forecasts(&self) -> Arc<AtomicBool> {
        let stop = Arc::new(AtomicBool::new(false));
        self.lock().forecast = Some(Arc::clone(&stop));
        stop
    }
}

impl Exchange {
    /// What is to be searched now.
    fn search(&self) -> Option<&Asked> {
        let asked = self.asked.as_ref()?;
        let known = |(answered, _): &(Asked, _)| answered.is_for(asked.alarm, asked.at);
        let is_known = self.answered.as_ref().is_some_and(known);
        (!is_known && asked.since.elapsed() >= SETTLED).then_some(asked)
    }

    fn interrupt(&mut self) {
        stop(&mut self.stop);
    }
}

fn stop(flag: &mut Option<Arc<AtomicBool>>) {
    if let Some(stop) = flag.take() {
        stop.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::alarms::{Change, Quantity};

    const AT: [f64; 2] = [120.0, 10.0];

    fn tested() -> Tested {
        Tested {
            alarm: AlarmId::BackwardWhirl,
            from: AT,
            change: Change {
                quantity: Quantity::Speed,
                to: 72.0,
            },
            ended: 19,
            of: 20,
        }
    }

    /// An advisor that was asked `ago`.
    fn asked(ago: Duration) -> Advisor {
        let advisor = Advisor::default();
        assert_eq!(advisor.follow(leads(), AT), None);
        if let Some(asked) = &mut advisor.lock().asked {
            asked.since -= ago;
        }
        advisor
    }

    fn leads() -> Option<(AlarmId, Vec<AlarmId>)> {
        Some((AlarmId::BackwardWhirl, vec![AlarmId::BackwardWhirl]))
    }

    #[test]
    fn a_search_waits_for_a_settled_alarm_and_holds_where_it_was_made() {
        assert!(asked(Duration::ZERO).due().is_none());
        let advisor = asked(SETTLED);
        let (what, _) = advisor.due().unwrap();
        advisor.answer(what, Some(tested()));
        assert!(advisor.due().is_none(), "one search is enough");
        assert_eq!(advisor.follow(leads(), AT), Some(tested()));
        assert_eq!(advisor.follow(leads(), [119.0, 10.1]), Some(tested()));
        // Somewhere else, or for another alarm, it says nothing.
        assert_eq!(advisor.follow(leads(), [100.0, 10.0]), None);
        assert_eq!(advisor.follow(Some((AlarmId::Shock, Vec::new())), AT), None);
        // Once nothing stands it is forgotten.
        assert_eq!(advisor.follow(None, AT), None);
        assert_eq!(advisor.follow(leads(), AT), None);
    }

    #[test]
    fn a_forecast_gives_way_to_goals_and_searches() {
        let advisor = asked(Duration::ZERO);
        let forecast = advisor.forecasts();
        let _ = advisor.follow(leads(), AT);
        assert!(!forecast.load(Ordering::Relaxed), "the alarm has not settled");
        let advisor = asked(SETTLED);
        let forecast = advisor.forecasts();
        let _ = advisor.follow(leads(), AT);
        assert!(forecast.load(Ordering::Relaxed));
        let (asked, _) = advisor.due().unwrap();
        advisor.answer(asked, Some(tested()));
        let forecast = advisor.forecasts();
        let _ = advisor.follow(leads(), AT);
        assert!(!forecast.load(Ordering::Relaxed), "the search has its answer");
        advisor.interrupt();
        assert!(forecast.load(Ordering::Relaxed));
    }

    #[test]
    fn what_changes_stops_the_search() {
        for change in [0, 1, 2, 3] {
            let advisor = asked(SETTLED);
            let (_, stop) = advisor.due().unwrap();
            match change {
                0 => drop(advisor.follow(None, AT)),
                1 => drop(advisor.follow(leads(), [90.0, 10.0])),
                2 => drop(advisor.follow(Some((AlarmId::Shock, Vec::new())), AT)),
                _ => advisor.interrupt(),
            }
            assert!(stop.load(Ordering::Relaxed), "{change}");
        }
        let advisor = asked(SETTLED);
        let (_, stop) = advisor.due().unwrap();
        let _ = advisor.follow(leads(), AT);
        assert!(!stop.load(Ordering::Relaxed));
    }
}
