#!/usr/bin/env bash
# Builds and runs the tests of one room or file after a change of it: those whose sources include something of it.
#   tests/room.sh app/values                 the preset dev, which compiles each file by itself
#   tests/room.sh volume/derived release
# The first build of a preset takes its full time; with ccache in CMAKE_CXX_COMPILER_LAUNCHER most of it is kept.
set -euo pipefail
[ $# -ge 1 ] || { sed -n '2,5p' "$0"; exit 2; }
cd "$(dirname "$0")/.."
room=${1%/} preset=${2:-dev}
[ -e "$room" ] || { echo "tests/room.sh: there is no $room" >&2; exit 2; }
pattern="#include \"${room%.*}[./]"

filters=() programs=()
for part in volume import codec vis packet app bench; do
    for gl in "" _gl; do
        suites=()
        for source in tests/"$part"/*_test.cpp; do
            case $source in *_gl_test.cpp) of=_gl ;; *) of= ;; esac
            { [ "$of" = "$gl" ] && grep -q "$pattern" "$source"; } || continue
            suites+=($(sed -nE 's/^(TYPED_)?TEST(_F|_P)?\((\w+),.*/\3/p' "$source" | sort -u))
        done
        [ ${#suites[@]} -gt 0 ] || continue
        programs+=("${part}${gl}_tests")
        filters+=("$(printf '%s.*:*/%s.*:%s/*:' $(for s in "${suites[@]}"; do echo "$s $s $s"; done))")
    done
done
[ ${#programs[@]} -gt 0 ] || { echo "no test includes $room: give a room that uses it" >&2; exit 1; }

[ -e "build/$preset/build.ninja" ] || cmake --preset "$preset" -DBUILD_TESTING=ON
cmake --build --preset "$preset" --target "${programs[@]}"
home="$PWD/build/$preset/home"
mkdir -p "$home"
export XDG_CONFIG_HOME="$home" XDG_STATE_HOME="$home" XDG_CACHE_HOME="$home" XDG_DATA_HOME="$home" TMPDIR="$home"
for i in "${!programs[@]}"; do
    echo "${programs[$i]}"
    "build/$preset/${programs[$i]}" --gtest_brief=1 --gtest_filter="${filters[$i]}"
done
