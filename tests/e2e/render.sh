#!/bin/bash
# Pictures without a window: the same session gives the same picture, a picture is a session again, and a damaged
# session or picture ends with status 2 and one line. Arguments TESSERA SOURCE_DIR.
tessera=$1 source=$2
source "$2/tests/e2e/common.bash"
size=640x400
draw() { "$tessera" render "$@" --size $size > /dev/null 2> err; }

"$tessera" generate fuel-cell -o cell.tsr --size 7x13x20 --times 2 > /dev/null 2> err || die "generate"

# The window's command line is checked before there is a window: status 2, one line.
refused() { # refused TEXT ARGUMENT...: the line holds the text
    local text=$1
    shift
    env -u DISPLAY -u WAYLAND_DISPLAY timeout 20 "$tessera" "$@" > /dev/null 2> err
    local status=$?
    [ $status = 2 ] || die "tessera $*: status $status"
    [ "$(wc -l < err)" = 1 ] || die "tessera $*: not one line"
    grep -q -- "$text" err || die "tessera $* does not say \"$text\""
}
refused 'nosuch: no layout of that name; there are .*, overview,' --layout nosuch
refused 'nosuch: no layout' cell.tsr --layout nosuch
refused 'frobnicate: neither a command nor a file' frobnicate
refused 'frobnicate: neither a command nor a file' cell.tsr frobnicate
refused 'pakc: neither a command nor a file' pakc a.json -o y.tsr
refused 'lens: .*--layout lens' lens
refused 'gone.tsr: no such file' gone.tsr
refused 'x.jpg: pictures are written as .png, .svg or .pdf' render cell.tsr -o x.jpg
refused 'x.foo: pictures are written as' compare cell.tsr -o x.foo
"$tessera" render cell.tsr --view histogram --time 0.03 -o h.csv > /dev/null 2> err || die "render a table"
[ "$(head -1 h.csv)" = "# numbers: as computed, at t = 0.03 s" ] || die "no time in: $(head -1 h.csv)"
"$tessera" --help | tr -s ' \n' ' ' | grep -q 'animation, .*, overview, .*, tesseract' || die "--help does not name the layouts"

draw cell.tsr --layout "$source/layouts/overview.json" -o first.png || die "render"

# On one machine the same session gives the same bytes, run after run.
draw cell.tsr --layout "$source/layouts/overview.json" -o second.png || die "render again"
cmp first.png second.png || die "two runs of one session differ"

# A built-in model is an input like a file; the fuel cell is what is drawn without one.
draw fuel-cell --view volume -o named.png || die "render fuel-cell"
draw --view volume -o default.png || die "render without input"
cmp named.png default.png || die "the fuel cell by its name is another picture"
draw overview marschner-lobb --view volume -o signal.png || die "a layout with a model"
! cmp -s signal.png named.png || die "another model is the same picture"

# What a PNG holds: its pixels, or the session in it ("pixels" or "session").
cat > png.py <<'PY'
import struct, sys, zlib
data, out, at = open(sys.argv[2], "rb").read(), b"", 8
while at < len(data):
    size, kind = struct.unpack(">I4s", data[at:at + 8])
    body = data[at + 8:at + 8 + size]
    if sys.argv[1] == "pixels" and kind == b"IDAT": out += body
    if sys.argv[1] == "session" and kind == b"iTXt" and body.startswith(b"tessera"):
        out = body.split(b"\0", 1)[1][2:].split(b"\0", 2)[2]
    at += 12 + size
sys.stdout.buffer.write(zlib.decompress(out))
PY
pixels() { python3 png.py pixels "$1" || die "$1 cannot be read"; }

# The picture opens as a session and gives the same pixels; so does the session in it, as a file.
draw first.png -o again.png || die "a picture does not open as a session"
cmp <(pixels first.png) <(pixels again.png) || die "the session in a picture gives another picture"
python3 png.py session first.png > s.tessera.json || die "no session in the picture"
draw s.tessera.json -o from-file.png || die "the session does not open"
cmp <(pixels first.png) <(pixels from-file.png) || die "the session as a file gives another picture"

