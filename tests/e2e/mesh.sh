#!/bin/bash
# mesh as a user runs it: arguments TESSERA SOURCE_DIR.
tessera=$1
source "$2/tests/e2e/common.bash"

check "data" 0 "$tessera" generate marschner-lobb -o ml.tsr --size 24x24x24
check "data as .vti" 0 "$tessera" generate marschner-lobb -o ml.vti --size 24x24x24
for ending in ply stl obj vtp; do
    check "a mesh as .$ending" 0 "$tessera" mesh ml.tsr --channel rho --iso 0.5 -o surface.$ending
    [ -s surface.$ending ] || fail "no surface.$ending"
done
grep -q "triangles" out.txt || fail "mesh says nothing"
[ "$(head -c 3 surface.ply)" = ply ] || fail "surface.ply is none"
check "with another parameter" 0 "$tessera" mesh ml.tsr --channel rho --iso 0.5 --color-by rho --level 1 -o coarse.ply
grep -aq "property float rho" coarse.ply || fail "no scalars"
check "a surface that is not there" 2 "$tessera" mesh ml.tsr --channel rho --iso 50 -o none.ply
[ -e none.ply ] && fail "none.ply was written"
check "an unknown parameter" 2 "$tessera" mesh ml.tsr --channel nothing --iso 0.5 -o none.ply
grep -q "rho" err.txt || fail "the known parameters are not named"
check "an unknown form" 2 "$tessera" mesh ml.tsr --channel rho --iso 0.5 -o none.xyz
check "no value" 1 "$tessera" mesh ml.tsr --channel rho -o none.ply
check "of the only parameter" 0 "$tessera" mesh ml.tsr --iso 0.5 -o only.ply
cmp -s only.ply surface.ply || fail "the only parameter is not what is taken"
"$tessera" info ml.tsr > info.txt
grep -qx "  times      1" info.txt || fail "info says more of one time than that it is one: $(grep times info.txt)"
check "of one of several parameters" 2 "$tessera" mesh planted --iso 0.5 -o none.ply
grep -q -- "--channel; there are .*,.*" err.txt || fail "the parameters to choose from are not named"
check "of a model" 0 "$tessera" mesh marschner-lobb --channel rho --iso 0.5 -o model.ply

# VTK reads what we wrote, where it is installed.
if python3 -c "import vtk" 2>/dev/null; then
    python3 - <<'PYTHON' || fail "VTK reads the files otherwise"
import vtk
counts = set()
stl = vtk.vtkSTLReader()
stl.MergingOff()  # merged corners make some of the smallest triangles none, which VTK 9.3 leaves out
for reader, name in ((vtk.vtkPLYReader(), "surface.ply"), (vtk.vtkXMLPolyDataReader(), "surface.vtp"),
                     (vtk.vtkOBJReader(), "surface.obj"), (stl, "surface.stl")):
    reader.SetFileName(name)
    reader.Update()
    counts.add(reader.GetOutput().GetNumberOfPolys())
assert len(counts) == 1 and min(counts) > 1000, counts
PYTHON
fi

finish
