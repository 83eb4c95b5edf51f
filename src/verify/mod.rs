//! The closed-form verification cases.
