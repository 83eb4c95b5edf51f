//! What an item may be by its numbers alone: its range, its trend, and how it moves with other items. A depth grows; a
//! hook load and a weight on bit mirror each other, as what stands on the bit does not hang on the hook.

use std::collections::BTreeMap;

use flexdrill_core::inputs::MeasuredKind;

use super::item::ItemCode;
use crate::Quantity;

/// Most numbers of an item that are kept: ten minutes at one per second.
const MOST_NUMBERS: usize = 600;
/// Fewest numbers from which anything is concluded: ten seconds of a usual rig.
const FEWEST: usize = 10;
/// Correlation from which two items are said to move together. Of ten numbers without any relation one pair in several
/// thousand has it.
const STRONG: f64 = 0.9;
/// Changes of one sign after which a number that never changes back is a depth and no sensor, whose values scatter.
const ONLY_GROWS: usize = 20;
/// Ratio of the scatters of hook load and weight in one unit, either way: friction takes part of what is slacked off.
const MIRRORS: f64 = 1.6;

/// What an item may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Depth,
    RotarySpeed,
    PumpStrokes,
    Penetration,
    Weight,
    HookLoad,
    Torque,
    Pressure,
}

/// Each with its name and its range in any of the units that rigs use, from the smaller to the larger unit.
const KINDS: [(Kind, &str, [f64; 2]); 8] = [
    (Kind::Depth, "a depth", [1.0, 50e3]),
    (Kind::RotarySpeed, "a rotary speed", [0.0, 350.0]),
    (Kind::PumpStrokes, "pump strokes", [0.0, 300.0]),
    (Kind::Penetration, "a rate of penetration", [-50.0, 1000.0]),
    (Kind::Weight, "a weight on bit", [-50.0, 500.0]),
    (Kind::HookLoad, "a hook load", [1.0, 10e3]),
    (Kind::Torque, "a torque", [-100.0, 100e3]),
    (Kind::Pressure, "a pressure", [-100.0, 100e3]),
];

/// The kind of a quantity of a mapping; none where the numbers of a rig do not show it.
fn kind(quantity: Quantity) -> Option<Kind> {
    match quantity {
        Quantity::RotarySpeed => Some(Kind::RotarySpeed),
        Quantity::WeightOnBit => Some(Kind::Weight),
        Quantity::Measured(MeasuredKind::BitDepth | MeasuredKind::HoleDepth) => Some(Kind::Depth),
        Quantity::Measured(MeasuredKind::RateOfPenetration) => Some(Kind::Penetration),
        Quantity::Measured(MeasuredKind::HookLoad) => Some(Kind::HookLoad),
        Quantity::Measured(MeasuredKind::SurfaceTorque) => Some(Kind::Torque),
        Quantity::Measured(MeasuredKind::StandpipePressure) => Some(Kind::Pressure),
        Quantity::Measured(_) | Quantity::Survey(_) => None,
    }
}

/// The numbers of an item with the frames that had them, in the order of the frames.
#[derive(Debug, Clone, Default)]
pub(super) struct Numbers(Vec<(u64, f64)>);

impl Numbers {
    /// Adds the number of a frame; beyond [`MOST_NUMBERS`] it is left out.
    pub(super) fn add(&mut self, frame: u64, value: f64) {
        if self.0.len() < MOST_NUMBERS {
            self.0.push((frame, value));
        }
    }

    fn mean(&self) -> f64 {
        self.0.iter().map(|(_, value)| value).sum::<f64>() / self.0.len() as f64
    }

    /// Numbers of changes upwards and downwards.
    fn changes(&self) -> [usize; 2] {
        let pairs = self.0.iter().zip(self.0.iter().skip(1));
        pairs.fold([0; 2], |[up, down], ((_, before), (_, after))| {
            [up + usize::from(after > before), down + usize::from(after < before)]
        })
    }

    /// What the item may be by range and trend alone.
    fn by_itself(&self) -> Vec<Kind> {
        let [up, down] = self.changes();
        let varies = up > 0 && down > 0;
        let only_grows = up.max(down) >= ONLY_GROWS && !varies;
        let fits = |kind: Kind, [least, most]: [f64; 2]| {
            let is_within = self.0.iter().all(|(_, value)| (least..=most).contains(value));
            is_within && if kind == Kind::Depth { !varies } else { !only_grows }
        };
        let kinds = KINDS.iter().filter(|(kind, _, range)| fits(*kind, *range));
        kinds.map(|(kind, ..)| *kind).collect()
    }

