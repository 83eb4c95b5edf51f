//! A sample as a file: what is read, and what is refused.

use super::*;

#[test]
fn what_was_written_is_read() {
    let config = config();
    let rows: Vec<(f64, Vec<f64>)> = (0..10)
        .map(|k| {
            (
                0.5 + 0.1 * f64::from(k),
                vec![1.0 / f64::from(k + 3), -12.345_678_9 * f64::from(k)],
            )
        })
        .collect();
    let keys = [INNER[0], TARE];
    let posterior = read(&text(&config, &keys, &rows), &config).unwrap();
    assert_eq!(posterior.keys(), keys);
    assert_eq!(posterior.provenance, provenance(&config, &keys));
    for (member, (weight, values)) in posterior.members().iter().zip(&rows) {
        assert_eq!(member.weight, *weight);
        for (found, written) in member.values.iter().zip(values) {
            assert!((found - written).abs() <= 5e-9 * written.abs());
        }
    }
    // As a spreadsheet writes it again: marks, quotes, ends of lines, lines filled with commas.
    let filled = ten().replace("# seed: 4", "\"# seed: 4\",").replace('\n', "\r\n") + ",\r\n\r\n";
    let again = Posterior::from_csv("a", ("\u{feff}".to_owned() + &filled).as_bytes()).unwrap();
    let first = Posterior::from_csv("a", ten().as_bytes()).unwrap();
    assert_eq!((again.members().len(), again.keys()), (10, first.keys()));
    assert_eq!(again.provenance, first.provenance);
    assert_ne!(again.sha256(), first.sha256());
}

#[test]
fn what_is_wrong_is_refused_with_its_place() {
    let config = config();
    let ten = ten();
    let (head, rows) = ten.split_at(ten.find("weight").unwrap());
    let heavy = format!("{head}weight,{BIT}\n1e3,1\n") + &"1,0.2\n".repeat(20);
    for (changed, why) in [
        (
            ten.replacen("\n1,0.2\n", "\n-1,0.2\n", 1),
            "posterior.csv:11: no posterior of `flexdrill calibrate`: weight: -1: must be at least 0",
        ),
        (
            ten.replacen("\n1,0.2\n", "\nNaN,0.9\n", 1),
            "posterior.csv:11: no posterior of `flexdrill calibrate`: weight: NaN: must be a finite number",
        ),
        (
            ten.replacen("\n1,0.2\n", "\n1,inf\n", 1),
            "posterior.csv:11: no posterior of `flexdrill calibrate`: tool.bit.friction_factor: inf: must be a finite number",
        ),
        (
            ten.replacen("\n1,0.2\n", "\n1,0.2,2\n", 1),
            "posterior.csv:11: no posterior of `flexdrill calibrate`: 3 values: must be 2, a weight and one per key",
        ),
        (
            ten.replace("\n1,", "\n0,"),
            "all weights are 0: at least one must be above 0",
        ),
        (heavy, "its weights amount to 1 members alike: must be at least 8"),
        (
            ten.replacen("\n1,0.2\n", "\n1,-0.2\n", 1),
            "posterior.csv:11: tool.bit.friction_factor: -0.2: must be 0 to",
        ),
        (
            ten.replace(BIT, "tool.bit.friction_facto"),
            "tool.bit.friction_facto: must be the name of a number of this configuration; did you mean tool.bit.friction_factor?",
        ),
        (
            ten.replace(BIT, "tool.links"),
            "tool.links: must be the name of a number of this configuration",
        ),
        (
            ten.replace(BIT, ""),
            "no posterior of `flexdrill calibrate`: column 2 has no name",
        ),
        (ten.replace(",tool", ",a,a,tool"), "a has two columns: must have one"),
        (
            ten.replace("weight,", "w,"),
            "the first column is `w`: must be `weight`",
        ),
        (head.to_owned(), "it has no line of names"),
        (format!("{head}weight,{BIT}\n"), "it has no members"),
        (format!("{head}weight\n1\n"), "it has no keys: the log determined none"),
        (
            format!(
                "{head}weight,{}\n",
                (0..65).map(|k| format!("k{k}")).collect::<Vec<_>>().join(",")
            ),
            "must have at most 64 keys",
        ),
        (
            format!("{head}weight,{BIT}\n") + &"1,1\n".repeat(100_001),
            "posterior.csv:100011: no posterior of `flexdrill calibrate`: must have at most 100000 members",
        ),
        (
            rows.to_owned(),
            "the comment line `# flexdrill posterior: ...` is missing",
        ),
        (ten.replace("posterior: 1", "posterior: 2"), "format 2: must be 1"),
        (
            ten.replace("usable: yes", "usable: no: another rock"),
            "posterior.csv: this calibration is not to be used: another rock",
        ),
        (
            ten.replace("log rows: 3 to", "log rows: 3 -"),
            "must be two numbers with `to`",
        ),
    ] {
        let error = read(&changed, &config).unwrap_err().to_string();
        assert!(error.contains(why), "{error}\n{why}");
    }
}

