#!/bin/sh
# VTK's pipeline is said to give a new output for each time: what was kept of one by ShallowCopy stays as it was. The
# reader of OpenFOAM fills the grids anew that it gave out before, and ShallowCopy of blocks shares these grids. So a
# program that keeps a copy of time 0 and then asks for time 1 has the values of time 1 twice, without any message.
# A copy of every grid in the blocks (RecursiveShallowCopy, DeepCopy) keeps its own.
# libvtk9.1 and python3-vtk9 9.1.0+really9.1.0+dfsg2-5+deb12u1 (Debian 12). Seen: "kept 310, deep 300". Exit status 0: still so.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
for package in python3-vtk9 libvtk9.1; do apt-get -qq download "$package=9.1.0+really9.1.0+dfsg2-5+deb12u1"; done
for package in *.deb; do dpkg -x "$package" root; done
mkdir -p case/constant/polyMesh case/0 case/1 case/system
head() { printf 'FoamFile { version 2.0; format ascii; class %s; object x; }\n%s\n' "$1" "$2"; }
head dictionary 'startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1; writeControl timeStep;
writeInterval 1;' > case/system/controlDict
head vectorField '8((0 0 0)(1 0 0)(1 1 0)(0 1 0)(0 0 1)(1 0 1)(1 1 1)(0 1 1))' > case/constant/polyMesh/points
head faceList '6(4(0 3 2 1) 4(4 5 6 7) 4(0 1 5 4) 4(3 7 6 2) 4(0 4 7 3) 4(1 2 6 5))' > case/constant/polyMesh/faces
head labelList '6(0 0 0 0 0 0)' > case/constant/polyMesh/owner
head labelList '0()' > case/constant/polyMesh/neighbour
head polyBoundaryMesh '1(walls { type wall; nFaces 6; startFace 0; })' > case/constant/polyMesh/boundary
for time in 0 1; do
    head volScalarField "dimensions [0 0 0 1 0 0 0]; internalField uniform 3${time}0;
boundaryField { walls { type zeroGradient; } }" | sed 's/object x/object T/' > case/$time/T
done
touch case/case.foam
cat > read.py << 'END'
from vtkmodules.vtkIOGeometry import vtkOpenFOAMReader
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet
reader = vtkOpenFOAMReader()
reader.SetFileName("case/case.foam")
reader.UpdateTimeStep(0)
kept, deep = vtkMultiBlockDataSet(), vtkMultiBlockDataSet()
kept.ShallowCopy(reader.GetOutput())
deep.DeepCopy(reader.GetOutput())
reader.UpdateTimeStep(1)
value = lambda blocks: blocks.GetBlock(0).GetCellData().GetArray("T").GetValue(0)
print("kept %g, deep %g" % (value(kept), value(deep)))
END
LD_LIBRARY_PATH=$(dirname "$(find "$folder/root" -name 'libvtkIOGeometry-9.1.so.1')") \
    PYTHONPATH=$folder/root/usr/lib/python3/dist-packages /usr/bin/python3 read.py | tee said
grep -qx 'kept 310, deep 300' said
