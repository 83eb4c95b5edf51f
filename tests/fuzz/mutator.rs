//! Bytes made from seeds, by a few changes that a format may not have thought of.

use crate::random::Random;

/// Longest input (bytes), unless the seed is longer.
const LONGEST: usize = 64 << 10;

/// The generator of an execution, which is a function of its number.
pub fn random(execution: u64) -> Random {
    Random(execution.wrapping_mul(0x9e37_79b9_7f4a_7c15))
}

/// Choices that change bytes.
trait Choices {
    /// An index below a bound; 0 for 0.
    fn index(&mut self, bound: usize) -> usize;
    /// One of a list.
    fn of<'a, T: ?Sized>(&mut self, list: &[&'a T]) -> Option<&'a T>;
    /// A range within so many bytes, short ones more often.
    fn range(&mut self, length: usize) -> std::ops::Range<usize>;
}

impl Choices for Random {
    fn index(&mut self, bound: usize) -> usize {
        self.below(bound as u64) as usize
    }

    fn of<'a, T: ?Sized>(&mut self, list: &[&'a T]) -> Option<&'a T> {
        list.get(self.index(list.len())).copied()
    }

    fn range(&mut self, length: usize) -> std::ops::Range<usize> {
        let begin = self.index(length + 1);
        let most = 1 << self.index(11);
        begin..length.min(begin + self.index(most + 1))
    }
}

const LIMITS: [u64; 18] = [
    0,
    1,
    2,
    0x7f,
    0x80,
    0xff,
    0x7fff,
    0x8000,
    0xffff,
    0x10_0000,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    1 << 40,
    i64::MAX as u64,
    1 << 63,
    // The largest float, and one that is none.
    0x7fef_ffff_ffff_ffff,
    0x7ff8_0000_0000_0000,
];

const NUMBERS: [&str; 22] = [
    "0",
    "-0",
    "-1",
    "1",
    "2",
    "3.5",
    "200",
    "1000000",
    "65535",
    "65536",
    "2147483648",
    "4294967296",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551616",
    "1e308",
    "-1e308",
    "1e-320",
    "1e999",
    ".nan",
    ".inf",
    "nan",
];

/// A seed with one to some changes.
pub fn mutate(seeds: &[Vec<u8>], words: &[&str], random: &mut Random) -> Vec<u8> {
    let mut bytes = seeds.get(random.index(seeds.len())).cloned().unwrap_or_default();
    let longest = bytes.len().max(LONGEST);
    loop {
        change(&mut bytes, seeds, words, random);
        bytes.truncate(longest);
        if random.index(3) == 0 {
            return bytes;
        }
    }
}

fn change(bytes: &mut Vec<u8>, seeds: &[Vec<u8>], words: &[&str], random: &mut Random) {
    let place = random.index(bytes.len());
    match random.index(14) {
        0 => {
            if let Some(byte) = bytes.get_mut(place) {
                *byte ^= 1 << random.index(8);
            }
        }
        1 => {
            if let Some(byte) = bytes.get_mut(place) {
                *byte = random.next_u64() as u8;
            }
        }
        // A number of 1 to 8 bytes at its limits, or one beside it.
        2 | 3 => {
            let width = 1 << random.index(4);
            let limit = LIMITS[random.index(LIMITS.len())].wrapping_add((random.index(3) as u64).wrapping_sub(1));
            let mut value = limit.to_le_bytes()[..width].to_vec();
            if random.index(4) == 0 {
                value.reverse();
            }
            overwrite(bytes, place, &value);
        }
        4 => {
            bytes.drain(random.range(bytes.len()));
        }
        5 => bytes.truncate(place),
        // The same again, up to a thousand times.
        6 => {
            let range = random.range(bytes.len());
            let times = 1 << random.index(11);
            let times = times.min(LONGEST / range.len().max(1));
            let again = bytes[range.clone()].repeat(times);
            bytes.splice(range.end..range.end, again);
        }
        7 => {
            let fresh: Vec<u8> = (0..random.index(16)).map(|_| random.next_u64() as u8).collect();
            bytes.splice(place..place, fresh);
        }
        // A part of another one.
        8 => {
            let other = &seeds[random.index(seeds.len())];
            let part = other[random.range(other.len())].to_vec();
            let range = random.range(bytes.len());
            bytes.splice(range, part);
        }
        9 => {
            if let Some(word) = random.of(words) {
                bytes.splice(place..place, word.bytes());
            }
        }
        10 => {
            if let Some(word) = random.of(words) {
                overwrite(bytes, place, word.as_bytes());
            }
        }
        // A number in digits.
        11 | 12 => {
            let is_digit = |byte: &u8| byte.is_ascii_digit() || b".-+e".contains(byte);
            let Some(begin) = bytes[place..].iter().position(u8::is_ascii_digit) else {
                return;
            };
            let begin = place + begin;
            let length = bytes[begin..].iter().take_while(|byte| is_digit(byte)).count();
            if let Some(number) = random.of(&NUMBERS) {
                bytes.splice(begin..begin + length, number.bytes());
            }
        }
        // A line elsewhere.
        _ => {
            let end = |from: usize| {
                bytes[from..]
                    .iter()
                    .position(|byte| *byte == b'\n')
                    .map(|at| from + at + 1)
            };
            let Some(begin) = end(place) else { return };
            let line = bytes[begin..end(begin).unwrap_or(bytes.len())].to_vec();
            let Some(to) = end(random.index(bytes.len())) else {
                return;
            };
            bytes.splice(to..to, line);
        }
    }
}

fn overwrite(bytes: &mut [u8], place: usize, value: &[u8]) {
    for (byte, value) in bytes.iter_mut().skip(place).zip(value) {
        *byte = *value;
    }
}
