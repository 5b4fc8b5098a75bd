#!/bin/bash
# Variants of a session in one figure with its table, keyframes as pictures and as a video. Arguments TESSERA SOURCE_DIR.
tessera=$1
source "$2/tests/e2e/common.bash"

"$tessera" generate fuel-cell -o cell.tsr --size 7x13x20 --times 3 > /dev/null 2> err || die "generate"
compare() { "$tessera" compare cell.tsr "$@" --size 480x320 --set /render/samples=1 > /dev/null 2> err; }
compare -o figure.png --csv table.csv --variant "as it is:" --variant "/render/filter=average" \
    --variant "long steps: /render/step=3; /render/jitter=true" || die "compare"
[ -s figure.png ] || die "no figure"
[ "$(wc -l < table.csv)" = 4 ] || die "the table has $(wc -l < table.csv) lines"
python3 - <<'PY' || die "the table is wrong"
import csv
rows = list(csv.DictReader(open("table.csv")))
assert rows[0]["reference"] == "yes" and rows[0]["RMSE (of 255)"] == "", rows[0]
assert rows[1]["variant"] == rows[1]["differs"] == "filter average", rows[1]
assert rows[2]["variant"] == "long steps"
for row in rows[1:]:
    assert float(row["RMSE (of 255)"]) > 0 and float(row["SSIM"]) < 1, row
    assert float(row["samples"]) > 0 and float(row["stored bytes"]) > 0, row
PY
compare -o again.png --csv again.csv --variant "as it is:" --variant "again:" || die "compare again"
grep -q 'again,unchanged,no,.*,0,0,inf,1,' again.csv || die "equal variants differ: $(cat again.csv)"

# What does not fit is said before anything is drawn.
compare -o bad.png --variant "/render/nothing=1" && die "an unknown setting passes"
[ $? = 0 ] || grep -q '/render/nothing' err || die "an unknown setting is not named"
for change in "/render/step" "render/step=1" "name: step=1"; do
    compare -o bad.png --variant "$change" && die "the change \"$change\" passes"
    grep -q 'needs NAME: /json/pointer=value' err || die "of \"$change\" is said: $(cat err)"
done
compare -o bad.png --reference 7 && die "a reference that is none passes"
[ -e bad.png ] && die "a failed comparison left a picture"

# Another file: both, and the difference.
"$tessera" generate fuel-cell -o other.tsr --size 9x13x20 --times 3 > /dev/null 2> err || die "generate other"
compare --with other.tsr -o both.png --csv both.csv || die "compare --with: $(cat err)"
python3 - <<'PY' || die "the table of two files is wrong: $(cat both.csv)"
import csv
assert [row["variant"] for row in csv.DictReader(open("both.csv"))] == ["cell.tsr", "other.tsr", "cell.tsr minus other.tsr"]
PY
# At another time, which both files have.
compare --with other.tsr -o late.png --csv late.csv --time 0.03 || die "compare --time: $(cat err)"
cmp -s late.csv both.csv && die "another time changes nothing"
compare -o bad.png --time 7 && die "a time that is not there passes"
grep -q -- '--time: 7: is not in' err || die "a wrong time is not said: $(cat err)"
# What is the same says so.
compare --with cell.tsr -o equal.png || die "compare with itself: $(cat err)"
grep -q 'is 0 everywhere: nothing differs' err || die "equal files do not say so: $(cat err)"
compare --with missing.tsr -o bad.png && die "a file that is not there passes"
[ -e bad.png ] && die "a failed comparison left a picture"

# Keyframes: first, middle and last picture differ, and the way back ends where it began.
cat > keys.json <<'JSON'
[{"path": "/camera/distance", "keys": [{"at": 0, "value": [2.2]}, {"at": 1, "value": [1.2], "easing": "linear"}, {"at": 2, "value": [2.2]}]},
 {"path": "/time", "keys": [{"at": 0, "value": [0], "easing": "linear"}, {"at": 2, "value": [0.06]}]}]
JSON
tracks=$(cat keys.json)
replay() { "$tessera" replay cell.tsr --view volume --size 160x120 --set /render/samples=1 --set /animation/duration=2 \
    --set "/animation/tracks=$tracks" "$@" > /dev/null 2> err; }
replay --animation --fps 1 --out frames || die "replay"
[ "$(ls frames)" = "$(printf 'frame-%04d.png\n' 0 1 2)" ] || die "frames: $(ls frames)"
cmp -s frames/frame-0000.png frames/frame-0001.png && die "nothing moved"
python3 - <<'PY' || die "a frame is not where its keys say"
import json, zlib
def session(name):
    data, at = open(name, "rb").read(), 8
    while at < len(data):
        size, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        body = data[at + 8:at + 8 + size]
        if kind == b"iTXt" and body.startswith(b"tessera"):
            return json.loads(zlib.decompress(body.split(b"\0", 1)[1][2:].split(b"\0", 2)[2]))
        at += 12 + size
first, middle, last = (session(f"frames/frame-000{i}.png") for i in range(3))
assert abs(first["camera"]["distance"] - 2.2) < 1e-6 and abs(middle["camera"]["distance"] - 1.2) < 1e-6
assert abs(middle["time"] - 0.03) < 1e-9 and abs(last["time"] - 0.06) < 1e-9
PY

# The video is ffmpeg's work: without it that is said at once, with it it gets the frames and their rate.
mkdir bin && ln -s "$(command -v bash)" bin/
PATH=$work/bin replay --video out.mp4 --out none
[ $? = 3 ] && grep -q 'ffmpeg' err || die "a missing ffmpeg is not said"
printf '#!%s\necho "$@" > "%s/arguments"; for last; do :; done; echo video > "$last"\n' "$(command -v bash)" "$work" > bin/ffmpeg
chmod +x bin/ffmpeg
PATH=$work/bin:$PATH replay --video out.mp4 --fps 2 --out more || die "replay to a video"
[ "$(cat out.mp4)" = video ] || die "no video"
grep -q -- '-framerate 2 -i more/frame-%04d.png' arguments || die "ffmpeg got: $(cat arguments)"
[ "$(ls more | wc -l)" = 5 ] || die "frames of the video: $(ls more)"
# Pictures that lay there before, beyond the last one, are no part of it.
grep -q -- '-frames:v 5 ' arguments || die "ffmpeg is not told how many frames: $(cat arguments)"
finish
