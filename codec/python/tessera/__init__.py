"""Archives of Tessera (.tsr) as NumPy arrays.

    import tessera
    run = tessera.open("run.tsr")
    run.times, run.parameters             # array([0., 0.03, ...]), ['O2', 'T', 'U', ...]
    T = run["T"]                          # a parameter: T.unit, T.shape == (times, z, y, x)
    T[-1]                                 # the last time, as a masked array [z, y, x]
    T[0, 10:20, :, 5]                     # decodes only what that box needs
    T.read(time=0, level=2)               # every fourth sample
    run["U"][0]                           # a vector: [z, y, x, 3]

    tessera.write("new.tsr", {"T": values}, times=[0, 1], spacing=(1e-4, 1e-4, 4e-4), units={"T": "K"})
    tessera.write("new.tsr", {"T": values}, axes=(None, None, ("cells", borders)))  # layers along z

Arrays are indexed [time, z, y, x(, component)]; sizes, spacings and origins are given as (x, y, z). Absent samples are
masked. What an archive stores on the body-centred lattice is resampled to the grid it came from, as `tessera unpack`
does. `xarray.open_dataset("run.tsr", engine="tessera")` opens an archive as an xarray data set.
"""
import json
import operator
import os

import numpy as np

from ._tessera import Error, Reader
from ._tessera import write as _write

__all__ = ["Archive", "Error", "Parameter", "open", "write"]


class Archive:
    """An open archive; see the help of the module. Raises Error for a file that is none, or is damaged."""

    def __init__(self, path):
        self.path = os.fspath(path)
        self._reader = Reader(self.path)
        self._info = self._reader.info(0)
        self.times = np.array(self._info["times"])
        self.quantities = {name: np.array(values) for name, _, values in self._info["quantities"]}
        self.quantity_units = {name: unit for name, unit, _ in self._info["quantities"]}
        self._parameters = {about["name"]: Parameter(self, i, about) for i, about in enumerate(self._info["parameters"])}

    name = property(lambda self: self._info["name"])
    time_name = property(lambda self: self._info["time_name"], doc="what `times` count: time, voltage, ...")
    time_unit = property(lambda self: self._info["time_unit"])
    length_unit = property(lambda self: self._info["length_unit"])
    provenance = property(lambda self: self._info["provenance"])
    levels = property(lambda self: self._reader.levels, doc="number of levels of detail")
    lattice = property(lambda self: self._reader.lattice, doc="of the stored samples: cc, bcc or d4")
    lossless = property(lambda self: self._reader.lossless, doc="whether every stored sample is exact")
    max_error = property(lambda self: self._reader.max_error, doc="otherwise the bound, relative to a parameter's range")

    @property
    def parameters(self):
        """The names of the parameters."""
        return list(self._parameters)

    def __getitem__(self, name):
        try:
            return self._parameters[name]
        except KeyError:
            raise KeyError(f"{self.path}: no parameter {name!r}; there are {', '.join(self._parameters)}") from None

    def __iter__(self):
        return iter(self._parameters)

    def __len__(self):
        return len(self._parameters)

    def __contains__(self, name):
        return name in self._parameters

    def size(self, level=0):
        """Samples along (x, y, z)."""
        return tuple(self._reader.info(level)["size"])

    def axes(self, level=0):
        """Axes of uneven spacing along x, y and z: None for an even one, else ("cells", borders of the cells, one more
        than samples) or ("points", places of the samples), in `length_unit`."""
        return tuple(axis and (axis[0], np.array(axis[1])) for axis in self._reader.info(level)["axes"])

    def coordinates(self, level=0):
        """Positions of the samples along x, y and z, in `length_unit`: three arrays."""
        info = self._reader.info(level)
        even = (o + d * np.arange(n) for o, d, n in zip(info["origin"], info["spacing"], info["size"]))
        return tuple(each if axis is None else np.array(places)
                     for each, axis, places in zip(even, info["axes"], info["coordinates"]))

    def __repr__(self):
        x, y, z = self.size()
        return f"<tessera.Archive {self.path!r}: {', '.join(self._parameters)}; {x} x {y} x {z}, {len(self.times)} times>"


