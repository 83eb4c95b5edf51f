//! The hole's axis: points joined by chords, with a frame at each that is carried without twist.

use flexdrill_base::validation::{Bound, ValidationError};
use nalgebra::{Vector2, Vector3};

/// Axes of the hole at a point, in the world's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// x: down the hole.
    pub tangent: Vector3<f64>,
    /// y: to the right where the hole began.
    pub right: Vector3<f64>,
    /// z: to the low side where the hole began.
    pub low: Vector3<f64>,
}

impl Frame {
    /// The frame of a hole at an inclination and an azimuth (rad). In a vertical hole z is opposite to the azimuth.
    fn at(inclination: f64, azimuth: f64) -> Self {
        let (sine, cosine) = inclination.sin_cos();
        let (east, north) = azimuth.sin_cos();
        Self {
            tangent: Vector3::new(sine * north, sine * east, cosine),
            right: Vector3::new(-east, north, 0.0),
            low: Vector3::new(-cosine * north, -cosine * east, sine),
        }
    }

    /// This frame turned to another tangent without twist: about the axis across both tangents t and t', a vector v across t
    /// becomes v - (v . t') / (1 + t . t') (t + t'). It has no angle, whose cosine would resolve 1e-8 rad at best. The two
    /// tangents must not be opposite.
    fn carried_to(&self, tangent: Vector3<f64>) -> Self {
        let between = (self.tangent + tangent) / (1.0 + self.tangent.dot(&tangent));
        let carry = |across: &Vector3<f64>| across - between * across.dot(&tangent);
        Self {
            tangent,
            right: carry(&self.right),
            low: carry(&self.low),
        }
    }

    /// Components (right, low) of a vector.
    pub fn across(&self, vector: Vector3<f64>) -> Vector2<f64> {
        Vector2::new(vector.dot(&self.right), vector.dot(&self.low))
    }

    /// Angles (right, low) by which a direction deviates from the tangent (rad).
    pub(crate) fn deviation(&self, direction: Vector3<f64>) -> Vector2<f64> {
        let along = direction.dot(&self.tangent);
        self.across(direction).map(|side| side.atan2(along))
    }

    /// The vector with components (right, low).
    pub(crate) fn vector(&self, across: Vector2<f64>) -> Vector3<f64> {
        self.right * across.x + self.low * across.y
    }
}

/// Inclination (rad) of a direction: its angle against the vertical.
pub(crate) fn inclination(direction: Vector3<f64>) -> f64 {
    direction.x.hypot(direction.y).atan2(direction.z)
}

/// Azimuth (rad) of a direction, clockwise seen from above; 0 for a vertical one.
pub(crate) fn azimuth(direction: Vector3<f64>) -> f64 {
    direction.y.atan2(direction.x)
}

/// A hole from its start to the bit.
///
/// The tangent at a point is the mean of its two chords; at both ends it continues the last chord's turn.
#[derive(Debug, Clone, PartialEq)]
pub struct Hole {
    points: Vec<Vector3<f64>>,
    frames: Vec<Frame>,
}

impl Hole {
    /// A hole of no length that begins at an inclination and an azimuth (rad), at the world's origin.
    ///
    /// # Errors
    /// [`ValidationError`] for an inclination outside 0 to pi, or an azimuth that is not finite.
    pub fn begin(inclination: f64, azimuth: f64) -> Result<Self, ValidationError> {
        Bound::Within(0.0, std::f64::consts::PI).check("hole.inclination", inclination, "rad")?;
        Bound::Finite.check("hole.azimuth", azimuth, "rad")?;
        Ok(Self {
            points: vec![Vector3::zeros()],
            frames: vec![Frame::at(inclination, azimuth)],
        })
    }

    /// Adds a straight piece of a length (m) in chords of at most `chord` (m).
    ///
    /// # Errors
    /// [`ValidationError`] for a length below 0 or a chord that is not above 0.
    pub fn straight(mut self, length: f64, chord: f64) -> Result<Self, ValidationError> {
        Bound::NotNegative.check("hole.straight", length, "m")?;
        Bound::Positive.check("hole.chord", chord, "m")?;
        let count = (length / chord - 1e-9).ceil();
        let direction = self.end().tangent;
        for _ in 0..count as usize {
            self.extend(direction, length / count);
        }
        Ok(self)
    }

    /// Adds an arc of a radius (m) and an angle (rad) towards the high side of the hole's frame, in chords of arcs of at
    /// most `chord` (m).
    ///
    /// # Errors
    /// [`ValidationError`] for a radius, an angle or a chord that is not above 0.
    pub fn arc(mut self, radius: f64, angle: f64, chord: f64) -> Result<Self, ValidationError> {
        Bound::Positive.check_all("hole", &[("radius", radius), ("chord", chord)], "m")?;
        Bound::Positive.check("hole.build_angle", angle, "rad")?;
        let count = (radius * angle / chord - 1e-9).ceil().max(1.0);
        let Frame { tangent, low, .. } = self.end();
        let length = 2.0 * radius * (0.5 * angle / count).sin();
        for index in 0..count as usize {
            let (sine, cosine) = ((index as f64 + 0.5) * angle / count).sin_cos();
            self.extend(tangent * cosine - low * sine, length);
        }
        Ok(self)
    }

