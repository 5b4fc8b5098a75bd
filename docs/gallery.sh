#!/usr/bin/env bash
# Renders the pictures of docs/gallery.md from the built-in models: gallery.sh [TESSERA] [FOLDER] [WIDTHxHEIGHT] [CELL],
# where CELL are the settings of the fuel cell as JSON.
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
tessera="${1:-$here/build/release/tessera}"
out="${2:-$here/docs/pictures/gallery}"
size="${3:-480x320}"
cell='/data={"model":"fuel-cell","settings":'"${4:-{\}}"'}'
mkdir -p "$out"

# A picture is a session: what many have in common is opened from one of them, and no data are computed but those shown.
bases=$(mktemp -d)
trap 'rm -rf "$bases"' EXIT
base() { # base NAME FROM ARGUMENTS...
    local name=$1 from=$2
    shift 2
    "$tessera" render "$from" -o "$bases/$name.png" --view volume --size 16x16 --set /views/volume/cursor=false "$@"
}
base cell overview --set "$cell"
base signal "$bases/cell.png" --set '/data={"model":"marschner-lobb","settings":{"nx":48,"ny":48,"nz":48,"times":1}}' \
    --set '/stretch=[1,1,1]' --set /time=0 --set /camera/distance=3.2 --set '/selection/brushes=[]'
base scan "$bases/cell.png" --set '/data={"model":"casting"}' --set '/stretch=[1,1,1]' --set /time=0 \
    --set '/selection/brushes=[]' --set /camera/distance=2.3 --set /views/volume/legend=false

picture_of() { # picture_of BASE NAME ARGUMENTS...: the volume view of a base with changes
    local from=$1 name=$2
    shift 2
    "$tessera" render "$bases/$from.png" -o "$out/$name.png" --view volume --size "$size" "$@"
}
picture() { # picture NAME ARGUMENTS...: of the cell
    picture_of cell "$@"
}
volume() { # volume CHANNEL [MORE]: a volume layer as JSON
    echo "{\"name\":\"$1\",\"technique\":{\"type\":\"volume\",\"channel\":\"$1\"${2:+,$2}}}"
}
surface() { # surface CHANNEL VALUE COLOUR OPACITY [MORE]
    echo "{\"name\":\"$1 $2\",\"technique\":{\"type\":\"iso\",\"channel\":\"$1\",\"value\":$2,\"color\":[$3],\"opacity\":$4${5:+,$5}}}"
}
signal() { # signal NAME ARGUMENTS...: of the Marschner-Lobb signal; ends on the given layers
    picture_of signal "$@"
}

# As data open
for model in fuel-cell planted marschner-lobb membrane casting; do
    data=("$model")
    [ "$model" != fuel-cell ] || data=(overview --set "$cell")
    "$tessera" render "${data[@]}" -o "$out/opens-$model.png" --view volume --size "$size"
done
# How samples along a ray become one colour
for style in composite maximum minimum average xray; do
    picture "style-$style" --set "/layers=[$(volume T "\"style\":\"$style\"")]"
done
signal style-localmaximum --set "/layers=[$(volume rho '"style":"localmaximum","threshold":0.6')]"
picture quantity-gradient --set "/layers=[$(volume T '"quantity":"gradient","density":4')]"
# Looks
for look in plain tone illustration cartoon glass distance charcoal sanguine softpencil pencil hardpencil hatching stipple chalk wire; do
    "$tessera" render charcoal -o "$out/look-$look.png" --view volume --size "$size" \
        --set '/layers/0/technique/color=[0.9,0.55,0.3]' --set "/layers/0/technique/look=\"$look\""
done
"$tessera" render charcoal -o "$out/look-print.png" --view volume --size "$size" --set '/paper={"color":[1,1,1],"tooth":0}'
picture look-boundaries --set "/layers=[$(volume T '"look":"boundaries"')]"
for look in charcoal illustration; do
    "$tessera" render "$look" -o "$out/look-layout-$look.png" --view volume --size "$size"
done
picture look-context --set '/selection/contextOpacity=0.8' --set /selection/contextSaturation=1 \
    --set "/layers=[$(volume T '"density":2,"look":{"part":"context","charcoal":{"contrast":0.6}}')]" \
    --set '/transfer/T={"colormap":"inferno","opacity":[[0,0],[0.6,0],[0.7,0.5],[1,0.9]]}' \
    --set '/selection/brushes=[{"name":"hot","region":{"type":"range","intervals":[{"channel":"T","lo":356.2,"hi":400,"soft":0.2}]}}]'
