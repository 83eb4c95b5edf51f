#!/usr/bin/env bash
# The main job: builds, starts the twin and a rig that plays a drilling log into it, and shows the twin in this terminal.
# Everything talks DDS over loopback, as separate programs. q or Ctrl-C ends it all.
#   launch_scripts/demo.sh --web     shows it in this machine's browser
#   launch_scripts/demo.sh --help    lists all options: they are those of `flexdrill demo`, which this script runs
set -euo pipefail
. "$(dirname "$0")/common.sh"
build
exec "$flexdrill" demo "$@"
