#!/bin/bash
# Slurm runs this script once for every data set of a batch, an array task each, and once more for the tables.
# What a centre needs first, such as its modules, goes here.

names=({{names}})
polar=({{polar}})
threads=${SLURM_CPUS_PER_TASK:-1}

if [ -z "${SLURM_ARRAY_TASK_ID:-}" ]; then
  exec "${polar[@]}" --gather "${names[@]/#/--only=}" --threads "$threads"
fi

# Signals go on to the program, which leaves a checkpoint: USR1 comes shortly before the time limit, TERM when
# the task is cancelled, preempted or put back into the queue.
program=
trap 'kill -USR1 "$program"' USR1
trap 'kill -TERM "$program"' TERM
"${polar[@]}" --no-tables --only="${names[SLURM_ARRAY_TASK_ID - 1]}" --threads "$threads" &
program=$!
wait "$program"
while kill -0 "$program" 2>/dev/null; do wait "$program"; done # a signal ends waiting, too
wait "$program"
code=$?

# Out of its time: back into the queue, to go on from the checkpoint. After TERM that is for Slurm to do.
if [ "$code" -eq $((128 + $(kill -l USR1))) ] && [ "${SLURM_RESTART_COUNT:-0}" -lt {{restarts}} ]; then
  scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"
fi
exit "$code"
