//! The rig page: its files, and what every answer of its server carries.

pub mod assets;
