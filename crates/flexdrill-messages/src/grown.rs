//! Messages that grew at their end: the bodies of older senders and older recordings are completed with the values that
//! the new fields then stand for.

use byteorder::{BigEndian, LittleEndian};

use super::{Ageing, AppliedInputs, Bands, Message, RigInputs, RigMeasured, Transfer, TwinStatus, to_cdr_body};

/// What an older sender leaves out.
struct Missing {
    /// Bytes of zero directly after the end of the older body.
    first: usize,
    /// What follows those begins at a multiple of this.
    align: usize,
    /// Numbers of eight bytes.
    numbers: &'static [f64],
    /// Bytes of zero after those.
    last: usize,
}

impl Missing {
    const fn numbers(numbers: &'static [f64]) -> Self {
        Self {
            first: 0,
            align: 8,
            numbers,
            last: 0,
        }
    }
}

/// The field `given` of four bytes, with which a message does not say which of its values are given.
const GIVEN: Missing = Missing {
    first: 0,
    align: 4,
    numbers: &[],
    last: 4,
};

/// The lists at the end of bands, which are empty: sensors that are not believed, why, and the factors of the bands.
const LISTS: Missing = Missing {
    first: 0,
    align: 4,
    numbers: &[],
    last: 12,
};

/// The lists at the end of ageing, which are empty without a table of lives: serial numbers, and four damages of two parts.
const NO_LIVES: Missing = Missing {
    first: 0,
    align: 4,
    numbers: &[],
    last: 36,
};

/// The rate and the pressure that older twins did not know did not act: no value, and no slew.
const NOT_APPLIED: &[f64] = &[0.0; 4];
/// The counts of surveys of a twin that did not count them; the bytes of a count 0 are those of the number 0.
const NO_SURVEYS: &[f64] = &[0.0; 3];
/// NaN is a value that is not given.
const NOT_GIVEN: &[f64] = &[f64::NAN; 2];

/// What older senders of each type leave out, the newest of them first.
const MISSING: &[(&str, &[Missing])] = &[
    (
        AppliedInputs::ROS_TYPE,
        &[
            Missing::numbers(NOT_APPLIED),
            // The length of a list (who asked for a parameter) and the refinement of steps.
            Missing {
                first: 5,
                ..Missing::numbers(NOT_APPLIED)
            },
        ],
    ),
    (
        RigInputs::ROS_TYPE,
        &[
            GIVEN,
            Missing {
                last: GIVEN.last,
                ..Missing::numbers(NOT_GIVEN)
            },
        ],
    ),
    (RigMeasured::ROS_TYPE, &[GIVEN]),
    (Bands::ROS_TYPE, &[LISTS]),
    (Ageing::ROS_TYPE, &[NO_LIVES]),
    (TwinStatus::ROS_TYPE, &[Missing::numbers(NO_SURVEYS)]),
];

/// Messages that grow by figures at their end, with the last field of the first version. An older twin does not say what
/// follows it: NaN.
const GROWS: &[(&str, &str)] = &[(Transfer::ROS_TYPE, "mud_power")];
/// As many figures as such a message may have more than in its first version.
static MORE: [f64; 32] = [f64::NAN; 32];

/// What older senders of a message that grows leave out: its last figure, its last two, and so on.
fn figures_at_the_end<M: Message>() -> Vec<Missing> {
    let last = GROWS.iter().find(|(ros_type, _)| *ros_type == M::ROS_TYPE);
    let after = last.and_then(|(_, last)| M::INFO.source().split_once(&format!("float64 {last}\n")));
    let more = after.map_or(0, |(_, after)| {
        after.lines().filter(|line| line.starts_with("float64 ")).count()
    });
    (1..=more)
        .filter_map(|count| MORE.get(..count).map(Missing::numbers))
        .collect()
}

/// The message in an older body, if it is one: completed, its fields fit to the last byte.
pub(crate) fn complete<M: Message>(body: &[u8], big_endian: bool) -> Option<M> {
    let older = MISSING.iter().find(|(ros_type, _)| *ros_type == M::ROS_TYPE);
    let listed = older.map_or(&[] as &[Missing], |(_, older)| *older);
    listed.iter().chain(&figures_at_the_end::<M>()).find_map(|missing| {
        let message = read_with::<M>(body, missing, 0, big_endian)?;
        // The bytes up to the multiple belong to no field. A body that ends within a field would read them as
        // that field, and then they matter.
        let again = read_with::<M>(body, missing, u8::MAX, big_endian)?;
        (to_cdr_body(&message).ok()? == to_cdr_body(&again).ok()?).then_some(message)
    })
}

