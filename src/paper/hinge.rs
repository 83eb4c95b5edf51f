//! The case of Fig. 9.
