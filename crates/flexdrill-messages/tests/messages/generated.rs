//! The checked-in message types agree with the definitions, and with the hashes that ROS 2 publishes.

use std::path::{Path, PathBuf};

use flexdrill_messages::generated::TYPES;
use xtask::messages::{Catalogue, schema};

/// The root of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn regenerating_gives_the_checked_in_file() {
    let fresh = xtask::messages::generate(&root()).unwrap();
    let checked_in = std::fs::read_to_string(root().join(xtask::messages::OUTPUT)).unwrap();
    assert!(
        fresh == checked_in,
        "crates/flexdrill-messages/src/generated.rs is old: run `cargo xtask messages`"
    );
}

#[test]
fn regenerating_gives_the_page_its_checked_in_messages() {
    let fresh = xtask::messages::generate_typescript(&root()).unwrap();
    let checked_in = std::fs::read_to_string(root().join(xtask::messages::PAGE_OUTPUT)).unwrap();
    assert!(
        fresh == checked_in,
        "{} is old: run `cargo xtask messages`",
        xtask::messages::PAGE_OUTPUT
    );
}

#[test]
fn every_definition_has_a_type_and_its_whole_schema() {
    let catalogue = Catalogue::read(&root()).unwrap();
    assert_eq!(catalogue.iter().count(), TYPES.len());
    for (definition, info) in catalogue.iter().zip(TYPES) {
        assert_eq!(definition.name.to_string(), info.ros_type);
        assert_eq!(schema::schema(definition, &catalogue).unwrap(), info.schema);
    }
}

/// Hashes of standard types as ROS 2 Jazzy's own packages carry them.
#[test]
fn standard_types_have_their_published_hashes() {
    for (ros_type, hash) in [
        (
            "std_msgs/msg/String",
            "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
        ),
        (
            "std_msgs/msg/Header",
            "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01",
        ),
        (
            "rcl_interfaces/msg/Log",
            "RIHS01_e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac",
        ),
        (
            "service_msgs/msg/ServiceEventInfo",
            "RIHS01_41bcbbe07a75c9b52bc96bfd5c24d7f0fc0a08c0cb7921b3373c5732345a6f45",
        ),
        (
            "visualization_msgs/msg/MarkerArray",
            "RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf",
        ),
    ] {
        assert_eq!(
            flexdrill_messages::find_type(ros_type).unwrap().rihs01,
            hash,
            "{ros_type}"
        );
    }
}
