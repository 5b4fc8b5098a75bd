#!/usr/bin/env bash
# What takes too long for every commit, one step after another; what failed is said at the end.
#   tests/nightly.sh                  all of it
#   tests/nightly.sh clang asan       some steps of: clang tidy asan fuzz gallery second-driver optimised load
# FUZZ_SECONDS: how long each fuzz target searches (600). LOAD_RUNS, LOAD_TESTS: how many times tests run beside busy cores (50), and
# arguments of ctest that choose them (all).
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
export TESSERA_WERROR=ON
failed=()

step() { # step NAME COMMAND...
    echo "nightly: $1"
    "${@:2}" || failed+=("$1")
}

clang() { ./test.sh clang -LE e2e; }

# clang-tidy over the sources as the preset "clang" compiles them (twelve in one unit, which reads each header once for them).
# Tests need not be fast, and divide integers where they count.
tidy() {
    ./setup.sh --clang && cmake --preset clang -B build/tidy -DBUILD_TESTING=ON -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON &&
        cmake --build build/tidy --target generated/shader_files.cpp || return 1
    newest=$(compgen -c clang-tidy- | grep -x 'clang-tidy-[0-9]*' | sort -V | tail -n 1) \
        tests=-performance-*,-bugprone-integer-division,-bugprone-signed-char-misuse
    export newest tests
    # shellcheck disable=SC2016
    python3 -c 'import json; print(*sorted({e["file"] for e in json.load(open("build/tidy/compile_commands.json"))}), sep="\n")' |
        xargs -P "$(nproc)" -n 1 sh -c '
            case $1 in */tests/*) checks=$tests ;; esac
            "$newest" -p build/tidy --quiet --warnings-as-errors="*" ${checks:+"--checks=$checks"} "$1"' tidy 2> /dev/null
}

asan() { ./test.sh asan; }

# Each target searches on from the stored corpus; what it finds lies in build/fuzz/found.
fuzz() {
    local names name good=0
    names=$(basename -s .cpp -a tests/fuzz/fuzz_*.cpp)
    # shellcheck disable=SC2086
    ./setup.sh --clang && cmake --preset fuzz -DBUILD_TESTING=ON -DTESSERA_WERROR=ON &&
        cmake --build --preset fuzz --target $names || return 1
    mkdir -p build/fuzz/found
    for name in $names; do
        mkdir -p "build/fuzz/corpus/$name"
        "build/fuzz/$name" -max_total_time="${FUZZ_SECONDS:-600}" -artifact_prefix=build/fuzz/found/ -print_final_stats=1 \
            "build/fuzz/corpus/$name" "tests/fuzz/corpus/$name" > "build/fuzz/$name.log" 2>&1 ||
            { tail -n 20 "build/fuzz/$name.log"; echo "FAILED: $name"; good=1; }
    done
    return "$good"
}

# Every picture of the gallery, of which the suite draws some.
gallery() {
    ./setup.sh --tests && cmake --preset release -DBUILD_TESTING=ON -DTESSERA_WERROR=ON && cmake --build --preset release --target tessera &&
        GALLERY_EVERY=1 bash tests/e2e/gallery.sh "$PWD/build/release/tessera" "$PWD"
}

# The tests that draw, by Mesa's GL on Vulkan in software.
second_driver() {
    ls /usr/share/vulkan/icd.d/lvp_icd* > /dev/null 2>&1 || { echo "mesa-vulkan-drivers is not installed"; return 1; }
    ./setup.sh --tests && cmake --preset release -DBUILD_TESTING=ON -DTESSERA_WERROR=ON && cmake --build --preset release || return 1
    local home=$PWD/build/release/second-driver
    rm -rf "$home"
    mkdir "$home" && chmod 700 "$home"
    LIBGL_ALWAYS_SOFTWARE=1 GALLIUM_DRIVER=zink TESSERA_TEST_DRIVER=zink XDG_RUNTIME_DIR=$home MESA_SHADER_CACHE_DIR=$home TMPDIR=$home \
        build/release/vis_gl_tests --gtest_brief=1
}

# The tests that draw, by shaders as users have them; otherwise Mesa compiles them for tests without optimising.
optimised() {
    ./setup.sh --tests && cmake --preset release -DBUILD_TESTING=ON -DTESSERA_WERROR=ON && cmake --build --preset release &&
        GALLIVM_PERF='' ctest --preset release -L gl -j "$(nproc)"
}

# Every test again and again while all cores are busy with something else: a test that depends on time fails now and then.
load() {
    local busy=() good=0
    for _ in $(seq "$(nproc)"); do
        (while :; do :; done) &
        busy+=($!)
    done
    # shellcheck disable=SC2086
    ./test.sh release --repeat until-fail:"${LOAD_RUNS:-50}" ${LOAD_TESTS:-} || good=1
    kill "${busy[@]}"
    return "$good"
}

[ $# -gt 0 ] || set -- clang tidy asan fuzz gallery second-driver optimised load
for name in "$@"; do
    case $name in
    clang | tidy | asan | fuzz | gallery | optimised | load) step "$name" "$name" ;;
    second-driver) step "$name" second_driver ;;
    *) echo "nightly: there is no step \"$name\"" >&2; exit 2 ;;
    esac
done
[ ${#failed[@]} -eq 0 ] || { echo "nightly: FAILED: ${failed[*]}"; exit 1; }
echo "nightly: passed"
