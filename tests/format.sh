#!/usr/bin/env bash
# C++ files must be as clang-format leaves them. Skipped (77) without clang-format or outside a git checkout.
cd "$(dirname "$0")/.." || exit 1
command -v clang-format >/dev/null || { echo "skipped: no clang-format"; exit 77; }
files=$(git ls-files '*.cpp' '*.h') && [ -n "$files" ] || { echo "skipped: not a git checkout"; exit 77; }
xargs clang-format --dry-run -Werror <<<"$files"
