//! From the twin to the messages: which are due ([`Outputs`]), how a snapshot fills them ([`fill`]), the table of their
//! scalars ([`figures`]), the values of the rig's messages by quantity, and the words for the codes ([`words`]). The crate
//! knows no network and no file.

pub mod figures;
pub mod fill;
mod measured;
mod outputs;
pub mod words;

pub use measured::{InputValues, MeasuredValues};
pub use outputs::{Encoded, Outputs, ParameterChange, published, run_inputs, schedule};
