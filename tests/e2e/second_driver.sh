#!/bin/bash
# Some of the tests that draw, by a second driver: Mesa's GL on Vulkan in software. Skipped (77) without it.
# Arguments TESSERA SOURCE_DIR. tests/nightly.sh runs all of them.
tessera=$1
source "$2/tests/e2e/common.bash"
ls /usr/share/vulkan/icd.d/lvp_icd* > /dev/null 2>&1 || { echo "skipped: no Vulkan in software (mesa-vulkan-drivers)"; exit 77; }
export LIBGL_ALWAYS_SOFTWARE=1 GALLIUM_DRIVER=zink TESSERA_TEST_DRIVER=zink XDG_RUNTIME_DIR=$work MESA_SHADER_CACHE_DIR=$work
chmod 700 "$work"
"$(dirname "$tessera")/vis_gl_tests" --gtest_filter="${SUITES:-RendererLoading.*:GeometryPassTest.*:DriverTest.*}" > out.txt 2>&1 || { fail "tests"; cat out.txt; }
grep -q '\[  PASSED  \] [1-9]' out.txt || fail "no test ran"
finish
