//! What a participant announces of itself (RTPS 2.5, 8.3 and 9.4), without the multicast group that it can be heard in.

use crate::dds::plan::GuidPrefix;

/// Length of a message's header (bytes).
const HEADER: usize = 20;
/// Of a submessage's, of a payload's and of a parameter's.
const SHORT_HEADER: usize = 4;
/// Submessages.
const PAD: u8 = 0x01;
const INFO_TS: u8 = 0x09;
const DATA: u8 = 0x15;
/// Their flags.
const LITTLE_ENDIAN: u8 = 0x01;
const INLINE_QOS: u8 = 0x02;
/// Parameters: multicast groups of an endpoint, of discovery and of all endpoints; the end of a list.
const MULTICAST: [u16; 3] = [0x0030, 0x0033, 0x0048];
const SENTINEL: u16 = 0x0001;

/// Whether these bytes are an RTPS message of this participant.
pub(super) fn is_from(message: &[u8], participant: &GuidPrefix) -> bool {
    message.starts_with(b"RTPS") && message.get(8..HEADER) == Some(participant.as_slice())
}

/// The message without multicast groups: who hears it answers by unicast, which is all that reaches it. What is no such
/// message is returned as it is.
pub(super) fn without_multicast(message: &[u8]) -> Vec<u8> {
    stripped(message).unwrap_or_else(|| message.to_vec())
}

fn stripped(message: &[u8]) -> Option<Vec<u8>> {
    let (header, mut rest) = message.split_at_checked(HEADER)?;
    let mut out = header.to_vec();
    while !rest.is_empty() {
        let [id, flags, length @ ..] = *rest.first_chunk::<SHORT_HEADER>()?;
        let is_little = flags & LITTLE_ENDIAN != 0;
        let mut length = usize::from(number(length, is_little));
        if length == 0 && ![PAD, INFO_TS].contains(&id) {
            // The last one may leave its length to that of the message.
            length = rest.len() - SHORT_HEADER;
        }
        let (body, next) = rest[SHORT_HEADER..].split_at_checked(length)?;
        let body = if id == DATA {
            data(body, flags & INLINE_QOS != 0, is_little)?
        } else {
            body.to_vec()
        };
        let length = u16::try_from(body.len()).ok()?;
        let length = if is_little {
            length.to_le_bytes()
        } else {
            length.to_be_bytes()
        };
        out.extend([id, flags]);
        out.extend(length);
        out.extend(body);
        rest = next;
    }
    Some(out)
}

/// The body of a DATA submessage.
fn data(body: &[u8], has_inline_qos: bool, is_little: bool) -> Option<Vec<u8>> {
    let to_qos: [u8; 2] = body.get(2..4)?.try_into().ok()?;
    let mut payload = 4 + usize::from(number(to_qos, is_little));
    if has_inline_qos {
        payload += parameters(body.get(payload..)?, is_little, |_| {})?;
    }
    let payload_is_little = match body.get(payload..payload + 2)? {
        [0, 3] => true,
        [0, 2] => false,
        _ => return None,
    };
    let (front, list) = body.split_at_checked(payload + SHORT_HEADER)?;
    let mut out = front.to_vec();
    let length = parameters(list, payload_is_little, |parameter| out.extend(parameter))?;
    out.extend(&list[length..]);
    Some(out)
}

/// Hands over each parameter of a list, with its header and the list's end, but for multicast groups; the list's length.
fn parameters(list: &[u8], is_little: bool, mut keep: impl FnMut(&[u8])) -> Option<usize> {
    let mut at = 0;
    loop {
        let [a, b, c, d] = *list.get(at..)?.first_chunk::<SHORT_HEADER>()?;
        let (id, length) = (number([a, b], is_little), number([c, d], is_little));
        let end = if id == SENTINEL {
            at + SHORT_HEADER
        } else {
            at + SHORT_HEADER + usize::from(length)
        };
        let parameter = list.get(at..end)?;
        if !MULTICAST.contains(&id) {
            keep(parameter);
        }
        at = end;
        if id == SENTINEL {
            return Some(at);
        }
    }
}

fn number(bytes: [u8; 2], is_little: bool) -> u16 {
    if is_little {
        u16::from_le_bytes(bytes)
    } else {
        u16::from_be_bytes(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OWN: GuidPrefix = [7; 12];

    /// An announcement with these parameters: a time, then the data, with a list of qualities before them or not.
    fn announcement(little: bool, qos: bool, leaves_length: bool, parameters: &[u16]) -> Vec<u8> {
        let number = |value: u16| {
            if little {
                value.to_le_bytes()
            } else {
                value.to_be_bytes()
            }
        };
        let list = |ids: &[u16]| {
            let mut list = Vec::new();
            for id in ids {
                list.extend(number(*id));
                list.extend(number(8));
                list.extend([*id as u8; 8]);
            }
            list.extend([number(1), number(0)].concat());
            list
        };
        let flags = u8::from(little) | if qos { 0x06 } else { 0x04 };
        let mut body = [[0; 2], number(16)].concat();
        body.extend([9; 16]);
        if qos {
            // A multicast group there is none of the participant's.
            body.extend(list(&[0x0030, 0x0071]));
        }
        body.extend([0, if little { 3 } else { 2 }, 0, 0]);
        body.extend(list(parameters));
        let mut message = b"RTPS\x02\x04\x01\x12".to_vec();
        message.extend(OWN);
        message.extend([INFO_TS, u8::from(little)]);
        message.extend(number(8));
        message.extend([5; 8]);
        // One without a body that is not the last.
        message.extend([INFO_TS, u8::from(little) | 2, 0, 0]);
        message.extend([DATA, flags]);
        message.extend(if leaves_length {
            [0; 2]
        } else {
            number(body.len() as u16)
        });
        message.extend(body);
        message
    }

    #[test]
    fn multicast_groups_go_and_all_else_stays() {
        for little in [true, false] {
            for qos in [true, false] {
                let all = [0x0050, 0x0032, 0x0033, 0x0031, 0x0048, 0x0030, 0x0058];
                let kept = [0x0050, 0x0032, 0x0031, 0x0058];
                let expected = announcement(little, qos, false, &kept);
                for leaves_length in [true, false] {
                    let message = announcement(little, qos, leaves_length, &all);
                    assert!(is_from(&message, &OWN));
                    assert_eq!(without_multicast(&message), expected, "{little} {qos} {leaves_length}");
                }
                assert_eq!(without_multicast(&expected), expected);
            }
        }
    }

    #[test]
    fn what_is_cut_or_of_others_is_left_as_it_is() {
        let message = announcement(true, true, false, &[0x0050, 0x0033, 0x0048]);
        for length in 0..message.len() {
            let cut = &message[..length];
            let out = without_multicast(cut);
            // A cut between two submessages leaves a message that holds nothing to take out.
            assert_eq!(out, cut, "{length}");
            assert_eq!(is_from(cut, &OWN), length >= HEADER);
        }
        assert!(!is_from(&message, &[8; 12]));
        assert!(!is_from(&[0; 60], &OWN));
    }
}
