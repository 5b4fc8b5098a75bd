#!/bin/bash
# Foreign files through the command line: look, pack, what is remembered, and one clear line for every bad input.
tessera=$1
source "$2/tests/e2e/common.bash"

printf '\0\1\2\3\4\5\6\7' > a.raw
echo '{"dims":[2,2,2],"dtype":"uint8","components":[{"name":"gas"}]}' > a.json
"$tessera" info a.raw | grep -q 'samples    2 x 2 x 2' || die "look at a raw file"
"$tessera" info a.json --json | grep -q '"bytes"' || die "look as JSON"
"$tessera" pack a.raw -o a.tsr --lossless --unit gas=mol/m3 > /dev/null || die "pack"
"$tessera" info a.raw | grep -q 'mol/m3' || die "a unit stated once is known the next time"

# Status 2 and one line on stderr.
bad() {
    "$tessera" "$@" > /dev/null 2> err
    local status=$?
    [ $status -eq 2 ] || die "status $status: tessera $*"
    [ "$(wc -l < err)" -eq 1 ] || die "not one line: tessera $*: $(cat err)"
}
printf '1234567' > a.raw
bad info a.raw
bad pack a.raw -o b.tsr
bad info missing.vti
echo '{"dims":[2,2,2],"dtype":"float128"}' > a.json
bad info a.raw
echo 'not xml' > c.vti
bad info c.vti
TESSERA_IMPORT=/bin/false bad info c.vti
printf '#!/bin/sh\nkill -SEGV $$\n' > crash && chmod +x crash
TESSERA_IMPORT=$work/crash bad info c.vti
grep -q 'crashed (signal 11)' err || die "a crash is named"
head -c 15 /dev/zero > half
printf '# vtk DataFile Version 3.0\nx\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\n' > cut.vtk
printf 'POINT_DATA 8\nSCALARS T float 1\nLOOKUP_TABLE default\n' >> cut.vtk
cat half >> cut.vtk
if [ -x "$(dirname "$tessera")/tessera-import" ]; then
    bad info cut.vtk
    bad pack cut.vtk -o b.tsr
    grep -q 'cut.vtk' err || die "a truncated file is named"
fi
[ ! -e b.tsr ] || die "half an archive is left"

# The reader of foreign files is confined before it reads the first one (tests/volume/confine_test.cpp: what that means).
import=$(dirname "$tessera")/tessera-import
if [ -x "$import" ]; then
    head -c 17 /dev/zero >> cut.vtk # whole again
    mkfifo asks
    "$import" cut.vtk < asks > answers &
    exec 9> asks
    for _ in $(seq 100); do [ -s answers ] && break || sleep 0.1; done
    grep -q '^NoNewPrivs:[[:space:]]*1' "/proc/$!/status" || [ "$(uname -r | cut -d. -f1)" -lt 6 ] ||
        fail "the reader is not confined"
    grep -q '^Max data size *[0-9]' "/proc/$!/limits" || fail "the memory of the reader is not limited"
    grep -q '^Max cpu time *[0-9]' "/proc/$!/limits" || fail "the time of the reader is not limited"
    exec 9>&-
    wait
fi

data=${TESSERA_DATA:-$TESSERA_TEST_DATA}/fuel-cell
[ -d "$data" ] && [ -x "$(dirname "$tessera")/tessera-import" ] || { echo "no fuel-cell data or no tessera-import"; exit 77; }
"$tessera" info "$data/grid/large.pvd" | grep -q 'absent: O2=region:0,3' || die "absent gas is noticed"
"$tessera" pack "$data/grid/small_0250.vti" "$data/grid/small_0260.vti" -o cell.tsr --lossless --lattice cc > /dev/null ||
    die "pack the fuel cell"
"$tessera" verify cell.tsr > /dev/null || die "verify"
"$tessera" unpack cell.tsr -o back.vti > /dev/null || die "unpack"
"$tessera" info back.pvd | grep -q 'times      2' || die "the exported series opens"
"$tessera" pack "$data/unstructured/air_260.vtu" "$data/unstructured/fuel_260.vtu" -o mesh.tsr --grid 20x20x40 > /dev/null ||
    die "pack meshes"
"$tessera" info mesh.tsr | grep -q 'air' || die "regions are named"
finish
