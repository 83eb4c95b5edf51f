//! A section of the configuration as one table, in which every number is named once.

/// Makes the structure of a section, its `Default` and `check_numbers`, which holds its numbers against their bounds.
///
/// A row is `key: type = default, bound(low, high), unit, why these limits;`. The bound is `within` or `above`
/// ([`Bound`](crate::checker::Bound)) and may refer to other keys through the name that stands behind the section's.
/// A row without bound is checked elsewhere; `below` instead of a bound holds the numbers of a section within this one.
/// In a section whose rows have no defaults every key must be given, unless serde has a default for it.
macro_rules! section {
    (
        $(#[$outer:meta])*
        pub struct $name:ident($this:ident) {
            $(
                $(#[$inner:meta])*
                $field:ident: $type:ty = $default:expr
                $(, $bound:ident $(($low:expr, $high:expr), $unit:literal, $reason:literal)?)?;
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
                    #[doc = concat!("\n\nAllowed: ", stringify!($bound), " ", stringify!($low), " to ",
                        stringify!($high), " ", $unit)]
                )?)?
                pub $field: $type,
            )*
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $default,)* }
            }
        }

        section!(@check $name, $this, $($field $(, $bound $(($low, $high), $unit, $reason)?)?;)*);
    };
    (
        $(#[$outer:meta])*
        pub struct $name:ident($this:ident) {
            $(
                $(#[$inner:meta])*
                $field:ident: $type:ty $(, $bound:ident $(($low:expr, $high:expr), $unit:literal, $reason:literal)?)?;
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
                    #[doc = concat!("\n\nAllowed: ", stringify!($bound), " ", stringify!($low), " to ",
                        stringify!($high), " ", $unit)]
                )?)?
                pub $field: $type,
            )*
        }

        section!(@check $name, $this, $($field $(, $bound $(($low, $high), $unit, $reason)?)?;)*);
    };
    (
        @check $name:ident, $this:ident,
        $($field:ident $(, $bound:ident $(($low:expr, $high:expr), $unit:literal, $reason:literal)?)?;)*
    ) => {
        impl $name {
            /// Holds the numbers against their bounds.
            pub(crate) fn check_numbers(&self, c: &mut crate::checker::Checker) {
                let $this = self;
                $(
                    $(section!(@row c, $this, $field, $bound $(($low, $high), $unit, $reason)?);)?
                )*
            }
        }
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
