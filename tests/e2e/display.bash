# Sourced by the scripts that drive the real window, with the arguments TESSERA SOURCE_DIR: a display of its own, a folder
# to work in, and what waits for the window. `app` is the process id of the program.
tessera=$1 source=$2
for tool in Xvfb xdotool; do
    command -v $tool >/dev/null || { echo "skipped: no $tool"; exit 77; }
done
work=$(mktemp -d)
export XDG_STATE_HOME=$work/state XDG_CONFIG_HOME=$work/config
pids=()
cleanup() {
    for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null; done
    wait 2>/dev/null
    rm -rf "$work"
}
trap cleanup EXIT
fail() {
    echo "FAILED: $1"
    [ -f "$work/log" ] && cat "$work/log"
    exit 1
}

# A free display: Xvfb itself finds one and tells its number.
mkfifo "$work/display"
Xvfb -displayfd 3 -screen 0 1500x950x24 -nolisten tcp -noreset 3>"$work/display" 2>"$work/xvfb.log" &
pids+=($!)
read -r number <"$work/display" || { echo "skipped: Xvfb does not start"; exit 77; }
export DISPLAY=:$number

# await SECONDS COMMAND...: until it succeeds.
await() {
    local tries=$(($1 * 5))
    shift
    for ((i = 0; i < tries; ++i)); do
        "$@" && return 0
        kill -0 "$app" 2>/dev/null || return 1
        sleep 0.2
    done
    return 1
}
fresh() { [ "$work/shot.png" -nt "$work/mark" ]; }
# Waits until no more pictures come of what was done before.
still() {
    local try
    sleep 0.3
    for ((try = 0; try < 100; ++try)); do
        [ -n "$(find "$work/shot.png" -newermt '0.8 seconds ago')" ] || break
        sleep 0.2
    done
}
# `fresh` means a complete picture of the window after what follows `mark`.
mark() {
    still
    touch "$work/mark"
    sleep 0.05
}

# Starts the program with the arguments given and waits for its first picture.
start() {
    touch "$work/mark"
    "$tessera" "$@" --screenshots "$work/shot.png" >"$work/log" 2>&1 &
    app=$!
    pids+=("$app")
    await 120 fresh || fail "the window does not show a picture"
    window=$(xdotool search --pid "$app" 2>/dev/null | tail -1)
    [ -n "$window" ] || window=$(xdotool search --name Tessera | tail -1)
    xdotool windowfocus "$window"
}
cd "$work" || exit 1
