#!/usr/bin/env python3
"""Writes tests/import/kinds/: one small field by the writers of each format, and kinds.json, the table that
tests/import/kinds_test.cpp checks. Not part of the tests: run it by hand where a format or a writer changes.

    apt-get install python3-vtk9 python3-nibabel python3-tifffile python3-pydicom python3-netcdf4 python3-h5py \
        python3-meshio python3-zarr teem-apps
    python3 tests/import/generate_kinds.py

Every file holds the same 6 x 5 x 4 samples i + 10 j + 110 k of a temperature in K at origin (1, -2, 3) with spacing
(0.5, 0.25, 2) mm, corner (5, 4, 3) set to 9999 and, where the format can say so, sample (2, 1, 3) absent. What each row
expects is read back by the independent reader that it names, never taken from what was written.
"""
import json
import os
import shutil
import subprocess
import sys

import numpy as np

HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "kinds")
SIZE, SPACING, ORIGIN = (6, 5, 4), (0.5, 0.25, 2.0), (1.0, -2.0, 3.0)
ABSENT, CORNER = (2, 1, 3), (5, 4, 3)


def field(dtype=np.float32, hole=np.nan):
    """Samples [z, y, x]."""
    k, j, i = np.mgrid[0 : SIZE[2], 0 : SIZE[1], 0 : SIZE[0]]
    values = (i + 10 * j + 110 * k).astype(dtype)
    values[CORNER[::-1]] = 9999
    if hole is not None:
        values[ABSENT[::-1]] = hole
    return values


rows = []


def row(name, reader, values, spacing, origin, *, unit="mm", times=(), time_unit="", parameter=None, first=None,
        compare=True, tolerance=0):
    """`values` [t, z, y, x] as the independent reader gives them in the axes of space, absent ones NaN."""
    values = np.asarray(values, float)
    if values.ndim == 3:
        values = values[None]
    nt, nz, ny, nx = values.shape
    places = [(0, 0, 0), (nx - 1, 0, 0), (0, ny - 1, 0), (0, 0, nz - 1), CORNER, (2, 1, 3), (3, 2, 1)]
    samples = []
    for t in {0, nt - 1}:
        for x, y, z in places:
            value = values[t, z, y, x]
            samples.append([x, y, z, t, None if np.isnan(value) else float(value)])
    rows.append({"file": first or name, "reader": reader, "dims": [nx, ny, nz], "spacing": [float(v) for v in spacing],
                 "origin": [float(v) for v in origin], "lengthUnit": unit, "times": [float(t) for t in times],
                 "timeUnit": time_unit, "parameter": parameter, "absent": int(np.isnan(values[0]).sum()),
                 "samples": samples, "sameField": compare, "tolerance": tolerance})


