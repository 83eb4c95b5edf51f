//! CDR bytes of the messages: layout where it is easy to get wrong, and that no bytes whatever make the decoder panic.

use flexdrill_messages::std_msgs::{Float64, Header};
use flexdrill_messages::std_srvs::TriggerRequest;
use flexdrill_messages::{
    AlarmList, AppliedInputs, ContactForces, Message, TwinStatus, diagnostic_msgs, from_cdr, large_array,
    rcl_interfaces, to_cdr, visualization_msgs,
};
use proptest::prelude::*;
use serde::{Deserialize, Serialize};

#[test]
fn alignment_counts_from_behind_the_header() {
    let bytes = to_cdr(&Float64 { data: 1.5 }).unwrap();
    assert_eq!(bytes, [&[0, 1, 0, 0][..], &1.5_f64.to_le_bytes()].concat());
}

#[test]
fn a_message_without_fields_is_one_byte() {
    assert_eq!(to_cdr(&TriggerRequest::default()).unwrap(), [0, 1, 0, 0, 0]);
}

#[test]
fn fixed_arrays_have_no_length_and_sequences_have_one() {
    let message = AppliedInputs {
        inner_friction: [0.1, 0.2],
        outer_friction: [0.3, 0.4],
        ..AppliedInputs::default()
    };
    let bytes = to_cdr(&message).unwrap();
    let pair = [0.1_f64.to_le_bytes(), 0.2_f64.to_le_bytes(), 0.3_f64.to_le_bytes()].concat();
    assert!(bytes.windows(pair.len()).any(|window| window == pair));

    let message = ContactForces {
        state: vec![ContactForces::FREE, ContactForces::BOTH, ContactForces::OUTER],
        ..ContactForces::default()
    };
    let bytes = to_cdr(&message).unwrap();
    let sequence = [3, 0, 0, 0, 0, 3, 2];
    assert!(bytes.windows(sequence.len()).any(|window| window == sequence));
}

#[test]
fn big_endian_is_understood() {
    let mut bytes = vec![0, 0, 0, 0];
    bytes.extend(2.25_f64.to_be_bytes());
    assert_eq!(from_cdr::<Float64>(&bytes).unwrap().data, 2.25);
}

#[test]
fn errors_name_the_type_and_the_cause() {
    let text = |bytes: &[u8]| from_cdr::<Header>(bytes).unwrap_err().to_string();
    assert!(text(&[0, 1]).contains("std_msgs/msg/Header: 2 bytes"));
    assert!(text(&[0, 7, 0, 0, 0, 0, 0, 0]).contains("0x0007"));
    assert!(text(&[0, 1, 0, 0, 1, 0, 0, 0]).contains("std_msgs/msg/Header"));
    let mut long = to_cdr(&Header::default()).unwrap();
    long.extend([0; 8]);
    assert!(text(&long).contains("8 bytes after the message"));
}

#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Covariance {
    #[serde(with = "large_array")]
    values: [f64; 36],
}

#[test]
fn arrays_beyond_what_serde_supports_have_the_same_layout() {
    let covariance = Covariance {
        values: std::array::from_fn(|index| index as f64),
    };
    let bytes = cdr_encoding::to_vec::<_, byteorder::LittleEndian>(&covariance).unwrap();
    assert_eq!(bytes.len(), 36 * 8);
    let (back, _) = cdr_encoding::from_bytes::<Covariance, byteorder::LittleEndian>(&bytes).unwrap();
    assert_eq!(back, covariance);
    assert!(cdr_encoding::from_bytes::<Covariance, byteorder::LittleEndian>(&bytes[..280]).is_err());
}

/// Decoding must end in a message or an error; a message that decodes must encode to something that decodes equally.
fn decode<M: Message>(bytes: &[u8]) {
    if let Ok(message) = from_cdr::<M>(bytes) {
        let again = to_cdr(&message).unwrap();
        assert_eq!(to_cdr(&from_cdr::<M>(&again).unwrap()).unwrap(), again);
    }
}

proptest! {
    #[test]
    fn property_bad_bytes_never_panic(mut bytes in proptest::collection::vec(any::<u8>(), 0..600), plain in any::<bool>()) {
        if plain && bytes.len() >= 4 {
            bytes[..4].copy_from_slice(&[0, 1, 0, 0]);
        }
        decode::<TwinStatus>(&bytes);
        decode::<ContactForces>(&bytes);
        decode::<AlarmList>(&bytes);
        decode::<visualization_msgs::MarkerArray>(&bytes);
        decode::<diagnostic_msgs::DiagnosticArray>(&bytes);
        decode::<rcl_interfaces::SetParametersRequest>(&bytes);
    }

    #[test]
    fn property_round_trip(
        numbers in proptest::collection::vec(any::<f64>(), 0..40),
        text in ".{0,20}",
        count in any::<u64>(),
    ) {
        let message = TwinStatus {
            sequence: count,
            version: text.clone(),
            input_name: vec![text; numbers.len()],
            input_age: numbers.clone(),
            phase_time: numbers,
            ..TwinStatus::default()
        };
        let bytes = to_cdr(&message).unwrap();
        let back: TwinStatus = from_cdr(&bytes).unwrap();
        prop_assert_eq!(to_cdr(&back).unwrap(), bytes);
    }
}
