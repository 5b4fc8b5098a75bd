#!/bin/bash
# Foreign files through the command line: look, pack, what is remembered, and one clear line for every bad input.
set -u
tessera=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export XDG_CONFIG_HOME=$work/config XDG_STATE_HOME=$work/state
cd "$work" || exit 1
fail() { echo "FAILED: $*"; exit 1; }

printf '\0\1\2\3\4\5\6\7' > a.raw
echo '{"dims":[2,2,2],"dtype":"uint8","components":[{"name":"gas"}]}' > a.json
"$tessera" info a.raw | grep -q 'samples    2 x 2 x 2' || fail "look at a raw file"
"$tessera" info a.json --json | grep -q '"bytes"' || fail "look as JSON"
"$tessera" pack a.raw -o a.tsr --lossless --unit gas=mol/m3 > /dev/null || fail "pack"
"$tessera" info a.raw | grep -q 'mol/m3' || fail "a unit stated once is known the next time"

# Status 2 and one line on stderr.
bad() {
    "$tessera" "$@" > /dev/null 2> err
    local status=$?
    [ $status -eq 2 ] || fail "status $status: tessera $*"
    [ "$(wc -l < err)" -eq 1 ] || fail "not one line: tessera $*: $(cat err)"
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
grep -q 'crashed (signal 11)' err || fail "a crash is named"
[ ! -e b.tsr ] || fail "half an archive is left"

data=${TESSERA_DATA:-$TESSERA_TEST_DATA}/fuel-cell
[ -d "$data" ] && [ -x "$(dirname "$tessera")/tessera-import" ] || { echo "no fuel-cell data or no tessera-import"; exit 77; }
"$tessera" info "$data/grid/large.pvd" | grep -q 'absent: O2=region:0,3' || fail "absent gas is noticed"
"$tessera" pack "$data/grid/small_0250.vti" "$data/grid/small_0260.vti" -o cell.tsr --lossless --lattice cc > /dev/null ||
    fail "pack the fuel cell"
"$tessera" verify cell.tsr > /dev/null || fail "verify"
"$tessera" unpack cell.tsr -o back.vti > /dev/null || fail "unpack"
"$tessera" info back.pvd | grep -q 'times      2' || fail "the exported series opens"
"$tessera" pack "$data/unstructured/air_260.vtu" "$data/unstructured/fuel_260.vtu" -o mesh.tsr --grid 20x20x40 > /dev/null ||
    fail "pack meshes"
"$tessera" info mesh.tsr | grep -q 'air' || fail "regions are named"
