//! Mappings, and why a wrong one is refused.

use super::*;

fn code(text: &str) -> ItemCode {
    text.parse().unwrap()
}

#[test]
fn defaults_follow_the_unit_system_and_a_site_changes_them() {
    let metric = Mapping::default().table();
    assert_eq!(metric[&code("0116")].unit, Unit::Kilodecanewton);
    let field = Mapping::from_text("site.yaml", "units: field\n").unwrap().table();
    assert_eq!(field[&code("0116")].unit, Unit::Kilopound);
    assert_eq!(field[&code("0121")].unit, Unit::Psi);
    let text = "items:\n  \"0116\": {quantity: weight_on_bit, unit: KDN, valid: [-1, 20]}\n  \"0117\":\n  \"2508\": \
                {quantity: lateral_shock, unit: g}\n";
    let site = Mapping::from_text("site.yaml", text).unwrap().table();
    assert_eq!(site[&code("0116")].unit, Unit::Kilodecanewton);
    assert_eq!(site[&code("0116")].valid, Some([-1.0, 20.0]));
    assert!(!site.contains_key(&code("0117")));
    assert_eq!(
        site[&code("2508")].quantity,
        Quantity::Measured(MeasuredKind::LateralShock)
    );
}

#[test]
fn what_cannot_be_is_refused_with_its_line() {
    // The spellings are those of logs and OPC UA too.
    let unit = |unit: &str| {
        let text = format!("items: {{\"0116\": {{quantity: weight_on_bit, unit: {unit}}}}}\n");
        Mapping::from_text("site.yaml", &text).map(|mapping| mapping.table()[&code("0116")].unit)
    };
    for (spelling, expected) in [
        ("klbs", Unit::Kilopound),
        ("kip", Unit::Kilopound),
        ("klb", Unit::Kilopound),
        ("daN", Unit::Decanewton),
        ("KDN", Unit::Kilodecanewton),
        ("tonne", Unit::TonneForce),
    ] {
        assert_eq!(unit(spelling).unwrap(), expected, "{spelling}");
    }
    let error = unit("ton").unwrap_err().to_string();
    assert!(
        error.contains("site.yaml:1") && error.contains("write tf for a tonne"),
        "{error}"
    );
    for (text, words) in [
        ("units: imperial\n", "imperial"),
        ("items: {\"0116\": {quantity: weight_on_bit, unit: psi}}\n", "kdaN"),
        ("items: {\"0104\": {quantity: weight_on_bit, unit: kN}}\n", "header"),
        ("items: {\"116\": {quantity: weight_on_bit, unit: kN}}\n", "four digits"),
        ("items: {\"0116\": {quantity: weight, unit: kN}}\n", "surface_torque"),
        (
            "items: {\"0116\": {quantity: weight_on_bit, unit: kN, valid: [5, 1]}}\n",
            "smallest",
        ),
        ("utc_offset_h: 30\n", "14"),
        ("sequence: perhaps\n", "ignore"),
        ("ask: {every_s: 0}\n", "0.1"),
        ("ask: {lines: [\"caf\u{e9}\"]}\n", "ASCII"),
        ("write: {items: {}}\n", "at least one"),
        (
            "write: {every_s: 0, items: {\"4008\": {figure: bit_torque, unit: kN.m}}}\n",
            "0.1",
        ),
        ("write: {items: {\"4008\": {figure: bit_torque, unit: deg}}}\n", "kN.m"),
        ("colour: red\n", "colour"),
    ] {
        let error = Mapping::from_text("site.yaml", text).unwrap_err().to_string();
        assert!(error.contains("site.yaml:1") && error.contains(words), "{text}{error}");
    }
}

#[test]
fn a_request_is_a_valid_packet_unless_the_site_has_another() {
    let by_itself = Mapping::default().ask().unwrap();
    assert_eq!(&*by_itself.request, b"&&\r\n0111-9999\r\n!!\r\n");
    assert_eq!(by_itself.after, ASKED_AFTER);
    let site = Mapping::from_text("site.yaml", "ask: {every_s: 5, lines: [\"&&\", \"!!\"]}\n").unwrap();
    let ask = site.ask().unwrap();
    assert_eq!(
        (&*ask.request, ask.every, ask.after),
        (b"&&\r\n!!\r\n".as_slice(), Duration::from_secs(5), Duration::ZERO)
    );
    let never = Mapping::from_text("site.yaml", "ask: {lines: []}\n").unwrap();
    assert_eq!(never.ask(), None);
}

#[test]
fn a_mapping_is_written_as_it_is_read() {
    let text = "write: {items: {\"4008\": {figure: max_bend_angle, unit: deg}}}\nitems: {\"0117\": }\n";
    let mapping = Mapping::from_text("site.yaml", text).unwrap();
    assert_eq!(mapping.items[&code("0117")], None);
    let write = mapping.write.unwrap();
    assert_eq!((write.every_s, write.items[&code("4008")].decimals), (1.0, 2));
}
