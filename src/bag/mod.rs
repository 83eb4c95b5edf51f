//! Bags: MCAP recording, reading, recovery, and rosbag2's SQLite as input.
