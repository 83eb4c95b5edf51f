//! Messages that grew at their end: the bodies of older senders and older recordings are completed with the values that
//! the new fields then stand for.

use byteorder::{BigEndian, LittleEndian};

use super::{AppliedInputs, Message, RigInputs, Transfer, to_cdr_body};

/// What an older sender leaves out.
struct Missing {
    /// Bytes of zero directly after the end of the older body.
    first: usize,
    /// Numbers of eight bytes after that, at the next multiple of eight.
    numbers: &'static [f64],
}

/// The rate and the pressure that older twins did not know did not act: no value, and no slew.
const NOT_APPLIED: &[f64] = &[0.0; 4];
/// An older twin does not say whether its drive was at its limit.
const NOT_SAID: &[f64] = &[f64::NAN];
/// NaN is a value that is not given.
const NOT_GIVEN: &[f64] = &[f64::NAN; 2];

/// What older senders of a type leave out, the newest of them first.
fn missing(ros_type: &str) -> &'static [Missing] {
    match ros_type {
        AppliedInputs::ROS_TYPE => &[
            Missing {
                first: 0,
                numbers: NOT_APPLIED,
            },
            // The length of a list (who asked for a parameter) and the refinement of steps.
            Missing {
                first: 5,
                numbers: NOT_APPLIED,
            },
        ],
        RigInputs::ROS_TYPE => &[Missing {
            first: 0,
            numbers: NOT_GIVEN,
        }],
        Transfer::ROS_TYPE => &[Missing {
            first: 0,
            numbers: NOT_SAID,
        }],
        _ => &[],
    }
}

/// The message in an older body, if it is one: completed, its fields fit to the last byte.
pub(crate) fn complete<M: Message>(body: &[u8], big_endian: bool) -> Option<M> {
    missing(M::ROS_TYPE).iter().find_map(|missing| {
        let message = read_with::<M>(body, missing, 0, big_endian)?;
        // The bytes up to the multiple of eight belong to no field. A body that ends within a field would read them as
        // that field, and then they matter.
        let again = read_with::<M>(body, missing, u8::MAX, big_endian)?;
        (to_cdr_body(&message).ok()? == to_cdr_body(&again).ok()?).then_some(message)
    })
}

/// The message in a body with what is missing, `padding` in the bytes between.
fn read_with<M: Message>(body: &[u8], missing: &Missing, padding: u8, big_endian: bool) -> Option<M> {
    let mut whole = body.to_vec();
    whole.resize(body.len() + missing.first, 0);
    whole.resize(whole.len().next_multiple_of(8), padding);
    for number in missing.numbers {
        whole.extend(if big_endian {
            number.to_be_bytes()
        } else {
            number.to_le_bytes()
        });
    }
    let decoded = if big_endian {
        cdr_encoding::from_bytes::<M, BigEndian>(&whole).ok()
    } else {
        cdr_encoding::from_bytes::<M, LittleEndian>(&whole).ok()
    };
    decoded.and_then(|(message, used)| (used == whole.len()).then_some(message))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::std_msgs::Header;
    use crate::{from_cdr, from_cdr_body, message_from_cdr_body};
    use serde::Serialize;

    /// As published before rate and pressure were inputs.
    #[derive(Serialize)]
    struct OlderRigInputs {
        header: Header,
        rotary_speed_rpm: f64,
        weight_on_bit_kn: f64,
        quality: u8,
        source: String,
    }

    fn older(source: &str) -> OlderRigInputs {
        OlderRigInputs {
            header: Header::default(),
            rotary_speed_rpm: 40.0,
            weight_on_bit_kn: 10.0,
            quality: RigInputs::SUSPECT,
            source: source.to_owned(),
        }
    }

    #[test]
    fn an_older_sender_of_rig_inputs_gives_no_rate_and_no_pressure() {
        for source in ["", "a", "encoder", "encoder 2", "a source of some length"] {
            let body = to_cdr_body(&older(source)).unwrap();
            let read: RigInputs = message_from_cdr_body(&body).unwrap();
            assert_eq!((read.rotary_speed_rpm, read.weight_on_bit_kn), (40.0, 10.0), "{source}");
            assert_eq!((read.quality, read.source.as_str()), (RigInputs::SUSPECT, source));
            assert!(read.rate_of_penetration_m_per_h.is_nan() && read.standpipe_pressure_mpa.is_nan());
            // In a bag with its header, of either byte order.
            let little = [[0, 1, 0, 0].as_slice(), body.as_slice()].concat();
            let big = cdr_encoding::to_vec::<_, BigEndian>(&older(source)).unwrap();
            let big = [[0; 4].as_slice(), big.as_slice()].concat();
            for bytes in [little, big] {
                let read: RigInputs = from_cdr(&bytes).unwrap();
                assert_eq!((read.weight_on_bit_kn, read.source.as_str()), (10.0, source));
                assert!(read.standpipe_pressure_mpa.is_nan());
            }
        }
    }

    #[test]
    fn an_older_transfer_does_not_say_whether_the_drive_was_at_its_limit() {
        let whole = Transfer {
            bit_torque: 90.0,
            mud_power: 3.0,
            drive_at_limit: 0.5,
            ..Transfer::default()
        };
        let body = to_cdr_body(&whole).unwrap();
        let read: Transfer = message_from_cdr_body(&body[..body.len() - 8]).unwrap();
        assert_eq!((read.bit_torque, read.mud_power), (90.0, 3.0));
        assert!(read.drive_at_limit.is_nan());
        assert!(message_from_cdr_body::<Transfer>(&body[..body.len() - 16]).is_err());
    }

    #[test]
    fn a_body_that_is_cut_is_not_an_older_one() {
        let whole = RigInputs {
            source: "encoder".to_owned(),
            rate_of_penetration_m_per_h: 3.0,
            standpipe_pressure_mpa: 20.0,
            ..RigInputs::default()
        };
        let body = to_cdr_body(&whole).unwrap();
        assert_eq!(from_cdr_body::<RigInputs>(&body).unwrap().0, whole);
        // The last byte of the older body only ends its text: without it, no value is missing.
        let older = to_cdr_body(&older("encoder")).unwrap().len() - 1;
        for length in (0..body.len()).filter(|length| *length < older || length.next_multiple_of(8) > body.len() - 16) {
            assert!(
                message_from_cdr_body::<RigInputs>(&body[..length]).is_err(),
                "{length} of {}",
                body.len()
            );
        }
    }
}
