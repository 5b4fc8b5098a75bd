"""Archives as xarray data sets: xarray.open_dataset("run.tsr", engine="tessera"). Values are read where they are used.

Absent samples are NaN: integers with absent samples become float32 (int32: float64).
"""
import os

import numpy as np
import xarray
from xarray.backends import BackendArray, BackendEntrypoint
from xarray.core import indexing

import tessera


class _Lazy(BackendArray):
    def __init__(self, parameter):
        self.parameter, self.shape = parameter, parameter.shape
        dtype = parameter.dtype
        self.integers = dtype.kind != "f"
        self.dtype = dtype if not self.integers or parameter.categorical else np.dtype(
            np.float64 if dtype.itemsize > 2 else np.float32)

    def __getitem__(self, key):
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.BASIC, self._read)

    def _read(self, key):
        values = self.parameter[key]
        if self.parameter.categorical:
            return np.ma.filled(values, 0).astype(self.dtype)
        return np.ma.filled(np.ma.asarray(values).astype(self.dtype), np.nan)


class TesseraBackend(BackendEntrypoint):
    """Opens .tsr files."""

    description = "Archives of Tessera (.tsr)"

    def open_dataset(self, filename_or_obj, *, drop_variables=None):
        archive = tessera.open(filename_or_obj)
        x, y, z = archive.coordinates()
        length = {"units": archive.length_unit} if archive.length_unit else {}
        coordinates = {"x": ("x", x, length), "y": ("y", y, length), "z": ("z", z, length),
                       "time": ("time", archive.times, {"long_name": archive.time_name})}
        if archive.time_unit and archive.time_name != "time":
            coordinates["time"][2]["units"] = archive.time_unit
        elif archive.time_unit:
            coordinates["time"][2]["time_unit"] = archive.time_unit  # "units" of a time would be decoded as dates
        for name, values in archive.quantities.items():
            coordinates[name] = ("time", values, {"units": archive.quantity_units[name]})
        variables = {}
        for name in archive:
            parameter = archive[name]
            axes = ("time", "z", "y", "x") + (("component",) if parameter.components > 1 else ())
            attributes = {"units": parameter.unit}
            if parameter.labels:
                attributes["flag_values"] = list(parameter.labels)
                attributes["flag_meanings"] = " ".join(text.replace(" ", "_") for text in parameter.labels.values())
            variables[name] = xarray.Variable(axes, indexing.LazilyIndexedArray(_Lazy(parameter)), attributes)
        for name in drop_variables or ():
            variables.pop(name, None)
        return xarray.Dataset(variables, coordinates, {"title": archive.name, "history": archive.provenance})

    def guess_can_open(self, filename_or_obj):
        return isinstance(filename_or_obj, (str, os.PathLike)) and os.fspath(filename_or_obj).endswith(".tsr")
