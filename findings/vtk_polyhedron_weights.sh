#!/bin/sh
# VTK's cells give the weights of their corners by InterpolateFunctions(pcoords, weights), at a place in the cell's own
# coordinates from 0 to 1: what EvaluatePosition returned as pcoords. A polyhedron takes a place of space there instead,
# with the same signature and without a message. A program that interpolates in all cells alike, by the pcoords that it
# has from EvaluatePosition, gets values of elsewhere in polyhedra; EvaluateLocation gives the right ones.
# libvtk9.1 and python3-vtk9 9.1.0+really9.1.0+dfsg2-5+deb12u1 (Debian 12). Seen, for the value x in a cell from 10 to 12
# at x = 11.5: "hexahedron 11.5, polyhedron 10.74, by EvaluateLocation 11.5". Exit status 0: still so.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
for package in python3-vtk9 libvtk9.1; do apt-get -qq download "$package=9.1.0+really9.1.0+dfsg2-5+deb12u1"; done
for package in *.deb; do dpkg -x "$package" root; done
cat > read.py << 'END'
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints, reference
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
grid, points = vtkUnstructuredGrid(), vtkPoints()
corners = [(10, 0, 0), (12, 0, 0), (12, 2, 0), (10, 2, 0), (10, 0, 2), (12, 0, 2), (12, 2, 2), (10, 2, 2)]
for corner in corners:
    points.InsertNextPoint(corner)
grid.SetPoints(points)
grid.InsertNextCell(12, 8, range(8))
faces = vtkIdList()
for n in [6, 4, 0, 3, 2, 1, 4, 4, 5, 6, 7, 4, 0, 1, 5, 4, 4, 1, 2, 6, 5, 4, 2, 3, 7, 6, 4, 3, 0, 4, 7]:
    faces.InsertNextId(n)
grid.InsertNextCell(42, faces)
def at(cell, located):
    closest, pcoords, weights, part, distance = [0] * 3, [0] * 3, [0] * 8, reference(0), reference(0)
    cell.EvaluatePosition((11.5, 1, 1), closest, part, pcoords, distance, weights)
    place = [0] * 3
    if located:
        cell.EvaluateLocation(part, pcoords, place, weights)
    else:
        cell.InterpolateFunctions(pcoords, weights)
    ids = cell.GetPointIds()
    return sum(w * corners[ids.GetId(n)][0] for n, w in enumerate(weights))
print("hexahedron %.4g, polyhedron %.4g, by EvaluateLocation %.4g"
      % (at(grid.GetCell(0), False), at(grid.GetCell(1), False), at(grid.GetCell(1), True)))
END
LD_LIBRARY_PATH=$(dirname "$(find "$folder/root" -name 'libvtkIOGeometry-9.1.so.1')") \
PYTHONPATH=$(dirname "$(find "$folder/root" -type d -name vtkmodules)") /usr/bin/python3 read.py | tee seen
grep -qx 'hexahedron 11.5, polyhedron 10.74, by EvaluateLocation 11.5' seen
