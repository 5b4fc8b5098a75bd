#!/bin/bash
# The most used mouse and key actions, in the real window: see hands.py. usage: hands.sh TESSERA SOURCE_DIR
source "$2/tests/e2e/display.bash"
command -v python3 >/dev/null || { echo "skipped: no python3"; exit 77; }
start
python3 "$source/tests/e2e/hands.py" || fail "hands"
