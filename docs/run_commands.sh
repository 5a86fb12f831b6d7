#!/usr/bin/env bash
# Runs the commands of a page: run_commands.sh PAGE.md, in the current folder, with limn on the PATH.
set -euo pipefail
awk '/^```sh$/ { inside = 1; next } /^```/ { inside = 0 } inside' "$1" | bash -euo pipefail
