//! Configuration, mapping and rows of a field log, ROS 2 arguments and parameter files.

use flexdrill::field_log::{self, Mapping, Position, Range};
use flexdrill::ros::args::{NodeIdentity, Overrides, RosArgs, split};
use flexdrill_config::Config;
use flexdrill_uncertainty::Priors;

use crate::engine::Target;
use crate::{file, folder, is_mapping, says_why};

const YAML: &[&str] = &[
    ": ",
    "- ",
    "[",
    "]",
    "{",
    "}",
    "&a ",
    "*a",
    "<<: *a\n",
    "? ",
    "|\n",
    ">\n",
    "\"",
    "'",
    "#",
    "---\n",
    "...\n",
    "~",
    "!!binary ",
    "!!str ",
    "\t",
    "\u{feff}",
    "\\u0000",
    "  ",
    ".nan",
    ".inf",
    "true",
    "null",
    "%YAML 1.2\n",
    "[[[[[[",
    "{a: {a: {a: ",
    "\r\n",
    "é",
    "\u{0}",
    "0x",
    "1_000",
    "[*a,*a,*a,*a,*a,*a,*a,*a,*a]",
];

#[test]
fn configuration() {
    Target {
        name: "configuration",
        seeds: vec![
            file("tests/data/small.yaml"),
            file("config/coarse.yaml"),
            file("config/paper.yaml"),
            file("config/rig.yaml"),
        ],
        words: &[
            YAML,
            &[
                "elements_per_link: ",
                "links: ",
                "time_step: ",
                "loads: [{at: {link: 1}, force: [1, 2, 3]}]\n",
                "arc: ",
                "line: ",
                "supports: ",
                "alarms: ",
                "outputs: ",
                "whirl: ",
                "hard_limits: ",
                "start: as_given\n",
                "uncertainty: ",
                "ensemble: {members: 8}",
                "distribution: {uniform: {low: 1, high: 2}}",
                "triangular: {low: 0, mode: 1, high: 2}",
                "form: factor",
                "correlation: -0.9",
                "correlated: ",
            ],
        ]
        .concat(),
        run: &mut |bytes| {
            let text = String::from_utf8_lossy(bytes);
            let config = match Config::from_text("fuzz.yaml", &text) {
                Ok(config) => config,
                Err(error) => return says_why(&error),
            };
            let written = config.to_yaml().unwrap();
            let again = Config::from_text("again.yaml", &written).unwrap_or_else(|error| panic!("{error}\n{written}"));
            assert_eq!(again, config);
            assert_eq!(again.hash(), config.hash());
            // What was accepted is fit for the mechanics, which check once more.
            config.tool().validate().unwrap();
            config.simulation();
            // So are its priors, unless a key is a number by the name of the check alone.
            if let Ok(priors) = Priors::of(&config) {
                let draws = priors.draws(1, 2);
                assert!(draws.iter().all(|draw| !draw.is_nan()));
                priors.sensor_errors(1, 2);
            }
            true
        },
    }
    .fuzz();
}

#[test]
fn mapping() {
    let direct = "separator: ';'\ncolumns:\n  time: {column: t, format: iso8601}\n  rotary_speed: {column: n, unit: rad/s}\n  \
                  weight_on_bit: {direct: {column: w, unit: tf}}\n  torque: {column: m, unit: ft.lbf}\n";
    Target {
        name: "mapping",
        seeds: vec![file("config/field_logs/rig_1hz.yaml"), direct.into()],
        words: &[
            YAML,
            &[
                "hookload",
                "direct",
                "values: [1]",
                "above: 1",
                "below: 2",
                "time_of_day",
                "milliseconds",
            ],
        ]
        .concat(),
        run: &mut |bytes| is_mapping(bytes, Mapping::from_text),
    }
    .fuzz();
}

