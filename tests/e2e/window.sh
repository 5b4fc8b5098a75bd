#!/bin/bash
# Drives the real window: opens the built-in data, brushes, undoes, saves by shortcut and quits; then checks the saved
# session and that it renders without a window to the picture the window showed.
# usage: window.sh TESSERA SOURCE_DIR
source "$2/tests/e2e/display.bash"
start

# Help opens and closes by key.
mark
xdotool key F1
await 30 fresh || fail "F1 draws nothing"
mark
xdotool key Escape
await 30 fresh || fail "Esc draws nothing"

# A brush: drag across a density plot (O2 against H2O is the third row, first column of the matrix).
mark
xdotool mousemove 745 582 mousedown 1
for ((x = 749; x <= 805; x += 8)); do xdotool mousemove $x $((582 + (x - 745) / 3)); sleep 0.03; done
xdotool mouseup 1
await 60 fresh || fail "brushing draws nothing"

# Save by shortcut: the dialog offers a name in the working folder.
mark
xdotool key ctrl+s
await 30 fresh || fail "Ctrl+S opens no dialog"
# The new frame may be one of the brush, before the dialog that takes the key.
for _ in 1 2 3; do
    xdotool key Return
    await 10 test -f session.tessera.json && break
done
[ -f session.tessera.json ] || fail "Ctrl+S saves nothing"
grep -q '"intervals": \[' session.tessera.json || fail "the saved session holds no brush"
grep -q '"history"' session.tessera.json || fail "the saved session holds no history"
cp session.tessera.json brushed.tessera.json

# Undo, then a lasso chosen in the toolbar, saving each; quit: no question is asked.
mark
xdotool key ctrl+z
await 30 fresh || fail "Ctrl+Z draws nothing"
xdotool key ctrl+s
cleared() { grep -q '"brushes": \[\]' session.tessera.json; }
await 30 cleared || fail "undo did not take the brush back"
mark
xdotool mousemove 970 406 click 1
await 30 fresh || fail "the list of tools does not open"
mark
xdotool mousemove 970 468 click 1
await 30 fresh || fail "no tool is chosen"
mark
xdotool mousemove 750 634 mousedown 1
for at in "770 630" "790 634" "802 646" "795 662" "775 670" "755 662"; do
    xdotool mousemove $at
    sleep 0.3
done
xdotool mouseup 1
await 60 fresh || fail "a lasso draws nothing"
xdotool key ctrl+s
lassoed() { grep -q '"type": "lasso"' session.tessera.json; }
await 30 lassoed || fail "the saved session holds no lasso"
# Files dropped on the window: a broken one is told of and changes nothing, a session opens.
if command -v python3 >/dev/null; then
    drop() { python3 "$source/tests/e2e/drop_files.py" "$window" "$1"; }
    printf 'no archive' >"$work/broken.tsr"
    mark
    drop "$work/broken.tsr" || fail "the window takes no dropped file"
    await 30 fresh || fail "a broken file dropped draws nothing"
    title() { xdotool getwindowname "$window" | grep -q "$1"; }
    title session || fail "a broken file dropped replaces the session"
    # A raw file whose layout nothing states is shown where that is stated.
    head -c 210 /dev/zero >"$work/plain.raw"
    mark
    drop "$work/plain.raw"
    await 30 fresh || fail "a raw file dropped draws nothing"
    xdotool mousemove 595 611 click 1
    sleep 0.5
    xdotool type --delay 30 "dims=5x6x7,type=u8"
    sleep 1.5
    xdotool mousemove 1033 704 click 1
    await 30 title plain || fail "a raw file does not open with the layout that was typed"
    drop "$work/brushed.tessera.json"
    await 30 title brushed || fail "a session dropped does not open"
    drop "$work/session.tessera.json"
    await 30 title session || fail "the other session dropped does not open"
fi
xdotool key ctrl+q
for ((i = 0; i < 300; ++i)); do kill -0 "$app" 2>/dev/null || break; sleep 0.2; done
kill -0 "$app" 2>/dev/null && fail "Ctrl+Q does not end the program"
wait "$app"
status=$?
[ $status -eq 0 ] || fail "exit status $status"
[ -z "$(ls "$work"/state/tessera | grep autosave)" ] || fail "a clean end leaves an autosave"

# The same session in the window and without one; the mouse rests where nothing answers to it.
xdotool mousemove 900 945
start brushed.tessera.json
still
cp shot.png window.png
# kill -9: the next start finds nothing to recover, for nothing was changed.
kill -9 "$app"
wait "$app" 2>/dev/null
"$tessera" render brushed.tessera.json --size 1500x950 -o headless.png >>"$work/log" 2>&1 || fail "render fails"
if command -v compare >/dev/null; then
    # Pixels that differ by more than 2 % of the range, at most 0.2 % of the picture. The status line at the bottom says
    # what this machine does (memory, what casts the rays), in the window alone.
    differing=$(compare -extract 1500x915+0+0 -fuzz 2% -metric AE window.png headless.png null: 2>&1)
    echo "pixels that differ: $differing of 1372500"
    [ "${differing%%.*}" -lt 2745 ] || fail "window and headless pictures differ in $differing pixels"
fi
# The exported picture is a session again, and gives the same picture.
"$tessera" render headless.png --size 1500x950 -o again.png >>"$work/log" 2>&1 || fail "a picture does not open as a session"
if command -v compare >/dev/null; then
    differing=$(compare -metric AE headless.png again.png null: 2>&1)
    [ "$differing" = 0 ] || fail "the session in a picture gives another picture ($differing pixels)"
fi
echo "window: all good"
