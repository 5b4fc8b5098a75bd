#!/usr/bin/env bash
# Installs the distribution's packages that Tessera is built and tested with, if any is missing: on Debian 12 or 13.
# Ubuntu 24.04 has the same names (not tried). Ubuntu 22.04 is too old: CMake 3.22, nlohmann-json 3.10, liblzma 5.2.
# --tests: those of ./test.sh too; --clang: the compiler of the presets "clang" and "fuzz", too.
set -euo pipefail

packages=(
    g++ cmake ninja-build pkg-config                                 # to build
    libglm-dev nlohmann-json3-dev libcli11-dev libtbb-dev            # headers and small libraries
    libzstd-dev liblzma-dev libxxhash-dev libpng-dev libmuparser-dev
    libimgui-dev libstb-dev libfreetype-dev libglfw3-dev libepoxy-dev libegl-dev # the window
    libgl1-mesa-dri libegl1 libgl1 libglx-mesa0                      # GL without a GPU
    libcairo2-dev zlib1g-dev                                         # figures as PDF
    libcurl4-openssl-dev                                             # archives on web servers
    fonts-roboto-unhinted fonts-font-awesome                         # text and icons
    libvtk9-dev libtiff-dev libpugixml-dev                           # tessera-import: readers of foreign formats
    libblosc-dev liblz4-dev libbz2-dev
)
test_packages=( # only ./test.sh needs these
    libgtest-dev libgmock-dev clang-format glslang-tools xvfb xdotool xauth
    mesa-vulkan-drivers                                   # a second driver
    poppler-utils librsvg2-bin                            # figures as other programs read them
    pybind11-dev python3-dev python3-numpy python3-xarray # the Python package
)
case $(. /etc/os-release && echo "${ID:-} ${VERSION_ID:-}") in
    "debian 12") clang=16 ;; # its "clang" is 14, which cannot compile <ranges> of gcc 12
    "ubuntu 24.04") clang=18 ;;
    *) clang=19 ;;
esac
[ "${1:-}" = --tests ] && packages+=("${test_packages[@]}")
[ "${1:-}" = --clang ] && packages+=("${test_packages[@]}" "clang-$clang" "libclang-rt-$clang-dev" "clang-tidy-$clang")

if ! command -v apt-get >/dev/null; then
    echo "setup: no apt-get here. What the build needs has these names on Fedora (not tried):" >&2
    echo "    gcc-c++ cmake ninja-build pkgconf glm-devel json-devel cli11-devel tbb-devel libzstd-devel xz-devel" >&2
    echo "    xxhash-devel libpng-devel libcurl-devel muParser-devel imgui-devel stb-devel freetype-devel cairo-devel glfw-devel libepoxy-devel" >&2
    echo "    mesa-libEGL-devel mesa-dri-drivers google-roboto-fonts fontawesome4-fonts vtk-devel libtiff-devel pugixml-devel" >&2
    echo "    blosc-devel lz4-devel bzip2-devel zlib-devel; for tests: gtest-devel gmock-devel clang-tools-extra glslang xorg-x11-server-Xvfb xdotool xorg-x11-xauth" >&2
    echo "    poppler-utils librsvg2-tools; for the Python package: pybind11-devel python3-devel python3-numpy python3-xarray" >&2
    exit 0
fi

missing=()
for package in "${packages[@]}"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "setup: run as root once, or install: ${missing[*]}" >&2; exit 1; }
    as_root=(sudo)
fi
echo "setup: installing ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -q
"${as_root[@]}" apt-get install -q -y --no-install-recommends "${missing[@]}"