/// Logs by the first byte: four mappings, the whole or a range.
#[test]
fn field_log() {
    let columns = |format: &str, more: &str| {
        format!(
            "columns:\n  time: {{column: t, format: {format}}}\n  rotary_speed: {{column: n, unit: r/min, scale: 2}}\n  \
             weight_on_bit: {{direct: {{column: w, unit: kN}}}}\n{more}"
        )
    };
    let texts = [
        String::from_utf8(file("config/field_logs/rig_1hz.yaml")).unwrap(),
        columns("iso8601", "  torque: {column: m, unit: N.m}\nseparator: ;\n"),
        columns("time_of_day", ""),
        columns(
            "milliseconds",
            "missing: [-999.25]\nquality: {max_gap: 2, frozen_after: 3}\n",
        ),
    ];
    let mappings = texts.map(|text| Mapping::from_text("mapping", &text).unwrap());
    let demo = String::from_utf8(file("config/field_logs/demo.csv")).unwrap();
    let part = |from: usize, rows: usize| -> Vec<u8> {
        let rows = demo.lines().take(1).chain(demo.lines().skip(from).take(rows));
        format!("\0{}", rows.collect::<Vec<_>>().join("\n")).into_bytes()
    };
    let table = |first: char, header: &str, row: &dyn Fn(usize) -> String| {
        let rows: String = (0..40).map(row).collect();
        format!("{first}{header}\n{rows}").into_bytes()
    };
    let folder = folder();
    let path = folder.path().join("log.csv");
    Target {
        name: "field_log",
        seeds: vec![
            part(1, 60),
            // A hook load needs its tare off bottom, from the beginning on.
            part(1, 150),
            table('\u{1}', "t;n;w;m", &|row| {
                format!("2024-05-01T23:59:{:02}.25Z;{row};2.5;100\n", row + 10)
            }),
            table('\u{6}', "t,n,w", &|row| format!("23:59:{:02}.5,40,{row}\r\n", row + 10)),
            table('\u{3}', "t,n,w", &|row| format!("{},40,{}\n", row * 1000, row % 7)),
        ],
        words: &[
            "\"",
            ",",
            ";",
            "\r",
            "\n",
            "\n\n",
            "-999.25",
            "1e308",
            "inf",
            "NaN",
            "2024-02-30T00:00:00Z",
            "24:00",
            "-",
            "+14:00",
            "\u{feff}",
            "\0",
            "\"\n\"",
            "9999-12-31T23:59:60Z",
            " ",
        ],
        run: &mut |bytes| {
            let (kind, content) = bytes.split_first().unwrap_or((&0, bytes));
            let range = match kind / 4 % 3 {
                0 => Range::ALL,
                1 => Range {
                    from: Some(Position::Row(u64::from(kind / 8))),
                    to: None,
                },
                _ => Range {
                    from: Some(Position::Time(1.0)),
                    to: Some(Position::Row(u64::from(*kind))),
                },
            };
            std::fs::write(&path, content).unwrap();
            let (sequence, report) = match field_log::read_range(&path, &mappings[usize::from(kind % 4)], &range) {
                Ok(read) => read,
                Err(error) => return says_why(&error),
            };
            assert!(report.to_string().contains("as an editor numbers them"));
            assert!(sequence.duration.is_finite() && report.duration.is_finite(), "{report}");
            assert!(
                sequence
                    .inputs
                    .iter()
                    .all(|input| input.time.is_finite() && input.value.is_finite())
            );
            assert!(sequence.inputs.is_sorted_by_key(|input| input.time), "times go back");
            assert!(
                sequence
                    .inputs
                    .iter()
                    .all(|input| (0.0..=sequence.duration).contains(&input.time))
            );
            let (mut used, mut counted): (Vec<u64>, u64) = (sequence.inputs.iter().map(|input| input.row).collect(), 0);
            used.dedup();
            counted += report.rows;
            assert!(
                used.len() as u64 <= counted,
                "{} rows have samples, {counted} are used",
                used.len()
            );
            true
        },
    }
    .fuzz();
}

const ROS: &[&str] = &[
    "-r",
    "-p",
    "--remap",
    "--param",
    ":=",
    "__ns:=/",
    "__node:=",
    "~/",
    "/",
    "//",
    "*",
    "/**",
    "/**/",
    "ros__parameters",
    "=",
    ":",
    "rostopic://",
    "rosservice://",
    "--log-level",
    "--",
    "--ros-args",
    "[1, 2",
    "]",
    "\n",
    "twin/status",
];

/// A node named by what was read, and its parameters.
fn resolve(arguments: &RosArgs) {
    let identity = match arguments.remapping.identity("/rig_7", "flexdrill") {
        Ok(identity) => identity,
        Err(error) => {
            says_why(&error);
            return;
        }
    };
    for name in ["twin/status", "~/reset", "/tf"] {
        for resolved in [
            arguments.remapping.topic(&identity, "flexdrill", name),
            arguments.remapping.service(&identity, "flexdrill", name),
        ] {
            match resolved {
                Ok(name) => assert!(name.starts_with('/'), "{name}"),
                Err(error) => {
                    says_why(&error);
                }
            }
        }
    }
    deep(&arguments.overrides);
}

/// The parameters of a node in a deep namespace.
fn deep(overrides: &Overrides) {
    for namespace in ["/", "/a/a/a/a/a/a/a/a/a/a/a/a"] {
        overrides.for_node(&NodeIdentity::new(namespace, "flexdrill").unwrap());
    }
}

/// Lines are arguments.
#[test]
fn ros_arguments() {
    Target {
        name: "ros_arguments",
        seeds: vec![
            "-r\nrig/weight_on_bit_kn:=/wob\n-r\n__ns:=/rig_7\n--remap\nflexdrill:__node:=twin\n-p\nrates.bit_state:=25.0".into(),
            "-p\nflexdrill:use_sim_time:=true\n--log-level\nflexdrill:=debug\n--log-level\nwarn\n--disable-rosout-logs".into(),
            "-p\na:=[1, 2.5]\n-p\nb:=[left, right]\n-e\n/enclave\n-r\nrostopic://twin/status:=~/status".into(),
        ],
        words: ROS,
        run: &mut |bytes| {
            let text = String::from_utf8_lossy(bytes);
            let given = std::iter::once("--ros-args").chain(text.split('\n')).map(str::to_owned);
            // A file that happens to be there says nothing of this.
            let (_, inside) = split(given.filter(|argument| argument != "--params-file"));
            match RosArgs::parse(&inside) {
                Ok(arguments) => {
                    resolve(&arguments);
                    true
                }
                Err(error) => says_why(&error),
            }
        },
    }
    .fuzz();
}

#[test]
fn parameter_file() {
    let folder = folder();
    let path = folder.path().join("parameters.yaml");
    let given = ["--params-file".to_owned(), path.to_str().unwrap().to_owned()];
    Target {
        name: "parameter_file",
        seeds: vec![
            "/**:\n  ros__parameters:\n    rates: {bit_state: 20.0}\n    use_sim_time: false\n    list: [1, 2]\n".into(),
            "rig_7:\n  flexdrill:\n    ros__parameters: {rates.bit_state: 25.0}\n/other:\n  ros__parameters: {x: text}\n".into(),
        ],
        words: &[YAML, ROS].concat(),
        run: &mut |bytes| {
            std::fs::write(&path, bytes).unwrap();
            match RosArgs::parse(&given) {
                Ok(arguments) => {
                    resolve(&arguments);
                    true
                }
                Err(error) => says_why(&error),
            }
        },
    }
    .fuzz();
}
