#!/usr/bin/env bash
# Builds what is committed, with warnings as errors, and passes every test on a Debian of one's choice: in a chroot that
# debootstrap makes from the package source of this machine (or from $DEBIAN_MIRROR). Run by hand, as root.
#   tests/platforms.sh FOLDER                        Debian 13 in FOLDER, which is made where it is absent and kept
#   tests/platforms.sh FOLDER bookworm               Debian 12
#   tests/platforms.sh FOLDER trixie build           no tests
#   tests/platforms.sh FOLDER trixie test clang      the preset "clang"
#   tests/platforms.sh FOLDER trixie package         makes the .deb, installs it in FOLDER.user, a new chroot, and draws
# Where CCACHE_DIR is set, the compiler's results are kept there. Test data are those of $TESSERA_DATA, read only.
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
[ $# -ge 1 ] && [ $# -le 4 ] || { sed -n '2,9s/^# \?//p' "$0" >&2; exit 2; }
root=$(realpath -m "$1")
suite=${2:-trixie} what=${3:-test} preset=${4:-release}
case $what in build | test | package) ;; *) echo "platforms: \"$what\" is no build, test or package" >&2; exit 2 ;; esac
[ "$(id -u)" -eq 0 ] || { echo "platforms: only root may make a chroot" >&2; exit 1; }
command -v debootstrap >/dev/null || { echo "platforms: debootstrap is missing (apt-get install debootstrap)" >&2; exit 1; }

step="start"
mounted=()
begin() {
    step=$1
    echo "platforms: $suite: $step"
}
finish() {
    local code=$?
    trap - EXIT
    for ((i = ${#mounted[@]} - 1; i >= 0; --i)); do umount "${mounted[i]}" || umount -l "${mounted[i]}"; done
    if [ "$code" -eq 0 ]; then
        echo "platforms: $suite: passed ($what, preset $preset)"
    else
        echo "platforms: $suite: FAILED at: $step" >&2
    fi
    exit "$code"
}
trap finish EXIT
trap 'exit 143' TERM # else a stopped run would count as passed
trap 'exit 130' INT

# mount_at ROOT FROM TO [OPTIONS]: a folder of this machine within a chroot.
mount_at() {
    mkdir -p "$1$3"
    ! mountpoint -q "$1$3" || umount -l "$1$3" # of a run that did not end
    mount --bind "$2" "$1$3"
    mounted+=("$1$3")
    [ $# -lt 4 ] || mount -o "remount,bind,$4" "$1$3"
}
# make_root ROOT: a chroot that programs can run in; one that is there already is taken as it is.
make_root() {
    if [ ! -e "$1/etc/debian_version" ]; then
        begin "debootstrap into $1"
        local mirror=${DEBIAN_MIRROR:-}
        [ -n "$mirror" ] ||
            mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Label: Debian' | head -n 1)
        [ -n "$mirror" ] || { echo "platforms: no source of Debian packages; set DEBIAN_MIRROR" >&2; exit 1; }
        debootstrap --variant=minbase "$suite" "$1" "$mirror"
    fi
    begin "mounts in $1"
    local has
    has=$(sed -n 's/^VERSION_CODENAME=//p' "$1/etc/os-release")
    [ "$has" = "$suite" ] || { echo "platforms: $1 is a $has" >&2; exit 1; }
    mount_at "$1" /proc /proc
    mount_at "$1" /dev /dev
    mount_at "$1" /dev/shm /dev/shm
    cp -L /etc/resolv.conf "$1/etc/resolv.conf"
}
variables=(PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive)
inside() { chroot "$1" env -i "${variables[@]}" bash -ec "$2"; } # inside ROOT COMMANDS

make_root "$root"
packages=(git ca-certificates dpkg-dev file)
data=${TESSERA_DATA:-$here/../shared/data}
if [ -d "$data" ]; then
    mount_at "$root" "$(realpath "$data")" /data ro
    variables+=(TESSERA_DATA=/data)
fi
if [ -n "${CCACHE_DIR:-}" ]; then
    mkdir -p "$CCACHE_DIR"
    mount_at "$root" "$(realpath "$CCACHE_DIR")" /ccache
    variables+=(CCACHE_DIR=/ccache CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache)
    variables+=(CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime)
    packages+=(ccache)
fi

begin "clone"
rm -rf "$root/tessera"
git clone -q --no-hardlinks "$here" "$root/tessera"
begin "packages"
inside "$root" "apt-get update -q; apt-get install -q -y --no-install-recommends ${packages[*]}
    /tessera/setup.sh $([ "$preset" = clang ] && echo --clang || echo --tests)"
begin "build"
variables+=(TESSERA_WERROR=ON)
inside "$root" "cd /tessera; cmake --preset $preset -DBUILD_TESTING=$([ "$what" = package ] && echo OFF || echo ON) -DTESSERA_WERROR=ON
    cmake --build --preset $preset"
case $what in
test)
    begin "tests"
    inside "$root" "cd /tessera; ./test.sh $preset"
    ;;
package)
    begin "package"
    inside "$root" "cd /tessera/build/$preset; cpack -G DEB"
    [ ! -e "$root.user" ] || { echo "platforms: $root.user exists" >&2; exit 1; }
    make_root "$root.user"
    cp "$root/tessera/build/$preset"/*.deb "$root.user/tessera.deb"
    begin "installing the package"
    inside "$root.user" "apt-get update -q; apt-get install -q -y /tessera.deb"
    begin "drawing with what is installed"
    inside "$root.user" "tessera render --layout overview -o /overview.png; tessera info /overview.png
        tessera generate fuel-cell -o /cell.tsr --size 7x13x20 --times 1; tessera unpack /cell.tsr -o /cell.vti
        tessera info /cell.vti"
    echo "platforms: see $root.user/overview.png"
    ;;
esac