class Parameter:
    """A parameter of an archive: an array [time, z, y, x(, component)] that is read where it is indexed."""

    def __init__(self, archive, index, about):
        self._archive, self._index = archive, index
        self.name, self.unit = about["name"], about["unit"]
        self.components = about["components"]
        self.labels = about["labels"]  # names by value, of a label
        self.categorical = about["categorical"]
        self.ranges = about["ranges"]  # (lowest, highest) of each component, then of the magnitude

    @property
    def shape(self):
        x, y, z = self._archive.size()
        return (len(self._archive.times), z, y, x) + ((self.components,) if self.components > 1 else ())

    ndim = property(lambda self: len(self.shape))

    @property
    def dtype(self):
        """Read from one sample: samples keep their type unless they are scaled."""
        return self.read(0, box=((0, 1),) * 3).dtype

    def read(self, time=0, level=0, box=None):
        """One time (an index) at a level of detail, as a masked array [z, y, x(, component)].

        box: ((z0, z1), (y0, y1), (x0, x1)), half open, in samples of that level; all of it by default.
        """
        time = _within(time, len(self._archive.times), "time")
        size = self._archive.size(level)[::-1]
        box = tuple((0, n) for n in size) if box is None else box
        begin, end = ([int(pair[side]) for pair in box][::-1] for side in (0, 1))
        parts = [self._archive._reader.read(self._index, c, time, level, begin, end) for c in range(self.components)]
        values, absent = zip(*parts)
        if all(mask is None for mask in absent):
            absent = np.ma.nomask
        else:
            absent = _joined([np.zeros(v.shape, bool) if m is None else m for v, m in parts])
        return np.ma.MaskedArray(_joined(values), absent)

    def __getitem__(self, key):
        key = self._full(key)
        lengths = self.shape
        picked = [range(_within(k, n, "index"), _within(k, n, "index") + 1) if not isinstance(k, slice)
                  else range(*k.indices(n)) for k, n in zip(key, lengths)]
        shape = tuple(len(each) for each in picked)
        if 0 in shape:
            out = np.ma.MaskedArray(np.empty(shape, self.dtype))
        else:
            box = tuple((min(each), max(each) + 1) for each in picked[1:4])
            inner = tuple(_from_first(each) for each in picked[1:4])
            if self.components > 1:
                inner += (slice(None) if isinstance(key[4], slice) and len(picked[4]) == self.components and
                          picked[4].step == 1 else list(picked[4]),)
            out = np.ma.stack([_picked(self.read(t, box=box), inner) for t in picked[0]])
        return out[tuple(slice(None) if isinstance(k, slice) else 0 for k in key)]

    def __array__(self, dtype=None):
        """All times. Absent samples of floats are NaN; a parameter of integers with absent samples is refused."""
        values = self[:]
        if values.mask.any():
            if values.dtype.kind != "f":
                raise Error(f"{self._archive.path}: {self.name}: integers with absent samples; index it for masked arrays")
            values = values.filled(np.nan)
        return np.asarray(values, dtype=dtype)

    def _full(self, key):
        """The key with one entry for each axis."""
        key = key if isinstance(key, tuple) else (key,)
        dots = [i for i, k in enumerate(key) if k is Ellipsis]  # not `in`, since arrays have no single ==
        if len(dots) > 1 or len(key) - len(dots) > self.ndim:
            raise IndexError(f"{self.name} has {self.ndim} axes")
        at = dots[0] if dots else len(key)
        rest = tuple(k for k in key[at:] if k is not Ellipsis)
        return key[:at] + (slice(None),) * (self.ndim - at - len(rest)) + rest

    def __repr__(self):
        unit = f" [{self.unit}]" if self.unit else ""
        return f"<tessera.Parameter {self.name}{unit} {self.shape}>"


