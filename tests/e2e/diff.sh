#!/bin/bash
# Differences as a user runs them: arguments TESSERA SOURCE_DIR.
tessera=$1
source "$2/tests/e2e/common.bash"

check "data" 0 "$tessera" generate marschner-lobb -o a.vti --size 20x20x20
cat >write.py <<'PYTHON'
import json, struct, sys
# T = 300 + x + 2 t on 5 x 4 x 3 at times 0 and 1, and the same on a finer grid, 1.5 lower.
def write(name, n, h, lower):
    values = [300 + h[0] * i + 2 * t - lower for t in (0, 1) for k in range(n[2]) for j in range(n[1]) for i in range(n[0])]
    open(name + ".raw", "wb").write(struct.pack("<%df" % len(values), *values))
    json.dump({"dims": n, "dtype": "float32", "spacing": h, "times": [0, 1],
               "components": [{"name": "T", "unit": "K"}]}, open(name + ".json", "w"))
write("coarse", [5, 4, 3], [1, 1, 1], 0)
write("fine", [9, 7, 5], [0.5, 0.5, 0.5], 1.5)
PYTHON
python3 write.py || die "no python3"
check "two files on unlike grids" 0 "$tessera" diff coarse.raw fine.raw -o table.csv
say "interpolated onto the grid of coarse" out.txt
say "# numbers: as computed; other data: as computed, interpolated onto the grid of coarse" table.csv
[ "$(sed -n 3p table.csv)" = "T,K,0,1.5,1.5,1.5,1.5,60,0,60" ] || fail "not 1.5 K everywhere: $(cat table.csv)"
check "the field" 0 "$tessera" diff coarse.raw fine.raw -o field.raw
python3 - <<'PYTHON' || fail "the field is another"
import struct
values = struct.unpack("<120f", open("field.raw", "rb").read())
assert all(abs(v - 1.5) < 1e-4 for v in values), values[:5]
PYTHON
check "as an archive" 0 "$tessera" diff coarse.raw fine.raw -o field.tsr
check "what it holds" 0 "$tessera" info field.tsr
say "T minus other" out.txt
check "a file and itself" 0 "$tessera" diff fine.raw fine.raw
say "on the same grid" out.txt
say "no sample differs" out.txt
# Labels are counted, and units of large integers are not lost.
cat >labels.py <<'PYTHON'
import json, struct
def write(name, labels, n):
    open(name + ".raw", "wb").write(struct.pack("<12i", *labels) + struct.pack("<12i", *n))
    json.dump({"dims": [3, 2, 2], "dtype": "int32", "spacing": [1, 1, 1],
               "components": [{"name": "region", "unit": "", "categorical": True}, {"name": "n", "unit": ""}]},
              open(name + ".json", "w"))
write("before", [0, 1, 2] * 4, [2000000000 + i for i in range(12)])
write("after", [0, 1, 2] * 3 + [0, 2, 1], [2000000000 + i + (i == 4) for i in range(12)])
PYTHON
python3 labels.py || die "no python3"
check "labels" 0 "$tessera" diff before.raw after.raw -o labels.csv
grep -q '^region (label) *- *- *- *- *12 *0 *2$' out.txt || fail "not two other labels: $(cat out.txt)"
grep -q '^n .* 12 *0 *1$' out.txt || fail "not one other number: $(cat out.txt)"
say "region,,0,,,,,12,0,2" labels.csv
grep -q "no sample differs" out.txt && fail "other labels are said to be none"
check "labels alone" 0 "$tessera" diff before.raw after.raw -p region
check "labels as data" 2 "$tessera" diff before.raw after.raw -p region -o labels.vti
say "labels have no difference" err.txt
check "the same labels" 0 "$tessera" diff before.raw before.raw -p region
say "no sample differs" out.txt

check "nothing in common" 2 "$tessera" diff coarse.raw a.vti
check "an unknown parameter" 2 "$tessera" diff coarse.raw fine.raw -p nothing
say "nothing" err.txt
check "no such file" 2 "$tessera" diff coarse.raw none.raw

# An archive that was resampled and its source are compared on the grid of the source: what unpacking gives, either way round,
# and what packing has said.
check "a cell" 0 "$tessera" generate fuel-cell --even -o cell.vti --size 9x11x23 --times 1
check "on BCC" 0 "$tessera" pack cell.vti -o bcc.tsr --lattice bcc
check "unpacked" 0 "$tessera" unpack bcc.tsr -o unpacked.vti
rows() { sed -n '/^Parameter/,$p' out.txt | sed 1d; } # numbers by parameter
check "with what is unpacked" 0 "$tessera" diff cell.vti unpacked.vti
rows >expected.txt
grep -q "^T " expected.txt || fail "no T in: $(cat out.txt)"
check "with the archive" 0 "$tessera" diff cell.vti bcc.tsr
cmp <(rows) expected.txt || fail "the archive differs otherwise from its source than what is unpacked of it: $(cat out.txt)"
say "other data: stored on BCC and corrected, .*, on the same grid" out.txt
check "turned round" 0 "$tessera" diff bcc.tsr cell.vti
say "minus cell.vti, stored on BCC and corrected" out.txt
rows >turned.txt
check "info of the archive" 0 "$tessera" info bcc.tsr --json
python3 - <<'PYTHON' || fail "the largest differences are not those that packing has said: $(cat expected.txt turned.txt)"
import json, re
said = {p["name"]: p["resampled"]["largest"] for p in json.load(open("out.txt"))["parameters"] if "resampled" in p}
for file in ("expected.txt", "turned.txt"):
    cells = [re.split("  +", line.strip()) for line in open(file)]
    rows = {row[0].split()[0]: row for row in cells}
    assert rows["T"][6] == "0", rows["T"]  # no sample in one only
    label = rows["region"]
    assert label[0] == "region (label)" and label[1:5] == ["-"] * 4, label
    for name in ("T", "O2", "H2O"):
        row = rows[name]
        assert abs(max(abs(float(row[1])), abs(float(row[4]))) / said[name] - 1) < 1e-3, (row, said[name])
PYTHON

check "an archive" 0 "$tessera" pack coarse.raw -o coarse.tsr --lattice cc --lossless
check "T minus its first time" 0 "$tessera" unpack coarse.tsr --derive "dT [K] = T - at(T, first)" -p dT -o dT.raw
python3 - <<'PYTHON' || fail "T minus its first time is another"
import struct
values = struct.unpack("<120f", open("dT.raw", "rb").read())
assert all(abs(v) < 1e-4 for v in values[:60]) and all(abs(v - 2) < 1e-4 for v in values[60:]), values
PYTHON
check "a time that is not there" 2 "$tessera" unpack coarse.tsr --derive "d = at(T, 7)" -o d.raw
say "position 7: time 7 lies outside those of the data, 0 to 1" err.txt
check "in the statistics" 0 "$tessera" stats coarse.tsr --derive "dT [K] = T - at(T, first)" --of dT -o dT.csv
say ",2.0," dT.csv
check "a wrong one there" 2 "$tessera" stats coarse.tsr --derive "dT = T - at(T, then)" --of dT
say "dT: position 11: a time is expected here" err.txt
check "no formula" 1 "$tessera" unpack coarse.tsr --derive "d" -o d.raw

finish
