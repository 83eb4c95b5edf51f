//! Alarms and incidents.

use maud::{Markup, html};

use super::priority_class;
use super::text::{capital, duration, location, number, percent};
use crate::incidents::{Incident, seconds};
use crate::reading::Summary;
use flexdrill_outputs::words;
use flexdrill_text::printable;

/// Largest number of incidents listed; the worst ones, if there are more.
const ROWS: usize = 60;

/// The section about alarms.
pub(super) fn section(summary: &Summary) -> Markup {
    let incidents = &summary.incidents;
    let mut groups: Vec<_> = incidents.groups().collect();
    // The worst first, then those that ask for an action, then the frequent ones.
    groups.sort_by_key(|group| std::cmp::Reverse((group.priority, group.acts, group.times)));
    let listed = listed(incidents.list());
    // What is not shown is counted: those of the list that were cut, and those that the list had no room for.
    let left_out = incidents.list().len() - listed.len() + incidents.more() as usize;
    html! {
        section {
            h2 { "Alarms and incidents" }
            // No messages about alarms is another statement than no alarm.
            @if !summary.has_alarms() {
                p { "The bag has no messages about alarms." }
            } @else if groups.is_empty() {
                p { "No alarm occurred." }
            } @else {
                table {
                    thead { tr { th { "priority" } th { "alarm" } th.n { "times" } th.n { "total time" } th { "what the driller can do" } th { "what the engineer can do" } } }
                    tbody { @for group in &groups {
                        tr {
                            td { (priority(group.priority)) }
                            td { (capital(&group.worst.name)) }
                            td.n { (group.times) }
                            td.n { (duration(seconds(group.duration))) }
                            td { (group.worst.what_to_do) }
                            td { (group.worst.what_the_engineer_can_do) }
                        }
                    } }
                }
                h3 { "Incidents" }
                table {
                    thead { tr {
                        th.n { "at (s)" } th.n { "for" }
                        @if !summary.log_rows.is_empty() { th { "rows of the log" } }
                        th { "priority" } th { "alarm" }
                        // Worst moments are in the list of alarms. An old recording has
                        // events only, and the head of the column says so.
                        @if incidents.has_lists() {
                            th { "where, at the worst moment" } th { "evidence at the worst moment" } th.n { "worst at (s)" }
                        } @else {
                            th { "where, when it was raised" }
                            th { "evidence when it was raised (the bag has no twin/alarms with the worst moments)" }
                        }
                    } }
                    tbody { @for incident in &listed { (row(incident, summary)) } }
                }
                @if left_out > 0 { p { "And " (left_out) " more, of no higher priority." } }
            }
            // The figures are those that the twin itself reported last.
            @if let Some(list) = &incidents.newest {
                p.note {
                    @if list.annunciations_per_hour.is_finite() {
                        (number(list.annunciations_per_hour)) " annunciations per hour; "
                    } @else { "Annunciations per hour: not known before a full hour; " }
                    @if list.flood_share.is_finite() {
                        (percent(list.flood_share)) " of the time in flood (more than 10 in 10 min); "
                    } @else { "time in flood: not known before a full 10 min; " }
                    (list.unacknowledged) " not acknowledged at the end."
                }
            }
        }
    }
}

fn priority(code: u8) -> Markup {
    html! { span.priority.(priority_class(code)) { (words::alarm_priority(code).to_uppercase()) } }
}

fn row(incident: &Incident, summary: &Summary) -> Markup {
    let instant = |time: i64| summary.start.saturating_add(time);
    let end = incident.end.map_or(summary.end, instant);
    let worst_at = incident.worst.worst_at.saturating_sub(summary.start);
    html! {
        tr {
            td.n { @if incident.from_before { "before" } @else { (format!("{:.1}", seconds(incident.begin))) } }
            td.n { @match incident.end {
                Some(end) => (duration(seconds(end - incident.begin).max(0.0))),
                None => "to the end",
            } }
            @if !summary.log_rows.is_empty() { td { (summary.log_rows.span(instant(incident.begin), end)) } }
            td { (priority(incident.priority)) }
            td { (capital(&incident.worst.name)) @if !incident.acknowledged_by.is_empty() { small { " acknowledged by " (printable(&incident.acknowledged_by)) } } }
            td { (location(incident.worst.body, incident.worst.measured_depth, incident.worst.inclination)) }
            td { (incident.worst.evidence) }
            @if summary.incidents.has_lists() {
                td.n {
                    @if incident.worst.worst_at > 0 && worst_at >= 0 {
                        (format!("{:.1}", seconds(worst_at)))
                        @let row = summary.log_rows.row(incident.worst.worst_at);
                        @if !row.is_empty() { small { " " (row) } }
                    }
                }
            }
        }
    }
}

/// The worst incidents, in the order of their begin.
fn listed(all: &[Incident]) -> Vec<&Incident> {
    let mut order: Vec<usize> = (0..all.len()).collect();
    order.sort_by_key(|index| std::cmp::Reverse(all[*index].priority));
    order.truncate(ROWS);
    order.sort_unstable();
    order.into_iter().map(|index| &all[index]).collect()
}
