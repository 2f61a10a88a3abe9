#!/bin/bash
# Trains the estimator on a GPU, from the sources to weights that can be shipped.
set -euo pipefail

usage() {
  cat <<'HELP'
training/gpu_run.sh MINUTES [FROM] [-- OPTIONS]  train for so many minutes, detached; FROM: weights to begin with
training/gpu_run.sh wait [SECONDS]               wait until the training is over, at most so long; say where it stands
training/gpu_run.sh stop                         stop it; the first form goes on from its last checkpoint

The first form builds glint-train alone (GLINT_TRAINER_ONLY: libtorch, CLI11, nlohmann-json), packs materials if there
is no pack yet, starts the training in a session of its own, and returns. When the loss jumps, the trainer returns to its
last good weights and halves the learning rate (glint-train --supervise); when the trainer itself ends with an error it
is started again from its checkpoint. Called again, the script goes on from the checkpoint. OPTIONS go to
`glint-train estimator` after the script's own, so that they win.

Environment (defaults in parentheses):
  OUT (training/run)     folder of everything that is written:
                           estimator.safetensors, .csv, .svg, .checkpoint   weights in bf16, loss log, its plot
                           log, status, pid                                 what the programs say
                           weights/                                         bf16 and float32 in parts, SHA256SUMS, join.sh
  MATERIALS ()           folders of materials as JPEGs named the ambientCG way, separated by colons. Packed once, by
                         glint-synth pack where it is built (SYNTH), else by glint-train pack from pictures that python3
                         with Pillow, djpeg or ImageMagick decodes. None: procedural materials alone
  PACK (OUT/materials.safetensors)   the pack; if it exists, MATERIALS is not read
  DEVICE (cuda)          or cpu, for small trials
  BATCH (128), PHOTOGRAPHS (256), CROPS (128,128,256)   samples and photographs a step; crop sizes in texels
  NETWORK (pooled)       the network: pooled, attended or descent (glint-train estimator --network)
  CHANNELS ()            the network's channels (glint-train estimator --channels)
  LR (3e-4)              peak learning rate
  POOL_THREADS (cores − 3)   threads that make materials
  TRAINER ()             a glint-train to use instead of building one; BUILD (build-trainer): where to build it
  SYNTH (build/bin/glint-synth)
  PART_BYTES (15000000)  largest part of a weights file
HELP
}

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
out=${OUT:-$root/training/run}
pack=${PACK:-$out/materials.safetensors}
build=${BUILD:-$root/build-trainer}
trainer=${TRAINER:-$build/bin/glint-train}
weights=$out/estimator.safetensors
float32=$out/estimator_float32.safetensors
most_failures=5 # of the trainer itself, in one training

fail() {
  echo "training/gpu_run.sh: $*" >&2
  exit 1
}

running() {
  [ -f "$out/pid" ] && kill -0 "$(cat "$out/pid")" 2>/dev/null
}

build_trainer() {
  [ -n "${TRAINER:-}" ] && return
  local prefix=
  prefix=$(python3 -c 'import torch; print(torch.utils.cmake_prefix_path)' 2>/dev/null) || true
  local generator=()
  command -v ninja >/dev/null && generator=(-G Ninja)
  cmake -S "$root" -B "$build" "${generator[@]}" -DCMAKE_BUILD_TYPE=Release -DGLINT_TRAINER_ONLY=ON \
    ${prefix:+-DCMAKE_PREFIX_PATH="$prefix"}
  cmake --build "$build" --target glint-train --parallel "$(nproc)"
}

# Pictures of the folder $1, and of the folders in it, as PNM files below $2.
decode() {
  if python3 -c 'import PIL' 2>/dev/null; then
    python3 - "$1" "$2" <<'PYTHON'
import concurrent.futures, pathlib, sys
from PIL import Image
source, target = map(pathlib.Path, sys.argv[1:])
def convert(path):
    to = target / path.relative_to(source).with_suffix('.ppm')
    to.parent.mkdir(parents=True, exist_ok=True)
    with Image.open(path) as image:
        image = image.convert('L' if image.mode in ('L', '1') else 'RGB')
        image.save(to.with_suffix('.pgm' if image.mode == 'L' else '.ppm'))
with concurrent.futures.ThreadPoolExecutor() as pool:
    list(pool.map(convert, sorted(source.rglob('*.jp*g'))))
PYTHON
    return
  fi
  local picture to
  (cd "$1" && find . -name '*.jp*g') | while read -r picture; do
    to=$2/${picture%.*}.ppm
    mkdir -p "$(dirname "$to")"
    if command -v djpeg >/dev/null; then
      djpeg -pnm "$1/$picture" >"$to"
    elif command -v convert >/dev/null; then
      convert "$1/$picture" -depth 8 "$to"
    else
      fail "$1: found JPEGs and nothing that reads them; install python3 with Pillow, djpeg or ImageMagick, or give PACK"
    fi
  done
}

