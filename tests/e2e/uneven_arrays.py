"""The Python package `tessera` on axes of uneven spacing, and the rectilinear grids that `tessera unpack` writes of them.
usage: uneven_arrays.py TESSERA (in an empty folder, the package on PYTHONPATH)"""
import json
import subprocess
import sys
import unittest

import numpy as np

import tessera

PROGRAM = sys.argv.pop(1)


def run(*words):
    return subprocess.run([PROGRAM, *words], check=True, capture_output=True, text=True).stdout


class Uneven(unittest.TestCase):
    """Axes of uneven spacing: layers along z, points along x."""

    def setUp(self):
        random = np.random.default_rng(2)
        self.values = random.normal(0, 1, (6, 4, 5)).astype(np.float32)
        self.values[2, 1, 3] = np.nan
        self.z = np.concatenate(([0], np.cumsum([1e-3, 1 / 3e4, 1e-5, 1e-5, 2e-4, 1e-3])))
        self.x = np.array([-1, 0.1, 0.2, 1 / 3, 5])
        self.axes = (("points", self.x), None, ("cells", self.z))
        tessera.write("uneven.tsr", {"T": self.values}, spacing=(1, 2, 1), origin=(0, 10, 0), axes=self.axes)

    def test_planes_come_back_bit_for_bit(self):
        for lattice in ("cc", "bcc"):
            tessera.write("uneven.tsr", {"T": self.values}, spacing=(1, 2, 1), origin=(0, 10, 0), axes=self.axes,
                          lattice=lattice)
            back = tessera.open("uneven.tsr")
            (of_x, x), y, (of_z, z) = back.axes()
            self.assertEqual((of_x, y, of_z), ("points", None, "cells"))
            np.testing.assert_array_equal(x, self.x)
            np.testing.assert_array_equal(z, self.z)
            x, y, z = back.coordinates()
            np.testing.assert_array_equal(x, self.x)
            np.testing.assert_array_equal(y, [10, 12, 14, 16])
            np.testing.assert_array_equal(z, 0.5 * (self.z[1:] + self.z[:-1]))
            run("verify", "uneven.tsr")
        about = json.loads(run("info", "uneven.tsr", "--json"))
        self.assertEqual(about["axes"][2], {"of": "cells", "planes": list(self.z)})
        self.assertEqual(about["bounds"], [[-1, 9, 0], [5, 17, self.z[-1]]])
        self.assertIn("spacing    x 0.1 to 4.66667, y 2, z 1e-05 to 0.001", run("info", "uneven.tsr"))
        tessera.write("even.tsr", {"T": self.values})
        self.assertEqual(tessera.open("even.tsr").axes(), (None, None, None))
        self.assertNotIn("axes", json.loads(run("info", "even.tsr", "--json")))

    def test_coarse_levels_state_their_places(self):
        wide = np.arange(40 * 4 * 4, dtype=np.float32).reshape(40, 4, 4)
        planes = np.cumsum(1.1 ** np.arange(41))
        tessera.write("levels.tsr", {"T": wide}, axes=(None, None, ("cells", planes)), wavelet="2,2")
        back = tessera.open("levels.tsr")
        self.assertGreater(back.levels, 1)
        np.testing.assert_allclose(back.coordinates(1)[2], back.coordinates()[2][::2], rtol=1e-12)
        np.testing.assert_array_equal(back["T"].read(level=1)[:, 0, 0], wide[::2, 0, 0])

    def test_wrong_axes_are_refused(self):
        for axes in ((None, None), (None,) * 4, (None, None, self.z), (None, None, ("faces", self.z)),
                     (None, None, ("points", self.z)), (None, None, ("cells", self.z[::-1])), (None, None, ("cells", "abc")),
                     (None, None, ("cells", [0, 1, 2, 3, 4, 5, np.nan])), 7 * [None]):
            with self.assertRaises(tessera.Error):
                tessera.write("wrong.tsr", {"T": self.values}, axes=axes)

    def test_a_pipe_and_append_keep_the_axes(self):
        planes = [float(z) for z in self.z]
        form = {"dims": [5, 4, 6], "dtype": "float32", "components": [{"name": "T"}],
                "axes": [None, None, {"of": "cells", "planes": planes}]}
        with open("form.json", "w", encoding="utf-8") as file:
            json.dump(form, file)
        frames = np.nan_to_num(self.values).astype("<f4").tobytes()
        subprocess.run([PROGRAM, "pack", "-", "-o", "live.tsr", "--raw", "form.json"], input=2 * frames, check=True,
                       capture_output=True)
        subprocess.run([PROGRAM, "pack", "-", "-o", "live.tsr", "--raw", "form.json", "--append"], input=frames, check=True,
                       capture_output=True)
        back = tessera.open("live.tsr")
        self.assertEqual(len(back.times), 3)
        np.testing.assert_array_equal(back.axes()[2][1], self.z)
        np.testing.assert_array_equal(back["T"][2], np.nan_to_num(self.values))
        form["axes"][2]["planes"][3] += 1e-6
        with open("form.json", "w", encoding="utf-8") as file:
            json.dump(form, file)
        other = subprocess.run([PROGRAM, "pack", "-", "-o", "live.tsr", "--raw", "form.json", "--append"], input=frames,
                               capture_output=True, text=False)
        self.assertEqual(other.returncode, 2)
        self.assertIn(b"other planes of z", other.stderr)

    def test_followed_files_keep_the_axes(self):
        run("unpack", "uneven.tsr", "-o", "part_0.raw")
        run("pack", "--follow", "part_*.raw", "-o", "followed.tsr", "--until-idle", "0.5", "--settle", "0.1")
        axes = tessera.open("followed.tsr").axes()
        np.testing.assert_array_equal(axes[0][1], self.x)
        np.testing.assert_array_equal(axes[2][1], self.z)

    def test_formats_of_one_spacing_refuse(self):
        for name in ("no.vti", "no.nrrd"):
            done = subprocess.run([PROGRAM, "unpack", "uneven.tsr", "-o", name], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2)
            self.assertIn("write .vtr", done.stderr)

    def test_xarray_has_the_places_of_the_samples(self):
        try:
            import xarray
        except ImportError:
            self.skipTest("no xarray")
        data = xarray.open_dataset("uneven.tsr", engine="tessera")
        np.testing.assert_array_equal(data["x"], self.x)
        np.testing.assert_array_equal(data["z"], 0.5 * (self.z[1:] + self.z[:-1]))

    def vtk(self):
        try:
            import vtkmodules.vtkIOXML
            return vtkmodules.vtkIOXML
        except ImportError:
            return self.skipTest("no VTK for Python")

    def test_vtk_reads_the_rectilinear_grid(self):
        reading = self.vtk()
        from vtkmodules.util.numpy_support import vtk_to_numpy
        run("unpack", "uneven.tsr", "-o", "uneven.vtr")
        reader = reading.vtkXMLRectilinearGridReader()
        reader.SetFileName("uneven.vtr")
        reader.Update()
        grid = reader.GetOutput()
        self.assertEqual(grid.GetDimensions(), (6, 5, 7))
        np.testing.assert_array_equal(vtk_to_numpy(grid.GetZCoordinates()), self.z)
        np.testing.assert_array_equal(vtk_to_numpy(grid.GetYCoordinates()), [9, 11, 13, 15, 17])
        np.testing.assert_array_equal(vtk_to_numpy(grid.GetXCoordinates()),
                                      [-1, *(0.5 * (self.x[1:] + self.x[:-1])), 5])
        np.testing.assert_array_equal(vtk_to_numpy(grid.GetFieldData().GetArray("points_x")), self.x)
        np.testing.assert_array_equal(vtk_to_numpy(grid.GetCellData().GetArray("T")), self.values.reshape(-1))

    def test_points_and_even_grids_are_point_data(self):
        reading = self.vtk()
        from vtkmodules.util.numpy_support import vtk_to_numpy
        for axes in ((None, None, ("points", self.z[:-1])), None):
            tessera.write("points.tsr", {"T": self.values}, origin=(3, 4, 5), axes=axes)
            run("unpack", "points.tsr", "-o", "points.vtr")
            reader = reading.vtkXMLRectilinearGridReader()
            reader.SetFileName("points.vtr")
            reader.Update()
            grid = reader.GetOutput()
            self.assertEqual(grid.GetDimensions(), (5, 4, 6))
            np.testing.assert_array_equal(vtk_to_numpy(grid.GetZCoordinates()),
                                          self.z[:-1] if axes else [5, 6, 7, 8, 9, 10])
            np.testing.assert_array_equal(vtk_to_numpy(grid.GetXCoordinates()), [3, 4, 5, 6, 7])
            np.testing.assert_array_equal(vtk_to_numpy(grid.GetPointData().GetArray("T")), self.values.reshape(-1))

    def test_the_reader_for_paraview_gives_rectilinear_grids(self):
        self.vtk()
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from tessera.vtk_reader import TesseraReader
        reader = TesseraReader()
        reader.SetFileName("uneven.tsr")
        reader.Update()
        grid = reader.GetOutputDataObject(0)
        self.assertEqual(grid.GetClassName(), "vtkRectilinearGrid")
        self.assertEqual(grid.GetDimensions(), (6, 5, 7))
        np.testing.assert_array_equal(vtk_to_numpy(grid.GetZCoordinates()), self.z)
        np.testing.assert_array_equal(vtk_to_numpy(grid.GetYCoordinates()), [9, 11, 13, 15, 17])
        np.testing.assert_array_equal(vtk_to_numpy(grid.GetCellData().GetArray("T")), self.values.reshape(-1))
        reader.SetFileName("even.tsr")
        tessera.write("even.tsr", {"T": self.values})
        reader.Update()
        self.assertEqual(reader.GetOutputDataObject(0).GetClassName(), "vtkImageData")


if __name__ == "__main__":
    unittest.main(verbosity=2)
