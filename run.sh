#!/usr/bin/env bash
# Installs what is missing, builds, and opens the workbench on the built-in fuel cell, or on the files given.
# Without a display the overview is rendered to out/overview.png instead.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

"$here/setup.sh"
(
    cd "$here"
    [ -f build/release/build.ninja ] || cmake --preset release -DBUILD_TESTING=OFF
    cmake --build --preset release --target programs
)

# Everything the program remembers stays in the checkout when it is started from here.
export XDG_CONFIG_HOME="$here/build/home/config" XDG_STATE_HOME="$here/build/home/state"
export XDG_CACHE_HOME="$here/build/home/cache" MESA_SHADER_CACHE_DIR="$here/build/home/cache/mesa"
mkdir -p "$XDG_CONFIG_HOME" "$XDG_STATE_HOME" "$MESA_SHADER_CACHE_DIR"

tessera="$here/build/release/tessera"
if [ -z "${DISPLAY:-}" ] && [ $# -eq 0 ]; then
    mkdir -p "$here/out"
    echo "No display: rendering the overview instead of opening the window."
    "$tessera" render overview -o "$here/out/overview.png" --size 1600x1000
    echo "See $here/out/overview.png"
else
    exec "$tessera" "$@"
fi