pack_materials() {
  [ -f "$pack" ] || [ -z "${MATERIALS:-}" ] && return
  local folders folder synth=${SYNTH:-$root/build/bin/glint-synth}
  IFS=: read -r -a folders <<<"$MATERIALS"
  for folder in "${folders[@]}"; do
    [ -d "$folder" ] || fail "MATERIALS: found $folder, which is no folder; give folders of materials, separated by colons"
  done
  if [ -x "$synth" ]; then
    "$synth" pack "${folders[@]}" --out "$pack"
    return
  fi
  local decoded=() k=0
  for folder in "${folders[@]}"; do
    decode "$folder" "$out/pnm/$k"
    decoded+=("$out/pnm/$k")
    k=$((k + 1))
  done
  "$trainer" pack "${decoded[@]}" --out "$pack"
  rm -r "$out/pnm"
}

# The weights in parts that fit where files may not be large, and what joins them.
split_weights() {
  local parts=$out/weights file
  rm -rf "$parts.new"
  mkdir -p "$parts.new"
  for file in "$weights" "$float32"; do
    split -d -a 2 -b "${PART_BYTES:-15000000}" "$file" "$parts.new/$(basename "$file").part-"
    (cd "$(dirname "$file")" && sha256sum "$(basename "$file")") >>"$parts.new/SHA256SUMS"
  done
  cat >"$parts.new/join.sh" <<'JOIN'
#!/bin/bash
# Joins the parts beside this script into whole files there and compares their checksums.
set -euo pipefail
cd "$(dirname "$0")"
while read -r _ file; do cat "$file".part-* >"$file"; done <SHA256SUMS
sha256sum -c SHA256SUMS
JOIN
  chmod +x "$parts.new/join.sh"
  rm -rf "$parts"
  mv "$parts.new" "$parts"
}

# The detached part: the trainer, started again where it fails, then the weights' parts.
supervise() {
  local failures=0
  until "$trainer" "$@"; do
    failures=$((failures + 1))
    if [ $failures -ge $most_failures ]; then
      echo "failed: glint-train ended with an error $failures times; see $out/log" >"$out/status"
      exit 1
    fi
    # From the second failure on from the checkpoint before, if there is one: the last may be why.
    if [ $failures -gt 1 ] && [ -f "$weights.checkpoint.previous" ]; then
      mv "$weights.checkpoint.previous" "$weights.checkpoint"
    fi
    echo "glint-train ended with an error; started again from its checkpoint"
    sleep 2
  done
  split_weights
  echo "done: $weights and its parts in $out/weights" >"$out/status"
}

train() {
  local minutes=$1 from=
  shift
  if [ $# -gt 0 ] && [ "$1" != -- ]; then
    from=$1
    [ -f "$from" ] || fail "FROM: found $from, which is no file; give weights written by glint-train"
    shift
  fi
  [ "${1:-}" = -- ] && shift
  running && fail "$out/pid: found a training that runs; wait for it, stop it, or give another OUT"
  mkdir -p "$out"
  build_trainer
  [ -x "$trainer" ] || fail "$trainer: found no program; give TRAINER, or none to build it"
  pack_materials
  local threads=$(($(nproc) > 4 ? $(nproc) - 3 : 1))
  local options=(estimator --out "$weights" --float32 "$float32" --resume --supervise --minutes "$minutes"
    --device "${DEVICE:-cuda}" --network "${NETWORK:-pooled}" --batch "${BATCH:-128}" --batch-photographs "${PHOTOGRAPHS:-256}"
    --crop "${CROPS:-128,128,256}" --lr "${LR:-3e-4}" --warmup 500 --average-decay 0.9995 --normal-weight 1.5
    --glossy-dielectric-share 0.2 --one-substance-share 0.25 --metal-share 0.1 --varnish-share 0.5
    --pool-threads "${POOL_THREADS:-$threads}" --pool-first 600 --pool-window 6000 --pool-per-step 2
    --checkpoint-minutes 1.5)
  [ -n "${CHANNELS:-}" ] && options+=(--channels "$CHANNELS")
  [ -n "$from" ] && options+=(--from "$from")
  [ -f "$pack" ] && options+=(--materials "$pack")
  echo training >"$out/status"
  setsid nohup "$root/training/gpu_run.sh" in-background "${options[@]}" "$@" >>"$out/log" 2>&1 </dev/null &
  echo $! >"$out/pid"
  echo "training in process $!; log: $out/log, losses: $weights.csv"
}

wait_for() {
  local until=$((SECONDS + ${1:-31536000}))
  while running && [ $SECONDS -lt $until ]; do sleep 0.2; done
  [ -f "$out/log" ] && tail -n 1 "$out/log"
  cat "$out/status" 2>/dev/null || fail "$out/status: found no training; start one with MINUTES"
  if ! running && [ "$(cat "$out/status")" = training ]; then
    fail "the training was ended from outside; call with MINUTES to go on from its checkpoint"
  fi
  ! grep -q '^failed' "$out/status"
}

stop() {
  running || fail "$out/pid: found no training that runs"
  kill -- "-$(cat "$out/pid")"
}

case "${1:-}" in
  "" | -h | --help) usage ;;
  wait) wait_for "${2:-}" ;;
  stop) stop ;;
  in-background) shift && supervise "$@" ;;
  *)
    [[ $1 =~ ^[0-9]+(\.[0-9]+)?$ ]] || fail "MINUTES: found $1; give a number (--help)"
    train "$@"
    ;;
esac
