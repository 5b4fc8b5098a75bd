#!/bin/bash
# Every shader that Mesa is given by some layouts is GLSL by the reference compiler, too. Skipped (77) without it.
# Arguments TESSERA SOURCE_DIR.
tessera=$1
source "$2/tests/e2e/common.bash"
command -v glslangValidator > /dev/null || { echo "skipped: no glslangValidator"; exit 77; }
mkdir shaders
export MESA_SHADER_DUMP_PATH=$work/shaders MESA_SHADER_CACHE_DISABLE=1
small='{"nx":5,"ny":9,"nz":21,"times":2}'
for layout in overview flow illustration lens evening shadowcube; do
    "$tessera" render --layout $layout -o picture.png --size 800x500 --set /render/engine=gl --set "/data/settings=$small" > out.txt 2>&1 ||
        { cat out.txt; die "render --layout $layout"; }
done
check_stage() { # check_stage STAGE FILE...
    local stage=$1 file
    shift
    for file in "$@"; do
        glslangValidator -S "$stage" "$file" > said.txt || { fail "$stage $file"; cat said.txt; }
    done
}
count=$(find shaders -name '*.glsl' | wc -l)
[ "$count" -gt 0 ] || { echo "skipped: the driver does not write its shaders"; exit 77; }
[ "$count" -ge 30 ] || fail "only $count shaders"
check_stage vert shaders/VS_*.glsl
check_stage frag shaders/FS_*.glsl
finish
