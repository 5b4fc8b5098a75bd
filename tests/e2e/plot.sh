#!/bin/bash
# Curves over time through the command line: the polarisation curve, statistics of a region, quantities of a table.
tessera=$1
source "$2/tests/e2e/common.bash"

bad() {
    "$tessera" "$@" > /dev/null 2> err
    local status=$?
    [ $status -eq 2 ] || die "status $status: tessera $*"
    [ "$(wc -l < err)" -eq 1 ] || die "not one line: tessera $*: $(cat err)"
}

# A series of numbered files: no unit is invented, a table names the axis.
for n in 1 2 11; do
    head -c 8 /dev/zero | tr '\0' "$(printf '\\%03o' "$n")" > "run_$n.raw"
    echo '{"dims":[2,2,2],"dtype":"uint8","components":[{"name":"T","unit":"K"}]}' > "run_$n.json"
done
"$tessera" info run_*.raw | grep -q 'times      3: step 1 .. 11$' || die "numbered files are steps"
printf 'operating point,U [V],j [A/m2]\n1,0.9,100\n2,0.8,500\n11,0.5,9000\n' > history.csv
"$tessera" info run_*.raw --over-time history.csv > out
grep -q 'operating point 1 .. 11$' out || die "the axis has the name of the table"
grep -q 'over time  U: 0.5 .. 0.9 V' out || die "info names the quantity"
"$tessera" info run_*.raw --over-time history.csv --json | grep -q '"timeName": "operating point"' || die "info as JSON"
"$tessera" plot run_*.raw --over-time history.csv -o curve.csv || die "plot"
printf 'operating point,j [A/m2],U [V]\n1,100,0.9\n2,500,0.8\n11,9000,0.5\n' > wanted
diff <(grep -v '^#' curve.csv) wanted || die "the polarisation curve"
"$tessera" plot run_*.raw --over-time history.csv --x U --y 'mean(T)' --y 'U*j' --by U -o by.csv || die "plot by voltage"
printf 'U [V],mean(T) [K],U*j [W/m2]\n0.5,11,4500\n0.8,2,400\n0.9,1,90\n' > wanted
diff <(grep -v '^#' by.csv) wanted || die "by voltage, with power"
"$tessera" plot run_*.raw --over-time history.csv -o curve.svg && grep -q '<circle' curve.svg || die "svg"
"$tessera" plot run_*.raw --over-time history.csv -o curve.pdf && [ "$(head -c 5 curve.pdf)" = %PDF- ] || die "pdf"
"$tessera" plot run_*.raw --over-time history.csv --preset oneColumn --text-pt 6 -o small.svg &&
    grep -q 'width="240.96pt" height="181.44pt"' small.svg && ! grep -o 'font-size="[0-9.]*"' small.svg | grep -qv '"6.00"' ||
    die "the form of a figure: $(head -c 300 small.svg)"
if command -v pdftotext > /dev/null; then # texts are texts
    pdftotext curve.pdf - | grep -qF 'j [A/m²]' || die "the axis of the PDF"
fi

# Archives keep what was stated, grow by it, and take a table when they are read.
"$tessera" pack run_1.raw run_2.raw -o cell.tsr --over-time history.csv --lattice cc > /dev/null || die "pack"
"$tessera" info cell.tsr | grep -q 'over time  U: 0.8 .. 0.9 V' || die "an archive keeps quantities"
"$tessera" plot cell.tsr -o archived.csv && grep -q '^2,500,0.8$' archived.csv || die "plot of an archive"
printf 'operating point,pump [W]\n1,5\n2,7\n' > pump.csv
"$tessera" plot cell.tsr --over-time pump.csv --y pump -o pump.out.csv && grep -q '^2,7$' pump.out.csv ||
    die "a table beside an archive"
"$tessera" unpack cell.tsr -o plane.raw --plane 1,0,0,0,-1 > /dev/null || die "a plane through space and time"
grep -q 'operating point \[-\]' plane.json || die "the axis of times is named"

