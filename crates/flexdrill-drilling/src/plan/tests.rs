//! Plans as tables and as arcs, and where a plan lies when the kick-off moves.

use super::*;

const GOOD: &str = "measured_depth_m,inclination_deg,azimuth_deg\n0,0,30\n5.0265,90,30\n10.0265,90,30\n";

#[test]
fn a_table_is_read_by_its_header() {
    let rows = read("plan.csv", GOOD).unwrap();
    assert_eq!(rows.len(), 3);
    assert!((rows[1].inclination - PI / 2.0).abs() < 1e-12 && (rows[2].azimuth - PI / 6.0).abs() < 1e-12);
    let other = "azimuth_deg, note, measured_depth_m, inclination_deg\n30, a, 0, 0\n30, b, 5, 45\n";
    assert_eq!(read("plan.csv", other).unwrap()[1].depth, 5.0);
}

#[test]
fn a_bad_table_is_refused_with_its_line() {
    for (text, expected) in [
        (
            "measured_depth_m,inclination_deg,azimuth_deg\n2,0,0\n1,10,0\n",
            "plan.csv:3: measured_depth_m = 1: must be above 2 m, the row before",
        ),
        (
            "measured_depth_m,inclination_deg,azimuth_deg\n0,0,0\n1,190,0\n",
            "plan.csv:3: inclination_deg = 190: must be 0 to 180 deg",
        ),
        (
            "measured_depth_m,inclination_deg,azimuth_deg\n0,0,east\n1,10,0\n",
            "plan.csv:2: azimuth_deg = east: must be -360 to 360 deg",
        ),
        ("measured_depth_m,inclination_deg\n0,0\n", "no column azimuth_deg"),
        (
            "measured_depth_m,inclination_deg,azimuth_deg\n0,0,0\n",
            "1 rows: must be 2",
        ),
        (
            "measured_depth_m,inclination_deg,azimuth_deg\n0,0\n",
            "must be a table with a header",
        ),
        (
            "measured_depth_m,inclination_deg,azimuth_deg\nnan,0,0\n1,0,0\n",
            "measured_depth_m = nan: must be a depth in metres",
        ),
    ] {
        let said = read("plan.csv", text).unwrap_err().to_string();
        assert!(said.contains(expected), "{said}");
    }
    let rows = read("plan.csv", GOOD).unwrap();
    assert!(covers("plan.csv", &rows, 5.0).is_ok());
    for (bit, expected) in [
        (9.5, "must be at least 10.500 m, a metre below the bit"),
        (-0.5, "must be 0 to -0.500 m, the bit"),
    ] {
        let said = covers("plan.csv", &rows, bit).unwrap_err().to_string();
        assert!(said.contains(expected), "{said}");
    }
}

#[test]
fn minimum_curvature_is_a_circle() {
    let [middle, quarter] = [0.5, 0.25].map(|share| between([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], share));
    assert!((inclination(middle) - PI / 4.0).abs() < 1e-12);
    assert!((inclination(quarter) - PI / 8.0).abs() < 1e-12);
}

/// A plan of 3 m radius, and a hole of 3.2 m that has left it: from the new kick-off every point of the plan is where it was,
/// twice. The plan as laid has chords of 20 mm: 1e-5 m.
#[test]
fn a_plan_stays_where_it_is_when_the_kick_off_moves() {
    let text = include_str!("../../../../tests/data/ahead.yaml");
    let before = flexdrill_config::Config::from_text("ahead.yaml", text).unwrap();
    let stations = [
        (0.5, 0.0, 30.0),
        (3.9, 0.0, 30.0),
        (6.0, 40.1, 30.0),
        (12.0, 90.0, 30.0),
    ];
    let station = |(measured_depth, inclination_deg, azimuth_deg)| PlannedStation {
        measured_depth,
        inclination_deg,
        azimuth_deg,
    };
    let planned = WellPlan {
        stations: stations.into_iter().map(station).collect(),
        file: None,
        target: 0.3,
        offset: [0.0, 0.0, 0.1],
    };
    let before = before.with_plan("a plan", Some(planned)).unwrap();
    let points = |config: &flexdrill_config::Config, bit: f64| {
        let plan = config.well.plan.as_ref().unwrap();
        let rows: Vec<Row> = plan.stations.iter().map(Row::from).collect();
        let drilling = Drilling::of(config, 10e3, 0.0).unwrap();
        let rows = in_plane_at(&rows, bit);
        Plan::laid(&rows, plan.offset, &drilling, config.well.length(), 3.0).points
    };
    let bit = before.well.length();
    let old = points(&before, bit);
    let mut now = before.clone();
    let (mut moved, mut top) = (0.0, [0.0; 3]);
    for length in [0.46, 4.0] {
        let by = length;
        let drilled: Vec<[f64; 2]> = vec![[0.33, 0.0]; (by / 0.02_f64).round() as usize];
        let next = now.rebased(&drilled, 0.02).unwrap();
        let at: [f64; 3] = now.well.course_to(by).position.into();
        let plan = moved_down(now.well.plan.as_ref().unwrap(), &now.well, by, at).unwrap();
        now = next.with_plan("moved", Some(plan)).unwrap();
        moved += by;
        top = std::array::from_fn(|axis| top[axis] + at[axis]);
        let new = points(&now, bit - moved);
        let mut compared = 0;
        for (depth, at) in &new {
            let nearest = old.iter().min_by(|a, b| {
                let off = |point: &(f64, [f64; 3])| (point.0 - depth - moved).abs();
                off(a).total_cmp(&off(b))
            });
            let (of, wanted) = nearest.unwrap();
            let along = depth + moved - of;
            if along.abs() > 0.011 {
                continue;
            }
            compared += 1;
            let off: f64 = (0..3).map(|axis| (at[axis] + top[axis] - wanted[axis]).powi(2)).sum();
            // The same point but for the way along the plan.
            assert!(
                (off.sqrt() - along.abs()).abs() < 2e-4,
                "{depth} m: {} {along}",
                off.sqrt()
            );
        }
        assert!(compared > 100, "{compared}");
    }
    assert!(now.well.plan.as_ref().unwrap().stations[0].measured_depth == 0.0);
    // What ends above is none, and a name of a table is no plan.
    let plan = before.well.plan.as_ref().unwrap();
    assert_eq!(moved_down(plan, &before.well, 12.5, [0.0; 3]), None);
    let named = WellPlan {
        stations: Vec::new(),
        file: Some("plan.csv".to_owned()),
        ..plan.clone()
    };
    assert_eq!(moved_down(&named, &before.well, 0.1, [0.0; 3]), None);
}
