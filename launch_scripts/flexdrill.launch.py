"""Starts the twin under ROS 2, and on request a rig that plays a log into it.

    ros2 launch flexdrill flexdrill.launch.py config:=path/to/config.yaml namespace:=rig_7
    ros2 launch flexdrill flexdrill.launch.py lifecycle:=active
    ros2 launch launch_scripts/flexdrill.launch.py log:=path/to/rig_log.csv record:=my_run

Included from another launch file it keeps to PushRosNamespace and SetParameter. The binary is the one installed with this
file, or target/release/flexdrill of this repository, or the one on PATH; binary:=... names another.
"""

import shutil
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, OpaqueFunction, RegisterEventHandler
from launch.event_handlers import OnProcessStart
from launch.events import matches_action
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import LifecycleNode, Node
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from lifecycle_msgs.msg import Transition

# The repository, or share/flexdrill where it is installed.
ROOT = Path(__file__).resolve().parent.parent

ARGUMENTS = [
    ("config", "", "configuration of the twin (YAML); empty: the parameter config_file, else the default"),
    ("namespace", "", "namespace of all topics that do not start with /"),
    ("node_name", "flexdrill", "name of the node"),
    ("params_file", "", "ROS 2 parameter file"),
    ("use_sim_time", "", "true: take the time from /clock; empty: as SetParameter says, else false"),
    ("lifecycle", "", "managed node: true waits to be configured and activated, active does both; empty: not managed"),
    ("record", "", "bag to record to (a folder, or a file .mcap); empty: none"),
    ("log", "", "rig log or bag to play into the twin; empty: wait for a real rig"),
    ("mapping", str(ROOT / "config" / "field_logs" / "rig_1hz.yaml"), "columns of a log in CSV"),
    ("rate", "1.0", "speed of playing the log"),
    ("binary", "", "path of the flexdrill binary"),
]


def find_binary(given):
    if given:
        return given
    installed = ROOT.parent.parent / "lib" / "flexdrill" / "flexdrill"
    built = ROOT / "target" / "release" / "flexdrill"
    for binary in (installed, built):
        if binary.exists():
            return str(binary)
    found = shutil.which("flexdrill")
    if found is None:
        raise RuntimeError(f"no flexdrill binary: run `cargo build --release` in {ROOT}, or give binary:=PATH")
    return found


def activate(twin):
    """Configures the node once it has started, and activates it once it is configured."""

    def change(transition):
        return EmitEvent(event=ChangeState(lifecycle_node_matcher=matches_action(twin), transition_id=transition))

    configured = OnStateTransition(
        target_lifecycle_node=twin,
        start_state="unconfigured",
        goal_state="inactive",
        entities=[change(Transition.TRANSITION_ACTIVATE)],
    )
    started = OnProcessStart(target_action=twin, on_start=[change(Transition.TRANSITION_CONFIGURE)])
    return [RegisterEventHandler(configured), RegisterEventHandler(started)]


def start(context):
    value = {name: LaunchConfiguration(name).perform(context) for name, _, _ in ARGUMENTS}
    binary = find_binary(value["binary"])
    namespace = value["namespace"].strip("/")
    node = ["run"]
    if value["config"]:
        node += ["--config", value["config"]]
    lifecycle = value["lifecycle"].lower()
    if lifecycle not in ("", "false", "true", "active"):
        raise RuntimeError(f"lifecycle:={value['lifecycle']} is not known: use true, active or false")
    is_managed = lifecycle in ("true", "active")
    if is_managed:
        node += ["--lifecycle"]
    if value["record"]:
        node += ["--record", value["record"]]
    parameters = [value["params_file"]] if value["params_file"] else []
    if value["use_sim_time"]:
        parameters.append({"use_sim_time": value["use_sim_time"].lower() == "true"})
    # An own namespace goes below one that was pushed; time to finish a recording before the launch system kills.
    common = {"namespace": namespace, "output": "screen", "executable": binary}
    kind = LifecycleNode if is_managed else Node
    twin = kind(name=value["node_name"], arguments=node, parameters=parameters, sigterm_timeout="15", **common)
    actions = [twin]
    if lifecycle == "active":
        actions += activate(twin)
    if value["log"]:
        rig = ["rig", value["log"], "--rate", value["rate"]]
        if value["log"].endswith(".csv"):
            rig += ["--mapping", value["mapping"]]
        actions.append(Node(name="flexdrill_rig", arguments=rig, **common))
    return actions


def generate_launch_description():
    declared = [DeclareLaunchArgument(name, default_value=default, description=text) for name, default, text in ARGUMENTS]
    return LaunchDescription([*declared, OpaqueFunction(function=start)])