def open(path):
    """Opens an archive (.tsr)."""
    return Archive(path)


def write(path, parameters, times=None, spacing=(1, 1, 1), origin=(0, 0, 0), *, units=None, labels=None, name="",
          length_unit="", time_name="time", time_unit="s", quantities=None, lattice="cc", max_error=0, axes=None,
          **options):
    """Packs arrays into an archive.

    parameters: arrays by name, [z, y, x] or [time, z, y, x], vectors with a last axis of 3; uint8, int16, uint16, int32
        or float32 in any byte order (float64 is rounded to float32, bool is uint8). Masked and NaN samples are absent. Without `times`, or with one, an
        array of four axes whose last has 3 members is a vector at one time.
    times: one number for each time, rising; by default 0, 1, ...
    spacing, origin: (x, y, z) in length_unit ("": not stated).
    axes: of uneven spacing, as Archive.axes() gives them: for x, y and z None (even, by spacing and origin),
        ("cells", n + 1 borders of the cells of n samples) or ("points", n places of the samples).
    units: by parameter. labels: {parameter: {value: name}} makes a parameter of integers a label.
    quantities: {name: (unit, values over times)}.
    lattice: "cc" keeps every sample, "bcc" resamples to 70.7 % of them, "d4" to 50 % in space and time.
    max_error: 0 stores every sample exactly; else the largest error of a sample, relative to the parameter's range.
    options: others of `tessera pack`, by their keys (threshold={...}, brickSize=32, ...).
    """
    if not os.fspath(path).endswith(".tsr"):
        raise Error(f"{path}: the name of an archive ends with .tsr")
    for given, what in ((parameters, "parameters"), (units or {}, "units"), (labels or {}, "labels")):
        if not isinstance(given, dict) and not hasattr(given, "items"):
            raise Error(f"{path}: {what} is no dictionary by the names of parameters")
        for key in given:
            if not isinstance(key, str) or not key:
                raise Error(f"{path}: {what}: {key!r} is no name of a parameter")
            if key not in parameters:
                raise Error(f"{path}: {what}: there is no parameter {key!r}")
    for given, what in ((spacing, "spacing"), (origin, "origin")):
        if np.shape(given) != (3,):
            raise Error(f"{path}: {what} is {given!r}, not three numbers (x, y, z)")
    units, labels = units or {}, labels or {}
    texts = [("name", name), ("length_unit", length_unit), ("time_name", time_name), ("time_unit", time_unit)]
    texts += [(f"the unit of {key}", unit) for key, unit in units.items()]
    texts += [(f"a label of {key}", text) for key, names in labels.items() for text in names.values()]
    texts += [text for key, (unit, _) in (quantities or {}).items() for text in (("a quantity", key), ("its unit", unit))]
    for what, text in texts + [("a parameter", key) for key in parameters]:
        if not isinstance(text, str) or any("\ud800" <= c <= "\udfff" for c in text):
            raise Error(f"{path}: {what} is {text!r}, no text in Unicode")
    given = []
    for key, values in parameters.items():
        samples, absent = _samples(key, values, times)
        given.append({"name": key, "unit": units.get(key, ""), "samples": samples, "absent": absent,
                      "categorical": key in labels, "labels": labels.get(key, {})})
    if not given:
        raise Error(f"{path}: no parameter")
    shape = given[0]["samples"].shape[:4]
    for each in given:
        if each["samples"].shape[:4] != shape:
            raise Error(f"{path}: {each['name']} has the shape {each['samples'].shape[:4]}, {given[0]['name']} {shape}")
    times = [float(t) for t in (range(shape[0]) if times is None else times)]
    if len(times) != shape[0] or not np.isfinite(times).all() or any(a >= b for a, b in zip(times, times[1:])):
        raise Error(f"{path}: times must rise, one for each of the {shape[0]} of the arrays")
    quantities = [(key, unit, [float(v) for v in values]) for key, (unit, values) in (quantities or {}).items()]
    for key, _, values in quantities:
        if len(values) != len(times):
            raise Error(f"{path}: {key} has {len(values)} values for {len(times)} times")
    axes = [None] * 3 if axes is None else list(axes)
    if len(axes) != 3:
        raise Error(f"{path}: {len(axes)} axes, not three (x, y, z)")
    axes = [_axis(path, name, axis) for name, axis in zip("xyz", axes)]
    about = {"size": shape[:0:-1], "axes": axes, "spacing": tuple(map(float, spacing)), "origin": tuple(map(float, origin)),
             "name": name, "length_unit": length_unit, "times": times, "time_name": time_name, "time_unit": time_unit,
             "quantities": quantities}
    if lattice not in ("cc", "bcc", "d4"):
        raise Error(f"{path}: lattice is {lattice!r}; there are 'cc', 'bcc' and 'd4'")
    if not 0 <= max_error < 1:
        raise Error(f"{path}: max_error is {max_error}, not in 0 .. 1")
    if lattice != "bcc":  # what is not given has the defaults of `tessera pack`
        options["lattice"] = lattice
    if max_error > 0:
        options.update(maxError=max_error, lossless=False)
    _write(os.fspath(path), about, given, json.dumps(options))


