#!/usr/bin/env bash
# ./dev test-cluster: twenty captures on a Slurm cluster of four nodes on this machine, while one
# node is killed, one is drained, one capture's photographs show no board, and one capture's disk is
# full. All others must come out with the bytes that `glint run` gives.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
project=$(cd "$here/../.." && pwd)
work=$project/build/cluster
nodes=4 captures=20
PATH=$project/build/bin:$PATH
. "$here/slurm.sh"

say() { printf '\n\033[1m%s\033[0m\n' "$*"; }

[ "$(id -u)" -eq 0 ] || { echo "test-cluster: needs root, to start Slurm's daemons" >&2; exit 2; }

cleanup() {
  stop_cluster "$work/slurm" 2>/dev/null || true
  mountpoint -q "$work/disk" && umount "$work/disk"
}
trap cleanup EXIT

make_captures() {
  for seed in 1 2; do
    glint-synth capture "$work/photographs/$seed" --photos 5 --megapixels 4 --texels 512 --resolution 128 \
      --seed "$seed" --log-level error >/dev/null
  done
  for i in $(seq -w "$captures"); do
    local from=$work/photographs/$((10#$i % 2 + 1)) to=$work/captures/sample_$i
    mkdir -p "$to"
    cp -r "$from/photos" "$to/"
    # Of different sizes, so that no result is another's.
    sed "s/^resolution_px.*/resolution_px = $((110 + 10#$i))/" "$from/capture.toml" >"$to/capture.toml"
    printf '\n[fit]\niterations = 20\n' >>"$to/capture.toml"
  done
  # No board is seen.
  for photo in "$work"/captures/sample_07/photos/*; do
    oiiotool --create 400x300 3 --fill:color=0.2,0.3,0.4 400x300 -d uint8 -o "$photo"
  done
  # A disk with room for the photographs and little more.
  mkdir -p "$work/disk"
  mount -t tmpfs -o size="$(($(du -sk "$work/captures/sample_13" | cut -f1) + 600))k" tmpfs "$work/disk"
  cp -r "$work/captures/sample_13/." "$work/disk/"
  rm -rf "$work/captures/sample_13"
  ln -s "$work/disk" "$work/captures/sample_13"
}

run_workflow() {
  snakemake --snakefile "$project/workflow/Snakefile" --profile "$project/workflow/profiles/slurm" \
    --directory "$work/captures" --latency-wait 5 "$@" >>"$work/snakemake.log" 2>&1
}

jobs_done() { find "$work"/captures/*/glint/workflow/ -regex '.*/[a-z]+' 2>/dev/null | wc -l; }

wait_for_jobs() {
  while [ "$(jobs_done)" -lt "$1" ] && kill -0 "$2" 2>/dev/null; do sleep 0.5; done
}

disturb() {
  local snakemake=$1 victim
  wait_for_jobs 15 "$snakemake"
  victim=$(squeue --noheader --states=running --format=%N | sort | head -n 1)
  victim=${victim:-node2}
  say "Killing $victim, with these jobs in the queue:"
  squeue --format='%8i %16j %10T %8N %R' | head -n 12
  kill_node "$work/slurm" "$victim"
  wait_for_jobs 40 "$snakemake"
  local drained=node3
  [ "$victim" = node3 ] && drained=node1
  say "Draining $drained; $victim is $(sinfo --noheader --nodes="$victim" --format=%T)"
  scontrol update nodename="$drained" state=drain reason=test
}

compare() {
  local different=0 same=0 name stage
  for capture in "$work"/captures/sample_*; do
    name=$(basename "$capture")
    [ "$name" = sample_07 ] && continue
    mkdir -p "$work/by-run/$name"
    cp -r "$capture/photos" "$capture/capture.toml" "$work/by-run/$name/"
    glint run "$work/by-run/$name" --log-level error >/dev/null 2>&1
    for stage in calib rectify fit refine export report; do
      # A manifest has the hash of every file of its result.
      if cmp -s "$capture/glint/$stage/manifest.json" "$work/by-run/$name/glint/$stage/manifest.json"; then
        same=$((same + 1))
      else
        different=$((different + 1))
        echo "different: $name, $stage"
      fi
    done
  done
  say "$same results are those of glint run, $different are not"
  [ "$different" -eq 0 ]
}

page_says() { grep -q "$1" "$work/captures/overview.html" || { echo "the page does not say: $1" >&2; exit 1; }; }

rm -rf "$work"
mkdir -p "$work"
say "Making $captures captures"
make_captures
say "Starting Slurm: $nodes nodes"
start_cluster "$work/slurm" "$nodes"
began=$(date +%s)
run_workflow &
snakemake=$!
disturb "$snakemake"
wait "$snakemake" && { echo "a broken capture did not fail" >&2; exit 1; }
say "All jobs ended after $(($(date +%s) - began)) s; nodes:"
sinfo --noheader --Node --format='%N %T'
page_says "2 failed, $((captures - 2)) done"
page_says "failed in calib"
page_says "No space left on device\|disk is full\|disk full"
say "The disk is enlarged, the node repaired; again:"
mount -o remount,size=200m "$work/disk"
scontrol update nodename="node[1-$nodes]" state=resume 2>/dev/null || true
run_workflow && { echo "a broken capture did not fail" >&2; exit 1; }
page_says "1 failed, $((captures - 1)) done"
say "Comparing with glint run"
compare
say "Page: $work/captures/overview.html"
