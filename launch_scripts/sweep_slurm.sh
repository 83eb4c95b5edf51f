#!/usr/bin/env bash
# Works on a sweep with Slurm: an array of tasks, each a part of the points. Run it where sbatch is; DIR must be the same
# folder on every node.
#
#   launch_scripts/sweep_slurm.sh DIR [TASKS]
#
# A task that Slurm kills or loses is queued again (--requeue) and goes on with what has no result. Starting a task costs
# one to two seconds, so a task takes many points. Run the script again when a node is away: Slurm holds its tasks back for
# some minutes, and what they have not done is done by the new ones.
set -euo pipefail
dir=$(realpath "${1:?use: $0 DIR [TASKS]}")
tasks=${2:-32}
flexdrill=${FLEXDRILL_BINARY:-flexdrill}

"$flexdrill" sweep status "$dir"
# --chdir: the folder of the submission need not be there on the nodes.
sbatch --wait --requeue --open-mode=append --chdir="$dir" --job-name=flexdrill --array="0-$((tasks - 1))" \
    --output="$dir/slurm-%a.log" ${SBATCH_MORE:-} \
    --wrap "exec '$flexdrill' sweep work '$dir' --chunk \$SLURM_ARRAY_TASK_ID/$tasks --jobs \${SLURM_CPUS_PER_TASK:-1}" ||
    echo "some tasks did not end well; their logs are $dir/slurm-*.log" >&2
"$flexdrill" sweep status "$dir"
