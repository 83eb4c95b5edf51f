use super::*;
use crate::bag::{BagMessage, Topic};
use crate::messages::to_cdr;

fn recorded(message: &AppliedInputs, shorter: usize) -> BagMessage {
    let mut data = to_cdr(message).unwrap();
    data.truncate(data.len() - shorter);
    BagMessage {
        topic: Arc::new(Topic::new(
            "/twin/applied_inputs",
            &AppliedInputs::INFO,
            topics::APPLIED_INPUTS.qos,
        )),
        topic_index: 0,
        log_time: 0,
        publish_time: 0,
        sequence: None,
        data,
    }
}

/// Bytes that older twins do not publish at the end of the message: rate and pressure with their slew limits, from
/// the next multiple of eight on; before that, refinement and the list of who asked (empty: its length alone).
fn older(message: &AppliedInputs) -> [BagMessage; 2] {
    let length = to_cdr(message).unwrap().len() - 4;
    // The refinement ends before the four numbers, padded to a multiple of eight.
    let unpadded = (0..8).find(|padding| {
        let data = to_cdr(message).unwrap();
        let end = 4 + length - 32 - padding;
        data[end - 1] == message.refinement
    });
    let without_rate = 32 + unpadded.unwrap();
    [recorded(message, without_rate), recorded(message, without_rate + 5)]
}

#[test]
fn applied_inputs_of_older_twins_are_read() {
    for (names, values) in [(vec![], vec![]), (vec!["whirl.hysteresis".to_owned()], vec![0.25])] {
        let mut message = AppliedInputs {
            rotary_speed: 4.0,
            parameter_name: names,
            parameter_value: values,
            refinement: 2,
            ..AppliedInputs::default()
        };
        let [before_rate, before_refinement] = older(&message);
        assert_eq!(before_rate.decode::<AppliedInputs>().unwrap(), message);
        let read = before_refinement.decode::<AppliedInputs>().unwrap();
        assert_eq!(
            read,
            AppliedInputs {
                refinement: 0,
                ..message.clone()
            }
        );
        assert!(changes_of(&read).iter().all(|change| change.asked_by.is_empty()));
        message.parameter_asked_by = vec!["a client".to_owned(); message.parameter_name.len()];
        message.rate_of_penetration = 1e-3;
        assert_eq!(recorded(&message, 0).decode::<AppliedInputs>().unwrap(), message);
    }
}
