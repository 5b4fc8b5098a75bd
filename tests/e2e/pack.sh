#!/bin/bash
# pack, info, verify and unpack as a user runs them: arguments TESSERA SOURCE_DIR. Exit 77 skips (nothing to do so yet).
tessera=$1
source "$2/tests/e2e/common.bash"

# A ramp of 16-bit numbers: 9 x 7 x 5, two times, two components.
python3 - <<'EOF'
import json, struct
numbers = [(i * 37 + i * i) % 65536 for i in range(9 * 7 * 5 * 2 * 2)]
open("ramp.raw", "wb").write(struct.pack("<%dH" % len(numbers), *numbers))
json.dump({"dims": [9, 7, 5], "dtype": "uint16", "times": [0, 0.5],
           "components": [{"name": "a", "unit": "K"}, {"name": "b", "unit": "Pa"}]}, open("ramp.json", "w"))
EOF

check "pack as CC" 0 "$tessera" pack ramp.json -o cc.tsr --lattice cc --json
say '"archiveBytes"' out.txt
check "verify" 0 "$tessera" verify cc.tsr
say whole out.txt
check "info" 0 "$tessera" info cc.tsr
say "9 x 7 x 5" out.txt
check "info --json" 0 "$tessera" info cc.tsr --json
python3 -c 'import json,sys; d=json.load(open("out.txt")); assert d["size"]==[9,7,5] and d["times"]==[0,0.5] and d["lossless"] and [p["name"] for p in d["parameters"]]==["a","b"], d' || failures=$((failures + 1))
check "info --bricks" 0 "$tessera" info cc.tsr --bricks --json
python3 -c 'import json; d=json.load(open("out.txt"))["bricks"]; assert len(d)==4 and all("histogram" not in b for b in d), d' || failures=$((failures + 1))
check "unpack" 0 "$tessera" unpack cc.tsr -o back.raw
cmp ramp.raw back.raw || fail "not the same samples"
check "its sidecar opens" 0 "$tessera" info back.json
check "unpack .vti" 0 "$tessera" unpack cc.tsr -o back.vti -t 0.5
check "unpack .nrrd" 0 "$tessera" unpack cc.tsr -o back.nrrd -p b -t 0
check "a coarse level" 0 "$tessera" unpack cc.tsr -o coarse.raw -l 1
check "pack as BCC" 0 "$tessera" pack ramp.json -o bcc.tsr --lattice bcc
check "verify BCC" 0 "$tessera" verify bcc.tsr --json
say '"ok": true' out.txt
check "unpack BCC" 0 "$tessera" unpack bcc.tsr -o grid.raw
check "info of BCC" 0 "$tessera" info bcc.tsr
say "resampled to BCC and back to the samples of the source (largest error .*; labels and absent samples are exact" out.txt
say "resampled: PSNR " out.txt
check "info of BCC as JSON" 0 "$tessera" info bcc.tsr --json
python3 - <<'EOF' || fail "another error than unpacking gives"
import json, math, struct
about, told = json.load(open("ramp.json")), json.load(open("out.txt"))
a, b = (open(name, "rb").read() for name in ("ramp.raw", "grid.raw"))
a, b = (struct.unpack("<%dH" % (len(x) // 2), x) for x in (a, b))
n, parameters = 9 * 7 * 5, told["parameters"]
for p, parameter in enumerate(parameters):
    apart = [abs(a[i] - b[i]) for t in range(2) for i in range((t * 2 + p) * n, (t * 2 + p + 1) * n)]
    extent = parameter["ranges"][0][1] - parameter["ranges"][0][0]
    psnr = 20 * math.log10(extent / math.sqrt(sum(x * x for x in apart) / len(apart)))
    assert parameter["resampled"]["largest"] == max(apart) and abs(parameter["resampled"]["psnr"] - psnr) < 1e-6, (psnr, parameter)
EOF

# What contradicts itself, and names under which nobody could open it.
for bound in "--max-error 0.01" "--psnr 60" "--preset visual"; do
    # shellcheck disable=SC2086
    check "lossless and $bound" 2 "$tessera" pack ramp.json -o no.tsr --lossless $bound
    say "--lossless: contradicts" err.txt
done
check "another ending" 2 "$tessera" pack ramp.json -o no.vti
say "ends with .tsr" err.txt
[ -z "$(ls no.* 2>/dev/null)" ] || fail "written: $(ls no.*)"

# Names of files need not be UTF-8.
odd=$'caf\xe9.tsr'
check "pack to an odd name" 0 "$tessera" pack ramp.json -o "$odd" --json
python3 -c 'import json; json.load(open("out.txt"))' || fail "no JSON: $(cat out.txt)"
check "verify an odd name" 0 "$tessera" verify "$odd" --json
say '"ok": true' out.txt
mkdir folder.tsr
check "pack to a folder" 2 "$tessera" pack ramp.json -o folder.tsr
say "folder.tsr: is a folder" err.txt

# Bricks that are alike, put together.
check "pack small bricks" 0 "$tessera" pack ramp.json -o bricks.tsr --lattice cc --brick-size 4
check "statistics of bricks" 0 "$tessera" info bricks.tsr --bricks --json
python3 -c 'import json; d=json.load(open("out.txt"))["bricks"]; assert len(d)==48 and sum(b["samples"] for b in d)==4*315 and all(sum(b["histogram"])==b["samples"] and b["range"][0]<b["mean"]<b["range"][1] for b in d), d' || failures=$((failures + 1))
check "info --merge" 0 "$tessera" info bricks.tsr --merge --merge.alike 1
say "as one" out.txt
check "info --merge --json" 0 "$tessera" info bricks.tsr --merge --merge.alike 1 --merge.shape mixed --json
python3 -c 'import json; m=json.load(open("out.txt"))["merged"]; assert [l["shape"] for l in m["layouts"]]==["uniform","mixed","best"] and m["layouts"][2]["bricks"]==1 and m["layouts"][1]["sizes"]=={"3x2x2":1} and m["bricks"][0]["end"]==[3,2,2] and m["bricks"][0]["bytesAsOne"]>0, m' || failures=$((failures + 1))
check "merging what is no archive" 2 "$tessera" info ramp.json --merge

# Absent samples keep their stored numbers: a fill value of the sidecar, NaN, a rule, and 0 that is also data elsewhere.
python3 - <<'EOF'
import json, math, struct
n = 9 * 7 * 5
a = [-999.0 if i % 5 == 0 else i * 0.25 for i in range(n)]
b = [math.nan if i % 7 == 0 else i * 0.1 for i in range(n)]
c = [0.0 if i % 3 == 0 else i / 3 for i in range(n)]
d = [0.0 if i % 9 < 4 else float(i % 3) for i in range(n)]
e = [1.0 if i % 9 >= 4 else 0.0 for i in range(n)]
open("gaps.raw", "wb").write(struct.pack("<%df" % (5 * n), *a, *b, *c, *d, *e))
json.dump({"dims": [9, 7, 5], "dtype": "float32",
           "components": [{"name": "a", "missing_value": -999}, {"name": "b"}, {"name": "c"}, {"name": "d"},
                          {"name": "e"}]}, open("gaps.json", "w"))
EOF
check "pack gaps" 0 "$tessera" pack gaps.json -o gaps.tsr --lattice cc --absent c=0 --no-auto-absent
check "unpack gaps" 0 "$tessera" unpack gaps.tsr -o gaps-back.raw
cmp gaps.raw gaps-back.raw || fail "absent samples differ"
check "pack what came back" 0 "$tessera" pack gaps-back.json -o again.tsr --lattice cc --no-auto-absent
[ "$("$tessera" info gaps.tsr --json | grep -A3 ranges)" = "$("$tessera" info again.tsr --json | grep -A3 ranges)" ] ||
    fail "other ranges"

# A vector of integers, each component with a scaling of its own, by the file or by the step of its loss.
python3 - <<'EOF'
import json, math, struct
n = 9 * 7 * 5
u = [int(12000 * math.sin(i * .01 * (c + 1))) for c in range(3) for i in range(n)]
open("scaled.raw", "wb").write(struct.pack("<%dh" % len(u), *u))
json.dump({"dims": [9, 7, 5], "dtype": "int16",
           "components": [{"name": "U." + "xyz"[c], "scale": [.1, .2, .5][c], "offset": [0, 3, -4][c]}
                          for c in range(3)]}, open("scaled.json", "w"))
EOF
check "pack a scaled vector" 0 "$tessera" pack scaled.json -o scaled.tsr --lattice cc
check "unpack it" 0 "$tessera" unpack scaled.tsr -o scaled-back.raw
cmp scaled.raw scaled-back.raw || fail "other integers"
check "pack it with loss" 0 "$tessera" pack scaled.json -o lossy.tsr --lattice cc --psnr 45
check "unpack that" 0 "$tessera" unpack lossy.tsr -o lossy-back.raw
python3 - <<'EOF' || failures=$((failures + 1))
import json, math, struct
n = 9 * 7 * 5
def physical(name):
    about, data = json.load(open(name + ".json")), open(name + ".raw", "rb").read()
    letter = {"int16": "h", "int32": "i", "float32": "f"}[about["dtype"]]
    values = struct.unpack("<%d%s" % (3 * n, letter), data)
    return [[c.get("offset", 0) + c.get("scale", 1) * v for v in values[i * n:(i + 1) * n]]
            for i, c in enumerate(about["components"])]
stored = physical("scaled")
assert physical("scaled-back") == stored
extent = max(max(a) - min(a) for a in stored)
for a, b in zip(stored, physical("lossy-back")):
    rms = math.sqrt(sum((x - y) ** 2 for x, y in zip(a, b)) / n)
    assert rms <= extent * 10 ** (-45 / 20), (rms, extent)
EOF

# Bytes packed with loss come back as bytes that hold values, in every format.
python3 - <<'EOF'
import json, struct
numbers = [i * 255 // 1319 for i in range(1320)]
open("bytes.raw", "wb").write(struct.pack("<1320B", *numbers))
json.dump({"dims": [12, 11, 10], "dtype": "uint8"}, open("bytes.json", "w"))
EOF
check "pack bytes with loss" 0 "$tessera" pack bytes.json -o bytes.tsr --lattice cc --abs-error 2
for format in raw nrrd vti; do check "unpack them to .$format" 0 "$tessera" unpack bytes.tsr -o bytes-back.$format; done
python3 - <<'EOF' || fail "codes in place of values"
import json
about, data = json.load(open("bytes-back.json")), open("bytes-back.raw", "rb").read()
assert about["dtype"] == "uint8" and "scale" not in about["components"][0], about
before = open("bytes.raw", "rb").read()
for i in (0, 660, 1319): assert abs(data[i] - before[i]) <= 2, (i, data[i], before[i])
assert max(abs(a - b) for a, b in zip(data, before)) == 2
assert open("bytes-back.nrrd", "rb").read()[-1320:] == data
assert data in open("bytes-back.vti", "rb").read()
EOF

# A series whose files have different number types, one of them named twice.
python3 - <<'EOF'
import json, struct
for number, (form, kind) in enumerate([("B", "uint8"), ("f", "float32"), ("h", "int16")]):
    open("mixed_%d.raw" % number, "wb").write(struct.pack("<60" + form, *[i * (number + 1) for i in range(60)]))
    json.dump({"dims": [5, 4, 3], "dtype": kind}, open("mixed_%d.json" % number, "w"))
EOF
check "a series of mixed types" 0 "$tessera" pack mixed_0.raw mixed_0.raw mixed_1.raw mixed_1.raw mixed_2.raw \
    -o mixed.tsr --lattice cc
check "unpack the mixed series" 0 "$tessera" unpack mixed.tsr -o mixed-back.raw
python3 -c 'import struct; v=struct.unpack("<180f", open("mixed-back.raw","rb").read()); assert v==tuple(float(i*(t+1)) for t in range(3) for i in range(60)), v' ||
    failures=$((failures + 1))

# Presets, and bounds in each unit.
python3 - <<'EOF'
import json, math, struct
wave = [300 + 40 * math.sin(x * .3) * math.cos(y * .2) + z * .7 for z in range(16) for y in range(17) for x in range(18)]
open("wave.raw", "wb").write(struct.pack("<%df" % len(wave), *wave))
json.dump({"dims": [18, 17, 16], "dtype": "float32", "components": [{"name": "T", "unit": "K"}]}, open("wave.json", "w"))
EOF
for preset in lossless visual small thesis; do
    check "preset $preset" 0 "$tessera" pack wave.json -o "$preset.tsr" --preset $preset --json
    check "verify preset $preset" 0 "$tessera" verify "$preset.tsr"
done
has() { # has FILE LATTICE LARGEST_ERROR: what info says of the archive
    check "info of $1" 0 "$tessera" info "$1" --json
    python3 -c 'import json,sys; d=json.load(open("out.txt")); sys.exit([d["lattice"], d["maxError"]] != [sys.argv[1], float(sys.argv[2])])' \
        "$2" "$3" || fail "$1 is not on $2 within $3"
}
check "an option overrides a preset" 0 "$tessera" pack wave.json -o preset.tsr --preset lossless --lattice bcc
has preset.tsr bcc 0
check "before it as well" 0 "$tessera" pack wave.json -o preset.tsr --max-error 0 --preset visual
has preset.tsr cc 0
check "a preset without a lattice keeps that of an archive" 0 "$tessera" convert lossless.tsr -o preset.tsr --preset visual
has preset.tsr cc 0.001
check "one with a lattice does not" 0 "$tessera" convert lossless.tsr -o preset.tsr --preset thesis
say "on BCC" <("$tessera" info preset.tsr)
check "unless it is stated" 0 "$tessera" convert lossless.tsr -o preset.tsr --preset thesis --lattice cc
say "on CC" <("$tessera" info preset.tsr)
check "no such preset" 1 "$tessera" pack wave.json -o x.tsr --preset best
check "unpack the lossless preset" 0 "$tessera" unpack lossless.tsr -o wave-back.raw
cmp wave.raw wave-back.raw || fail "the preset lossless is not"
[ "$(stat -c %s small.tsr)" -lt "$(stat -c %s visual.tsr)" ] || fail "small is not"
for bound in "--abs-error 0.25" "--psnr 60" "--max-error 0.001"; do
    # shellcheck disable=SC2086
    check "pack $bound" 0 "$tessera" pack wave.json -o bound.tsr --lattice cc $bound
    check "unpack $bound" 0 "$tessera" unpack bound.tsr -o bound.raw
    python3 - "$bound" <<'EOF' || fail "$bound is not kept"
import math, struct, sys
read = lambda name: struct.unpack("<%df" % (16 * 17 * 18), open(name, "rb").read())
a, b = read("wave.raw"), read("bound.raw")
errors = [abs(x - y) for x, y in zip(a, b)]
extent, rms = max(a) - min(a), math.sqrt(sum(e * e for e in errors) / len(errors))
option, bound = sys.argv[1].split()
measured = {"--abs-error": max(errors), "--max-error": max(errors) / extent, "--psnr": rms / extent * 10 ** 3 * 60}[option]
sys.exit(not 0 < measured <= float(bound))
EOF
done
check "a negative bound" 1 "$tessera" pack wave.json -o x.tsr --psnr -3

# No more memory than was allowed: the least that packing says it needs, for noise, which does not shrink; in `tall`
# frames go through in slabs.
python3 - <<'EOF'
import array, json, os, random
n = 96
frame = [random.random() for _ in range(n * n * n)]
with open("noise.raw", "wb") as file:
    for t in range(2): array.array("f", frame[t:] + frame[:t]).tofile(file)
json.dump({"dims": [n, n, n], "dtype": "float32", "times": [0, 1], "components": [{"name": "x"}]},
          open("noise.json", "w"))
dims = [64, 64, 1000]
with open("tall.raw", "wb") as file: file.write(os.urandom(2 * 2 * dims[0] * dims[1] * dims[2]))
json.dump({"dims": dims, "dtype": "uint16", "times": [0, 1], "components": [{"name": "x"}]}, open("tall.json", "w"))
# Eight times, for D4*.
for name, dims in (("eight", [64, 64, 64]), ("tall-eight", [64, 64, 400])):
    with open(name + ".raw", "wb") as file: file.write(os.urandom(8 * 2 * dims[0] * dims[1] * dims[2]))
    json.dump({"dims": dims, "dtype": "uint16", "times": list(range(8)), "components": [{"name": "x"}]},
              open(name + ".json", "w"))
EOF
for what in "noise --lattice cc" "noise --lattice bcc" "noise --lattice bcc --resample.filter bspline5" \
    "eight --lattice d4" "eight --lattice d4 --resample.filter sinc" "noise --lattice cc --max-error 0.001" \
    "noise --lattice bcc --resample.sharpen 1" "noise --lattice bcc --target-size 2.9" \
    "tall --lattice cc" "tall --lattice bcc --resample.filter bspline5" "tall-eight --lattice d4" \
    "tall-eight --lattice d4 --resample.filter bspline5" "tall --lattice cc --target-size 4" \
    "tall-eight --lattice d4 --target-size 8"; do
    data=${what%% *} how=${what#* }
    # shellcheck disable=SC2086
    check "too little memory, $what" 2 "$tessera" pack "$data.json" -o noise.tsr $how --memory 12
    least=$(sed -n 's/.*needs about \([0-9]*\) MB.*/\1/p' err.txt)
    [ -n "$least" ] || die "no least memory is said, $what"
    limits=$((least + 1))
    case $how in
    *target-size* | *bspline5*) ;; # they take longest
    *) [[ $data = tall* ]] && limits+=" $((least + 8))" || limits+=" $((least + 20))" ;;
    esac
    for memory in $limits; do
        # shellcheck disable=SC2086
        check "memory $memory, $what" 0 "$tessera" pack "$data.json" -o noise.tsr $how --memory $memory --json
        python3 - $memory "$data" <<'EOF' || fail "more than $memory MB, or no slabs, with $what"
import json, sys
done = json.load(open("out.txt"))
slabs = any("slabs" in note for note in done["notes"])
print("peak", done["peakMemory"] / 1e6, "MB,", "slabs" if slabs else "whole frames")
sys.exit(not 0 < done["peakMemory"] <= 1e6 * float(sys.argv[1]) or (sys.argv[2].startswith("tall") and not slabs))
EOF
    done
done
rm -f tall*.raw eight.raw
rm -f noise.raw noise.tsr

# An archive that grows: later times, then another parameter, come to the same as everything at once.
python3 - <<'EOF'
import json, math, struct
def frame(t, p): return [300 + 40 * math.sin(i * .03 + t) + p * (i % 50) for i in range(12 * 11 * 10)]
def series(name, times, parameters):
    open(name + ".raw", "wb").write(b"".join(struct.pack("<1320f", *frame(t, p)) for t in times for p in parameters))
    json.dump({"dims": [12, 11, 10], "dtype": "float32", "times": times,
               "components": [{"name": "Tp"[p], "unit": "K"} for p in parameters]}, open(name + ".json", "w"))
series("all", [0, 1, 2, 3], [0, 1])
series("early", [0, 1], [0])
series("late", [2, 3], [0])
series("other", [0, 1, 2, 3], [1])
series("many", list(range(8)), [0, 1])
EOF
check "pack all at once" 0 "$tessera" pack all.json -o all.tsr --abs-error 0.01
check "pack the early times" 0 "$tessera" pack early.json -o grown.tsr --abs-error 0.01
check "append later times" 0 "$tessera" pack late.json --append -o grown.tsr
say "of it from" out.txt
check "append a parameter" 0 "$tessera" pack other.json --append -o grown.tsr --json
say '"addedBytes"' out.txt
check "verify what has grown" 0 "$tessera" verify grown.tsr
check "info of what has grown" 0 "$tessera" info grown.tsr --json
python3 -c 'import json; d=json.load(open("out.txt")); assert d["version"]==3 and d["commits"]>=3 and d["times"]==[0,1,2,3] and [p["name"] for p in d["parameters"]]==["T","p"], d' || failures=$((failures + 1))
check "unpack all" 0 "$tessera" unpack all.tsr -o all-back.raw
check "unpack what has grown" 0 "$tessera" unpack grown.tsr -o grown-back.raw
cmp all-back.raw grown-back.raw || { echo "FAILED: growing gives other samples"; failures=$((failures + 1)); }
cp grown.tsr kept.tsr
check "times that are there" 2 "$tessera" pack early.json --append -o all.tsr
check "times before the last" 2 "$tessera" pack all.json --append -o grown.tsr
say "not after the last" err.txt
check "another grid" 2 "$tessera" pack wave.json --append -o grown.tsr
check "options of one's own" 2 "$tessera" pack late.json --append -o grown.tsr --psnr 40
check "nothing to append to" 2 "$tessera" pack late.json --append -o nothing.tsr
cmp grown.tsr kept.tsr || { echo "FAILED: a refused append has written"; failures=$((failures + 1)); }
printf unfinished >>grown.tsr
check "an unfinished append is ignored" 0 "$tessera" verify grown.tsr

# An archive packed anew: with an error, of a size, never above it; stages and time are told.
check "convert to another bound" 0 "$tessera" convert all.tsr -o converted.tsr --abs-error 0.5 --json
say '"stages"' out.txt
check "verify what was converted" 0 "$tessera" verify converted.tsr
[ "$(stat -c %s converted.tsr)" -lt "$(stat -c %s all.tsr)" ] || { echo "FAILED: a larger error takes more"; failures=$((failures + 1)); }
check "convert keeps the lattice" 0 "$tessera" convert cc.tsr -o converted.tsr
check "unpack it" 0 "$tessera" unpack converted.tsr -o back.raw
cmp ramp.raw back.raw || { echo "FAILED: converting changes samples"; failures=$((failures + 1)); }
# On BCC and D4* it keeps the grid its samples came from, and can grow.
check "pack a BCC archive that grows" 0 "$tessera" pack early.json -o early.tsr --lattice bcc
check "unpack it" 0 "$tessera" unpack early.tsr -o early-back.nrrd -t 1
for again in convert pack; do
    check "$again the BCC archive" 0 "$tessera" $again early.tsr -o again.tsr
    check "unpack what $again made" 0 "$tessera" unpack again.tsr -o again-back.nrrd -t 1
    cmp early-back.nrrd again-back.nrrd || fail "$again gives another grid or other samples"
done
check "convert it with an error" 0 "$tessera" convert early.tsr -o again.tsr --abs-error 0.01
check "append to what was converted" 0 "$tessera" pack late.json --append -o again.tsr
check "unpack that" 0 "$tessera" unpack again.tsr -o again-back.raw
[ "$(stat -c %s again-back.raw)" = $((4 * 1320 * 4)) ] || fail "it has not grown by two times of the same grid"
check "append an archive" 0 "$tessera" pack late.json -o late.tsr
check "to one on BCC" 0 "$tessera" pack late.tsr --append -o early.tsr
check "append one packed with loss" 0 "$tessera" pack early.json -o lossy.tsr --abs-error 0.01
check "later times of it" 0 "$tessera" pack late.json -o late.tsr --abs-error 0.01
error() { "$tessera" info "$1" --json | python3 -c 'import json,sys; print(json.load(sys.stdin)["maxError"])'; }
before="$(error lossy.tsr) $(error late.tsr)"
check "to another" 0 "$tessera" pack late.tsr --append -o lossy.tsr
say "now .* of it from" out.txt
python3 -c 'import sys; after, *before = map(float, sys.argv[1:]); sys.exit(not 0 < after <= max(before))' \
    $(error lossy.tsr) $before || fail "nothing was coded again, but errors are added"
check "verify what was joined" 0 "$tessera" verify lossy.tsr
check "pack D4*" 0 "$tessera" pack many.json -o d4.tsr --lattice d4
check "four times on D4*" 2 "$tessera" pack all.json -o few.tsr --lattice d4
say "needs 8 times or more, not 4" err.txt
check "convert D4*" 0 "$tessera" convert d4.tsr -o again.tsr
check "info of that" 0 "$tessera" info again.tsr --json
python3 -c 'import json; d=json.load(open("out.txt")); assert d["lattice"]=="d4" and d["sourceSize"]==[12,11,10], d' || fail "another grid of D4*"

# Errors add up, and are not forgotten.
check "pack with an error" 0 "$tessera" pack wave.json -o lossy.tsr --max-error 0.01
for again in convert pack; do
    check "$again it without" 0 "$tessera" $again lossy.tsr -o again.tsr
    check "info" 0 "$tessera" info again.tsr
    say "error within 0.01 of range" out.txt
done
check "convert with another" 0 "$tessera" convert lossy.tsr -o again.tsr --max-error 0.02
check "info" 0 "$tessera" info again.tsr
say "error within 0.03 of range" out.txt

check "convert what is no archive" 2 "$tessera" convert ramp.json -o x.tsr
check "convert onto itself" 2 "$tessera" convert cc.tsr -o cc.tsr
check "pack to a size" 0 "$tessera" pack wave.json -o sized.tsr --target-size 0.004
[ "$(stat -c %s sized.tsr)" -le 4000 ] || { echo "FAILED: above the size asked"; failures=$((failures + 1)); }
check "no such size" 2 "$tessera" pack wave.json -o x.tsr --target-size 0.0001
check "too little memory" 2 "$tessera" pack wave.json -o x.tsr --memory 1
check "progress as JSON" 0 "$tessera" pack wave.json -o sized.tsr --progress-json
say '"fraction"' out.txt

# Wrong usage 1, bad input 2 with one line, and nothing left behind.
check "no output" 1 "$tessera" pack ramp.json
check "no such wavelet" 1 "$tessera" pack ramp.json -o x.tsr --wavelet 9,9
check "missing input" 2 "$tessera" pack nothing.raw -o x.tsr
check "no such level" 2 "$tessera" unpack cc.tsr -o x.raw -l 17
check "no such parameter" 2 "$tessera" unpack cc.tsr -o x.raw -p c
check "unwritable" 3 "$tessera" pack ramp.json -o no/such/folder/x.tsr
check "onto its input" 2 "$tessera" pack ramp.raw -o ramp.raw
head -c 500 cc.tsr >cut.tsr
check "a cut archive" 2 "$tessera" verify cut.tsr
[ "$(wc -l <err.txt)" = 1 ] || { echo "FAILED: not one line:"; cat err.txt; failures=$((failures + 1)); }
python3 -c 'b=bytearray(open("cc.tsr","rb").read()); b[200]^=4; open("flip.tsr","wb").write(b)'
check "a flipped bit" 2 "$tessera" verify flip.tsr
say damaged err.txt
say "of .* cannot be read, the rest can; 1 place is damaged" err.txt
python3 -c 'b=bytearray(open("cc.tsr","rb").read()); b[100]^=4; open("head.tsr","wb").write(b)'
check "a flipped bit of one header" 0 "$tessera" verify head.tsr
say "but for one copy of the header" out.txt
say "one of its two copies is damaged" err.txt
check "the same as JSON" 0 "$tessera" verify head.tsr --json
say '"damaged": 1' out.txt
say '"damagedBricks": 0' out.txt
check "is not unpacked" 2 "$tessera" unpack flip.tsr -o x.raw
head -c 100 ramp.raw >short.raw
cp ramp.json short.json
check "a short raw file" 2 "$tessera" pack short.raw -o x.tsr
ls x.* ./*.part-* 2>/dev/null && fail "something was left behind"

# Real volumes, where they are: bit for bit.
data=${TESSERA_DATA:-${TESSERA_TEST_DATA:-}}
for raw in "$data"/volumes/{nucleon,tooth,gfs,colpex}*.raw; do
    [ -f "$raw" ] || continue
    check "pack $raw" 0 "$tessera" pack "$raw" -o real.tsr --lattice cc
    check "verify $raw" 0 "$tessera" verify real.tsr
    check "unpack $raw" 0 "$tessera" unpack real.tsr -o real.raw
    cmp "$raw" real.raw || fail "$raw differs"
done
# A limit of the size of files, or a quota, ends a write as a full disk does.
for command in "pack ramp.json -o limited.tsr --lattice cc --wavelet 1,0 --brick-size 4" "unpack cc.tsr -o limited.raw" "unpack cc.tsr -o limited.vti -t 0.5"; do
    # shellcheck disable=SC2086
    check "$command, limited" 3 bash -c 'ulimit -f 1; exec "$@"' limited "$tessera" $command
    say "limited" err.txt
    say "File too large" err.txt
    [ -z "$(ls -A | grep limited)" ] || fail "$command, limited: something is left: $(ls -A | grep limited)"
done
# What a link leads to is replaced, not the link; what is no file stays as it is.
ln -s linked.tsr latest.tsr
check "pack to a link" 0 "$tessera" pack ramp.json -o latest.tsr --lattice cc
[ -L latest.tsr ] && [ -f linked.tsr ] || fail "the link was replaced"
check "verify what it leads to" 0 "$tessera" verify linked.tsr
mkfifo pipe.tsr
check "pack to a pipe" 3 "$tessera" pack ramp.json -o pipe.tsr --lattice cc
say "pipe.tsr: is no file, but a device or a pipe" err.txt
[ -p pipe.tsr ] || fail "the pipe was replaced"
finish
