#!/usr/bin/env bash
# Renders the pictures of the README with the built program.
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
tessera="$here/build/release/tessera"
out="$here/docs/pictures"
mkdir -p "$out"
"$tessera" render overview -o "$out/overview.png" --size 1600x1000
"$tessera" render starved -o "$out/starved.png" --size 1600x1000
"$tessera" render gases -o "$out/gases.png" --view volume --size 1200x700
"$tessera" render lens -o "$out/lens.png" --view volume --size 1200x700
"$tessera" render flow -o "$out/flow.png" --view volume --size 1200x700
"$tessera" render overview -o "$out/slices.png" --view slices --size 1200x700 --time 0.6 \
    --set '/views/slices/channel="O2"' --set '/views/slices/contourOf="T"' \
    --set /views/slices/contours=12 --set /views/slices/contourValues=true
"$tessera" render overview -o "$out/marschner-lobb.png" --view volume --size 900x700 \
    --set '/data={"model":"marschner-lobb","settings":{"nx":64,"ny":64,"nz":64,"times":1}}' \
    --set '/title="Marschner-Lobb signal"' --set '/stretch=[1,1,1]' --set /time=0 --set /camera/distance=3.4 \
    --set /views/volume/cursor=false --set '/selection/brushes=[]' \
    --set '/layers=[{"name":"surface","technique":{"type":"iso","channel":"rho","value":0.5,"color":[0.85,0.6,0.3]}}]'
"$tessera" render parallel -o "$out/parallel.png" --view parallelCoordinates --size 900x560
"$tessera" render worlds -o "$out/worlds.png" --view hierarchy --size 900x560
"$tessera" render callouts -o "$out/callouts.png" --view volume --size 900x560
"$tessera" render pieces -o "$out/pieces.png" --view pieces --size 900x560
"$tessera" render timelines -o "$out/timelines.png" --view volume --size 900x560
"$tessera" render lic -o "$out/lic.png" --view volume --size 900x560
"$tessera" render glyphs -o "$out/glyphs.png" --view volume --size 900x560
"$tessera" render hyperslice -o "$out/hyperslice.png" --view hyperSlice --size 900x560
for drawing in cells:grid scale:even; do
    "$tessera" render membrane -o "$out/layers-${drawing%:*}.png" --view slices --size 900x560 \
        --set '/views/slices/channel="region"' --set "/data/lattice=\"${drawing#*:}\""
done