# Shadows of depth
for strength in 0 1.5; do
    "$tessera" render flow -o "$out/depth-shadows-${strength%.*}.png" --view volume --size "$size" --set "$cell" \
        --set "/depthMask/strength=$strength" --set '/paper={"color":[1,1,1],"tooth":0}' --set '/layers/2/visible=false'
done
"$tessera" render flow -o "$out/halos.png" --view volume --size "$size" --set "$cell" --set /layers/2/visible=false \
    --set /layers/0/technique/halo=3 --set /layers/1/technique/halo=3 --set '/paper={"color":[1,1,1],"tooth":0}'
# Strokes in slices
base strokes lic --set "$cell"
picture_of strokes strokes-colors
for look in grey bySpeed; do
    picture_of strokes "strokes-${look,,}" --set "/layers/0/technique/strokes/$look=true" \
        --set "/layers/1/technique/strokes/$look=true" --set "/layers/2/technique/strokes/$look=true"
done
# Drawings of four things in four styles, for print
drawings() { # drawings BASE NAME LAYERS ARGUMENTS...: LAYERS contain LOOK in place of their look
    local from=$1 name=$2 layers=$3
    shift 3
    for look in cartoon pencil hatching stipple; do
        picture_of "$from" "drawing-$name-$look" --set "/layers=[${layers//LOOK/\"$look\"}]" \
            --set '/paper={"color":[1,1,1],"tooth":0}' --without legend,axes,gizmo,scaleBar,cursor,box,title "$@"
    done
}
drawings scan casting "$(surface density 60 0.75,0.78,0.82 1 '"look":LOOK')"
base rings charcoal
drawings rings signal "$(surface rho 0.5 0.85,0.6,0.3 1 '"look":LOOK')"
base sheets illustration --set "$cell" --set /camera/distance=1.5
drawings sheets cell "$(surface T 355 0.95,0.6,0.3 1 '"look":LOOK'),$(surface O2 2.5 0.35,0.6,0.85 1 '"look":LOOK')"
base tubes flow --set "$cell" --set /camera/distance=1.3
tubes() { # tubes CHANNEL FROM TO: those of one gas
    echo "{\"name\":\"$1\",\"technique\":{\"type\":\"flow\",\"vector\":\"U\",\"channel\":\"$1\",\"count\":12,\"length\":4," \
        "\"radius\":0.014,\"from\":$2,\"to\":$3,\"look\":LOOK}}"
}
drawings tubes flow "$(tubes O2 '[0,0.5,0]' '[1,1,1]'),$(tubes H2 '[0,0,0]' '[1,0.5,1]')"
# Particles
base timelines timelines --set "$cell"
picture_of timelines particles-timelines --set /views/volume/legend=false --set /camera/distance=1.5
base speedlines speedlines --set "$cell"
picture_of speedlines particles-speedlines --set /views/volume/legend=false --set /camera/distance=1.5
base streams flow --set "$cell"
particles() { # particles NAME CHANNEL FROM TO CHANNEL FROM TO MORE: flow of both gases
    local both
    both="$(for i in 0 1; do
        echo "{\"name\":\"$2\",\"technique\":{\"type\":\"flow\",\"vector\":\"U\",\"channel\":\"$2\",\"from\":$3,\"to\":$4,$8}}"
        [ $i = 1 ] || echo ,
        set -- "$1" "$5" "$6" "$7" "$5" "$6" "$7" "$8"
    done)"
    picture_of streams "$1" --set /views/volume/legend=false --set /camera/distance=1.5 --set "/layers=[$both]"
}
particles particles-streaklines O2 '[0.25,0.6,0.02]' '[0.75,0.98,0.02]' H2 '[0.25,0.02,0.98]' '[0.75,0.4,0.98]' \
    '"kind":"streaklines","seeds":"plane","count":12,"radius":0.006'
particles particles-arrows O2 '[0,0.5,0]' '[1,1,1]' H2 '[0,0,0]' '[1,0.5,1]' \
    '"kind":"bentArrows","seeds":"even","separation":0.12,"count":7,"length":0.15,"radius":0.012,"minimumSpeed":0.04'
