#!/bin/bash
# Every shader that Mesa is given by some layouts is GLSL by the reference compiler, too. Skipped (77) without it.
# Arguments TESSERA SOURCE_DIR.
tessera=$1
source "$2/tests/e2e/common.bash"
command -v glslangValidator > /dev/null || { echo "skipped: no glslangValidator"; exit 77; }
mkdir shaders
export MESA_SHADER_DUMP_PATH=$work/shaders MESA_SHADER_CACHE_DISABLE=1
export GALLIVM_PERF=nopt LP_NATIVE_VECTOR_WIDTH=128 # for the pictures, which nothing looks at: see docs/testing.md
"$tessera" generate fuel-cell -o cell.tsr --size 5x9x21 --times 2 > out.txt 2>&1 || { cat out.txt; die "generate"; }
for layout in overview flow illustration lens evening shadowCube; do
    data=cell.tsr
    [ $layout = evening ] && data= # which shows a signal of its own
    # shellcheck disable=SC2086
    "$tessera" render --layout $layout $data -o picture.png --size 640x400 --set /render/engine=gl > out.txt 2>&1 ||
        { cat out.txt; die "render --layout $layout"; }
done
check_stage() { # check_stage STAGE FILE...: each by itself
    local stage=$1
    shift
    glslangValidator -S "$stage" "$@" > said.txt || { fail "$stage"; grep -B1 ERROR said.txt; }
}
count=$(find shaders -name '*.glsl' | wc -l)
[ "$count" -gt 0 ] || { echo "skipped: the driver does not write its shaders"; exit 77; }
[ "$count" -ge 30 ] || fail "only $count shaders"
check_stage vert shaders/VS_*.glsl
check_stage frag shaders/FS_*.glsl
finish
