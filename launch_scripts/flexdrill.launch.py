"""Starts the twin under ROS 2, and on request a rig that plays a log into it.

    ros2 launch launch_scripts/flexdrill.launch.py config:=config/coarse.yaml namespace:=rig_7
    ros2 launch launch_scripts/flexdrill.launch.py log:=path/to/rig_log.csv record:=my_run

The binary is target/release/flexdrill of this repository, or else the one on PATH; binary:=... names another.
"""

import shutil
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction
from launch.substitutions import LaunchConfiguration

ROOT = Path(__file__).resolve().parent.parent

ARGUMENTS = [
    ("config", str(ROOT / "config" / "default.yaml"), "configuration of the twin (YAML)"),
    ("namespace", "", "namespace of all topics that do not start with /"),
    ("node_name", "flexdrill", "name of the node"),
    ("params_file", "", "ROS 2 parameter file"),
    ("use_sim_time", "false", "take the time from /clock"),
    ("record", "", "bag to record to (a folder, or a file .mcap); empty: none"),
    ("log", "", "rig log or bag to play into the twin; empty: wait for a real rig"),
    ("mapping", str(ROOT / "config" / "field_logs" / "rig_1hz.yaml"), "columns of a log in CSV"),
    ("rate", "1.0", "speed of playing the log"),
    ("binary", "", "path of the flexdrill binary"),
]


def find_binary(given):
    if given:
        return given
    built = ROOT / "target" / "release" / "flexdrill"
    if built.exists():
        return str(built)
    found = shutil.which("flexdrill")
    if found is None:
        raise RuntimeError(f"no flexdrill binary: run `cargo build --release` in {ROOT}, or give binary:=PATH")
    return found


def start(context):
    value = {name: LaunchConfiguration(name).perform(context) for name, _, _ in ARGUMENTS}
    binary = find_binary(value["binary"])
    node = [binary, "run", "--config", value["config"]]
    if value["record"]:
        node += ["--record", value["record"]]
    node += ["--ros-args", "-r", f"__node:={value['node_name']}"]
    if value["namespace"]:
        node += ["-r", f"__ns:=/{value['namespace'].strip('/')}"]
    if value["params_file"]:
        node += ["--params-file", value["params_file"]]
    node += ["-p", f"use_sim_time:={value['use_sim_time']}"]
    # Time to finish a recording before the launch system kills.
    actions = [ExecuteProcess(cmd=node, name="flexdrill", output="screen", sigterm_timeout="15")]
    if value["log"]:
        rig = [binary, "rig", value["log"], "--rate", value["rate"]]
        if value["log"].endswith(".csv"):
            rig += ["--mapping", value["mapping"]]
        if value["namespace"]:
            rig += ["--namespace", f"/{value['namespace'].strip('/')}"]
        actions.append(ExecuteProcess(cmd=rig, name="flexdrill_rig", output="screen"))
    return actions


def generate_launch_description():
    declared = [DeclareLaunchArgument(name, default_value=default, description=text) for name, default, text in ARGUMENTS]
    return LaunchDescription([*declared, OpaqueFunction(function=start)])