# Classification
for kind in post pre preintegrated; do
    signal "classification-$kind" --set "/layers=[$(volume rho "\"classification\":\"$kind\",\"shaded\":false")]" \
        --set '/transfer/rho={"opacity":[[0,0],[0.46,0],[0.48,0.9],[0.52,0.9],[0.54,0],[1,0]]}' --set /render/step=1.5
done
# Surfaces
picture surfaces --set "/layers=[$(surface O2 2 0.35,0.55,0.95 0.5),$(surface O2 4 0.2,0.75,0.85 0.45),$(surface H2 26.5 0.95,0.6,0.25 0.55)]"
signal surface-rays --set "/layers=[$(surface rho 0.5 0.85,0.6,0.3 1)]"
signal surface-polygons --set "/layers=[$(surface rho 0.5 0.85,0.6,0.3 1 '"method":"polygons"')]"
# Proxy geometry
for proxy in rays slices shells stacks; do
    picture "proxy-$proxy" --set "/layers=[$(volume T '"shaded":false')]" --set "/render/proxy=\"$proxy\""
done
# Lattices and filters
signal lattice-cc --set /data/lattice='"grid"' --set "/layers=[$(surface rho 0.5 0.85,0.6,0.3 1)]" --set '/render/filter="average"'
signal lattice-bcc-average --set "/layers=[$(surface rho 0.5 0.85,0.6,0.3 1)]" --set '/render/filter="average"'
signal lattice-bcc-tetrahedral --set "/layers=[$(surface rho 0.5 0.85,0.6,0.3 1)]" --set '/render/filter="tetrahedral"'
signal lattice-bcc --set "/layers=[$(surface rho 0.5 0.85,0.6,0.3 1)]" --set '/render/filter="quasi"'
# A scan
scan() { # scan NAME LAYERS [MORE]: the computed scan of a casting
    local name=$1 layers=$2
    shift 2
    picture_of scan "scan-$name" --set "/layers=[$layers]" \
        --set '/transfer/density={"colormap":"cividis","opacity":[[0,0],[0.25,0],[0.4,0.1],[0.5,0.1],[0.7,0.9],[1,0.9]]}' "$@"
}
scan pre "$(volume density '"classification":"pre","shaded":false')"
scan post "$(volume density '"shaded":false')"
scan shaded "$(volume density '"density":3')"
scan gradient "$(volume density '"quantity":"gradient","shaded":false')" \
    --set '/transfer/density={"colormap":"gray","opacity":[[0,0],[0.15,0],[0.6,0.5],[1,0.8]]}'
scan npr "$(volume density '"look":"illustration","density":0.5')" --set '/paper={"color":[1,1,1],"tooth":0}'
scan surfaces "$(surface density 60 0.75,0.78,0.82 0.35),$(surface density 165 0.9,0.6,0.3 1)"
scan xray "$(volume density '"style":"xray","density":0.12')"
scan maximum "$(volume density '"style":"maximum"')"
steel="$(surface density 60 0.6,0.68,0.75 1)"
scan cc "$steel" --set '/data={"model":"casting","lattice":"grid"}'
scan bcc "$steel"
scan half "$steel" --set '/data={"model":"casting","settings":{"nx":56,"ny":44,"nz":52}}'
scan half-average "$steel" --set '/data={"model":"casting","settings":{"nx":56,"ny":44,"nz":52}}' --set '/render/filter="average"'
# Light
shape="$(surface rho 0.5 0.85,0.6,0.3 1)"
signal light-phong --set "/layers=[$shape]"
signal light-physical --set "/layers=[$shape]" --set '/lighting/model="physical"' --set /lighting/roughness=0.25
signal light-studio --set "/layers=[$shape]" --set '/lighting/model="physical"' --set '/lighting/environment/kind="studio"' \
    --set /lighting/roughness=0.2
signal light-shadows --set "/layers=[$shape]" --set /lighting/shadows/strength=0.8 --set /lighting/shadows/occlusion=0.8
base flow flow --set "$cell"
for cast in true false; do # tubes above the hot sheet
    picture_of flow "light-meshes-$cast" \
        --set /views/volume/legend=false --set /camera/distance=1.5 --set /lighting/shadows/resolution=128 --set "/lighting/shadows/meshes=$cast" \
        --set '/layers=[{"name":"air","technique":{"type":"flow","vector":"U","channel":"O2","count":24,"from":[0,0.75,0],"to":[1,1,1],"length":4,"radius":0.007}},{"name":"temperature","technique":{"type":"volume","channel":"T","shaded":false,"density":3}}]' \
        --set '/transfer/T={"colormap":"inferno","opacity":[[0,0],[0.45,0],[0.6,0.3],[1,0.5]]}' \
        --set '/lighting/lights=[{"kind":"world","azimuth":0,"elevation":80}]' --set /lighting/shadows/strength=0.95