    /// Adds chords of another description of the hole (m, world).
    ///
    /// # Errors
    /// [`ValidationError`] for a chord that has no length.
    pub fn through(mut self, chords: impl IntoIterator<Item = Vector3<f64>>) -> Result<Self, ValidationError> {
        for chord in chords {
            let length = chord.norm();
            Bound::Positive.check("hole.chord", length, "m")?;
            self.extend(chord / length, length);
        }
        Ok(self)
    }

    /// Points of the axis (m), from the start to the bit.
    pub fn points(&self) -> &[Vector3<f64>] {
        &self.points
    }

    /// Frames at the points.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// The frame at the bit.
    pub fn end(&self) -> Frame {
        self.frames[self.frames.len() - 1]
    }

    /// Length of all chords (m).
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
    }

    /// Adds a chord in a direction (of length 1).
    pub(crate) fn extend(&mut self, direction: Vector3<f64>, length: f64) {
        self.points
            .push(self.points[self.points.len() - 1] + direction * length);
        self.frames.push(self.end());
        self.carry_end();
    }

    /// A hole of no points, which stands for one that is being changed.
    pub(crate) const fn empty() -> Self {
        Self {
            points: Vec::new(),
            frames: Vec::new(),
        }
    }

    /// Removes the last chord.
    pub(crate) fn remove_last(&mut self) {
        self.points.pop();
        self.frames.pop();
        if self.points.len() > 1 {
            self.carry_end();
        }
    }

    /// Turns the last chord to a direction (of length 1).
    pub(crate) fn turn_last(&mut self, direction: Vector3<f64>) {
        let last = self.points.len() - 1;
        let length = (self.points[last] - self.points[last - 1]).norm();
        self.points[last] = self.points[last - 1] + direction * length;
        self.carry_end();
    }

    /// Direction of chord `index`, which ends at that point.
    fn chord(&self, index: usize) -> Vector3<f64> {
        (self.points[index] - self.points[index - 1]).normalize()
    }

    /// Sets the frames at both ends of the last chord.
    fn carry_end(&mut self) {
        let last = self.points.len() - 1;
        let chord = self.chord(last);
        if last >= 2 {
            let tangent = (self.chord(last - 1) + chord).normalize();
            self.frames[last - 1] = self.frames[last - 2].carried_to(tangent);
        }
        let before = self.frames[last - 1];
        // The tangent turns on as much behind the chord as it has turned from the point before to the chord.
        let tangent = chord * (2.0 * chord.dot(&before.tangent)) - before.tangent;
        self.frames[last] = before.carried_to(tangent);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_ends_where_a_circle_does() {
        let hole = Hole::begin(0.0, 0.0).unwrap();
        let hole = hole.straight(1.0, 0.04).unwrap().arc(3.2, 1.2, 0.04).unwrap();
        let end = Vector3::new(3.2 * (1.0 - 1.2_f64.cos()), 0.0, 1.0 + 3.2 * 1.2_f64.sin());
        assert!((hole.points().last().unwrap() - end).norm() < 1e-12);
        // The kink between the straight piece and the first chord is shared by the tangents near it, not lost.
        assert!((inclination(hole.end().tangent) - 1.2).abs() < 1e-2);
        assert!((hole.length() - 1.0 - 3.2 * 1.2).abs() < 1e-3);
    }

    #[test]
    fn frames_are_right_handed_and_low_is_down_in_a_level_hole() {
        let hole = Hole::begin(0.5, 0.3).unwrap().arc(3.2, 1.0707963, 0.04).unwrap();
        for frame in hole.frames() {
            assert!((frame.tangent.cross(&frame.right) - frame.low).norm() < 1e-12);
        }
        assert!((hole.end().low - Vector3::z()).norm() < 1e-6, "{:?}", hole.end());
        assert!((azimuth(hole.end().tangent) - 0.3).abs() < 1e-12);
    }

    /// Chords of one direction differ by rounding, whose angle no arc cosine has.
    #[test]
    fn straight_holes_have_frames_at_any_inclination() {
        for tenths in 0..=1800 {
            let inclination = (f64::from(tenths) / 10.0).to_radians();
            let hole = Hole::begin(inclination, 0.4).unwrap().straight(8.0, 0.04).unwrap();
            let (first, last) = (hole.frames()[0], hole.end());
            // 200 chords of a hole of 8 m, whose coordinates round to 1e-15 of it.
            assert!((last.low - first.low).norm() < 1e-10, "{inclination} rad: {last:?}");
        }
    }

    #[test]
    fn nonsense_is_refused() {
        assert!(Hole::begin(-0.1, 0.0).is_err());
        let hole = Hole::begin(0.0, 0.0).unwrap();
        assert!(hole.clone().straight(f64::NAN, 0.04).is_err());
        assert!(hole.clone().straight(1.0, 0.0).is_err());
        assert!(hole.arc(0.0, 1.0, 0.04).is_err());
    }
}
