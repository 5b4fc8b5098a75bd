#!/bin/bash
# The C library for solvers: what a C program (tests/writer/solver.c) appends comes back; killed at random moments, what it
# had acknowledged is readable, and it goes on from there. Arguments TESSERA SOURCE_DIR.
tessera=$1 source=$2
source "$source/tests/e2e/common.bash"
solver=$(dirname "$tessera")/writer_solver
times=40

check "wrong arguments" 0 "$solver" arguments wrong.tsr
check "after them" 0 "$tessera" verify wrong.tsr
say '"lengthUnit": ""' <("$tessera" info wrong.tsr --json) # the solver states none there
[ "$(ls wrong.tsr*)" = wrong.tsr ] || fail "parts are left: $(ls wrong.tsr*)"

samples() { # samples ARCHIVE TIMES BOUND: intact, and each sample what solver.c computes, within so much of its range
    "$tessera" verify "$1" > /dev/null || fail "verify $1"
    "$tessera" unpack "$1" -o back.raw > /dev/null || fail "unpack $1"
    python3 - "$2" "$3" << 'END' || fail "other samples in $1"
import json, math, struct, sys
times, bound, n = int(sys.argv[1]), float(sys.argv[2]), 11 * 7 * 40
about, data = json.load(open("back.json")), open("back.raw", "rb").read()
assert about["times"] == list(range(times)), about["times"]
assert about["dims"] == [11, 7, 40] and about["spacing"] == [.5, .5, .25] and about["origin"] == [1, 2, 3], about
names = [(c["name"], c["unit"]) for c in about["components"]]
assert names == [("T", "K"), ("U.x", "m/s"), ("U.y", "m/s"), ("U.z", "m/s")], names
values = struct.unpack("<%df" % (4 * n * times), data)
single = lambda x: struct.unpack("f", struct.pack("f", x))[0]
for t in range(times):
    for a, c in enumerate([0, 0, 1, 2]):
        for i in range(n):
            is_, was = values[(t * 4 + a) * n + i], single(math.sin(0.01 * i * (c + 1)) + 0.125 * t)
            if a == 0 and i % 13 == 0: assert not math.isfinite(is_), is_
            else: assert abs(is_ - was) <= bound * (2 + 0.125 * t), (t, a, i, is_, was)
END
}
check "all times" 0 "$solver" whole.tsr $times new 0 0
samples whole.tsr $times 0
# Every 13th sample of T is not finite: absent, and no neighbour is resampled from it.
check "bricks" 0 "$tessera" info whole.tsr --bricks --json
python3 -c 'import json; b=json.load(open("out.txt"))["bricks"]; f={x["channel"]: x["presentFraction"] for x in b}; assert abs(f["T"]-2843/3080)<1e-6 and f["U.x"]==1, f' ||
    fail "$(head -c 300 out.txt)"
check "with an error" 0 "$solver" lossy.tsr $times new 0 0.01
samples lossy.tsr $times 0.01
[ "$(stat -c %s lossy.tsr)" -lt "$(stat -c %s whole.tsr)" ] || fail "an error saves nothing"
check "on BCC" 0 "$solver" bcc.tsr 3 new 1 0
check "verify BCC" 0 "$tessera" verify bcc.tsr
say "on BCC, from a grid of 11 x 7 x 40" <("$tessera" info bcc.tsr)
check "samples on BCC" 0 "$tessera" stats bcc.tsr
say "^T \[K\] .* 92.3 %" out.txt

# Axes of uneven spacing.
check "axes" 0 "$solver" axes axes.tsr
check "verify axes" 0 "$tessera" verify axes.tsr
"$tessera" info axes.tsr --json > axes.json
python3 - << 'END' || fail "other axes: $(head -c 600 axes.json)"
import json
about = json.load(open("axes.json"))
assert about["times"] == [0, 1] and about["size"] == [4, 3, 2], about
x, y, z = about["axes"]
assert y is None and x == {"of": "points", "planes": [0.1, 0.2, 1 / 3, 7]} and z == {"of": "cells", "planes": [-1e-3, 0, 1e-5]}, about
assert about["bounds"] == [[0.1, 1.75, -1e-3], [7, 3.25, 1e-5]], about["bounds"]
END

# Killed and started again until it is done.
kills=0 known=0
: > said
while [ "$known" -lt $times ] && [ $kills -lt 200 ]; do
    "$solver" live.tsr $times continue 0 0 20 >> said 2> err &
    pid=$!
    sleep "0.$((RANDOM % 4))$((RANDOM % 10))"
    kill -KILL $pid 2> /dev/null && kills=$((kills + 1))
    wait $pid 2> /dev/null
    [ -s said ] || continue
    known=$("$tessera" info live.tsr | sed -n 's/^ *times *\([0-9]*\).*/\1/p')
    # Each is acknowledged once; a kill may come between the commit and the line.
    [ "$known" -gt "$(tail -n 1 said)" ] || fail "time $(tail -n 1 said) was acknowledged, the archive has $known"
    [ -s err ] && { fail "the solver: $(cat err)"; break; }
done
check "the end" 0 "$solver" live.tsr $times continue 0 0
echo "killed $kills times"
[ $kills -ge 3 ] || fail "killed $kills times only"
samples live.tsr $times 0
[ -z "$(sort said | uniq -d)" ] || fail "a time was appended twice"

# A new run replaces the archive of the one before by its first time.
check "a new run" 0 "$solver" live.tsr 2 new 0 0
samples live.tsr 2 0
finish
