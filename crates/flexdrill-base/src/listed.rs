//! Enumerations whose variants are written once.

/// Declares an enumeration of which a variant is one row: its documentation, its name, its code where it has one, and its
/// words. It gets `ALL`, the variants in their order, and a private `row`, the words of a variant. The number after the
/// enumeration's name is that of the words.
///
/// ```
/// flexdrill_base::listed! {
///     /// A direction.
///     #[derive(Debug, Clone, Copy, PartialEq)]
///     pub enum Direction: 2 {
///         /// Towards the kick-off.
///         Up: "up", "towards the kick-off";
///         /// Towards the bit.
///         Down: "down", "towards the bit";
///     }
/// }
///
/// impl Direction {
///     /// Its name.
///     pub const fn name(self) -> &'static str {
///         self.row()[0]
///     }
/// }
///
/// assert_eq!(Direction::ALL.map(Direction::name), ["up", "down"]);
/// ```
#[macro_export]
macro_rules! listed {
    (
        $(#[$outer:meta])*
        $visibility:vis enum $name:ident: $words:literal {
            $($(#[$inner:meta])* $variant:ident $(= $code:literal)?: $($word:literal),+;)+
        }
    ) => {
        $(#[$outer])*
        $visibility enum $name {
            $($(#[$inner])* $variant $(= $code)?,)+
        }

        impl $name {
            /// All of them, in their order.
            $visibility const ALL: [Self; [$(stringify!($variant)),+].len()] = [$(Self::$variant),+];

            const fn row(self) -> [&'static str; $words] {
                match self {
                    $(Self::$variant => [$($word),+],)+
                }
            }
        }
    };
}
