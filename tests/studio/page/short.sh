#!/usr/bin/env bash
# short.sh PROGRAMS: the first page of a real Studio in a real browser, without npm: its script runs under the server's policy.
# Exit code 77 (skipped) where there is no chromium, or the programs were built without pages.
set -euo pipefail
chromium=$(command -v "${CHROMIUM:-chromium}") || { echo "no chromium"; exit 77; }
programs=$1
work=$(mktemp -d)
studio=
end() {
  [ -z "$studio" ] || kill "$studio" 2>/dev/null || true
  rm -rf "$work"
}
trap end EXIT
mkdir "$work/captures"
"$programs/glint-studio" --no-browser --port 0 "$work/captures" >"$work/said" 2>&1 &
studio=$!
address=
for _ in $(seq 100); do
  address=$(grep -o 'http://127\.0\.0\.1:[0-9]*/[^ ]*' "$work/said" | head -n 1) && break
  kill -0 "$studio" 2>/dev/null || { cat "$work/said"; exit 1; }
  sleep 0.1
done
timeout 60 "$chromium" --headless --no-sandbox --disable-gpu --user-data-dir="$work/profile" \
  --dump-dom "$address" >"$work/page" 2>"$work/browser" || { tail -n 5 "$work/browser"; exit 1; }
grep -q '<div id="app">' "$work/page" || { echo "built without pages"; exit 77; }
# The page is dumped as it loads, before it has asked for captures.
grep -qF '>Library</h1>' "$work/page" || { echo "the first page has no title:"; cat "$work/page"; exit 1; }
echo "the first page stands"
