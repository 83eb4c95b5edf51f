//! Sub-stepping: a step is halved where one does not converge, doubled again as soon as its grid allows.

/// Progress through one step, in units of the smallest sub-step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SubSteps {
    whole: u64,
    most: u32,
    /// Halvings of the largest sub-step.
    coarsest: u32,
    done: u64,
    level: u32,
    deepest: u32,
}

impl SubSteps {
    /// At the beginning of a step that is taken in 2^`coarsest` parts, each of which may be halved until the step has been
    /// halved `most` times.
    pub fn new(most: u32, coarsest: u32) -> Self {
        let most = most.max(coarsest);
        Self {
            whole: 1 << most,
            most,
            coarsest,
            done: 0,
            level: coarsest,
            deepest: coarsest,
        }
    }

    /// The next sub-step: parts of the step behind it at its start and at its end (0 to 1, exact); `None` at the step's
    /// end.
    pub fn part(&self) -> Option<(f64, f64)> {
        let at = |part: u64| part as f64 / self.whole as f64;
        (self.done < self.whole).then(|| (at(self.done), at(self.done + self.size())))
    }

    /// The sub-step was taken.
    pub fn accept(&mut self) {
        self.done += self.size();
        if self.level > self.coarsest && self.done.is_multiple_of(self.size() * 2) {
            self.level -= 1;
        }
    }

    /// The sub-step was rejected; `false` if it was the smallest one already.
    pub fn reject(&mut self) -> bool {
        if self.level == self.most {
            return false;
        }
        self.level += 1;
        self.deepest = self.deepest.max(self.level);
        true
    }

    /// Whether the step's first part is being tried, for the first time.
    pub fn is_first(&self) -> bool {
        self.done == 0 && self.level == self.coarsest
    }

    /// Most halvings so far, on top of the parts that were asked for.
    pub fn deepest(&self) -> u32 {
        self.deepest - self.coarsest
    }

    fn size(&self) -> u64 {
        self.whole >> self.level
    }
}

/// Most sub-steps that a step with n = `max_halvings` attempts, taken and rejected ones together: 3 x 2^(n-1) + n - 1,
/// and 1 without halving. Every second smallest sub-step is taken, the steps between them are all tried in vain; as the
/// size grows by one level at a time, not all of the larger ones are tried again, which would be 2^(n+1) - 1.
pub const fn most_attempts(max_halvings: u32) -> u64 {
    match max_halvings {
        0 => 1,
        n => 3 * (1 << (n - 1)) + n as u64 - 1,
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;

    /// Most attempts from here on, whatever is accepted or rejected.
    fn worst(sub_steps: SubSteps, known: &mut HashMap<(u64, u32), u64>) -> u64 {
        if sub_steps.part().is_none() {
            return 0;
        }
        let key = (sub_steps.done, sub_steps.level);
        if let Some(&worst) = known.get(&key) {
            return worst;
        }
        let (mut accepted, mut rejected) = (sub_steps, sub_steps);
        accepted.accept();
        let after_accept = worst(accepted, known);
        let after_reject = if rejected.reject() { worst(rejected, known) } else { 0 };
        known.insert(key, 1 + after_accept.max(after_reject));
        known[&key]
    }

    #[test]
    fn the_bound_is_the_worst_of_all_ways_through_a_step() {
        for most in 0..=12 {
            assert_eq!(
                worst(SubSteps::new(most, 0), &mut HashMap::new()),
                most_attempts(most),
                "{most}"
            );
        }
        assert_eq!(most_attempts(6), 101);
    }

    #[test]
    fn a_step_without_trouble_is_taken_whole() {
        let mut sub_steps = SubSteps::new(6, 0);
        assert_eq!(sub_steps.part(), Some((0.0, 1.0)));
        sub_steps.accept();
        assert_eq!((sub_steps.part(), sub_steps.deepest()), (None, 0));
    }

    #[test]
    fn a_refined_step_is_taken_in_its_parts() {
        let mut sub_steps = SubSteps::new(6, 1);
        assert!(sub_steps.is_first());
        assert_eq!(sub_steps.part(), Some((0.0, 0.5)));
        assert!(sub_steps.reject() && !sub_steps.is_first());
        for part in [(0.0, 0.25), (0.25, 0.5), (0.5, 1.0)] {
            assert_eq!(sub_steps.part(), Some(part));
            sub_steps.accept();
        }
        assert_eq!((sub_steps.part(), sub_steps.deepest()), (None, 1));
        // Where no halving is allowed, the parts are.
        let mut sub_steps = SubSteps::new(0, 2);
        assert_eq!(sub_steps.part(), Some((0.0, 0.25)));
        assert!(!sub_steps.reject());
        // A refined step never takes more attempts than one that is halved as often as it may.
        for (most, coarsest) in [(6, 1), (6, 2), (2, 2)] {
            assert!(worst(SubSteps::new(most, coarsest), &mut HashMap::new()) <= most_attempts(most));
        }
    }

    #[test]
    fn the_size_grows_again_on_its_own_grid() {
        let mut sub_steps = SubSteps::new(2, 0);
        assert!(sub_steps.reject() && sub_steps.reject() && !sub_steps.reject());
        assert_eq!(sub_steps.part(), Some((0.0, 0.25)));
        sub_steps.accept();
        assert_eq!(sub_steps.part(), Some((0.25, 0.5)));
        sub_steps.accept();
        assert_eq!(sub_steps.part(), Some((0.5, 1.0)));
        sub_steps.accept();
        assert_eq!((sub_steps.part(), sub_steps.deepest()), (None, 2));
    }
}
