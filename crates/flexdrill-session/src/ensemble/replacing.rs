//! Which members stay and which ones others replace: by the weights of what was measured, and where some failed.

use super::engine::Ensemble;
use super::place::{Place, State};
use flexdrill_calibration::residual::RigQuantity;
use flexdrill_ensemble::{Evidence, LEAST_MEMBERS, Part, Renewal, effective_number, renewal, tempering, weights};

/// Share of the members that remain alike where others are chosen by their weights: what this leaves of the weights counts once
/// those have come.
const ALIKE: f64 = 0.5;
/// Scatter of a new member about the one that it is near, the `h` of Liu and West.
const SCATTER: f64 = 0.2;

/// A member that is prepared to take a place.
pub(super) struct Prepared {
    takes: usize,
    /// The combination of members that it is; none of a draw from the priors.
    near: Option<Renewal>,
    pub(super) place: Place,
}

/// Why members are replaced.
pub(super) enum Chosen {
    /// Few carry most of the weight: the part of it that has chosen them, by member that had one.
    ByWeights(Vec<Option<Part>>),
    /// Some failed.
    Failed,
    /// Those that run were chosen by what is withdrawn.
    Misled,
}

/// A choice of members that stay, and of those that are prepared.
pub(super) struct Choice {
    by: Chosen,
    pub(super) prepared: Vec<Prepared>,
}

impl Ensemble {
    /// Logarithms of the members' weights; NaN for those that failed.
    pub(super) fn logs(&self) -> Vec<f64> {
        let log = |place: &Place| match &place.state {
            State::Runs(member) => member.windows.evidence.log_weight(),
            _ => f64::NAN,
        };
        self.places.iter().map(log).collect()
    }

    /// Weights of the members; 0 for those that failed. A window that few members explain leaves as many alike as a band needs:
    /// the rest of it counts once others have replaced them.
    pub(super) fn weights(&self) -> Vec<f64> {
        tempered(&self.logs(), LEAST_MEMBERS).1
    }

    /// Puts those that were prepared into their places.
    pub(super) fn replace(&mut self) {
        let Some(choice) = self.choice.take() else { return };
        if let Chosen::ByWeights(parts) = &choice.by {
            self.renewals += 1;
            for (place, part) in self.places.iter_mut().zip(parts) {
                if let (State::Runs(member), Some(part)) = (&mut place.state, part) {
                    let evidence = &mut member.windows.evidence;
                    *evidence = evidence.chosen(part);
                }
            }
        }
        let evidence: Vec<Option<Evidence>> = (self.places.iter())
            .map(|place| place.member().map(|member| member.windows.evidence.clone()))
            .collect();
        let begins_again = matches!(choice.by, Chosen::Misled);
        let mut replaced = Vec::new();
        for Prepared { takes, near, mut place } in choice.prepared {
            match (&mut place.state, near.map(|near| near_evidence(&near, &evidence))) {
                (State::Runs(member), Some(Some(evidence))) => member.windows.evidence = evidence,
                (State::Runs(_), None) => {}
                // A child of a member that has failed since has nothing that weighs it.
                _ => place.state = State::Failed,
            }
            replaced.push(std::mem::replace(&mut self.places[takes], place));
        }
        if begins_again {
            // All that were drawn first run again, and what was measured before says nothing of those that begin now.
            self.outermost.clear();
            self.misled = false;
            let running = self.places.iter_mut().filter_map(Place::member_mut);
            running.for_each(|member| member.windows.begin_again());
        } else {
            self.keep_outermost(replaced);
        }
    }

    /// Prepares the members of the beginning in the place of those that were chosen by what is withdrawn.
    fn choose_the_first(&mut self) {
        let places = self.places.iter().enumerate().filter(|(_, place)| !place.first);
        let prepared = places.map(|(takes, _)| Prepared {
            takes,
            near: None,
            place: Place::new(
                self.priors
                    .member(self.seed, takes as u64)
                    .map_err(|error| error.to_string()),
                true,
            ),
        });
        self.choice = Some(Choice {
            prepared: prepared.collect(),
            by: Chosen::Misled,
        });
    }

    /// Chooses which members stay where few carry most of the weight or some failed, and prepares others near those.
    pub(super) fn choose(&mut self, now: u64) {
        if self.misled {
            return self.choose_the_first();
        }
        let logs = self.logs();
        let count = logs.len() as f64;
        let effective = effective_number(&tempered(&logs, 0.0).1);
        let few = effective < (ALIKE * count).max(LEAST_MEMBERS + 1.0).min(count - 0.5);
        let failed = self.places.iter().any(Place::has_failed);
        if !(few || failed) || effective == 0.0 {
            return;
        }
        let (power, shares) = tempered(&logs, ALIKE * count);
        // A member that could not be drawn has no weight, wherever it is.
        let size = self.priors.entries().len() + 2 * self.priors.sensors().len();
        let scores = |place: &Place| {
            place
                .drawn
                .as_ref()
                .map_or_else(|_| vec![0.0; size], |drawn| drawn.scores.clone())
        };
        let scores: Vec<Vec<f64>> = self.places.iter().map(scores).collect();
        let children = renewal(&scores, &shares, SCATTER, self.seed ^ now);
        // The first child of a member is the member itself, which need not be prepared.
        let mut stays = vec![false; shares.len()];
        let mut others = Vec::new();
        for child in children {
            if std::mem::replace(&mut stays[child.parent], true) {
                others.push(child);
            }
        }
        let gone = (0..stays.len()).filter(|index| {
            if few {
                !stays[*index]
            } else {
                self.places[*index].has_failed()
            }
        });
        let prepared = gone.zip(others).map(|(takes, child)| Prepared {
            takes,
            place: Place::new(
                self.priors.at(child.at.clone()).map_err(|error| error.to_string()),
                false,
            ),
            near: Some(child),
        });
        let parts = |place: &Place| place.member().map(|member| member.windows.evidence.part(power));
        self.choice = Some(Choice {
            prepared: prepared.collect(),
            by: match few {
                true => Chosen::ByWeights(self.places.iter().map(parts).collect()),
                false => Chosen::Failed,
            },
        });
    }
}

/// The largest power of weights with these logarithms that leaves `least` members alike, and the weights by it: 0 for members
/// without one.
fn tempered(logs: &[f64], least: f64) -> (f64, Vec<f64>) {
    if logs.iter().all(|log| log.is_nan()) {
        return (1.0, vec![0.0; logs.len()]);
    }
    let power = tempering(logs, least);
    (
        power,
        weights(&logs.iter().map(|log| power * log).collect::<Vec<f64>>()),
    )
}

/// The evidence of a child of members with this evidence: that of its parent, with the mean residuals that its parameters have
/// where figures are linear in them.
fn near_evidence(child: &Renewal, members: &[Option<Evidence>]) -> Option<Evidence> {
    let parent = members.get(child.parent)?.as_ref()?;
    let residuals: Vec<Vec<Option<f64>>> = (members.iter())
        .map(|member| {
            member
                .as_ref()
                .map_or_else(Vec::new, |of| of.mean_residuals().collect())
        })
        .collect();
    let of_channel = |channel: usize| -> Vec<Option<f64>> {
        let known = residuals.iter().map(|of| of.get(channel).copied().flatten());
        known.collect()
    };
    let moved: Vec<Option<f64>> = (0..RigQuantity::COUNT)
        .map(|channel| child.combined(&of_channel(channel)))
        .collect();
    Some(parent.moved(&moved))
}
