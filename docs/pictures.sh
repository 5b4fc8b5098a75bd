#!/usr/bin/env bash
# Renders the pictures of the README with the built program: docs/pictures.sh [folder with engine_crop_149x208x110_uint8.raw]
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
tessera="$here/build/release/tessera"
out="$here/docs/pictures"
mkdir -p "$out"
"$tessera" render overview -o "$out/overview.png" --size 1600x1000
"$tessera" render starved -o "$out/starved.png" --size 1600x1000
"$tessera" render gases -o "$out/gases.png" --view volume --size 1200x700
"$tessera" render overview -o "$out/slices.png" --view slices --size 1200x700 --time 0.6 --set /views/slices/contours=12
if [ -n "${1:-}" ]; then
    "$tessera" render "$1/engine_crop_149x208x110_uint8.raw" -o "$out/engine.png" --view volume --size 900x800
fi
