#!/bin/bash
# Commands whose memory a control group limits: arguments TESSERA SOURCE_DIR. Needs root, and control groups that it may
# make. What does not fit is said in one line, and nothing is left; nothing is ended by the system.
tessera=$1
source "$2/tests/e2e/common.bash"
skip() {
    echo "skipped: $*"
    exit 77
}
[ "$(id -u)" = 0 ] || skip "only root may limit memory"
groups=/sys/fs/cgroup limit=memory.max
if [ -d $groups/memory ]; then groups=$groups/memory limit=memory.limit_in_bytes; fi
group=$groups/tessera-test-$$
mkdir "$group" 2>/dev/null || skip "no control group can be made"
trap 'rmdir "$group"; rm -rf "$work"' EXIT
echo 500000000 2>/dev/null >"$group/$limit" || skip "a control group cannot limit memory"
limited() { # limited COMMAND...: in the group
    # shellcheck disable=SC2016
    bash -c 'echo $$ >"$0/cgroup.procs" || exit 99; exec "$@"' "$group" "$@"
}
limited true || skip "no process can be moved into a control group"
refused() { # refused COMMAND...
    check "$1 beyond the limit" 3 limited "$tessera" "$@"
    say "not enough memory" err.txt
    [ "$(wc -l <err.txt)" = 1 ] || fail "$1: not one line: $(cat err.txt)"
    rm out.txt err.txt
    for part in *.part-*; do [ ! -e "$part" ] || fail "$1 leaves $part"; done
}

truncate -s 400000000 zero.raw
echo '{"dims": [500, 500, 400], "dtype": "float32", "parameters": ["v"]}' >zero.json
check "pack in slabs" 0 limited "$tessera" pack zero.json -o zero.tsr
check "unpack" 0 limited "$tessera" unpack zero.tsr -o zero.vti
rm -f zero.vti
check "stats of an archive" 0 limited "$tessera" stats zero.tsr
say "100 000 000" out.txt
check "a picture of an archive" 0 limited "$tessera" render zero.tsr -o zero.png --size 500x300
refused pack zero.json -o bcc.tsr --lattice bcc
refused mesh zero.tsr --iso 0.5 -o zero.stl
refused stats zero.json
refused diff zero.tsr zero.json
refused render zero.json -o refused.png --size 500x300
finish
