#!/bin/sh
# kill_loop.sh PYTHON WORKER: a few rounds of kills in a folder of their own, removed when all is well.
set -eu
folder=$(mktemp -d)
"$1" "$(dirname "$0")/kill_loop.py" --rounds 3 "$folder/kills" "$2" OUT
rm -r "$folder"
