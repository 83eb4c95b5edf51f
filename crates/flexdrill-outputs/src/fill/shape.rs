//! The tool as markers: bore, both pipes' deflected lines, contact forces.
//!
//! Frame: X horizontal in the build's direction, Y horizontal, Z down, origin at the kick-off; metres. Displacements
//! from the bore axis are drawn larger than they are, the bore itself is not.

use super::arrows::{POINTS_PER_ARROW, colour, push_arrow};
use flexdrill_core::twin::{ContactLayer, Snapshot};
use flexdrill_messages::geometry_msgs::{Point, Pose, Quaternion, Vector3};
use flexdrill_messages::std_msgs::{ColorRGBA, Header};
use flexdrill_messages::visualization_msgs::{Marker, MarkerArray};

/// How the tool is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeStyle {
    /// Factor on displacements from the bore axis.
    pub exaggeration: f64,
    /// Force drawn in red and at full length (N).
    pub full_scale_force: f64,
    /// Length of the arrow of that force (m).
    pub full_scale_length: f64,
}

impl ShapeStyle {
    /// Displacements enlarged by `exaggeration`, arrows up to 0.5 m for 5 kN.
    pub fn new(exaggeration: f64) -> Self {
        Self {
            exaggeration,
            full_scale_force: 5000.0,
            full_scale_length: 0.5,
        }
    }
}

const BORE: ColorRGBA = rgba(0.5, 0.5, 0.5, 0.6);
const PIPE: ColorRGBA = rgba(0.95, 0.55, 0.1, 1.0);
const GUIDE: ColorRGBA = rgba(0.2, 0.6, 0.85, 0.8);

const fn rgba(r: f32, g: f32, b: f32, a: f32) -> ColorRGBA {
    ColorRGBA { r, g, b, a }
}

/// Fills `out` with five markers, always the same ones, so that each message replaces the one before.
pub fn tool_shape(snapshot: &Snapshot, header: &Header, style: &ShapeStyle, out: &mut MarkerArray) {
    // Five in every message: a viewer keeps a marker until one of the same name replaces it.
    out.markers.resize_with(5, Marker::default);
    let [bore, pipe, guide, inner, outer] = out.markers.as_mut_slice() else {
        return;
    };
    let shape = &snapshot.shape;
    line(bore, header, "bore", 0.004, BORE, shape.bore.iter().copied());
    line(
        pipe,
        header,
        "flexible_pipe",
        0.02,
        PIPE,
        displaced(snapshot, &shape.pipe, style.exaggeration),
    );
    line(
        guide,
        header,
        "guide_pipe",
        0.01,
        GUIDE,
        displaced(snapshot, &shape.guide, style.exaggeration),
    );
    // The force on the inner body of a layer points from the place of contact to the axis.
    arrows(
        inner,
        header,
        "pipe_guide_contact",
        snapshot,
        &snapshot.contacts.pipe_guide,
        style,
        |station| {
            let (pipe, guide) = (shape.pipe.get(station)?, shape.guide.get(station)?);
            Some((*pipe, [pipe[0] - guide[0], pipe[1] - guide[1]]))
        },
    );
    // The contact with the wall is at the guide, and its normal is the guide's own displacement from the bore.
    arrows(
        outer,
        header,
        "guide_wall_contact",
        snapshot,
        &snapshot.contacts.guide_wall,
        style,
        |station| shape.guide.get(station).map(|guide| (*guide, *guide)),
    );
}

/// What all markers have in common.
fn begin(marker: &mut Marker, header: &Header, namespace: &str, kind: i32, width: f64) {
    super::stamp(&mut marker.header, header);
    namespace.clone_into(&mut marker.ns);
    marker.id = 0;
    marker.type_ = kind;
    marker.pose = Pose {
        position: Point::default(),
        orientation: Quaternion {
            w: 1.0,
            ..Quaternion::default()
        },
    };
    marker.scale = Vector3 {
        x: width,
        ..Vector3::default()
    };
    marker.points.clear();
    marker.colors.clear();
}

/// Viewers complain of a list without points: it is deleted instead.
fn end(marker: &mut Marker) {
    marker.action = if marker.points.is_empty() {
        Marker::DELETE
    } else {
        Marker::ADD
    };
}

fn line(
    marker: &mut Marker,
    header: &Header,
    namespace: &str,
    width: f64,
    color: ColorRGBA,
    points: impl Iterator<Item = [f64; 3]>,
) {
    begin(marker, header, namespace, Marker::LINE_STRIP, width);
    marker.color = color;
    marker.points.extend(points.map(|[x, y, z]| Point { x, y, z }));
    end(marker);
}

/// World positions of a pipe's displaced axis.
fn displaced<'a>(
    snapshot: &'a Snapshot,
    lateral: &'a [[f64; 2]],
    exaggeration: f64,
) -> impl Iterator<Item = [f64; 3]> + 'a {
    let shape = &snapshot.shape;
    shape
        .bore
        .iter()
        .zip(&shape.low_side)
        .zip(lateral)
        .map(move |((bore, low_side), lateral)| offset(*bore, *low_side, lateral.map(|value| value * exaggeration)))
}

/// `origin` moved by (y, z) of the station frame.
fn offset(origin: [f64; 3], low_side: [f64; 3], [y, z]: [f64; 2]) -> [f64; 3] {
    [
        origin[0] + z * low_side[0],
        origin[1] + y + z * low_side[1],
        origin[2] + z * low_side[2],
    ]
}

/// Arrows of one layer. `place` gives, for a station, where the inner body is and in which direction it leans on the
/// outer one, both as (y, z) of the station frame.
fn arrows(
    marker: &mut Marker,
    header: &Header,
    namespace: &str,
    snapshot: &Snapshot,
    layer: &ContactLayer,
    style: &ShapeStyle,
    place: impl Fn(usize) -> Option<([f64; 2], [f64; 2])>,
) {
    begin(marker, header, namespace, Marker::LINE_LIST, 0.006);
    marker.color = rgba(1.0, 1.0, 1.0, 1.0);
    let stations = snapshot
        .shape
        .bore
        .iter()
        .zip(&snapshot.shape.low_side)
        .zip(&layer.normal);
    for (station, ((bore, low_side), &force)) in stations.enumerate() {
        let Some((centre, lean)) = place(station) else {
            continue;
        };
        let distance = (lean[0] * lean[0] + lean[1] * lean[1]).sqrt();
        if force <= 0.0 || distance == 0.0 {
            continue;
        }
        let share = force / style.full_scale_force;
        let tail = offset(*bore, *low_side, centre.map(|value| value * style.exaggeration));
        let direction = offset([0.0; 3], *low_side, lean.map(|value| -value / distance));
        let side = offset([0.0; 3], *low_side, [lean[1] / distance, -lean[0] / distance]);
        push_arrow(
            &mut marker.points,
            tail,
            direction,
            side,
            style.full_scale_length * share.min(1.0),
        );
        marker
            .colors
            .extend(std::iter::repeat_n(colour(share), POINTS_PER_ARROW));
    }
    end(marker);
}
