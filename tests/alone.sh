#!/usr/bin/env bash
# Whether C++ files of the product compile alone, as they do in the presets without groups of files: those given, or
# those that differ from a commit (HEAD).
#   tests/alone.sh [FILE.cpp ...]      BASE=main tests/alone.sh
set -euo pipefail
cd "$(dirname "$0")/.."
files=("$@")
[ ${#files[@]} -gt 0 ] || mapfile -t files < <(git diff --name-only --diff-filter=d "${BASE:-HEAD}" -- '*.cpp'
                                              git ls-files --others --exclude-standard -- '*.cpp')
flags="-std=c++20 -fsyntax-only -Wall -Wextra -Wshadow -I. -DTESSERA_VERSION=\"\" -DTESSERA_X86"
packages=$(pkg-config --cflags imgui epoxy egl cairo libzstd liblzma)
vtk=$(ls -d /usr/include/vtk-9* 2>/dev/null | tail -1)
failed=0
for file in "${files[@]}"; do
    case $file in *_avx2.cpp | *_avx512.cpp | *_plain.cpp | tests/*) continue ;; esac
    # shellcheck disable=SC2086
    if ! out=$(c++ $flags $packages ${vtk:+-isystem $vtk} "$file" 2>&1); then
        echo "$file does not compile alone:"
        grep -m3 error <<<"$out" || head -3 <<<"$out"
        failed=1
    fi
done
exit $failed