#[test]
fn a_posterior_of_another_tool_or_file_is_refused() {
    let ten = ten();
    let other = config().with_value("well.hole_diameter", 0.1185).unwrap();
    let error = read(&ten, &other).unwrap_err().to_string();
    assert!(
        error.contains("a posterior of another tool or hole (log \"rig, of May.csv\""),
        "{error}"
    );
    // What was fitted, how it is solved and what is called an alarm make no other tool.
    for (key, value) in [(BIT, 0.83), ("solver.time_step", 1e-4), ("whirl.hysteresis", 0.3)] {
        read(&ten, &config().with_value(key, value).unwrap()).unwrap();
    }
    let digest = read(&ten, &config()).unwrap().sha256().to_owned();
    let named = config().with_value("ensemble.posterior_sha256", digest).unwrap();
    read(&ten, &named).unwrap();
    let error = read(&(ten + "1,1\n"), &named).unwrap_err().to_string();
    assert!(
        error.contains("ensemble.posterior_sha256, for the same plausible tools"),
        "{error}"
    );
    let error = Posterior::named_by(&config(), Path::new("nowhere"))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("posterior.csv: the posterior named by ensemble.from cannot be read"),
        "{error}"
    );
}

#[test]
fn a_key_needs_a_prior_that_has_its_values() {
    let config = config();
    let refused = |keys: &[&str], values: &[f64], odd: &[f64]| {
        let mut rows = vec![(1.0, values.to_vec()); 20];
        rows[4].1 = odd.to_vec();
        let posterior = read(&text(&config, keys, &rows), &config).unwrap();
        let priors = Priors::of(&config).unwrap();
        // A run that goes on takes what holds.
        let kept = priors.clone().drawn_from_what_holds(&posterior);
        kept.member(1, 2).unwrap();
        priors.drawn_from(&posterior).unwrap_err().to_string()
    };
    let error = refused(&["tool.joint.friction"], &[0.1], &[0.3]);
    assert!(
        error.contains("tool.joint.friction: must be in uncertainty.keys") && error.contains("are 0.1 to 0.1"),
        "{error}"
    );
    let error = refused(&["tool.joint.play_deg"], &[0.5], &[1.5]);
    assert!(
        error.contains("posterior.csv:15: tool.joint.play_deg: 1.5 deg: must be from "),
        "{error}"
    );
    assert!(
        error.ends_with("(its prior has no values beyond; state a wider one)"),
        "{error}"
    );
    let error = refused(&INNER, &[0.3, 0.3], &[0.3, 0.31]);
    assert!(
        error.contains("posterior.csv:15: contact.inner.friction_axial: 0.31: must be 0.3 (it has one draw with"),
        "{error}"
    );
}

/// A file with damaged bytes, lines that were cut, doubled or exchanged: it is read or refused in words.
fn damaged() -> impl Strategy<Value = Vec<u8>> {
    let edits = prop::collection::vec((any::<prop::sample::Index>(), 0..6_u8, any::<u8>()), 1..12);
    edits.prop_map(|edits| {
        const WORDS: [&[u8]; 8] = [
            b"1e308",
            b"-1",
            b",",
            b"\n",
            b"NaN",
            b"weight",
            b"# usable: no",
            b"\xff",
        ];
        let mut bytes = ten().into_bytes();
        for (place, what, byte) in edits {
            if bytes.is_empty() {
                break;
            }
            let at = place.index(bytes.len());
            match what {
                0 => bytes[at] = byte,
                1 => bytes.truncate(at),
                2 => drop(bytes.remove(at)),
                3 => bytes.insert(at, byte),
                4 => drop(bytes.splice(at..at, WORDS[usize::from(byte) % WORDS.len()].iter().copied())),
                _ => {
                    let tail = bytes[at..].to_vec();
                    bytes.extend(tail);
                }
            }
        }
        bytes
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn a_damaged_file_is_read_or_refused_in_words(bytes in damaged()) {
        let config = config();
        match Posterior::from_csv("damaged.csv", &bytes) {
            Err(error) => {
                let error = error.to_string();
                prop_assert!(error.starts_with("damaged.csv") && error.len() < 1000, "{}", error);
            }
            Ok(posterior) => {
                let held = posterior.belongs_to(&config);
                let priors = Priors::of(&config).unwrap();
                match priors.clone().drawn_from(&posterior) {
                    Ok(after) if held.is_ok() => {
                        let draws = after.member(1, 3).unwrap().draws;
                        prop_assert!(draws.iter().all(|draw| draw.is_finite()));
                    }
                    Ok(_) => {}
                    Err(error) => prop_assert!(error.to_string().starts_with("damaged.csv")),
                }
                let _ = priors.drawn_from_what_holds(&posterior).member(1, 3);
            }
        }
    }
}
