#!/usr/bin/env bash
# The twin alone: builds and runs the node in this terminal until Ctrl-C. Options go to `flexdrill run`, for example
#   launch_scripts/node.sh --config config/default.yaml --ros-args -r __ns:=/rig_7
# Unlike the demo it uses the network as ROS 2 is set up here (ROS_DOMAIN_ID, ROS_LOCALHOST_ONLY).
set -euo pipefail
. "$(dirname "$0")/common.sh"
build
case " $* " in
*" --config"*) ;;
*) set -- --config "$root/config/default.yaml" "$@" ;;
esac
say "flexdrill run $*"
exec "$flexdrill" run "$@"
