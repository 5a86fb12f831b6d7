#!/usr/bin/env bash
# Opens a report in a headless browser and lets it try itself: pictures, slider, zoom, tables, no network.
#   bench/report/check.sh REPORT.html
set -euo pipefail
page=$(realpath "$1")
home=$(mktemp -d)
trap 'rm -rf "$home"' EXIT
dom=$(HOME=$home timeout 120 chromium --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --user-data-dir="$home" \
  --window-size=1200,900 --virtual-time-budget=20000 --dump-dom "file://$page#test" 2>/dev/null | grep -o '<html[^>]*>' | head -n 1)
if [[ $dom != *'data-test="passed"'* ]]; then
  echo "limn bench: the report fails in the browser: $dom" >&2
  exit 1
fi
