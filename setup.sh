#!/usr/bin/env bash
# Installs the distribution's packages that Tessera is built and tested with, if any is missing. Debian 12 or later.
# --tests: those of ./test.sh too; --clang: the compiler of the presets "clang" and "fuzz", too.
set -euo pipefail

packages=(
    g++ cmake ninja-build pkg-config                                 # to build
    libglm-dev nlohmann-json3-dev libcli11-dev libtbb-dev            # headers and small libraries
    libzstd-dev liblzma-dev libxxhash-dev libpng-dev libmuparser-dev
    libimgui-dev libstb-dev libfreetype-dev libglfw3-dev libepoxy-dev libegl-dev # the window
    libgl1-mesa-dri libegl1 libgl1 libglx-mesa0                      # GL without a GPU
    fonts-roboto-unhinted fonts-font-awesome                         # text and icons
    libvtk9-dev libtiff-dev zlib1g-dev                               # tessera-import: readers of foreign formats
)
test_packages=(libgtest-dev libgmock-dev clang-format glslang-tools xvfb xdotool xauth x11-utils) # only ./test.sh needs these
case $(. /etc/os-release && echo "${ID:-} ${VERSION_ID:-}") in
    "debian 12") clang=16 ;; # its "clang" is 14, which cannot compile <ranges> of gcc 12
    "ubuntu 24.04") clang=18 ;;
    *) clang=19 ;;
esac
[ "${1:-}" = --tests ] && packages+=("${test_packages[@]}")
[ "${1:-}" = --clang ] && packages+=("${test_packages[@]}" "clang-$clang" "libclang-rt-$clang-dev")

missing=()
for package in "${packages[@]}"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

if ! command -v apt-get >/dev/null; then
    echo "setup: this system has no apt-get; please install the equivalents of: ${missing[*]}" >&2
    exit 1
fi
as_root=()
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "setup: run as root once, or install: ${missing[*]}" >&2; exit 1; }
    as_root=(sudo)
fi
echo "setup: installing ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -q
"${as_root[@]}" apt-get install -q -y --no-install-recommends "${missing[@]}"
