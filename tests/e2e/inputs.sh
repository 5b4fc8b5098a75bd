#!/bin/bash
# Paths that lead to no file, as every kind of input of every command: one line, the status of bad input, and no waiting.
tessera=$1
source "$(dirname "$0")/common.bash"
command -v timeout >/dev/null || { echo "no timeout"; exit 77; }

"$tessera" generate marschner-lobb --size 12x12x12 -o good.tsr >/dev/null 2>err || die "an archive for the others"
"$tessera" unpack good.tsr -o good.raw >/dev/null 2>err || die "a raw file for the others"
mkfifo pipe
python3 - <<'END' || die "a socket"
import socket
socket.socket(socket.AF_UNIX).bind("socket")
END
mkdir folder

# refused WHAT COMMAND...: within 20 seconds and with little memory, by one line.
refused() {
    local what=$1
    shift
    (ulimit -v 6000000; exec timeout -k 1 20 "$tessera" "$@") >out.txt 2>err.txt </dev/null
    local got=$?
    [ "$got" = 2 ] || fail "$what: $*: exit status $got, not 2: $(tail -c 300 err.txt)"
    [ "$(wc -l <err.txt)" = 1 ] || fail "$what: $*: not one line: $(head -c 600 err.txt)"
}

# The same path under the endings by which kinds of files are told apart.
for kind in pipe socket /dev/zero /dev/full folder; do
    name=$(basename "$kind")
    target=$kind
    [ "${kind:0:1}" = / ] || target=$PWD/$kind
    for ending in tsr raw json tessera.json pvd series nrrd mhd vti nii csv h5 nc tif png svg pdf dcm hdr foam case npy am; do
        ln -sf "$target" "$name.$ending"
        [ "$kind.$ending" = folder.foam ] && continue
        refused "$kind as .$ending" info "$name.$ending"
    done
    ln -sf "$target" "$name.hdf"
    for command in "pack $name.tsr -o o.tsr" "pack $name.vti -o o.tsr" "unpack $name.tsr -o o.vti" "verify $name.tsr" \
        "stats $name.tsr -o o.csv" "diff good.tsr $name.tsr" "diff $name.raw good.tsr" "mesh $name.tsr --iso 1 -o o.ply" \
        "plot $name.csv -o o.csv" "render $name.tessera.json -o o.png" "render $name.tsr -o o.png" \
        "render good.tsr --layout $name.json -o o.png" "replay $name.tessera.json -o o" \
        "info $name.raw --raw dims=2x2x2,type=u8" "info good.raw --raw $name.json" \
        "info good.raw --over-time $name.csv" "pack good.raw --over-time $name.csv -o o.tsr"; do
        refused "$kind" $command
    done
    [ ! -e o.tsr ] && [ ! -e o.png ] && [ ! -e o.ply ] && [ ! -e o.csv ] || fail "$kind: something is left"
    # What a session names.
    timeout -k 1 60 "$tessera" render good.tsr -o o.png --size 40x40 --view volume --set /lighting/inMaps=true \
        --set /lighting/environment/kind=picture --set "/lighting/environment/picture=$target" >out.txt 2>err.txt </dev/null
    [ $? -lt 100 ] || fail "$kind as a picture of light: does not end"
    grep -q "is a pipe or a device\|is a folder\|OpenGL" err.txt || fail "$kind as a picture of light: $(head -c 300 err.txt)"
    rm -f o.png
done

# A header that names one.
printf 'ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = pipe.raw\n' > a.mhd
printf '{"dims": [2, 2, 2], "dtype": "uint8", "components": ["a"], "file": "zero.raw"}' > a.json
printf '<VTKFile><Collection><DataSet timestep="0" file="pipe.vti"/></Collection></VTKFile>' > a.pvd
printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: zero.raw\n' > a.nhdr
for header in a.json a.pvd a.nhdr; do refused "a header" info $header; done
[ -x "$(dirname "$tessera")/tessera-import" ] && refused "a header" info a.mhd

# What stands in a file may not lead elsewhere, unless the user says so.
mkdir data
head -c 8 good.raw > outside.raw
printf '{"dims": [2, 2, 2], "dtype": "uint8", "components": ["a"], "file": "../outside.raw"}' > data/a.json
refused "a file elsewhere" info data/a.json
say "outside of its folder" err.txt
check "a file elsewhere, allowed" 0 "$tessera" info data/a.json --allow-outside
"$tessera" pack data/a.json --allow-outside -o far.tsr >/dev/null 2>&1 || fail "an archive of a file elsewhere"

finish