def _axis(path, name, axis):
    """One of `axes` as (what its planes are, list of numbers)."""
    if axis is None:
        return None
    try:
        of, planes = axis
        planes = np.asarray(planes, dtype=np.float64)
    except (TypeError, ValueError):
        planes = np.empty(0)
    if planes.ndim != 1 or planes.size == 0 or not isinstance(of, str):
        raise Error(f"{path}: axes: {name} is neither None, nor (\"cells\" or \"points\", numbers)")
    return of, planes.tolist()


def _samples(name, values, times):
    """Contiguous [time, z, y, x, component] and a mask of the same shape, empty where nothing is absent."""
    absent = np.ma.getmaskarray(values)
    values = np.asarray(np.ma.getdata(values))
    values = values.astype(values.dtype.newbyteorder("="), copy=False)
    if values.dtype == np.float64 or values.dtype == np.float16:
        values = values.astype(np.float32)
    if values.dtype == np.bool_:
        values = values.astype(np.uint8)
    if values.dtype.kind == "f":
        absent = absent | np.isnan(values)
    several = times is not None and len(times) > 1
    vector = values.ndim in (4, 5) and values.shape[-1] == 3 and (values.ndim == 5 or not several)
    axes = values.ndim - vector
    if axes not in (3, 4):
        raise Error(f"{name}: {values.ndim} axes; [z, y, x] or [time, z, y, x] are wanted, and 3 components last")
    shape = ((1,) if axes == 3 else ()) + values.shape + (() if vector else (1,))
    samples = np.ascontiguousarray(values.reshape(shape))
    mask = np.ascontiguousarray(absent.reshape(shape).astype(np.uint8)) if absent.any() else np.empty(0, np.uint8)
    return samples, mask


def _within(index, length, what):
    """An index counted from the start; negative ones count from the end."""
    try:
        at = operator.index(index)
    except TypeError:
        raise IndexError(f"{what} {index!r} is neither a whole number nor a slice; lists and arrays of indices are not "
                         "taken: read first, then pick") from None
    if not -length <= at < length:
        raise IndexError(f"{what} {at} of {length}")
    return at + length if at < 0 else at


def _from_first(picked):
    """Where the members of a range lie in a box that begins with the least of them."""
    return [each - min(picked) for each in picked] if picked.step != 1 else slice(None)


def _picked(values, along):
    """Picks along each axis by itself; NumPy would take lists for several axes as positions of single samples."""
    for axis, one in enumerate(along):
        values = values[(slice(None),) * axis + (one,)]
    return values


def _joined(parts):
    return parts[0] if len(parts) == 1 else np.stack(parts, axis=-1)
