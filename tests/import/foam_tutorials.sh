#!/bin/bash
# Opens the start folder of every tutorial of OpenFOAM: each is read, or one line says why not. Not part of CI: the
# Debian packages openfoam and openfoam-examples are needed, and meshing takes a quarter of an hour.
#
#   tests/import/foam_tutorials.sh TESSERA FOLDER [SECONDS]
#
# TESSERA is the program, FOLDER gets the tutorials with their meshes (kept, and not made again, where they are there).
# A mesh is made by what the tutorial's own Allrun.pre and Allrun run, without solvers, else by blockMesh, for so many
# seconds at most (60).
set -u
[ $# -ge 2 ] || { sed -n '2,10s/^# \{0,1\}//p' "$0"; exit 2; }
tessera=$1 folder=$2 seconds=${3:-60}
examples=/usr/share/doc/openfoam-examples/examples
command -v blockMesh > /dev/null && [ -d $examples ] || { echo "needs the packages openfoam and openfoam-examples"; exit 2; }
mkdir -p "$folder"
[ -d "$folder/examples" ] || cp -r $examples "$folder/examples"

# A case is a folder with system/controlDict; those of regions and of meshes to be mapped are cases, too.
mapfile -t cases < <(find "$folder/examples" -path '*/system/controlDict*' -printf '%h\n' | sed 's|/system$||' | sort -u)

# The package has no RunFunctions, which all scripts of tutorials use: this one runs what makes meshes and fields.
export WM_PROJECT_DIR=$folder/foam FOAM_TUTORIALS=$folder/examples
mkdir -p "$WM_PROJECT_DIR/bin/tools"
ln -sfn /usr/share/openfoam/etc "$WM_PROJECT_DIR/etc"
cat > "$WM_PROJECT_DIR/bin/tools/RunFunctions" << 'END'
getApplication() { foamDictionary -entry application -value system/controlDict; }
getNumberOfProcessors() { echo 1; }
isParallel() { false; }
canCompile() { false; }
wantCompile() { false; }
restore0Dir() { rm -rf 0; cp -r 0.orig 0; }
notTest() { true; }
isTest() { false; }
cloneCase() { cp -r "$1" "$2"; }
cloneMesh() { mkdir -p "$2/constant"; cp -r "$1/constant/polyMesh" "$2/constant"; }
runApplication() {
    while :; do
        case "$1" in
            -a | -o) shift ;;
            -s | -d | -decomposeParDict) shift 2 ;;
            *) break ;;
        esac
    done
    case "$1" in
        *Mesh | *MeshToFoam | *ToFoam | *Zones | splitMeshRegions | surface* | topoSet | create* | setFields | *Set | \
        changeDictionary | transformPoints | refine* | extrude* | *mapFields | autoPatch | set* | PDR* | foamDictionary)
            "$@" ;;
        *) echo "not run: $*" ;;
    esac
}
runParallel() { runApplication "$@"; }
END

# mesh CASE: makes the mesh of a case that has none.
mesh() (
    cd "$1" || exit
    [ -e .meshed ] && exit
    touch .meshed
    for m4 in system/*.m4* constant/polyMesh/*.m4*; do
        [ -e "$m4" ] && zcat -f "$m4" | m4 > "${m4%.m4*}"
    done
    for script in Allrun.pre Allrun; do
        [ -e $script ] && timeout "$seconds" bash ./$script
    done
    find . -path '*polyMesh*' -name 'points*' | grep -q . && exit
    [ -e 0 ] || [ ! -e 0.orig ] || cp -r 0.orig 0
    timeout "$seconds" blockMesh
    for region in system/*/; do
        region=$(basename "$region")
        [ -e "system/$region/blockMeshDict" ] && timeout "$seconds" blockMesh -region "$region"
    done
    exit 0
) > /dev/null 2>&1 < /dev/null

read=0 said=0 wrong=0
: > "$folder/report"
for case in "${cases[@]}"; do
    mesh "$case"
    name=${case#"$folder/examples/"}
    out=$(timeout 300 "$tessera" info "$case" 2> "$folder/error")
    status=$?
    lines=$(wc -l < "$folder/error")
    if [ $status = 0 ]; then
        read=$((read + 1))
        echo "read   $name: $(sed -n 's/^ *samples *//p' <<< "$out"), $(sed -n 's/^ *parameters *//p' <<< "$out") parameters" >> "$folder/report"
    elif [ $status = 2 ] && [ "$lines" = 1 ] && ! grep -q 'vtk\|0x' "$folder/error"; then
        said=$((said + 1))
        echo "said   $name: $(sed "s|$case||g" "$folder/error")" >> "$folder/report"
    else
        wrong=$((wrong + 1))
        echo "WRONG  $name: status $status, $lines lines: $(head -c 300 "$folder/error")" >> "$folder/report"
    fi
done
echo "${#cases[@]} cases: $read read, $said refused with a reason in one line, $wrong otherwise"
sed -n 's/^said [^:]*: [^:]*: //p' "$folder/report" | sort | uniq -c | sort -rn | head -20
grep '^WRONG' "$folder/report"
[ $wrong = 0 ]
