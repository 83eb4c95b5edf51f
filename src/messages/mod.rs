//! ROS 2 message types, generated from `msg/*.msg`.