# So does a figure, and readers that know nothing of sessions accept it.
for ending in svg pdf; do
    draw s.tessera.json -o figure.$ending || die "no figure"
    draw figure.$ending -o from-$ending.png || die "a figure as $ending does not open as a session"
    cmp <(pixels first.png) <(pixels from-$ending.png) || die "the session in the $ending gives another picture"
    "$tessera" info figure.$ending | grep -q '(session)' || die "info of a figure as $ending"
done
"$tessera" render cell.tsr --view histogram --preset oneColumn --text-pt 14 --ground white -o h.svg > /dev/null 2> err ||
    die "a figure of a plot"
grep -q 'width="240.96pt" height="181.44pt"' h.svg && ! grep -o 'font-size="[0-9.]*"' h.svg | grep -qv '"14.00"' ||
    die "a figure of another form: $(head -c 300 h.svg)"
if command -v rsvg-convert > /dev/null; then
    rsvg-convert figure.svg -o figure.svg.png 2> err && [ ! -s err ] || die "librsvg: $(cat err)"
fi
if command -v pdfdetach > /dev/null; then
    pdfinfo figure.pdf > out 2> err && [ ! -s err ] && grep -q 'Pages: *1$' out || die "poppler: $(cat err)"
    pdftotext figure.pdf texts 2> err && grep -q "stretch 5 : 10 : 1" texts && [ ! -s err ] || die "the texts of the PDF: $(cat err)"
    pdfdetach -save 1 -o attached.tessera.json figure.pdf 2> err && [ ! -s err ] || die "the attached session"
    draw attached.tessera.json -o attached.png || die "the attached session does not open"
    cmp <(pixels first.png) <(pixels attached.png) || die "the attached session gives another picture"
fi
python3 -c 'import re, sys; print(re.sub("(?s)<metadata.*</metadata>", "", sys.stdin.read()))' < figure.svg > plain.svg
! draw plain.svg -o none.png && grep -q 'plain.svg: this picture contains no session' err || die "a figure without session"

# The comparison can fail: another camera is another picture.
draw s.tessera.json --set /camera/distance=9 -o far.png || die "--set"
cmp -s <(pixels first.png) <(pixels far.png) && die "another camera gives the same picture"

# Damaged: status 2, one line, no picture.
bad() {
    draw "$1" -o bad.png
    local status=$?
    [ $status = 2 ] || die "$1: status $status"
    [ "$(wc -l < err)" = 1 ] || die "$1: not one line"
    [ ! -e bad.png ] || die "$1: drew a picture"
}
bytes=$(wc -c < s.tessera.json)
for part in 0 1 $((bytes / 3)) $((bytes / 2)) $((bytes - 3)); do
    head -c "$part" s.tessera.json > cut.tessera.json
    bad cut.tessera.json
done
python3 - <<'PY'
text = open("s.tessera.json", "rb").read()
for name, place in (("quote", text.index(b'"camera"')), ("number", text.index(b'"schema": ') + 10)):
    data = bytearray(text)
    data[place] ^= 0x40
    open("flip-%s.tessera.json" % name, "wb").write(data)
picture = open("first.png", "rb").read()
for name, place in (("head", 20), ("text", picture.index(b"iTXt") + 200), ("pixels", len(picture) // 2)):
    data = bytearray(picture)
    data[place] ^= 4
    open("flip-%s.png" % name, "wb").write(data)
open("cut.png", "wb").write(picture[:len(picture) * 2 // 3])
PY
for file in flip-*.json flip-*.png cut.png; do bad "$file"; done
mv cell.tsr elsewhere.tsr
bad s.tessera.json
grep -q 'not found' err || die "the missing data file is not named"
ls ./*.part-* 2> /dev/null && die "something is left behind"
# Surroundings that cannot be read: the picture is drawn without them, and one line says why.
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\nxx' >torn.hdr
"$tessera" render evening -o torn.png --view volume --size 160x120 --set "/lighting/environment/picture=\"$PWD/torn.hdr\"" 2>err || die "a torn light picture ends the program"
[ "$(grep -c 'torn.hdr' err)" = 1 ] || die "a torn light picture is not said once"
echo "render: all good"
finish
