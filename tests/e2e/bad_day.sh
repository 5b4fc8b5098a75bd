#!/bin/bash
# What fails beside the data: full disks behind standard output and behind the cache of the graphics driver, damaged files
# of the program itself, broken sessions, names that command a terminal. Arguments TESSERA SOURCE_DIR.
tessera=$1 source=$2
source "$2/tests/e2e/common.bash"
export HOME=$work XDG_CACHE_HOME=$work/cache

"$tessera" generate marschner-lobb -o ml.tsr --size 12x12x12 > /dev/null 2> err || die "generate"

# Whatever a command prints: if that cannot be written, it says so.
full() { # full WHAT ARGUMENTS...
    local what=$1
    shift
    "$tessera" "$@" > /dev/full 2> err.txt
    local got=$?
    [ $got = 3 ] || fail "$what into a full disk: exit status $got"
    say "tessera: standard output: cannot be written: No space left on device" err.txt
    [ "$(wc -l < err.txt)" = 1 ] || fail "$what: not one line: $(cat err.txt)"
}
if [ -w /dev/full ]; then
    full help --help
    full version --version
    full "help of a command" stats --help
    full info info ml.tsr
    full "info as JSON" info ml.tsr --json
    full stats stats ml.tsr
    full verify verify ml.tsr
    full "verify as JSON" verify ml.tsr --json
    full generate generate marschner-lobb -o other.tsr --size 12x12x12
    full settings generate --list marschner-lobb
    full unpack unpack ml.tsr -o out.raw
    full pack pack ml.tsr -o again.tsr --lattice cc
    full mesh mesh ml.tsr -o surface.ply --iso 0.5
    full diff diff ml.tsr again.tsr
else
    echo "not tried: there is no /dev/full"
fi

# What is remembered of imports is damaged: data open, and it is said.
head -c 210 /dev/zero > plain.raw
mkdir -p config/tessera
for damage in '{' '[1]' '{"units": 3}' '{"absent": {"a": ["no rule at all ="]}}'; do
    echo "$damage" > config/tessera/units.json
    check "damaged memory" 0 "$tessera" info plain.raw --raw dims=5x6x7,type=u8
    say "config/tessera/units.json: .*not used until it is mended" err.txt
    [ "$(cat config/tessera/units.json)" = "$damage" ] || fail "the damaged memory was replaced"
done
rm config/tessera/units.json

# A broken session is told of as such: what is broken, and where.
cp "$source/tests/sessions/first_look.tessera.json" whole.tessera.json || die "no session"
head -c 3000 whole.tessera.json > cut.tessera.json
cp cut.tessera.json cut.json
sed 's/"schema": [0-9]*/"schema": 9999/' whole.tessera.json > newer.tessera.json
for name in cut.tessera.json cut.json; do
    for command in info "stats" "render -o x.png" "pack -o x.tsr"; do
        # shellcheck disable=SC2086
        check "$command of a broken session" 2 "$tessera" ${command%% *} $name $([ "$command" = "${command#* }" ] || echo "${command#* }")
        say "$name: line [0-9]*, column [0-9]*: broken JSON" err.txt
    done
done
check "a newer session" 2 "$tessera" stats newer.tessera.json
say "newer version of Tessera" err.txt
check "a whole session" 2 "$tessera" stats whole.tessera.json
say "is a session, and data are expected here" err.txt

# Names in files and names of files reach no terminal as commands, and no exported file as what breaks it.
python3 - <<'PY' || die "no python3"
import json
open("names.raw", "wb").write(bytes(range(210)) * 2)
json.dump({"dims": [5, 6, 7], "dtype": "uint8", "components": [
    {"name": "=cmd\u001b[31m\u0007", "unit": "\u009b2Jm"}, {"name": "a<b\u0000&\"\n", "unit": ""}]},
    open("names.json", "w"))