    /// Correlation with the numbers of another item in the frames that had both, and the ratio of their scatters; none where
    /// too few frames had both, or one of them is constant.
    fn with(&self, other: &Self) -> Option<(f64, f64)> {
        let of_other: BTreeMap<u64, f64> = other.0.iter().copied().collect();
        let both: Vec<(f64, f64)> = self
            .0
            .iter()
            .filter_map(|(frame, value)| Some((*value, *of_other.get(frame)?)))
            .collect();
        if both.len() < FEWEST {
            return None;
        }
        let count = both.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| both.iter().map(of).sum::<f64>() / count;
        let means = (mean(|pair| pair.0), mean(|pair| pair.1));
        let (mut own, mut others, mut product) = (0.0, 0.0, 0.0);
        for pair in &both {
            let from_mean = (pair.0 - means.0, pair.1 - means.1);
            own += from_mean.0 * from_mean.0;
            others += from_mean.1 * from_mean.1;
            product += from_mean.0 * from_mean.1;
        }
        let correlation = product / (own * others).sqrt();
        // Constant items have no correlation, and numbers near the largest overflow.
        correlation.is_finite().then(|| (correlation, (own / others).sqrt()))
    }
}

/// What an item may be, in words for its row: `may be a weight on bit (mirrors 0114)`. `quantity` is what the mapping makes
/// of it; words begin with CHECK where the numbers contradict that. None where there are too few numbers.
pub(super) fn in_words(
    code: ItemCode,
    quantity: Option<Quantity>,
    all: &BTreeMap<ItemCode, Numbers>,
) -> Option<String> {
    let own = all.get(&code).filter(|own| own.0.len() >= FEWEST)?;
    let others = all.iter().filter(|(other, _)| **other != code);
    let pairs: Vec<(ItemCode, &Numbers, f64, f64)> = others
        .filter_map(|(other, numbers)| {
            let (correlation, ratio) = own.with(numbers)?;
            Some((*other, numbers, correlation, ratio))
        })
        .collect();
    let mut kinds = own.by_itself();
    // A mirror decides between the two that mirror each other, of which the hook carries more.
    let mirror = pairs
        .iter()
        .filter(|(_, _, correlation, ratio)| *correlation <= -STRONG && (1.0 / MIRRORS..=MIRRORS).contains(ratio))
        .min_by(|one, other| one.2.total_cmp(&other.2));
    let mut how = String::new();
    if let Some((other, numbers, ..)) = mirror {
        kinds = vec![if own.mean() > numbers.mean() {
            Kind::HookLoad
        } else {
            Kind::Weight
        }];
        how = format!(" (mirrors {other})");
    } else if let Some((other, ..)) = pairs
        .iter()
        .filter(|(_, _, correlation, _)| *correlation >= STRONG)
        .max_by(|one, other| one.2.total_cmp(&other.2))
    {
        how = format!(" (moves with {other})");
    }
    let is_constant = own.changes() == [0, 0];
    let contradicts = quantity.and_then(kind).is_some_and(|mapped| !kinds.contains(&mapped));
    let names: Vec<&str> = KINDS
        .iter()
        .filter(|(kind, ..)| kinds.contains(kind))
        .map(|(_, name, _)| *name)
        .collect();
    let may_be = match names.as_slice() {
        [] => "by its numbers none of the usual quantities".to_owned(),
        names => format!("may be {}{how}", names.join(", ")),
    };
    match (contradicts, is_constant) {
        (true, _) => Some(format!("CHECK: {may_be}")),
        // A constant says nothing of what it is.
        (false, true) => None,
        (false, false) => Some(may_be),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn code(item: u8) -> ItemCode {
        ItemCode { record: 1, item }
    }

    /// An item: its number, what the mapping takes it for, and its value by frame.
    type Item<'a> = (u8, Option<Quantity>, &'a dyn Fn(u32) -> f64);

    /// Items by their numbers in frames, with what is said of each.
    fn words(items: &[Item<'_>], frames: u32) -> Vec<Option<String>> {
        let mut all: BTreeMap<ItemCode, Numbers> = BTreeMap::new();
        for (item, _, value) in items {
            for frame in 0..frames {
                all.entry(code(*item)).or_default().add(frame.into(), value(frame));
            }
        }
        let each = items
            .iter()
            .map(|(item, quantity, _)| in_words(code(*item), *quantity, &all));
        each.collect()
    }

    /// A weight that wanders, in kdaN, without a period that another item has.
    fn weight(frame: u32) -> f64 {
        0.8 + 0.3 * f64::from(frame * frame % 17) / 17.0
    }

    #[test]
    fn a_depth_grows_and_a_hook_load_mirrors_the_weight() {
        const DEPTH: Quantity = Quantity::Measured(MeasuredKind::BitDepth);
        const HOOK: Quantity = Quantity::Measured(MeasuredKind::HookLoad);
        let said = words(
            &[
                (8, Some(DEPTH), &|frame| 2500.0 + 0.001 * f64::from(frame)),
                // 15 kdaN hang on the hook; friction keeps a tenth of what is set down.
                (14, Some(HOOK), &|frame| 15.0 - 0.9 * weight(frame)),
                (16, Some(Quantity::WeightOnBit), &weight),
            ],
            60,
        );
        let said: Vec<&str> = said.iter().map(|said| said.as_deref().unwrap()).collect();
        assert_eq!(
            said,
            [
                "may be a depth",
                "may be a hook load (mirrors 0116)",
                "may be a weight on bit (mirrors 0114)"
            ]
        );
    }

    #[test]
    fn what_contradicts_the_mapping_is_marked() {
        const PRESSURE: Quantity = Quantity::Measured(MeasuredKind::StandpipePressure);
        let strokes = |frame: u32| 60.0 + f64::from(frame * frame % 13);
        let said = words(
            &[
                // Hook load and weight exchanged.
                (14, Some(Quantity::WeightOnBit), &|frame| 15.0 - weight(frame)),
                (16, Some(Quantity::Measured(MeasuredKind::HookLoad)), &weight),
                // A depth under the number of a speed; a pressure that the strokes make.
                (20, Some(Quantity::RotarySpeed), &|frame| {
                    200.0 + 0.01 * f64::from(frame)
                }),
                (21, Some(PRESSURE), &|frame| 5.0 * strokes(frame).powi(2)),
                (30, None, &strokes),
                // A speed that stands says nothing, one of 5000 is none.
                (31, Some(Quantity::RotarySpeed), &|_| 40.0),
                (32, Some(Quantity::RotarySpeed), &|_| 5000.0),
            ],
            60,
        );
        let begins = [
            Some("CHECK: may be a hook load (mirrors 0116)"),
            Some("CHECK: may be a weight on bit (mirrors 0114)"),
            Some("CHECK: may be a depth"),
            Some("may be a torque, a pressure (moves with 0130)"),
            Some("may be a rotary speed, pump strokes, "),
            None,
            Some("CHECK: may be a depth, a hook load, a torque, a pressure"),
        ];
        for (said, begin) in said.iter().zip(begins) {
            match begin {
                Some(begin) => assert!(said.as_deref().is_some_and(|said| said.starts_with(begin)), "{said:?}"),
                None => assert_eq!(*said, None),
            }
        }
        assert!(said[4].as_deref().unwrap().ends_with("(moves with 0121)"), "{said:?}");
    }

    #[test]
    fn few_numbers_say_nothing_and_many_are_not_kept() {
        let said = words(&[(8, None, &f64::from), (9, None, &|_| f64::MAX)], FEWEST as u32 - 1);
        assert_eq!(said, [None, None]);
        let mut numbers = Numbers::default();
        for frame in 0..10_000_u32 {
            numbers.add(frame.into(), f64::from(frame));
        }
        assert_eq!(numbers.0.len(), MOST_NUMBERS);
        // Numbers near the largest have a scatter that overflows, and no correlation.
        let said = words(
            &[(8, None, &|frame| f64::MAX * f64::from(frame % 2)), (9, None, &weight)],
            20,
        );
        assert_eq!(said[0].as_deref(), Some("by its numbers none of the usual quantities"));
    }
}