done
"$tessera" render evening -o "$out/light-evening.png" --view volume --size "$size"
for span in neighbours wide; do
    "$tessera" render charcoal -o "$out/gradient-$span.png" --view volume --size "$size" --set '/layers/0/technique/look="plain"' \
        --set '/layers/0/technique/color=[0.85,0.6,0.3]' --set '/appearance/theme="dark"' --set /lighting/specular=0.5 \
        --set "/render/gradient=\"$span\"" --set '/data={"model":"marschner-lobb","settings":{"nx":48,"ny":48,"nz":48,"times":1}}'
done
signal clip-sphere --set "/layers=[$shape,$(volume rho '"density":0.5')]" \
    --set '/clips=[{"kind":"sphere","keep":"outside","center":[0.6,0.6,0.6],"radius":0.7}]'
# Space and time
"$tessera" render tesseract -o "$bases/tesseract.png" --view tesseract --size 16x16 --set "$cell"
tesseract() { # tesseract NAME ARGUMENTS...: the tesseract view of its layout with changes
    local name=$1
    shift
    "$tessera" render "$bases/tesseract.png" -o "$out/$name.png" --view tesseract --size "$((${size%x*} * 4 / 3))x${size%x*}" \
        --set /views/tesseract/controls=false "$@"
}
tesseract tesseract
tesseract tesseract-turned --set /views/tesseract/turn4=[35,0,-50] --set '/views/tesseract/colorBy="fourth"' \
    --set /views/tesseract/lattice=3 --set /views/tesseract/eye=1.4
tesseract tesseract-temperature --set '/views/tesseract/fourth="T"' --set /views/tesseract/turn4=[30,20,0] \
    --set /views/tesseract/density=0.5 --set /views/tesseract/radius=5
picture time-along-z --set '/data={"model":"planted","settings":{"times":24},"timeAxis":{"axis":"z","place":0.3}}' \
    --set "/layers=[$(volume H2 '"density":4')]" --set '/selection/brushes=[]' --set /camera/distance=1.9
# Lenses
lens() { # lens NAME EFFECT LAYERS [MORE]: one in the middle of the cell
    picture "lens-$1" --set "/layers=[$3]" --set /camera/distance=1.9 --set /views/volume/legend=false \
        --set "/lenses=[{\"name\":\"lens\",\"effect\":\"$2\",\"center\":[0.0011,0.0009,0.02],\"size\":[0.17,0.17,0.17]${4:+,$4}}]"
}
inside() { # inside LAYER: drawn in the lens alone
    echo "${1%\}},\"lens\":\"lens\"}"
}
lens parameter replace "$(volume T),$(inside "$(volume O2)")"
lens technique replace "$(volume T),$(inside "$(surface O2 2.2 0.35,0.6,0.95 1)"),$(inside "$(surface H2 26.5 0.95,0.6,0.25 1)")"
lens cut replace "$(volume T)" '"shape":"box","rotation":[0,30,0],"rim":0.03'
lens only only "$(volume T)" '"shape":"cylinder"'
lens enhance enhance "$(volume T '"density":0.4')"
lens suppress suppress "$(volume T)"
lens magnify magnify "$(volume T)" '"shape":"disc","magnification":3'
# Focus and context
focus() { # focus NAME ARGUMENTS...
    local name=$1
    shift
    picture "focus-$name" --set "/layers=[$(volume T)]" \
        --set '/selection/brushes=[{"region":{"type":"range","intervals":[{"channel":"O2","lo":0,"hi":1.5,"soft":0.2},{"channel":"T","lo":355.3,"hi":360,"soft":0.1}]}}]' "$@"
}
focus opacity --set /selection/contextOpacity=0.04
focus lightness --set /selection/contextOpacity=0.3 --set /selection/contextLightness=1.5
focus blur --set /selection/contextOpacity=0.5 --set /selection/contextSaturation=0.6 --set /selection/contextBlur=0.03