/// The message in a body with what is missing, `padding` in the bytes between.
fn read_with<M: Message>(body: &[u8], missing: &Missing, padding: u8, big_endian: bool) -> Option<M> {
    let mut whole = body.to_vec();
    whole.resize(body.len() + missing.first, 0);
    whole.resize(whole.len().next_multiple_of(missing.align), padding);
    for number in missing.numbers {
        whole.extend(if big_endian {
            number.to_be_bytes()
        } else {
            number.to_le_bytes()
        });
    }
    whole.resize(whole.len() + missing.last, 0);
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
    fn an_older_sender_does_not_say_which_values_are_given() {
        for source in ["", "a", "ab", "abc", "abcd", "the rig"] {
            let measured = RigMeasured {
                hook_load: 5e4,
                source: source.to_owned(),
                given: 7,
                ..RigMeasured::default()
            };
            let body = to_cdr_body(&measured).unwrap();
            // An older body ends with its text.
            let end = body.len() - 4 - (source.len() + 1).wrapping_neg() % 4;
            let read: RigMeasured = message_from_cdr_body(&body[..end]).unwrap();
            assert_eq!(read, RigMeasured { given: 0, ..measured }, "{source}");
            for length in (0..end - 1).chain(body.len() - 3..body.len()) {
                assert!(
                    message_from_cdr_body::<RigMeasured>(&body[..length]).is_err(),
                    "{source}: {length}"
                );
            }
        }
    }

    #[test]
    fn older_bands_name_no_sensor_that_is_not_believed() {
        let whole = Bands {
            members: 12,
            no_bands: "why".to_owned(),
            any_alarm_upper: 0.5,
            ..Bands::default()
        };
        let body = to_cdr_body(&whole).unwrap();
        let older = body.len() - LISTS.last;
        assert_eq!(message_from_cdr_body::<Bands>(&body[..older]).unwrap(), whole);
        assert!(message_from_cdr_body::<Bands>(&body[..older - 8]).is_err());
    }

    #[test]
    fn older_ageing_has_no_lives() {
        for works in [vec![], vec![3.5, 4.5]] {
            let whole = Ageing {
                duration: 7.0,
                guide_wall_friction_work: works,
                ..Ageing::default()
            };
            let body = to_cdr_body(&whole).unwrap();
            let older = body.len() - NO_LIVES.last;
            assert_eq!(message_from_cdr_body::<Ageing>(&body[..older]).unwrap(), whole);
            for cut in [older - 4, older + 4] {
                assert!(message_from_cdr_body::<Ageing>(&body[..cut]).is_err(), "{cut}");
            }
        }
    }

    #[test]
    fn an_older_status_counts_no_surveys() {
        for changed in [
            vec![],
            vec!["a".to_owned()],
            vec!["rate (Hz)".to_owned(), String::new()],
        ] {
            let whole = TwinStatus {
                sequence: 7,
                steps_stood_still: 5,
                changed_parameter: changed.clone(),
                ..TwinStatus::default()
            };
            let body = to_cdr_body(&whole).unwrap();
            // The texts follow a count of eight bytes. An older body ends with the last of them, without the bytes up to the
            // next multiple of eight.
            let mut texts: usize = 4;
            for text in &changed {
                texts = texts.next_multiple_of(4) + 4 + text.len() + 1;
            }
            let padded = body.len() - 8 * NO_SURVEYS.len();
            let end = padded - (texts.next_multiple_of(8) - texts);
            for older in [end, padded] {
                assert_eq!(
                    message_from_cdr_body::<TwinStatus>(&body[..older]).unwrap(),
                    whole,
                    "{changed:?}"
                );
            }
            for cut in [end - 2, padded + 8] {
                assert!(
                    message_from_cdr_body::<TwinStatus>(&body[..cut]).is_err(),
                    "{changed:?}: {cut}"
                );
            }
        }
    }

    #[test]
    fn an_older_transfer_does_not_say_the_figures_at_its_end() {
        let whole = Transfer {
            bit_torque: 90.0,
            mud_power: 3.0,
            drive_at_limit: 0.5,
            ..Transfer::default()
        };
        let body = to_cdr_body(&whole).unwrap();
        let more = figures_at_the_end::<Transfer>().len();
        for left_out in 1..=more {
            let read: Transfer = message_from_cdr_body(&body[..body.len() - 8 * left_out]).unwrap();
            assert_eq!((read.bit_torque, read.mud_power), (90.0, 3.0));
            // The first of them is `drive_at_limit`.
            assert_eq!(read.drive_at_limit.is_nan(), left_out == more);
        }
        assert!(message_from_cdr_body::<Transfer>(&body[..body.len() - 8 * (more + 1)]).is_err());
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
        // The last byte of the older body only ends its text: without it, no value is missing. Without `given` it is the
        // body of a sender that does not know that field.
        let older = to_cdr_body(&older("encoder")).unwrap().len() - 1;
        let is_older = |length: usize| length == body.len() - 4 || (older..=body.len() - 20).contains(&length);
        for length in (0..body.len()).filter(|length| !is_older(*length)) {
            assert!(
                message_from_cdr_body::<RigInputs>(&body[..length]).is_err(),
                "{length} of {}",
                body.len()
            );
        }
    }
}