PY
clean() { # clean FILE: no control characters, and UTF-8
    python3 - "$1" <<'PY' || fail "$1 has what is no text"
import sys
text = open(sys.argv[1], "rb").read().decode("utf-8")
sys.exit(any(ord(c) < 32 and c not in "\n\t" or 127 <= ord(c) < 160 for c in text))
PY
}
check "info of names" 0 "$tessera" info names.json
clean out.txt
clean err.txt
check "pack of names" 0 "$tessera" pack names.json -o names.tsr
clean out.txt
check "info of the archive" 0 "$tessera" info names.tsr
clean out.txt
check "info as JSON" 0 "$tessera" info names.tsr --json
python3 -c 'import json, sys; json.load(open("out.txt", encoding="utf-8"))' || fail "info gives no JSON"
cp out.txt out.json
check "table of names" 0 "$tessera" stats names.tsr -o names.csv
clean names.csv
grep -q '^=\|,=' names.csv && fail "a cell of the table is a formula: $(cat names.csv)"
check "plot of names" 0 "$tessera" stats names.tsr --along z -o names.svg
clean names.svg
python3 -c 'import xml.dom.minidom as x; x.parse("names.svg")' || fail "the plot is no SVG"
check "VTK file of names" 0 "$tessera" unpack names.tsr -o names.vti
python3 - <<'PY' || fail "the head of the VTK file is no XML"
import xml.dom.minidom as x
data = open("names.vti", "rb").read()
x.parseString(data[:data.index(b"<AppendedData")] + b"</VTKFile>")
PY
check "NRRD of names" 0 "$tessera" unpack names.tsr -o names.nrrd -p "$(python3 -c 'import json; print(json.load(open("out.json", encoding="utf-8"))["parameters"][1]["name"])')"
[ "$(sed '/^$/q' names.nrrd | grep -ac "^type:\|^sizes:\|^content:")" = 3 ] || fail "the header of the NRRD file is broken"
check "raw of names" 0 "$tessera" unpack names.tsr -o back.raw
python3 -c 'import json; json.load(open("back.json", encoding="utf-8"))' || fail "the sidecar is no JSON"
esc=$'\e[31mred.vti' latin=$'\xb0.vti'
for name in "$esc" "$latin"; do
    check "a name that is no text" 2 "$tessera" info "$name"
    clean err.txt
    echo "no data" > "$name"
    check "a name that is no text" 2 "$tessera" info "$name"
    clean err.txt
    check "a name that is no text" 2 "$tessera" render "$name" -o x.png
    clean err.txt
done
cp ml.tsr $'\xb0\e[5m.tsr'
check "JSON of such a name" 0 "$tessera" info $'\xb0\e[5m.tsr' --json
python3 -c 'import json; json.load(open("out.txt", encoding="utf-8"))' || fail "info gives no JSON"

# The cache of the graphics driver lies on a full disk: found by trying, as root.
small=$work/small
# shellcheck disable=SC2329
clean_up() {
    cd / && umount "$small" 2> /dev/null
    rm -rf "$work"
}
mkdir "$small"
if [ "$(id -u)" = 0 ] && mount -t tmpfs -o size=2m tmpfs "$small" 2> /dev/null; then
    trap clean_up EXIT
    mkdir "$small/mesa_shader_cache"
    truncate -s 1310728 "$small/mesa_shader_cache/index" # as Mesa leaves it: without room of its own
    for with in "an index" "nothing"; do
        [ "$with" = nothing ] && rm -r "$small/mesa_shader_cache"
        dd if=/dev/zero of="$small/filler" bs=1K 2> /dev/null
        XDG_CACHE_HOME=$small "$tessera" render marschner-lobb --view volume --size 64x48 --set /render/engine=gl -o full.png > out.txt 2> err.txt
        got=$?
        # Without OpenGL it ends with 3 and says so.
        [ $got = 0 ] || { [ $got = 3 ] && grep -q OpenGL err.txt; } || fail "a full cache with $with: exit status $got: $(cat err.txt)"
        rm "$small/filler"
    done
else
    echo "not tried: a full disk, since only root may mount one"
fi
finish
