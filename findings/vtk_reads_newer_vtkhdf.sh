#!/bin/sh
# A file of a newer major version is expected to be refused by a reader that does not know it. VTK 9.1 knows version 1 of
# VTKHDF; a file of version 2 with several steps (written by VTK 9.3 and later) it opens with a warning in its log, but
# without an error: no times, and the first step alone.
# libvtk9.1 and python3-vtk9 9.1.0+really9.1.0+dfsg2-5+deb12u1, python3-h5py 3.7.0-8 (Debian 12).
# Seen: "version 2.1, 2 steps: 0 times, T 1 1, error code 0". Exit status 0: still so.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
for package in python3-vtk9=9.1.0+really9.1.0+dfsg2-5+deb12u1 libvtk9.1=9.1.0+really9.1.0+dfsg2-5+deb12u1 \
    python3-h5py=3.7.0-8 python3-h5py-serial=3.7.0-8; do
    apt-get -qq download "$package"
done
for package in *.deb; do dpkg -x "$package" root; done
cat > write.py <<'END'
import h5py
import numpy as np
with h5py.File("steps.vtkhdf", "w") as file:
    root = file.create_group("VTKHDF")
    root.attrs["Version"], root.attrs["Type"] = np.array([2, 1]), np.bytes_("UnstructuredGrid")
    root["Points"] = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    root["Connectivity"], root["Offsets"], root["Types"] = np.arange(4), np.array([0, 4]), np.array([10], "u1")
    root["NumberOfPoints"], root["NumberOfCells"], root["NumberOfConnectivityIds"] = [4], [1], [4]
    root["PointData/T"] = np.array([1.0] * 4 + [2.0] * 4)  # of both steps, one after the other
    steps = root.create_group("Steps")
    steps.attrs["NSteps"] = 2
    steps["Values"], steps["PartOffsets"], steps["NumberOfParts"] = [0.0, 1.0], [0, 0], [1, 1]
    steps["PointOffsets"], steps["CellOffsets"], steps["ConnectivityIdOffsets"] = [0, 0], [[0], [0]], [[0], [0]]
    steps["PointDataOffsets/T"] = [0, 4]
END
cat > read.py <<'END'
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOHDF import vtkHDFReader
reader = vtkHDFReader()
reader.SetFileName("steps.vtkhdf")
reader.UpdateInformation()
times = reader.GetOutputInformation(0).Length(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
reader.Update()
print(times, *reader.GetOutput().GetPointData().GetArray("T").GetRange(), reader.GetErrorCode())
END
PYTHONPATH="$folder/root/usr/lib/python3/dist-packages"
export PYTHONPATH
/usr/bin/python3 write.py
library=$(find "$folder/root" -name 'libvtkIOHDF-9.1.so.*' | head -n 1)
seen=$(LD_LIBRARY_PATH=$(dirname "$library") /usr/bin/python3 read.py)
set -- $seen
echo "version 2.1, 2 steps: $1 times, T ${2%.0} ${3%.0}, error code $4"
[ "$seen" = "0 1.0 1.0 0" ]
