#!/bin/bash
# Pictures on a machine without any OpenGL driver: the volume view of every layout that ships, and what else there is,
# beside the same pictures by OpenGL. Arguments TESSERA SOURCE_DIR.
tessera=$1 source=$2
source "$2/tests/e2e/common.bash"
without() { env __EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent LIBGL_DRIVERS_PATH=/nonexistent "$@"; }
"$tessera" generate fuel-cell -o cell.tsr --size 7x13x40 --times 4 > /dev/null 2> err || die "generate"

"$tessera" render cell.tsr --view volume --size 64x48 -o first.png > /dev/null 2> err || die "render"
grep -q 'without OpenGL' err && with_gl= || with_gl=yes
without "$tessera" render cell.tsr --view volume --size 64x48 -o first.png > /dev/null 2> err || die "without OpenGL"
[ "$(wc -l < err)" = 1 ] || die "not one line"
say 'the processor draws without OpenGL: no OpenGL 4.5 context' err

# same WHAT DECIBELS A [B]: a PNG shows something, and is at least that much like another one of its size.
cat > same.py <<'PY'
import math, struct, sys, zlib

def pixels(path):
    data, body, at = open(path, "rb").read(), b"", 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR": width, height, depth, color = struct.unpack(">IIBB", data[at + 8:at + 18])
        if kind == b"IDAT": body += data[at + 8:at + 8 + size]
        at += 12 + size
    parts = {2: 3, 6: 4}[color]
    raw, row, rows = zlib.decompress(body), width * parts, []
    before = bytearray(row)
    for y in range(height):
        kind, line = raw[y * (row + 1)], bytearray(raw[y * (row + 1) + 1:(y + 1) * (row + 1)])
        for i in range(row):
            a, b, c = line[i - parts] if i >= parts else 0, before[i], before[i - parts] if i >= parts else 0
            if kind == 1: line[i] = line[i] + a & 255
            elif kind == 2: line[i] = line[i] + b & 255
            elif kind == 3: line[i] = line[i] + (a + b) // 2 & 255
            elif kind == 4:
                p = a + b - c
                near = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
                line[i] = line[i] + near & 255
        before = line
        rows.append(bytes(v for i, v in enumerate(line) if i % parts < 3))
    return (width, height), b"".join(rows)

size, ours = pixels(sys.argv[2])
other, theirs = pixels(sys.argv[3]) if sys.argv[3:] else (size, ours)
shown = len({ours[i:i + 3] for i in range(0, len(ours), 3)})
error = sum((a - b) ** 2 for a, b in zip(ours, theirs)) / len(ours)
psnr = 20 * math.log10(255 / math.sqrt(error)) if error else math.inf
if size != other or shown < 50 or psnr < float(sys.argv[1]):
    sys.exit(f"{size} for {other}, {shown} colours, {psnr:.1f} dB")
PY
same() {
    python3 same.py "${@:2}" > out.txt 2>&1 || fail "$1: $(cat out.txt)"
}

draw() { # draw NAME ARGUMENT...
    local name=$1
    shift
    without "$tessera" render "$@" --size 240x180 --scale 0.5 -o "$name.png" > /dev/null 2> err || { fail "$name"; cat err; return; }
    same "$name" 0 "$name.png"
}
alike() { # alike NAME ARGUMENT...: with OpenGL and without
    draw "$@"
    [ -n "$with_gl" ] || return
    local name=$1
    shift
    "$tessera" render "$@" --size 240x180 --scale 0.5 -o "$name-gl.png" > /dev/null 2> err || { fail "$name with OpenGL"; cat err; return; }
    same "$name" 45 "$name.png" "$name-gl.png"
}
layouts=0
for layout in "$source"/layouts/*.json; do
    grep -Pzq '"volume": \{\s*"type": "volume"' "$layout" || continue
    name=$(basename "$layout" .json)
    layouts=$((layouts + 1))
    case $name in
        charcoal | evening) set -- --set '/data/settings={"nx":24,"ny":24,"nz":24,"times":1}' ;;
        compressionError) # its data are not of a file, so its own must be few
            sed 's/"settings": {/&"nx": 7, "ny": 13, "nz": 40, /' "$layout" > few.json
            layout=few.json
            set -- ;;
        *) set -- cell.tsr ;;
    esac
    case $name in
        charcoal | lens) alike "$name" "$@" --layout "$layout" --view volume ;;
        *) draw "$name" "$@" --layout "$layout" --view volume ;;
    esac
done
[ $layouts -ge 14 ] || fail "only $layouts layouts"

# The whole window, with plots and slices; a figure of which every text is one; a table.
alike window cell.tsr --layout overview
alike points cell.tsr --layout tesseract --view tesseract
check "a figure" 0 without "$tessera" render cell.tsr --view volume --size 240x180 -o figure.svg
say '<text' figure.svg
say '<image' figure.svg
check "a table" 0 without "$tessera" render cell.tsr --view histogram -o table.csv

# Variants of a scene beside each other, and a curve.
check "compare" 0 without "$tessera" compare cell.tsr --variant "as it is:" --variant "/render/filter=average" \
    --size 480x320 --set /render/samples=1 -o compare.png --csv compare.csv
same compare 0 compare.png
check "plot" 0 without "$tessera" plot cell.tsr --size 240x180 -o plot.png
same plot 0 plot.png

# Each step of an animation.
check "replay" 0 without "$tessera" replay cell.tsr --layout animation --animation --fps 0.25 --view volume --size 64x48 -o steps
[ "$(find steps -name '*.png' | wc -l)" -ge 3 ] || fail "replay draws $(ls steps)"
[ "$(grep -c 'without OpenGL' err.txt)" = 1 ] || fail "it is not said once"

# What only OpenGL draws is refused: status 3, one line more.
check "proxy geometry" 3 without "$tessera" render cell.tsr --view volume --set /render/proxy=slices --size 64x48 -o no.png
say 'without OpenGL proxy geometry cannot be drawn' err.txt
[ -e no.png ] && fail "it is drawn"
finish
