#!/bin/sh
# What Snakemake asks of a job: running, success or failed.
state=$(scontrol --oneliner show job "$1" 2>/dev/null | grep -o 'JobState=[A-Z_]*' | cut -d= -f2)
# Slurm forgets finished jobs after some minutes; its accounts, where they are kept, do not.
[ -n "$state" ] || state=$(sacct --noheader --parsable2 --allocations --format=state --jobs "$1" 2>/dev/null | head -n 1)
case $state in
  COMPLETED*) echo success ;;
  PENDING* | CONFIGURING* | RUNNING* | COMPLETING* | REQUEUE* | RESIZING* | SUSPENDED* | STOPPED* | SIGNALING* | STAGE_OUT*) echo running ;;
  *) echo failed ;;
esac
