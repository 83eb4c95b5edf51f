//! How a number changed over time, in words.

use crate::six_digits;

/// The first, the last and the extreme values of a number, and whether it rose and fell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// The first value.
    pub first: f64,
    last: f64,
    least: f64,
    most: f64,
    rose: bool,
    fell: bool,
}

impl Course {
    /// Begins with the first value.
    pub const fn new(value: f64) -> Self {
        Self {
            first: value,
            last: value,
            least: value,
            most: value,
            rose: false,
            fell: false,
        }
    }

    /// Adds a later value.
    pub fn add(&mut self, value: f64) {
        self.rose |= value > self.last;
        self.fell |= value < self.last;
        (self.least, self.most) = (self.least.min(value), self.most.max(value));
        self.last = value;
    }

    /// The course of values in their order; `None` without one.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values = values.into_iter();
        let mut course = Self::new(values.next()?);
        values.for_each(|value| course.add(value));
        Some(course)
    }

    /// Whether all values are the same.
    pub const fn is_constant(self) -> bool {
        !self.rose && !self.fell
    }

    /// Range and trend in the unit of the values: a depth only grows while drilling, a weight varies.
    pub fn words(self) -> String {
        let range = format!("{} to {}", six_digits(self.least), six_digits(self.most));
        match (self.rose, self.fell) {
            (false, false) => "constant".to_owned(),
            (true, false) => format!("{range}, only rises"),
            (false, true) => format!("{range}, only falls"),
            (true, true) => format!("{range}, varies"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_course_says_range_and_trend() {
        let words = |values: &[f64]| Course::of(values.iter().copied()).map(Course::words);
        assert_eq!(words(&[1.0, 3.0, 4.0]).as_deref(), Some("1 to 4, only rises"));
        assert_eq!(words(&[4.0, 4.0, 1.0]).as_deref(), Some("1 to 4, only falls"));
        assert_eq!(words(&[2.0, 1.0, 5.0]).as_deref(), Some("1 to 5, varies"));
        assert_eq!(words(&[7.0, 7.0]).as_deref(), Some("constant"));
        assert_eq!(words(&[]), None);
    }
}
