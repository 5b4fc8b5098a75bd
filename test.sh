#!/usr/bin/env bash
# Installs what is missing, builds everything and passes every test.
#   ./test.sh          the release build, all tests
#   ./test.sh asan     the same with address and undefined sanitizers (tests that need no window)
#   ./test.sh clang    by clang
#   ./test.sh release --rerun-failed     what follows the preset goes to ctest
# TESSERA_WERROR=ON in the environment makes warnings errors.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
preset=${1:-release}
[ $# -eq 0 ] || shift
cd "$here"

"$here/setup.sh" "$([ "$preset" = clang ] && echo --clang || echo --tests)"
cmake --preset "$preset" -DBUILD_TESTING=ON -DTESSERA_WERROR="${TESSERA_WERROR:-OFF}"
cmake --build --preset "$preset"

# Tests write nothing outside the build folder.
home="$here/build/$preset/home"
rm -rf "$home"
mkdir -p "$home/mesa"
export XDG_CONFIG_HOME="$home/config" XDG_STATE_HOME="$home/state" XDG_CACHE_HOME="$home/cache"
export XDG_DATA_HOME="$home/data" MESA_SHADER_CACHE_DIR="$home/mesa" TMPDIR="$home"

if [ "$preset" = asan ]; then
    # Mesa and its LLVM keep memory of their own until the process ends.
    export ASAN_OPTIONS=detect_leaks=1 LSAN_OPTIONS="suppressions=$here/tests/lsan.supp:print_suppressions=0"
    ctest --preset asan -j "$(nproc)" -LE e2e "$@"
else
    # One more than there are cores: some tests mostly wait.
    ctest --preset "$preset" -j "$(($(nproc) + 1))" "$@"
fi
