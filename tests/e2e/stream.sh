#!/bin/bash
# `tessera pack -`: frames that come through a pipe, in pieces, become the times of an archive, sample for sample; an archive is
# continued; what cannot be right is said, and what was whole stays. Arguments TESSERA SOURCE_DIR.
tessera=$1 source=$2
source "$source/tests/e2e/common.bash"

export TMPDIR=$work/tmp
mkdir "$TMPDIR"

cat > solver.py << 'END'
"""Frames of T (4 x 3 x 2 samples, floats) and U (a vector) for the steps named, or with "timed" with their times before them."""
import struct, sys, time
steps, timed = [int(x) for x in sys.argv[1].split(",")], "timed" in sys.argv
order = ">" if "big" in sys.argv else "<"
for step in steps:
    out = struct.pack(order + "d", 0.25 * step) if timed else b""
    out += b"".join(struct.pack(order + "f", 1000 * c + 100 * step + i) for c in range(4) for i in range(24))
    for at in (0, 3, 100):  # in pieces that have nothing to do with samples
        sys.stdout.buffer.write(out[at:{0: 3, 3: 100, 100: None}[at]])
        sys.stdout.flush()
        time.sleep(0.01)
if "cut" in sys.argv: sys.stdout.buffer.write(b"1234567890")
END
cat > form.json << 'END'
{ "dims": [4, 3, 2], "dtype": "float32", "spacing": [0.5, 0.5, 2], "length_unit": "mm",
  "components": [{ "name": "T", "unit": "K" }, { "name": "U.x", "unit": "m/s" }, { "name": "U.y", "unit": "m/s" },
                 { "name": "U.z", "unit": "m/s" }] }
END
big=form.big.json
python3 -c 'import json; form = json.load(open("form.json")); form["byte_order"] = "big"; print(json.dumps(form))' > $big

holds() { # holds ARCHIVE TIMES STEPS: intact, these times, and the samples that the solver computes at these steps
    "$tessera" verify "$1" > /dev/null || fail "verify $1"
    "$tessera" unpack "$1" -o back.raw > /dev/null || fail "unpack $1"
    "$tessera" info "$1" --json > info.json
    python3 - "$1" "$2" "$3" << 'END' || fail "$1 holds something else"
import json, struct, sys
archive, times, steps = sys.argv[1], json.loads(sys.argv[2]), json.loads(sys.argv[3])
about, data = json.load(open("back.json")), open("back.raw", "rb").read()
assert about["times"] == times, about["times"]
assert about["dims"] == [4, 3, 2] and about["spacing"] == [0.5, 0.5, 2], about
assert [(p["name"], p["unit"]) for p in json.load(open("info.json"))["parameters"]] == [("T", "K"), ("U", "m/s")]
assert json.load(open("info.json"))["name"] == archive.split(".")[0].split("-")[0]
want = [1000 * c + 100 * step + i for step in steps for c in range(4) for i in range(24)]
assert list(struct.unpack("<%df" % len(want), data)) == want
END
}

exact=(--lattice cc --lossless)
python3 solver.py 0,1,2 | "$tessera" pack - -o live.tsr --raw form.json --time-step 0.5 "${exact[@]}" > lines || fail "a stream"
holds live.tsr "[0, 0.5, 1]" "[0, 1, 2]"
sed 's/ (.*//' lines > said
for i in "0 0" "0.5 1" "1 2"; do echo "live.tsr: time ${i% *} of frame ${i#* } appended"; done | cmp - said || cat lines

# It goes on after the last time, with the options of the archive; as JSON.
python3 solver.py 3,4 | "$tessera" pack - --append -o live.tsr --raw form.json --time-step 0.5 --json > lines ||
    fail "a stream that continues"
holds live.tsr "[0, 0.5, 1, 1.5, 2]" "[0, 1, 2, 3, 4]"
python3 -c 'import json; l = [json.loads(x) for x in open("lines")]
assert [(x["frame"], x["time"], x["times"]) for x in l] == [(0, 1.5, 4), (1, 2, 5)], l' || cat lines

# Also where the archive does not begin at 0 or has another step.
python3 solver.py 0,1 timed | "$tessera" pack - -o after.tsr --raw form.json --times-given "${exact[@]}" > lines || fail "times of its own"
holds after.tsr "[0, 0.25]" "[0, 1]"
python3 solver.py 2,3 | "$tessera" pack - --append -o after.tsr --raw form.json --time-step 1.5 > lines || fail "another step"
holds after.tsr "[0, 0.25, 1.75, 3.25]" "[0, 1, 2, 3]"