def at(name):
    path = os.path.join(HERE, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    return path


def vtk_image(values, cells=False):
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkStringArray
    from vtkmodules.vtkCommonDataModel import vtkImageData

    image = vtkImageData()
    image.SetDimensions(*SIZE)
    image.SetSpacing(*SPACING)
    image.SetOrigin(*ORIGIN)
    array = numpy_to_vtk(values.ravel(), deep=True)
    array.SetName("T")
    image.GetPointData().SetScalars(array)
    unit = vtkStringArray()
    unit.SetName("length_unit")
    unit.InsertNextValue("mm")
    image.GetFieldData().AddArray(unit)
    return image


def by_vtk():
    import vtkmodules.vtkIOImage as io_image
    import vtkmodules.vtkIOLegacy as io_legacy
    import vtkmodules.vtkIOXML as io_xml
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkVersion

    def read(reader, path):
        reader.SetFileName(path)
        reader.Update()
        image = reader.GetOutput()
        data = vtk_to_numpy(image.GetPointData().GetArray(0)).reshape(image.GetDimensions()[::-1]).astype(float)
        return data, image.GetSpacing(), image.GetOrigin()

    version = "VTK " + vtkVersion.GetVTKVersion()
    for mode, name in ((0, "vtk_ascii.vti"), (1, "vtk_binary.vti"), (2, "vtk_appended.vti")):
        writer = io_xml.vtkXMLImageDataWriter()
        writer.SetFileName(at(name))
        writer.SetDataMode(mode)
        writer.SetInputData(vtk_image(field()))
        writer.Write()
        row(name, version, *read(io_xml.vtkXMLImageDataReader(), at(name)), parameter="T")
    writer = io_legacy.vtkStructuredPointsWriter()
    writer.SetFileName(at("vtk_legacy.vtk"))
    writer.SetFileTypeToBinary()
    writer.SetInputData(vtk_image(field()))
    writer.Write()
    row("vtk_legacy.vtk", version, *read(io_legacy.vtkStructuredPointsReader(), at("vtk_legacy.vtk")), parameter="T")
    writer = io_image.vtkMetaImageWriter()
    writer.SetFileName(at("vtk_meta.mhd"))
    writer.SetRAWFileName(at("vtk_meta.zraw"))
    writer.SetInputData(vtk_image(field()))
    writer.Write()
    row("vtk_meta.mhd", version, *read(io_image.vtkMetaImageReader(), at("vtk_meta.mhd")), unit="")


def by_nibabel():
    import nibabel

    affine = np.diag([*SPACING, 1.0])
    affine[:3, 3] = ORIGIN
    turned = affine.copy()  # the first axis runs to the left, as many scanners store it
    turned[0, 0] = -SPACING[0]
    turned[0, 3] = ORIGIN[0] + SPACING[0] * (SIZE[0] - 1)
    for name, matrix, data in (
        ("nibabel.nii", affine, field().transpose(2, 1, 0)),
        ("nibabel_left.nii.gz", turned, field().transpose(2, 1, 0)[::-1]),
    ):
        image = nibabel.Nifti1Image(data, matrix)
        image.header.set_xyzt_units("mm", "sec")
        nibabel.save(image, at(name))
        back = nibabel.as_closest_canonical(nibabel.load(at(name)))
        row(name, "nibabel " + nibabel.__version__, back.get_fdata().transpose(2, 1, 0), back.header.get_zooms()[:3],
            back.affine[:3, 3])
    series = np.stack([field().transpose(2, 1, 0), field().transpose(2, 1, 0) + 1000], axis=3)
    image = nibabel.Nifti1Image(series, affine)
    image.header.set_xyzt_units("mm", "sec")
    image.header.set_zooms((*SPACING, 2.5))
    nibabel.save(image, at("nibabel_4d.nii"))
    back = nibabel.load(at("nibabel_4d.nii"))
    row("nibabel_4d.nii", "nibabel " + nibabel.__version__, back.get_fdata().transpose(3, 2, 1, 0),
        back.header.get_zooms()[:3], back.affine[:3, 3], times=(0, 2.5), time_unit="s", compare=False)


def by_teem():
    unu = shutil.which("teem-unu") or "unu"  # Debian's name of it
    raw = at("teem.tmp.raw")
    field().tofile(raw)
    make = [unu, "make", "-i", raw, "-t", "float", "-s", *map(str, SIZE), "-e", "raw", "-en", "little",
            "-spc", "3", "-orig", "(%g,%g,%g)" % ORIGIN, "-dirs", "(%g,0,0) (0,%g,0) (0,0,%g)" % SPACING]
    for name, encoding in (("teem_raw.nrrd", "raw"), ("teem_gzip.nrrd", "gzip"), ("teem_ascii.nrrd", "ascii"),
                           ("teem_hex.nrrd", "hex")):
        subprocess.run([*make, "-o", at("teem.tmp.nrrd")], check=True)
        subprocess.run([unu, "save", "-f", "nrrd", "-e", encoding, "-i", at("teem.tmp.nrrd"), "-o", at(name)],
                       check=True)
        subprocess.run([unu, "save", "-f", "nrrd", "-e", "raw", "-en", "little", "-i", at(name), "-o",
                        at("teem.tmp.back.nrrd")], check=True)
        with open(at("teem.tmp.back.nrrd"), "rb") as file:
            head, body = file.read().split(b"\n\n", 1)
        assert b"space directions: (0.5,0,0) (0,0.25,0) (0,0,2)" in head, head
        row(name, "teem 1.12", np.frombuffer(body, "<f4").reshape(SIZE[::-1]), SPACING, ORIGIN, unit="")
    for name in os.listdir(HERE):
        if ".tmp" in name:
            os.remove(at(name))


def by_tifffile():
    import tifffile

    version = "tifffile " + tifffile.__version__
    tifffile.imwrite(at("tifffile_imagej.tif"), field(hole=None)[:, None], imagej=True,
                     resolution=(1 / SPACING[0], 1 / SPACING[1]), metadata={"spacing": SPACING[2], "unit": "mm",
                                                                            "axes": "ZCYX"})
    back = tifffile.TiffFile(at("tifffile_imagej.tif"))
    row("tifffile_imagej.tif", version, back.asarray(), SPACING, (0, 0, 0), compare=False)
    tifffile.imwrite(at("tifffile_ome.ome.tif"), field(np.uint16, None)[None, :, None], ome=True,
                     metadata={"axes": "TZCYX", "PhysicalSizeX": SPACING[0], "PhysicalSizeXUnit": "mm",
                               "PhysicalSizeY": SPACING[1], "PhysicalSizeYUnit": "mm", "PhysicalSizeZ": SPACING[2],
                               "PhysicalSizeZUnit": "mm"})
    row("tifffile_ome.ome.tif", version, tifffile.TiffFile(at("tifffile_ome.ome.tif")).asarray(), SPACING, (0, 0, 0),
        compare=False)


def by_netcdf():
    import netCDF4

    for name, kind in (("netcdf4.nc", "NETCDF4"), ("netcdf3.nc", "NETCDF3_CLASSIC"), ("netcdf_packed.nc", "NETCDF4")):
        with netCDF4.Dataset(at(name), "w", format=kind) as file:
            for axis, letter in ((2, "z"), (1, "y"), (0, "x")):
                file.createDimension(letter, SIZE[axis])
                variable = file.createVariable(letter, "f8", (letter,))
                variable[:] = ORIGIN[axis] + SPACING[axis] * np.arange(SIZE[axis])
                variable.units, variable.axis = "mm", letter.upper()
            packed = name == "netcdf_packed.nc"
            variable = file.createVariable("T", "i2" if packed else "f4", ("z", "y", "x"),
                                           fill_value=-1 if packed else 1e20)
            variable.units = "K"
            if packed:
                variable.scale_factor, variable.add_offset = 0.5, 0.0
            variable[:] = np.ma.masked_invalid(field())
        with netCDF4.Dataset(at(name)) as file:
            values = file["T"][:].astype(float).filled(np.nan)
            origin = [float(file[a][0]) for a in "xyz"]
            spacing = [float(file[a][1] - file[a][0]) for a in "xyz"]
        row(name, "netCDF4 " + netCDF4.__version__, values, spacing, origin, parameter="T")


def by_h5py():
    import h5py

    with h5py.File(at("h5py_scales.h5"), "w") as file:
        data = file.create_dataset("T", data=field(hole=-7))
        data.attrs["_FillValue"] = np.float32(-7)
        data.attrs["units"] = "K"
        for d, axis in ((0, 2), (1, 1), (2, 0)):
            scale = file.create_dataset("xyz"[axis], data=ORIGIN[axis] + SPACING[axis] * np.arange(SIZE[axis]))
            scale.attrs["units"] = "mm"
            scale.make_scale("xyz"[axis])
            data.dims[d].attach_scale(scale)
    with h5py.File(at("h5py_scales.h5")) as file:
        values = file["T"][:].astype(float)
        values[values == file["T"].attrs["_FillValue"]] = np.nan
        axes = {d.label or list(d.keys())[0]: d[0][:] for d in file["T"].dims}
    row("h5py_scales.h5", "h5py " + h5py.__version__, values, [axes[a][1] - axes[a][0] for a in "xyz"],
        [axes[a][0] for a in "xyz"], parameter="T")


def by_pydicom():
    import pydicom
    from pydicom.dataset import FileDataset, FileMetaDataset
    from pydicom.uid import ExplicitVRLittleEndian, generate_uid

    values = field(np.int16, -2000)
    series, study, frame = (generate_uid(entropy_srcs=["tessera", str(n)]) for n in range(3))
    for k in range(SIZE[2]):
        meta = FileMetaDataset()
        meta.MediaStorageSOPClassUID = "1.2.840.10008.5.1.4.1.1.2"
        meta.MediaStorageSOPInstanceUID = generate_uid(entropy_srcs=["tessera", "slice", str(k)])
        meta.TransferSyntaxUID = ExplicitVRLittleEndian
        slice_ = FileDataset(None, {}, file_meta=meta, preamble=b"\0" * 128)
        slice_.is_little_endian, slice_.is_implicit_VR = True, False
        slice_.SOPClassUID, slice_.SOPInstanceUID = meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID
        slice_.Modality, slice_.SeriesInstanceUID, slice_.StudyInstanceUID = "CT", series, study
        slice_.FrameOfReferenceUID = frame
        slice_.InstanceNumber = SIZE[2] - k  # not in the order of positions
        slice_.ImageOrientationPatient, slice_.PixelSpacing = [1, 0, 0, 0, 1, 0], [SPACING[1], SPACING[0]]
        slice_.ImagePositionPatient = [ORIGIN[0], ORIGIN[1], ORIGIN[2] + SPACING[2] * k]
        slice_.SliceThickness = SPACING[2]
        slice_.Rows, slice_.Columns = SIZE[1], SIZE[0]
        slice_.SamplesPerPixel, slice_.PhotometricInterpretation = 1, "MONOCHROME2"
        slice_.BitsAllocated = slice_.BitsStored = 16
        slice_.HighBit, slice_.PixelRepresentation, slice_.PixelPaddingValue = 15, 1, -2000
        slice_["PixelPaddingValue"].VR = "SS"
        slice_.RescaleIntercept, slice_.RescaleSlope = 0, 1
        slice_.PixelData = values[k].tobytes()
        slice_.save_as(at("pydicom/%d.dcm" % (SIZE[2] - k)), write_like_original=False)
    files = [pydicom.dcmread(at("pydicom/" + n)) for n in os.listdir(at("pydicom"))]
    files.sort(key=lambda f: float(f.ImagePositionPatient[2]))
    back = np.stack([f.pixel_array.astype(float) for f in files])
    back[back == files[0].PixelPaddingValue] = np.nan
    row("pydicom", "pydicom " + pydicom.__version__, back, SPACING, [float(v) for v in files[0].ImagePositionPatient])


def by_numpy():
    np.savez(at("numpy.npz"), T=field(), **{
        a: ORIGIN[n] + SPACING[n] * np.arange(SIZE[n]) for n, a in enumerate("xyz")})
    back = np.load(at("numpy.npz"))
    row("numpy.npz", "NumPy " + np.__version__, back["T"], [back[a][1] - back[a][0] for a in "xyz"],
        [back[a][0] for a in "xyz"], unit="", parameter="T")


def by_zarr():
    import zarr

    shutil.rmtree(at("zarr.zarr"), ignore_errors=True)
    group = zarr.open_group(at("zarr.zarr"), "w")
    group.create_dataset("0", data=field(), chunks=(3, 2, 4), compressor=zarr.Zlib(level=3), dimension_separator="/")
    group.attrs["multiscales"] = [{
        "version": "0.4", "name": "T",
        "axes": [{"name": a, "type": "space", "unit": "millimeter"} for a in "zyx"],
        "datasets": [{"path": "0", "coordinateTransformations": [
            {"type": "scale", "scale": SPACING[::-1]}, {"type": "translation", "translation": ORIGIN[::-1]}]}]}]
    row("zarr.zarr", "zarr " + zarr.__version__, zarr.open_group(at("zarr.zarr"), "r")["0"][:], SPACING, ORIGIN)


def by_meshio():
    """The field at the corners of 60 hexahedra: sampled on as many points as there are, within the rounding of that."""
    import meshio

    k, j, i = np.mgrid[0 : SIZE[2], 0 : SIZE[1], 0 : SIZE[0]]
    points = np.stack([ORIGIN[a] + SPACING[a] * n.ravel() for a, n in enumerate((i, j, k))], axis=1)
    corner = (k * SIZE[1] + j) * SIZE[0] + i
    first = corner[:-1, :-1, :-1].ravel()
    up, across = SIZE[0], SIZE[0] * SIZE[1]
    cells = np.stack([first + n for n in (0, 1, 1 + up, up, across, across + 1, across + 1 + up, across + up)], axis=1)
    mesh = meshio.Mesh(points, [("hexahedron", cells)], {"T": field(hole=None).ravel()})
    os.makedirs(at("meshio"), exist_ok=True)
    for name, options in (("mesh.vtu", {}), ("mesh.vtk", {}), ("mesh.xdmf", {}), ("mesh_gmsh.msh", {}),
                          ("mesh_tecplot.dat", {})):
        path = at("meshio/" + name)
        kind = {"mesh_gmsh.msh": "gmsh", "mesh_tecplot.dat": "tecplot"}.get(name)
        here = os.getcwd()
        os.chdir(at("meshio"))  # its writer of XDMF puts the HDF5 file into the current folder
        meshio.write(name, mesh, file_format=kind, **options)
        os.chdir(here)
        back = meshio.read(path, file_format=kind)
        order = np.lexsort(tuple(np.round((back.points - points[0]) / SPACING).T))
        values = np.asarray(back.point_data["T"]).ravel()[order].reshape(SIZE[::-1])
        row("meshio/" + name, "meshio " + meshio.__version__, values, SPACING, ORIGIN, unit="", parameter="T",
            compare=False, tolerance=0.3)


def by_text():
    """A table of points, and the text of a Gaussian cube: no reader but the definition."""
    lines = ["x [mm],y [mm],z [mm],T [K]"]
    for k in range(SIZE[2]):
        for j in range(SIZE[1]):
            for i in range(SIZE[0]):
                value = field()[k, j, i]
                place = [ORIGIN[a] + SPACING[a] * n for a, n in enumerate((i, j, k))]
                lines.append(",".join("%g" % v for v in place) + "," + ("" if np.isnan(value) else "%g" % value))
    with open(at("table.csv"), "w") as file:
        file.write("\n".join(lines) + "\n")
    back = np.genfromtxt(at("table.csv"), delimiter=",", skip_header=1)
    row("table.csv", "NumPy " + np.__version__, back[:, 3].reshape(SIZE[::-1]), SPACING, ORIGIN, parameter="T")


def main():
    wanted = sys.argv[1:]
    shutil.rmtree(HERE, ignore_errors=True)
    os.makedirs(HERE)
    for make in (by_vtk, by_nibabel, by_teem, by_tifffile, by_netcdf, by_h5py, by_pydicom, by_numpy, by_zarr, by_meshio,
                 by_text):
        if not wanted or make.__name__[3:] in wanted:
            make()
    with open(at("kinds.json"), "w") as file:
        file.write("[\n" + ",\n".join(json.dumps(r) for r in rows) + "\n]\n")
    print(len(rows), "rows,", sum(os.path.getsize(os.path.join(d, f)) for d, _, n in os.walk(HERE) for f in n), "bytes")


main()
