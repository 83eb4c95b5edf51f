//! The checked-in message types agree with the definitions, by our own generator and by an independent one.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use flexdrill_messages::TypeInfo;
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

/// roslibrust wants one folder per package with a package.xml; ours is built from the same files.
fn packages_for_roslibrust(folder: &Path) -> Vec<PathBuf> {
    let mut sources = vec![("flexdrill".to_owned(), root())];
    for entry in std::fs::read_dir(root().join("crates/flexdrill-messages/external")).unwrap() {
        let path = entry.unwrap().path();
        sources.push((path.file_name().unwrap().to_string_lossy().into_owned(), path));
    }
    let mut packages = Vec::new();
    for (name, source) in sources {
        let package = folder.join(&name);
        std::fs::create_dir_all(package.join("msg")).unwrap();
        std::fs::write(
            package.join("package.xml"),
            format!(
                "<package format=\"3\"><name>{name}</name><export><build_type>ament_cmake</build_type></export></package>"
            ),
        )
        .unwrap();
        let Ok(messages) = std::fs::read_dir(source.join("msg")) else {
            continue;
        };
        for message in messages {
            let path = message.unwrap().path();
            // Services stand beside our messages; only messages are compared.
            if path.extension().is_some_and(|extension| extension == "srv") {
                continue;
            }
            std::fs::copy(&path, package.join("msg").join(path.file_name().unwrap())).unwrap();
        }
        packages.push(package);
    }
    packages
}

#[test]
fn interop_roslibrust_computes_the_same_hashes() {
    let folder = tempfile::tempdir().unwrap();
    let packages = packages_for_roslibrust(folder.path());
    let (tokens, _) = roslibrust_codegen::find_and_generate_ros_messages_without_ros_package_path(packages).unwrap();
    // Each type's name and hash stand together in the generated source; spaces are the printer's.
    let text: String = tokens.to_string().chars().filter(|c| !c.is_whitespace()).collect();
    let mut different = BTreeSet::new();
    // roslibrust takes `byte` for another type than ROS 2 does; rosbags' hashes cover those.
    let comparable =
        |info: &&TypeInfo| info.ros_type.contains("/msg/") && !info.schema.lines().any(|line| line.starts_with("byte"));
    for info in TYPES.iter().filter(comparable) {
        let bytes: String = (7..71)
            .step_by(2)
            .map(|at| format!("0x{},", &info.rihs01[at..at + 2]))
            .collect();
        if !text.contains(&format!("\"{}\",&[{bytes}]", info.dds_type)) {
            different.insert(info.ros_type);
        }
    }
    assert!(different.is_empty(), "roslibrust has other hashes for {different:?}");
}