# Uneven times, and a vector.
python3 - <<'PYTHON' || die "no python3"
import json, struct
times, count = [0, 1, 10], 3 * 3 * 2
values = [v for t in times for v in [t] * count + [1] * count + [2] * count + [3] * count]
open("uneven.raw", "wb").write(struct.pack("<%df" % len(values), *values))
json.dump({"dims": [3, 3, 2], "dtype": "float32", "spacing": [1, 1, 1], "times": times, "length_unit": "mm", "time_unit": "s",
           "components": [{"name": name, "unit": ""} for name in ("v", "U.x", "U.y", "U.z")]}, open("uneven.json", "w"))
PYTHON
"$tessera" pack uneven.raw -o uneven.tsr --lattice cc > /dev/null || die "pack with uneven times"
for time in 1 4; do
    "$tessera" unpack uneven.tsr -p v -o at.raw --plane 0,0,0,1,-$time > /dev/null || die "a plane at one time"
    python3 -c "import struct; v = struct.unpack('<18f', open('at.raw', 'rb').read()); assert set(v) == {$time}, v" ||
        die "v = t at t = $time"
done
"$tessera" unpack uneven.tsr -p v -o along.nrrd --plane 1,0,0,0,-1 > /dev/null || die "a plane with time along it"
grep -aq '^space units: "mm" "mm" "s"$' along.nrrd || die "each axis has its unit"
python3 -c "import struct; b = open('along.nrrd', 'rb').read().split(b'\n\n', 1)[1]; assert struct.unpack('<18f', b) == (0,) * 6 + (5,) * 6 + (10,) * 6" ||
    die "even steps along uneven times"
"$tessera" unpack uneven.tsr -p U -t 1 -o U.nrrd > /dev/null || die "a vector as NRRD"
grep -aq '^sizes: 3 3 3 2$' U.nrrd && grep -aq '^kinds: vector domain domain domain$' U.nrrd || die "it is whole"
python3 -c "import struct; b = open('U.nrrd', 'rb').read().split(b'\n\n', 1)[1]; assert struct.unpack('<54f', b) == (1, 2, 3) * 18" ||
    die "its components"
"$tessera" unpack uneven.tsr -p '|U|' -t 1 -o length.nrrd > /dev/null && grep -aq '^sizes: 3 3 2$' length.nrrd ||
    die "its length where that is asked for"

printf 'operating point,U\n1,x\n' > broken.csv
bad info run_*.raw --over-time broken.csv
grep -q 'broken.csv.*line 2' err || die "file and line of a broken table: $(cat err)"
bad plot run_*.raw --y 'mean(nothing)' -o a.csv
bad plot run_1.raw -o a.csv
bad plot run_*.raw -o a.xls
[ ! -e a.csv ] || die "half a table is left"

data=${TESSERA_DATA:-$TESSERA_TEST_DATA}/fuel-cell
[ -d "$data" ] && [ -x "$(dirname "$tessera")/tessera-import" ] || { echo "no fuel-cell data or no tessera-import"; exit 77; }
"$tessera" plot "$data/grid/small.pvd" -o cell.csv || die "the polarisation curve of the cell"
[ "$(grep -vc '^#' cell.csv)" -eq 27 ] || die "26 states"
grep -v '^#' cell.csv | tail -1 | grep -q '^0.26,5432.*,0.4$' || die "the last state: $(tail -1 cell.csv)"
"$tessera" plot "$data/grid/small.pvd" --x time --y 'mean(T)' --y 'max(T)' --region region=1 --over-time \
    "$data/history.csv" -o T.csv || die "mean T over time"
head -3 T.csv | grep -q '^time \[s\],mean(T) in region 1 \[K\],max(T) in region 1 \[K\]$' || die "names and units: $(head -2 T.csv)"
finish
