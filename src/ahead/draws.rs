//! Which of some weighted tools the members of a look-ahead have.

use super::goal::MOST_MEMBERS;

/// The tool of each member, by its number.
///
/// Tool i with the share w_i is drawn at the instants (u_i + j) / w_i for j = 0, 1, ..., with u_i uniform in 0 to 1; members
/// take the draws in the order of these instants. Until an instant t tool i was drawn t w_i times in the mean over the u_i,
/// so that each is drawn by its weight, and never more than once more or less than that: the first members of any number
/// stand for the weights, which independent draws of as few would not. Tools of equal weight are all drawn once before
/// any is drawn again.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Draws(Vec<usize>);

impl Draws {
    /// Draws among tools of these weights, which need not sum up to 1; those that are no positive number are never drawn.
    pub fn new(weights: &[f64], seed: u64) -> Self {
        let mut random = fastrand::Rng::with_seed(seed);
        let sum: f64 = weights.iter().filter(|weight| **weight > 0.0).sum();
        let begun: Vec<f64> = weights.iter().map(|_| random.f64()).collect();
        let mut instants = Vec::new();
        for (tool, (weight, begun)) in weights.iter().zip(begun).enumerate() {
            let share = weight / sum;
            if share.is_nan() || share <= 0.0 {
                continue;
            }
            // Until the instant n, n w_i + 1 draws at most are of this tool, and n - 1 at least of all.
            let most = (f64::from(MOST_MEMBERS + weights.len() as u32) * share).ceil() as u32 + 1;
            instants.extend((0..most).map(|draw| ((begun + f64::from(draw)) / share, tool)));
        }
        instants.sort_by(|a, b| a.0.total_cmp(&b.0));
        instants.truncate(MOST_MEMBERS as usize);
        Self(instants.into_iter().map(|(_, tool)| tool).collect())
    }

    /// The tool of a member; none where there is no tool.
    pub fn of(&self, member: u32) -> Option<usize> {
        self.0.get(member as usize).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counts(weights: &[f64], seed: u64, members: u32) -> Vec<f64> {
        let draws = Draws::new(weights, seed);
        let mut counts = vec![0.0; weights.len()];
        for member in 0..members {
            counts[draws.of(member).unwrap()] += 1.0;
        }
        counts
    }

    #[test]
    fn equal_tools_are_all_drawn_once_before_any_is_drawn_again() {
        for seed in 0..50 {
            for round in 1..=4 {
                assert_eq!(
                    counts(&[0.5; 16], seed, 16 * round),
                    [f64::from(round); 16],
                    "seed {seed}"
                );
            }
        }
        // Which come first depends on the seed.
        let firsts: std::collections::BTreeSet<_> = (0..50).map(|seed| Draws::new(&[1.0; 16], seed).of(0)).collect();
        assert!(firsts.len() > 8, "{firsts:?}");
    }

    /// Over many seeds the first ten members have each tool as often as its weight asks for: also one that is expected
    /// less than once in them.
    #[test]
    fn the_first_members_stand_for_the_weights() {
        const SEEDS: u64 = 4000;
        let weights = [0.4, 0.25, 0.15, 0.1, 0.06, 0.03, 0.01];
        let mut all = [0.0; 7];
        for seed in 0..SEEDS {
            let counts = counts(&weights, seed, 10);
            for ((all, count), weight) in all.iter_mut().zip(&counts).zip(weights) {
                *all += count;
                // Once more or less than its share, and the instant of the tenth draw lies up to three draws off: all seven
                // shares are rounded.
                assert!(
                    (count - 10.0 * weight).abs() <= 1.0 + 3.0 * weight,
                    "seed {seed}: {counts:?}"
                );
            }
        }
        for (all, weight) in all.iter().zip(weights) {
            let mean = all / SEEDS as f64;
            // A count is one of two neighbours, so that its deviation is half at most, that of the mean 0.008; and the tenth
            // draw is not an instant, which moves the mean by less than a third of a weight.
            assert!(
                (mean - 10.0 * weight).abs() < 0.03 + 0.34 * weight,
                "{mean} for {weight}"
            );
        }
    }

    #[test]
    fn what_has_no_weight_is_never_drawn() {
        let counts = counts(&[0.0, 1.0, f64::NAN, -1.0, 3.0], 7, MOST_MEMBERS);
        assert_eq!(counts[0] + counts[2] + counts[3], 0.0);
        assert!((counts[4] / counts[1] - 3.0).abs() < 0.1, "{counts:?}");
        assert_eq!(Draws::new(&[], 1).of(0), None);
        assert_eq!(Draws::new(&[0.0], 1).of(0), None);
    }
}
