//! The table of figures and the definitions of the messages agree.

use flexdrill_messages::Message;
use flexdrill_outputs::figures::{BIT_STATE, CONTACT_FORCES, Figure, HOLE_AHEAD, JOINT_DEFLECTIONS, TRANSFER, Window};

/// The scalar numbers of a message's definition, by type and name. A constant has a value.
fn scalars<M: Message>() -> Vec<(&'static str, &'static str)> {
    let lines = M::INFO.source().lines().filter(|line| !line.contains(['#', '=']));
    let fields = lines.filter_map(|line| line.split_once(' '));
    fields
        .filter(|(kind, _)| ["float64", "uint32", "bool"].contains(kind))
        .collect()
}

/// Every row has its field with a comment.
fn check<M: Message>(table: &[Figure<M>]) {
    let scalars = scalars::<M>();
    for figure in table {
        let field = figure.field;
        assert!(scalars.iter().any(|(_, name)| *name == field), "{}: {field}", M::NAME);
        let text = figure.text();
        assert!(text.ends_with('.'), "{}: {field}: {text}", M::NAME);
        // What covers the interval says so in the definition too; all of `twin/transfer` covers its window.
        let word = match figure.window {
            Window::Mean => "mean",
            Window::Rms => "Root mean square",
            Window::Largest => "Largest",
            Window::Integral => "Integral",
            Window::Instant | Window::LongMean | Window::LongRms => "",
        };
        assert!(text.contains(word), "{}: {field}: {text}", M::NAME);
        assert_eq!(figure.window == Window::LongRms, field.ends_with("_rms"), "{field}");
    }
}

/// Every float64 of the message has its row.
fn check_all<M: Message>(table: &[Figure<M>]) {
    check(table);
    for (kind, name) in scalars::<M>() {
        let rows = table.iter().filter(|figure| figure.field == name).count();
        assert!(rows == 1 || kind != "float64", "{}: {name}: {rows} rows", M::NAME);
    }
}

#[test]
fn every_scalar_of_the_messages_is_a_row() {
    check_all(BIT_STATE);
    check(JOINT_DEFLECTIONS);
    check(CONTACT_FORCES);
    check(HOLE_AHEAD);
    check_all(TRANSFER);
}

#[test]
fn a_figure_has_the_text_of_its_field() {
    let torque = TRANSFER
        .iter()
        .find(|figure| figure.field == "guide_wall_friction_torque");
    assert_eq!(
        torque.unwrap().text(),
        "Torque of the rotation that friction between guide and wall takes (N m), without what the advance takes."
    );
}

/// A name, a label within its group, and a figure that bridges send has a unit for them.
#[test]
fn names_and_labels_are_unique() {
    let mut names: Vec<&str> = Vec::new();
    names.extend(BIT_STATE.iter().filter_map(|figure| figure.bridge));
    names.extend(JOINT_DEFLECTIONS.iter().filter_map(|figure| figure.bridge));
    names.extend(CONTACT_FORCES.iter().filter_map(|figure| figure.bridge));
    names.extend(TRANSFER.iter().filter_map(|figure| figure.bridge));
    names.extend(HOLE_AHEAD.iter().filter_map(|figure| figure.bridge));
    let sent = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), sent);
    check_labels(BIT_STATE);
    check_labels(TRANSFER);
    check_labels(HOLE_AHEAD);
    // A figure of the bit without a label would be in no report.
    assert!(BIT_STATE.iter().all(|figure| figure.shown.is_some()));
}

fn check_labels<M>(table: &[Figure<M>]) {
    for (at, figure) in table.iter().enumerate() {
        let field = figure.field;
        assert!(figure.bridge.is_none() || figure.kind.dimension().is_some(), "{field}");
        for other in &table[at + 1..] {
            let (Some(one), Some(two)) = (figure.shown, other.shown) else {
                continue;
            };
            let differ = one.label != two.label && one.short != two.short;
            assert!(one.group != two.group || differ, "{one:?} {two:?}");
        }
    }
}

/// A column of the Python package has the unit at its end, and what it measures at that instant is another column.
#[test]
fn columns_carry_their_units() {
    let of_bit = |field| BIT_STATE.iter().find(|figure| figure.field == field).unwrap().column();
    assert_eq!(of_bit("torque"), "mean_torque_nm");
    assert_eq!(of_bit("rotary_speed"), "mean_rotary_speed_rad_per_s");
    assert_eq!(of_bit("stick_slip_index"), "stick_slip_index");
    assert_eq!(of_bit("axial_acceleration"), "axial_acceleration_m_per_s2");
    let of_transfer = |field| TRANSFER.iter().find(|figure| figure.field == field).unwrap().column();
    assert_eq!(of_transfer("surface_weight_rms"), "surface_weight_rms_n");
    assert_eq!(of_transfer("drive_power"), "drive_power_w");
}

/// What is written is read again, in this field alone.
#[test]
fn a_figure_writes_its_own_field() {
    check_writes(TRANSFER);
    check_writes(HOLE_AHEAD);
}

fn check_writes<M: Message + Default>(table: &[Figure<M>]) {
    for (at, figure) in table.iter().enumerate() {
        let mut message = M::default();
        // 1 is a value of a flag too.
        (figure.write)(&mut message, 1.0);
        for (other, read) in table.iter().map(|figure| figure.read).enumerate() {
            assert_eq!(read(&message) == 1.0, other == at, "{}", figure.field);
        }
    }
}
