//! A section of the configuration as one table, in which every number is named once.

/// Makes the structure of a section, its `Default` and `check_numbers`, which holds its numbers against their bounds.
///
/// A row is `key: type = default, bound(low, high), unit, why these limits;`. The bound is `within` or `above`
/// ([`Bound`](crate::checker::Bound)). A limit is a literal, which the JSON Schema of the key then carries too, or an
/// expression that refers to other keys through the name in parentheses after the section's name, which only the check
/// can evaluate. A row without a bound is checked elsewhere; `below` instead of a bound checks the numbers of a section
/// within this one. In a section whose rows have no defaults every key must be given, unless serde has a default for
/// it.
macro_rules! section {
    (
        $(#[$outer:meta])*
        pub struct $name:ident($this:ident) {
            $(
                $(#[$inner:meta])*
                $field:ident: $type:ty = $default:expr
                $(, $bound:ident $(($($limits:tt)*), $unit:literal, $reason:literal)?)?;
            )*
        }
    ) => {
        $(#[$outer])*
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        #[serde(deny_unknown_fields, default)]
        pub struct $name {
            $(
                $(#[$inner])*
                $($(
                    #[doc = section!(@words $bound($($limits)*), $unit)]
                    #[schemars(transform = section!(@constant $bound($($limits)*)).in_schema())]
                )?)?
                pub $field: $type,
            )*
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $default,)* }
            }
        }

        section!(@check $name, $this, $($field $(, $bound $(($($limits)*), $unit, $reason)?)?;)*);
    };
    (
        $(#[$outer:meta])*
        pub struct $name:ident($this:ident) {
            $(
                $(#[$inner:meta])*
                $field:ident: $type:ty $(, $bound:ident $(($($limits:tt)*), $unit:literal, $reason:literal)?)?;
            )*
        }
    ) => {
        $(#[$outer])*
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $name {
            $(
                $(#[$inner])*
                $($(
                    #[doc = section!(@words $bound($($limits)*), $unit)]
                    #[schemars(transform = section!(@constant $bound($($limits)*)).in_schema())]
                )?)?
                pub $field: $type,
            )*
        }

        section!(@check $name, $this, $($field $(, $bound $(($($limits)*), $unit, $reason)?)?;)*);
    };
    (
        @check $name:ident, $this:ident,
        $($field:ident $(, $bound:ident $(($($limits:tt)*), $unit:literal, $reason:literal)?)?;)*
    ) => {
        impl $name {
            /// Holds the numbers against their bounds.
            pub(crate) fn check_numbers(&self, c: &mut crate::checker::Checker) {
                let $this = self;
                $(
                    $(section!(@row c, $this, $field, $bound $(($($limits)*), $unit, $reason)?);)?
                )*
            }
        }
    };
    (@words $bound:ident($low:expr, $high:expr), $unit:literal) => {
        concat!("\n\nAllowed: ", stringify!($bound), " ", stringify!($low), " to ", stringify!($high), " ", $unit)
    };
    // The limits that no other key moves.
    (@constant $bound:ident($low:literal, $high:literal)) => {
        crate::checker::Bound::$bound($low, $high)
    };
    (@constant $bound:ident($low:literal, $high:expr)) => {
        crate::checker::Bound::$bound($low, f64::INFINITY)
    };
    (@constant $bound:ident($low:expr, $high:literal)) => {
        crate::checker::Bound::$bound(f64::NEG_INFINITY, $high)
    };
    (@constant $bound:ident($low:expr, $high:expr)) => {
        crate::checker::Bound::$bound(f64::NEG_INFINITY, f64::INFINITY)
    };
    (@row $c:ident, $this:ident, $field:ident, below) => {
        $c.below(stringify!($field), |c| $this.$field.check_numbers(c));
    };
    (@row $c:ident, $this:ident, $field:ident, $bound:ident($low:expr, $high:expr), $unit:literal, $reason:literal) => {
        $c.number(
            stringify!($field),
            $this.$field,
            crate::checker::Bound::$bound($low, $high),
            $unit,
            $reason,
        );
    };
}

pub(crate) use section;

/// Whether a key has its default of 0, so that it is left out of the file and of the hash.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
pub(crate) fn is_zero(value: &f64) -> bool {
    *value == 0.0
}
