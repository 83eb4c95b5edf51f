//! The address space as clients browse it.

use super::*;
use flexdrill_messages::to_cdr_body;
use std::collections::BTreeSet;

#[test]
fn names_are_unique_and_described_and_nothing_has_a_value_before_the_twin_speaks() {
    let all = variables();
    let mut seen = BTreeSet::new();
    let empty = TwinState::default();
    for variable in &all {
        assert!(
            seen.insert((variable.folder, variable.name.clone())),
            "{}",
            variable.name
        );
        assert!(variable.description.len() > 5, "{}", variable.name);
        assert!(variable.value(&empty).is_none() && variable.stamp(&empty).is_none());
    }
    assert!(all.len() > 80, "{}", all.len());
}

#[test]
fn every_figure_over_plausible_tools_has_its_quantiles_and_no_value_without_bands() {
    let variables = of_bands();
    let known = OverTools::known();
    let name = |figure: &str, quantile: &str| format!("{}/{quantile}", figure.replace('/', "_"));
    let of = |wanted: &str| variables.iter().find(|variable| variable.name == wanted).unwrap();
    // In one message: the quantiles of the k-th figure are k, k + 0.5 and k + 1.
    let bands = Bands {
        members: 12,
        effective: 11.5,
        any_alarm: f64::NAN,
        bands: (0..)
            .zip(&known)
            .map(|(index, figure)| FigureBand {
                name: figure.name.clone(),
                unit: figure.unit.to_owned(),
                p5: f64::from(index),
                p50: f64::from(index) + 0.5,
                p95: f64::from(index) + 1.0,
            })
            .collect(),
        ..Bands::default()
    };
    let mut twin = TwinState::default();
    twin.take(&topics::BANDS, &to_cdr_body(&bands).unwrap(), 0).unwrap();
    for (index, figure) in (0..).zip(&known) {
        for (quantile, more) in [("p5", 0.0), ("p50", 0.5), ("p95", 1.0)] {
            let variable = of(&name(&figure.name, quantile));
            assert_eq!(
                variable.value(&twin),
                Some(Variant::from(f64::from(index) + more)),
                "{}",
                figure.name
            );
            let unit = variable.kind.unit().unwrap();
            let in_message = if unit == Unit::One { "" } else { unit.name() };
            assert_eq!(in_message.replace('.', " "), figure.unit, "{}", figure.name);
        }
    }
    assert_eq!(of("members").value(&twin), Some(Variant::from(12_u64)));
    assert_eq!(of("effective").value(&twin), Some(Variant::from(11.5)));
    assert_eq!(of("any_alarm").value(&twin), None, "no number");
    // Without bands their variables have no value, and say why.
    let none = Bands {
        no_bands: "7 plausible tools amount to 7.0 alike".into(),
        bands: Vec::new(),
        ..bands
    };
    twin.take(&topics::BANDS, &to_cdr_body(&none).unwrap(), 0).unwrap();
    assert_eq!(of(&name(&known[0].name, "p50")).value(&twin), None);
    assert_eq!(of("no_bands").value(&twin), Some(Variant::from(none.no_bands)));
}