# Without --append it replaces; a file is read as a pipe is.
python3 solver.py 7 > frames
check "replaced" 0 "$tessera" pack - -o live.tsr --raw form.json "${exact[@]}" < frames
holds live.tsr "[0]" "[7]"

# With their own times, big-endian; a solver that starts again from a checkpoint repeats times.
python3 solver.py 1,3 timed big | "$tessera" pack - -o timed.tsr --raw $big --times-given "${exact[@]}" > lines || fail "times"
holds timed.tsr "[0.25, 0.75]" "[1, 3]"
python3 solver.py 2,3,5 timed big | "$tessera" pack - --append -o timed.tsr --raw $big --times-given > lines 2> err ||
    fail "times again"
holds timed.tsr "[0.25, 0.75, 1.25]" "[1, 3, 5]"
say "time 0.5 of frame 0 is in the archive already" err
say "time 0.75 of frame 1 is in the archive already" err
python3 solver.py 6,6 timed big > frames
check "a time twice" 2 "$tessera" pack - --append -o timed.tsr --raw $big --times-given < frames
say "not after the last one, 1.5" err.txt
holds timed.tsr "[0.25, 0.75, 1.25, 1.5]" "[1, 3, 5, 6]"

# A frame that is cut is left out, and said.
python3 solver.py 0,1 cut > frames
check "a cut frame" 2 "$tessera" pack - -o cut.tsr --raw form.json "${exact[@]}" < frames
say "ends within frame 2, after 10 of 384 bytes; the frames before are in the archive" err.txt
holds cut.tsr "[0, 1]" "[0, 1]"

# SIGTERM ends it between frames, with what it has.
mkfifo pipe
"$tessera" pack - -o held.tsr --raw form.json "${exact[@]}" < pipe > lines 2> err &
pid=$!
exec 3> pipe
python3 solver.py 0 >&3
head -c 100 frames >&3
for i in $(seq 100); do grep -q appended lines && break; sleep 0.1; done
kill -TERM $pid
wait $pid || fail "SIGTERM: $(cat err)"
exec 3>&-
holds held.tsr "[0]" "[0]"
ls -d "$TMPDIR"/tessera-frames* 2> /dev/null && fail "frames are left"

# A killed one leaves the frame that it was reading, which the next one removes; not that of one that runs.
"$tessera" pack - -o killed.tsr --raw form.json "${exact[@]}" < pipe > lines 2> err &
pid=$!
exec 3> pipe
head -c 100 frames >&3
for i in $(seq 100); do [ -n "$(ls "$TMPDIR"/tessera-frames.part-$pid 2> /dev/null)" ] && break; sleep 0.1; done
python3 solver.py 7 | "$tessera" pack - -o beside.tsr --raw form.json "${exact[@]}" > lines || fail "a stream beside another"
[ -d "$TMPDIR"/tessera-frames.part-$pid ] || fail "frames of a stream that runs are removed"
kill -KILL $pid
wait $pid 2> /dev/null
exec 3>&-
[ -d "$TMPDIR"/tessera-frames.part-$pid ] || fail "nothing was left to remove"
python3 solver.py 7 | "$tessera" pack - -o beside.tsr --raw form.json "${exact[@]}" > lines || fail "a stream after a kill"
ls -d "$TMPDIR"/tessera-frames* 2> /dev/null && fail "frames of a killed stream are left"

# What cannot be a stream.
bad() { # bad TEXT OPTIONS...
    local text=$1
    shift
    check "$*" 2 "$tessera" pack "$@" < /dev/null
    say "$text" err.txt
}
bad "needs the layout of a frame" - -o no.tsr
bad "no frame arrived" - -o no.tsr --raw form.json
bad "is one time" - -o no.tsr --raw dims=4x3x2,type=u8,times=2
bad "no such file" - -o no.tsr --raw absent.json
bad "packed alone" - form.json -o no.tsr --raw form.json
bad "no archive to append to" - --append -o no.tsr --raw form.json
bad "D4" - -o no.tsr --raw form.json --lattice d4
bad "is for frames on standard input" form.json -o no.tsr --time-step 2
bad "how many frames" - -o no.tsr --raw form.json --progress-json
check "two ways of times" 1 "$tessera" pack - -o no.tsr --raw form.json --times-given --time-step 2
[ ! -e no.tsr ] || fail "an archive of nothing"
finish
