//! Births and data of a Sparkplug node.

use super::*;

fn node() -> SparkplugNode {
    SparkplugNode::new("a/b".parse().unwrap(), None)
}

fn read(message: &Message) -> Payload {
    Payload::decode(message.payload.as_slice()).unwrap()
}

#[test]
fn numbers_of_births_continue_those_of_an_earlier_program() {
    let kept = std::sync::Arc::new(std::sync::Mutex::new(Vec::new()));
    let started = |last| {
        let kept = kept.clone();
        node().continuing(last, move |number| kept.lock().unwrap().push(number))
    };
    let number = |message: &Message| match read(message).metrics[0].value {
        Some(Value::Long(number)) => number,
        ref other => panic!("{other:?}"),
    };
    let mut first = started(None);
    assert_eq!(number(&first.will()), 0);
    // An attempt that fails has no birth.
    first.disconnected();
    assert_eq!(number(&first.will()), 0);
    first.connected(Instant::now());
    assert_eq!(number(&first.next(Instant::now()).unwrap()), 0);
    first.disconnected();
    assert_eq!(number(&first.will()), 1);
    let last = kept.lock().unwrap().last().copied();
    let mut second = started(last);
    second.connected(Instant::now());
    assert_eq!(
        [number(&second.will()), number(&second.next(Instant::now()).unwrap())],
        [2, 2]
    );
    assert_eq!(number(&started(Some(255)).will()), 0);
    assert_eq!(*kept.lock().unwrap(), [0, 1, 2, 0]);
}

#[test]
fn a_birth_comes_first_then_what_changed_with_rising_numbers() {
    let mut node = node();
    let now = Instant::now();
    node.number("x", "N", 1.0);
    node.number("y", "m", f64::NAN);
    node.connected(now);
    let birth = node.next(now).unwrap();
    assert_eq!(birth.topic, "spBv1.0/a/NBIRTH/b");
    let payload = read(&birth);
    assert_eq!(payload.seq, Some(0));
    let names: Vec<_> = payload
        .metrics
        .iter()
        .filter_map(|metric| metric.name.as_deref())
        .collect();
    assert_eq!(names, [BIRTH_DEATH, REBIRTH, "x", "y"]);
    // The specification forbids aliases of these two.
    assert!(payload.metrics[..2].iter().all(|metric| metric.alias.is_none()));
    assert_eq!(payload.metrics[3].is_null, Some(true));
    assert!(node.next(now).is_none());
    for round in 1..=600_u64 {
        node.number("x", "N", round as f64 + 1.0);
        node.number("y", "m", f64::NAN);
        let data = read(&node.next(now).unwrap());
        assert_eq!(data.seq, Some(round % 256));
        let [metric] = data.metrics.as_slice() else {
            panic!("{data:?}")
        };
        assert_eq!((metric.alias, metric.name.as_ref()), (payload.metrics[2].alias, None));
    }
    // A new metric asks for a birth, at most one a second.
    node.flag("z", Some(true));
    assert!(node.next(now).is_none());
    let later = now + BIRTH_INTERVAL;
    assert_eq!(read(&node.next(later).unwrap()).seq, Some(0));
}

#[test]
fn deaths_have_the_number_of_their_birth_and_each_connection_another() {
    let mut node = node();
    let number = |payload: &Payload| payload.metrics[0].value.clone();
    for connection in 0..300_u64 {
        // An attempt that fails has no number.
        node.disconnected();
        let will = read(&node.will());
        assert_eq!(number(&will), Some(Value::Long(connection % 256)));
        assert_eq!((will.seq, will.timestamp), (None, None));
        node.connected(Instant::now());
        assert_eq!(number(&read(&node.next(Instant::now()).unwrap())), number(&will));
        node.disconnected();
    }
}

#[test]
fn the_only_command_is_a_rebirth_and_any_bytes_are_survived() {
    let mut node = node();
    let start = Instant::now();
    node.connected(start);
    assert!(node.next(start).is_some());
    let command = |name: &str, value| {
        let metric = Metric {
            name: Some(name.to_owned()),
            value: Some(value),
            ..Metric::default()
        };
        let payload = Payload {
            metrics: vec![metric],
            ..Payload::default()
        };
        payload.encode_to_vec()
    };
    let rebirth = command(REBIRTH, Value::Boolean(true));
    for wrong in [
        command(REBIRTH, Value::Boolean(false)),
        command("Rig/Speed", Value::Double(1.0)),
        Vec::new(),
        vec![0xff; 100],
    ] {
        node.received("spBv1.0/a/NCMD/b", &wrong);
    }
    node.received("spBv1.0/a/NCMD/c", &rebirth);
    assert_eq!(node.counts(), [1, 0, 5, 0]);
    let later = start + BIRTH_INTERVAL;
    assert!(node.next(later).is_none());
    node.received("spBv1.0/a/NCMD/b", &rebirth);
    assert_eq!(node.counts(), [1, 1, 5, 0]);
    assert_eq!(node.next(later).unwrap().topic, "spBv1.0/a/NBIRTH/b");
    for cut in 0..rebirth.len() {
        for byte in [0, 0x7f, 0x80, 0xff] {
            let mut damaged = rebirth.clone();
            damaged[cut] = byte;
            node.received("spBv1.0/a/NCMD/b", &damaged);
            node.received("spBv1.0/a/NCMD/b", &damaged[..cut]);
        }
    }
    for wrong in ["", "a", "a/", "/b", "a/b/c", "a+/b", "a/#"] {
        assert!(wrong.parse::<NodeName>().is_err(), "{wrong}");
    }
}
