//! Field logs: CSV with a mapping file, as timed inputs.
