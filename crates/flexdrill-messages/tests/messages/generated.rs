//! The checked-in message types agree with the definitions, and with the hashes that ROS 2 publishes.

use std::path::{Path, PathBuf};

use flexdrill_messages::generated::TYPES;
use xtask::messages::{Catalogue, definition, hash, schema};

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

/// Hashes of an action of the example interfaces, and of the messages that all actions use, as generators for ROS 2 Jazzy
/// write them.
#[test]
fn an_action_has_its_published_hashes() {
    let mut catalogue = Catalogue::read(&root()).unwrap();
    let text = "int32 order\n---\nint32[] sequence\n---\nint32[] sequence\n";
    catalogue
        .add_action("example_interfaces", "Fibonacci", text, definition::Source::Text)
        .unwrap();
    for (package, kind, name, published) in [
        (
            "example_interfaces",
            "action",
            "Fibonacci_FeedbackMessage",
            "RIHS01_c1de71afd52e49a89c53d8262366884185bc0a02f78ce051c4e46b0a7fe59bb2",
        ),
        (
            "example_interfaces",
            "action",
            "Fibonacci_GetResult_Response",
            "RIHS01_6021dc98ab9b4bbe395e48aa4de81ee5f68eb570f88358affcc648146668b24f",
        ),
        (
            "action_msgs",
            "msg",
            "GoalStatusArray",
            "RIHS01_6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e",
        ),
        (
            "action_msgs",
            "msg",
            "GoalInfo",
            "RIHS01_6398fe763154554353930716b225947f93b672f0fb2e49fdd01bb7a7e37933e9",
        ),
        (
            "unique_identifier_msgs",
            "msg",
            "UUID",
            "RIHS01_1b8e8aca958cbea28fe6ef60bf6c19b683c97a9ef60bb34752067d0f2f7ab437",
        ),
    ] {
        let name = definition::TypeName {
            package: package.to_owned(),
            kind,
            name: name.to_owned(),
        };
        let definition = catalogue.get(&name).unwrap();
        assert_eq!(hash::rihs01(definition, &catalogue).unwrap(), published, "{name}");
    }
    // The action as a whole names what ROS 2 makes of it, in this order.
    let whole = catalogue
        .actions()
        .find(|action| action.name.package == "example_interfaces")
        .unwrap();
    let fields: Vec<&str> = whole.fields.iter().map(|field| field.name.as_str()).collect();
    let expected = [
        "goal",
        "result",
        "feedback",
        "send_goal_service",
        "get_result_service",
        "feedback_message",
    ];
    assert_eq!(fields, expected);
    assert!(catalogue.dependencies(whole).unwrap().len() > 10);
}

/// Hashes of the standard for simulators, as a separate Python program computed them from the definitions of
/// simulation_interfaces 1.5.0; for types with published hashes it computed those.
#[test]
fn types_of_the_standard_for_simulators_have_their_hashes() {
    let of = |name: &str| {
        let full = format!("simulation_interfaces/{name}");
        let message = flexdrill_messages::find_type(&full).map(|info| info.rihs01);
        let service = flexdrill_messages::find_service(&full).map(|info| info.rihs01);
        let action = flexdrill_messages::find_action(&full).map(|info| info.rihs01);
        message.or(service).or(action).unwrap()
    };
    for (name, hash) in [
        (
            "msg/Result",
            "cf43a306adff3337a0a47143d8f5689933bc70a30478f13b077dc1fe3bc5ad17",
        ),
        (
            "msg/SimulationState",
            "bb9f87ccdd98fba113052a512d9801e84ce732d0a2b3c2b0cb281828de36e415",
        ),
        (
            "msg/SimulatorFeatures",
            "8b101c8529bc0ea3dcf056078254768f39832b9ef0adaf93bd5cea96c0de3305",
        ),
        (
            "srv/GetSimulatorFeatures",
            "abb9439c8cf196722a469fb6c68b44b484f198c2a1356ac38849a29c2a20a794",
        ),
        (
            "srv/GetSimulationState",
            "3362dcebee4b1afebbf9c4beee5c79c1455385aded62092a892d61fde8644f30",
        ),
        (
            "srv/SetSimulationState",
            "a868b916dce49974f637ba252141258c4b07b0c06858b88af560e3eb6bfbcb30",
        ),
        (
            "srv/ResetSimulation",
            "4ce285d7ff9b8ac70dcc95161f32bf54c05a6f4b13427990e41ab40c36c39646",
        ),
        (
            "srv/StepSimulation",
            "913fe0653690ce6bf8f09f316e6a626747012e9fca31e26719910d417aa8565c",
        ),
        (
            "srv/StepSimulation_Request",
            "cda33f6887815f3dce0f90e61fd8efd39bda13ae264ddede15c33fbad890630e",
        ),
        (
            "action/SimulateSteps",
            "f0837c898e1219cd73bf4c041feab41e8c533e8e1057e982744dba7b093467eb",
        ),
        (
            "action/SimulateSteps_FeedbackMessage",
            "a30dee7ee7380769e616406ec5067b238aa2b27e1dbd7a5957fba1d908d7754d",
        ),
        (
            "action/SimulateSteps_SendGoal",
            "504407b9ff5617a737df8222cf581452b4f2e699e11e940d8d36590c5fb07d01",
        ),
        (
            "action/SimulateSteps_GetResult",
            "a1dae0516ab5c70d6d797e1bcd55c9448dfbb1966643f1ebd3e3f153d8169ae0",
        ),
    ] {
        assert_eq!(of(name), format!("RIHS01_{hash}"), "{name}");
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
