"""Archives as vtkImageData, for VTK and (by paraview_plugin.py) ParaView. Archives with an axis of uneven spacing are
vtkRectilinearGrid, with cell data if an axis is of cells. Each parameter is an array of point or cell data, in its unit; absent samples of numbers are NaN (integers with absent samples become floats), those of labels are 0.
"""
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkDataArraySelection
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData, vtkRectilinearGrid
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline

import tessera


class TesseraReader(VTKPythonAlgorithmBase):
    """Reads the time asked for, at a level of detail (0 = every sample), of the parameters that are switched on."""

    def __init__(self):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkDataSet")
        self._path, self._level, self._archive = "", 0, None
        self._arrays = vtkDataArraySelection()
        self._arrays.AddObserver("ModifiedEvent", lambda *_: self.Modified())

    def SetFileName(self, path):
        if path != self._path:
            self._path, self._archive = path, None
            self._arrays.RemoveAllArrays()
            self.Modified()

    def SetLevel(self, level):
        if level != self._level:
            self._level = level
            self.Modified()

    def GetDataArraySelection(self):
        return self._arrays

    def GetTimestepValues(self):
        return list(self._opened().times) if self._path else []

    def _opened(self):
        if self._archive is None:
            self._archive = tessera.open(self._path)
            for name in self._archive:
                self._arrays.AddArray(name)
        return self._archive

    def _level_read(self):
        return min(max(self._level, 0), self._opened().levels - 1)

    def RequestDataObject(self, request, inputs, outputs):
        information = outputs.GetInformationObject(0)
        kind = vtkRectilinearGrid if self._path and any(self._opened().axes(self._level_read())) else vtkImageData
        if not isinstance(information.Get(vtkDataObject.DATA_OBJECT()), kind):
            information.Set(vtkDataObject.DATA_OBJECT(), kind())
        return 1

    def RequestInformation(self, request, inputs, outputs):
        archive, information = self._opened(), outputs.GetInformationObject(0)
        axes, _ = _rulers(archive, self._level_read())
        information.Set(Pipeline.WHOLE_EXTENT(), [bound for axis in axes for bound in (0, len(axis) - 1)], 6)
        information.Set(vtkDataObject.ORIGIN(), [axis[0] for axis in axes], 3)
        information.Set(vtkDataObject.SPACING(), _spacing(axes), 3)
        times = [float(time) for time in archive.times]
        information.Remove(Pipeline.TIME_STEPS())
        for time in times:
            information.Append(Pipeline.TIME_STEPS(), time)
        information.Set(Pipeline.TIME_RANGE(), [times[0], times[-1]], 2)
        return 1

    def RequestData(self, request, inputs, outputs):
        archive, information = self._opened(), outputs.GetInformationObject(0)
        level, time = self._level_read(), 0
        if information.Has(Pipeline.UPDATE_TIME_STEP()):
            time = int(np.abs(archive.times - information.Get(Pipeline.UPDATE_TIME_STEP())).argmin())
        axes, cells = _rulers(archive, level)
        grid = information.Get(vtkDataObject.DATA_OBJECT())
        grid.SetDimensions([len(axis) for axis in axes])
        if any(archive.axes(level)):
            for put, axis in zip((grid.SetXCoordinates, grid.SetYCoordinates, grid.SetZCoordinates), axes):
                put(numpy_to_vtk(axis, deep=True))
        else:
            grid.SetOrigin([axis[0] for axis in axes])
            grid.SetSpacing(_spacing(axes))
        for name in archive:
            if not self._arrays.ArrayIsEnabled(name):
                continue
            parameter = archive[name]
            values = parameter.read(time, level)
            if np.ma.getmaskarray(values).any():
                if parameter.categorical:
                    values = values.filled(0)
                else:
                    values = values.astype(np.float64 if values.dtype == np.int32 else np.float32).filled(np.nan)
            flat = np.ascontiguousarray(np.ma.getdata(values)).reshape(-1, parameter.components)
            array = numpy_to_vtk(flat if parameter.components > 1 else flat[:, 0], deep=True)
            array.SetName(name)
            (grid.GetCellData() if cells else grid.GetPointData()).AddArray(array)
        grid.GetInformation().Set(vtkDataObject.DATA_TIME_STEP(), float(archive.times[time]))
        return 1


def _rulers(archive, level):
    """Coordinates along x, y and z, and whether values belong to the cells between them: where an axis is of cells, all
    are. Even axes then have borders half a cell from the samples, axes of points in the middle between them."""
    axes, places = archive.axes(level), archive.coordinates(level)
    if not any(axis and axis[0] == "cells" for axis in axes):
        return places, False
    rulers = []
    for axis, at, step in zip(axes, places, archive._reader.info(level)["spacing"]):
        if axis is None:
            rulers.append(at[0] + step * (np.arange(len(at) + 1) - 0.5))
        elif axis[0] == "cells":
            rulers.append(axis[1])
        else:
            rulers.append(np.concatenate((at[:1], 0.5 * (at[:-1] + at[1:]), at[-1:])))
    return rulers, True


def _spacing(axes):
    return [axis[1] - axis[0] if len(axis) > 1 else 1.0 for axis in axes]
