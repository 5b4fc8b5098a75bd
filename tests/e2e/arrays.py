"""The Python package `tessera`, beside what `tessera unpack` writes and beside the arrays that were packed.
usage: arrays.py TESSERA (in an empty folder, the package on PYTHONPATH)"""
import json
import subprocess
import sys
import unittest

import numpy as np

import tessera

PROGRAM = sys.argv.pop(1)


def run(*words):
    return subprocess.run([PROGRAM, *words], check=True, capture_output=True, text=True).stdout


def unpacked(archive, name, *options):
    """What `tessera unpack` writes of a parameter: an array [time, component, z, y, x]."""
    run("unpack", archive, "-o", "unpacked.raw", "-p", name, *options)
    with open("unpacked.json", encoding="utf-8") as file:
        about = json.load(file)
    x, y, z = about["dims"]
    parts = about["components"]
    time = np.dtype([(part["name"], part.get("dtype", about["dtype"]), (z, y, x)) for part in parts])
    times = np.fromfile("unpacked.raw", time, len(about["times"]))
    return np.stack([times[part["name"]] for part in parts if "presence_of" not in part], axis=1)


def same(a, b, what=""):
    """The same values, absent at the same places."""
    assert np.shape(a) == np.shape(b), (what, np.shape(a), np.shape(b))
    np.testing.assert_array_equal(np.ma.getmaskarray(a), np.ma.getmaskarray(b), str(what))
    np.testing.assert_array_equal(np.ma.filled(a, 0), np.ma.filled(b, 0), str(what))


class Reading(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        run("generate", "fuel-cell", "--even", "-o", "exact.tsr", "--size", "11x13x70", "--times", "3")
        run("convert", "exact.tsr", "-o", "cc.tsr", "--lattice", "cc", "--brick-size", "16")
        cls.cc, cls.bcc = tessera.open("cc.tsr"), tessera.open("exact.tsr")

    def test_what_is_in_it(self):
        about = json.loads(run("info", "cc.tsr", "--json"))
        self.assertEqual(self.cc.parameters, [p["name"] for p in about["parameters"]])
        self.assertEqual([self.cc[n].unit for n in self.cc], [p["unit"] for p in about["parameters"]])
        self.assertEqual(list(self.cc.times), about["times"])
        self.assertEqual(self.cc["T"].shape, (3, 70, 13, 11))
        self.assertEqual(self.cc["U"].shape, (3, 70, 13, 11, 3))
        self.assertEqual(self.cc.size(), (11, 13, 70))
        self.assertIn("T", self.cc)
        self.assertEqual(len(self.cc), len(self.cc.parameters))

    def test_samples_are_those_that_unpack_writes(self):
        for archive, file in ((self.cc, "cc.tsr"), (self.bcc, "exact.tsr")):
            for name in ("T", "U", "O2", "region"):
                wanted = unpacked(file, name)
                got = archive[name][:]
                self.assertEqual(got.dtype, wanted.dtype, name)
                for c in range(wanted.shape[1]):
                    one = got[..., c] if wanted.shape[1] > 1 else got
                    present = ~np.ma.getmaskarray(one)
                    self.assertTrue(present.any())
                    np.testing.assert_array_equal(one.data[present], wanted[:, c][present], name)
                    self.assertTrue(np.isnan(wanted[:, c][~present]).all() or not present.all())

    def test_absent_samples_are_masked(self):
        mask = np.ma.getmaskarray(self.cc["O2"][0])
        self.assertGreater(mask.sum(), 0)
        self.assertLess(mask.sum(), mask.size)
        self.assertFalse(np.ma.getmaskarray(self.cc["T"][0]).any())

    def test_indexing_is_that_of_numpy(self):
        for archive in (self.cc, self.bcc):
            self.index(archive["T"], archive["U"])

    def index(self, T, U):
        whole, vectors = T[:], U[:]
        for key in (0, -1, (1, 5), (slice(None), 10, 3, 4), (1, slice(10, 40)), (2, slice(60, 10, -7), 5),
                    (..., 3), (0, ..., slice(1, None, 3)), (slice(0, 3, 2), -1, slice(2, 9)), (0, slice(5, 5)),
                    (1, 69, 12, 10), (0, slice(None, None, 2), slice(None, None, 3)),
                    (slice(0, 3, 2), slice(60, 10, -7), slice(1, None, 2), slice(None, None, 4))):
            same(T[key], whole[key], key)
        for key in (1, (0, 3, 4, 5), (0, slice(3, 9), ..., 2), (..., slice(0, 2)), (2, 5, 6, 7, -1), (..., slice(None, None, -1)),
                    (0, slice(None, None, 2), ..., slice(0, 3, 2)), (1, slice(9, 3, -2), slice(1, 9, 3), 4, slice(None, None, -2))):
            same(U[key], vectors[key], key)
        for key in (3, (0, 70), (0, 0, 0, 0, 0), (..., ...), np.array([0, 1]), [0, 1], "x", 1.5):
            with self.assertRaises(IndexError):
                T[key]

    def test_levels(self):
        for name in ("T", "O2"):
            got, wanted = self.cc[name].read(time=2, level=1), unpacked("cc.tsr", name, "--level", "1")[2, 0]
            self.assertEqual(got.shape, (35, 7, 6))
            present = ~np.ma.getmaskarray(got)
            np.testing.assert_array_equal(got.data[present], wanted[present])
        box = self.cc["T"].read(time=2, level=1, box=((10, 20), (0, 7), (3, 4)))
        np.testing.assert_array_equal(box, self.cc["T"].read(time=2, level=1)[10:20, :, 3:4])
        x, y, z = self.cc.coordinates(1)
        np.testing.assert_allclose(z, self.cc.coordinates()[2][::2], rtol=1e-12)
        with self.assertRaises(tessera.Error):
            self.cc["T"].read(level=self.cc.levels)

    def test_errors_name_what_is_wrong(self):
        with self.assertRaisesRegex(KeyError, "no parameter 'X'; there are .*T"):
            self.cc["X"]
        with self.assertRaisesRegex(tessera.Error, "absent.tsr"):
            tessera.open("absent.tsr")
        with open("broken.tsr", "wb") as file:
            file.write(b"no archive")
        with self.assertRaisesRegex(tessera.Error, "broken.tsr"):
            tessera.open("broken.tsr")


class Writing(unittest.TestCase):
    def setUp(self):
        random = np.random.default_rng(1)
        self.T = random.normal(350, 5, (2, 9, 7, 5)).astype(np.float32)
        self.T[0, 3, 2, 1] = np.nan
        self.U = random.normal(0, 1, (2, 9, 7, 5, 3)).astype(np.float32)
        self.grey = np.ma.MaskedArray(random.integers(0, 60000, (2, 9, 7, 5)).astype(np.uint16), False)
        self.grey[1, 8, 6, 4] = np.ma.masked
        self.region = (np.arange(315).reshape(9, 7, 5) % 3).astype(np.uint8)[None].repeat(2, 0)

    def test_every_sample_comes_back(self):
        tessera.write("w.tsr", {"T": self.T, "U": self.U, "grey": self.grey, "region": self.region}, times=[0.5, 2],
                      spacing=(1, 2, 3), origin=(10, 20, 30), units={"T": "K"}, labels={"region": {1: "air", 2: "fuel"}},
                      quantities={"voltage": ("V", [0.7, 0.5])}, length_unit="mm", name="made")
        back = tessera.open("w.tsr")
        self.assertEqual(list(back.times), [0.5, 2])
        self.assertEqual((back["T"].unit, back.length_unit, back.name, back.lossless), ("K", "mm", "made", True))
        tessera.write("plain.tsr", {"T": self.T})
        self.assertEqual(tessera.open("plain.tsr").length_unit, "")  # not stated
        self.assertEqual(tessera.open("plain.tsr").name, "plain")
        self.assertEqual(list(back.quantities["voltage"]), [0.7, 0.5])
        self.assertEqual(back.quantity_units["voltage"], "V")
        self.assertEqual(back["region"].labels, {1: "air", 2: "fuel"})
        for axis, first, step in zip(back.coordinates(), (10, 20, 30), (1, 2, 3)):
            np.testing.assert_allclose(axis[:2], [first, first + step])
        np.testing.assert_array_equal(back["T"][:].filled(-1), np.where(np.isnan(self.T), -1, self.T))
        np.testing.assert_array_equal(back["U"][:], self.U)
        self.assertEqual(back["grey"].dtype, np.uint16)
        np.testing.assert_array_equal(back["grey"][:].filled(0), self.grey.filled(0))
        np.testing.assert_array_equal(np.ma.getmaskarray(back["grey"][:]), np.ma.getmaskarray(self.grey))
        np.testing.assert_array_equal(back["region"][:], self.region)
        about = json.loads(run("info", "w.tsr", "--json"))
        self.assertEqual([p["name"] for p in about["parameters"]], ["T", "U", "grey", "region"])
        run("verify", "w.tsr")

    def test_byte_orders_layouts_and_extremes(self):
        numbers = np.arange(210).reshape(5, 6, 7)
        several = [numbers.astype(kind) for kind in (">f4", "<f4", ">f8", ">i2", ">u2", ">i4", np.bool_)]
        several += [np.asfortranarray(several[0]), several[0][::-1, :, ::-2], np.broadcast_to(several[0][:1], (4, 6, 7)),
                    several[0].T, numbers.astype(np.float32) * np.float32(1e-42), (numbers - 99.0) * 3e36,
                    np.ones((1, 1, 40000), np.float32), np.ones((40000, 1, 1), np.float32)]
        for values in several:
            tessera.write("several.tsr", {"v": values})
            same(tessera.open("several.tsr")["v"].read(), values.astype(np.float32), values.dtype)

    def test_a_bound_is_kept(self):
        smooth = np.sin(np.arange(20000).reshape(20, 25, 40) * 0.01).astype(np.float32)
        tessera.write("b.tsr", {"T": smooth}, max_error=0.001)
        back = tessera.open("b.tsr")
        self.assertFalse(back.lossless)
        error = np.abs(back["T"][0] - smooth).max()
        self.assertGreater(error, 0)
        self.assertLessEqual(error, 0.001 * (smooth.max() - smooth.min()) * 1.0001)

    def test_options_are_those_of_packing_and_no_others(self):
        values = np.arange(40 * 40 * 40, dtype=np.float32).reshape(40, 40, 40)
        tessera.write("o.tsr", {"T": values}, lattice="bcc", brickSize=16)
        self.assertEqual(tessera.open("o.tsr").lattice, "bcc")
        self.assertEqual(tessera.open("o.tsr").levels, 3)
        for options in ({"lattice": "bc"}, {"max_error": 2}, {"max_error": -1}, {"brickSise": 16}, {"brickSize": "big"},
                        {"wavelet": "9,9"}):
            with self.assertRaises(tessera.Error, msg=options):
                tessera.write("no.tsr", {"T": values}, **options)

    def test_one_time_needs_no_axis(self):
        tessera.write("one.tsr", {"T": self.T[1], "U": self.U[1]})
        back = tessera.open("one.tsr")
        self.assertEqual((back["T"].shape, back["U"].shape), ((1, 9, 7, 5), (1, 9, 7, 5, 3)))
        np.testing.assert_array_equal(back["U"][0], self.U[1])

    def test_wrong_arrays_are_refused_and_leave_no_file(self):
        for parameters, options in (({"T": self.T[0, 0]}, {}), ({"T": self.T, "U": self.U[:1]}, {}), ({}, {}),
                                    ({"T": self.T}, {"times": [2, 1]}), ({"T": self.T}, {"times": [1, 2, 3]}),
                                    ({"T": self.T}, {"times": [0, np.nan]}), ({"T": self.T}, {"times": [0, np.inf]}),
                                    ({"T": self.T}, {"spacing": (0, 1, 1)}), ({"T": self.T}, {"spacing": (1, 1, np.nan)}),
                                    ({"T": self.T}, {"spacing": (1, 1)}), ({5: self.T}, {}), ({"": self.T}, {}),
                                    ({"T": self.T}, {"units": "K"}), ({"T": self.T}, {"units": {"X": "K"}}),
                                    ({"T": self.T}, {"labels": {"X": {1: "a"}}}), ({"T": self.T}, {"origin": (np.nan, 0, 0)}), ({"T": self.T[:, :0]}, {}),
                                    ({"T": self.T.astype(np.complex64)}, {}), ({"T": self.T[1].astype(np.int64)}, {}),
                                    ({"T": self.T}, {"quantities": {"U": ("V", [1])}}),
                                    ({"T": self.T}, {"units": {"T": 5}}), ({"T": self.T}, {"name": "\ud800"}),
                                    ({"T": self.T}, {"time_unit": None}), ({"T": self.T}, {"spacing": (1e-300, 1, 1)}),
                                    ({"T": self.T}, {"origin": (1e300, 1, 1)})):
            with self.assertRaises(tessera.Error):
                tessera.write("wrong.tsr", parameters, **options)
            with self.assertRaises(tessera.Error):
                tessera.open("wrong.tsr")
        with self.assertRaisesRegex(tessera.Error, "ends with .tsr"):
            tessera.write("wrong.vti", {"T": self.T})


class Xarray(unittest.TestCase):
    def setUp(self):
        try:
            import xarray
        except ImportError:
            self.skipTest("no xarray")
        self.xarray = xarray

    def test_a_data_set_is_opened_by_the_name_of_the_engine(self):
        run("generate", "fuel-cell", "--even", "-o", "x.tsr", "--size", "7x9x20", "--times", "2")
        run("convert", "x.tsr", "-o", "xcc.tsr", "--lattice", "cc")
        data, archive = self.xarray.open_dataset("xcc.tsr", engine="tessera"), tessera.open("xcc.tsr")
        self.assertEqual(data["T"].dims, ("time", "z", "y", "x"))
        self.assertEqual(data["U"].dims, ("time", "z", "y", "x", "component"))
        self.assertEqual(data["T"].attrs["units"], "K")
        np.testing.assert_array_equal(data["z"], archive.coordinates()[2])
        np.testing.assert_array_equal(data["time"], archive.times)
        np.testing.assert_array_equal(data["T"], archive["T"][:])
        np.testing.assert_array_equal(data["O2"], archive["O2"][:].filled(np.nan))
        middle = data["T"].sel(z=archive.coordinates()[2][7]).isel(time=1)
        np.testing.assert_array_equal(middle, archive["T"][1, 7])
        self.assertAlmostEqual(float(data["O2"].mean()), float(archive["O2"][:].mean()), 5)


class Vtk(unittest.TestCase):
    def setUp(self):
        try:
            from tessera.vtk_reader import TesseraReader
        except ImportError:
            self.skipTest("no VTK for Python")
        run("generate", "fuel-cell", "--even", "-o", "v.tsr", "--size", "7x9x20", "--times", "3")
        run("convert", "v.tsr", "-o", "vcc.tsr", "--lattice", "cc")
        self.reader, self.archive = TesseraReader(), tessera.open("vcc.tsr")
        self.reader.SetFileName("vcc.tsr")

    def test_an_image_of_the_time_asked_for(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        self.reader.UpdateInformation()
        self.reader.UpdateTimeStep(self.archive.times[2])
        image = self.reader.GetOutputDataObject(0)
        self.assertEqual(image.GetDimensions(), (7, 9, 20))
        for i, axis in enumerate(self.archive.coordinates()):
            self.assertAlmostEqual(image.GetBounds()[2 * i], axis[0], 12)
            self.assertAlmostEqual(image.GetBounds()[2 * i + 1], axis[-1], 12)
        data = image.GetPointData()
        self.assertEqual([data.GetArrayName(i) for i in range(data.GetNumberOfArrays())], self.archive.parameters)
        T, U, O2 = (vtk_to_numpy(data.GetArray(name)) for name in ("T", "U", "O2"))
        np.testing.assert_array_equal(T.reshape(20, 9, 7), self.archive["T"][2])
        np.testing.assert_array_equal(U.reshape(20, 9, 7, 3), self.archive["U"][2].filled(np.nan))
        np.testing.assert_array_equal(O2.reshape(20, 9, 7), self.archive["O2"][2].filled(np.nan))

    def test_levels_and_chosen_parameters(self):
        self.reader.UpdateInformation()
        self.assertEqual(self.reader.GetTimestepValues(), list(self.archive.times))
        self.reader.GetDataArraySelection().DisableAllArrays()
        self.reader.GetDataArraySelection().EnableArray("T")
        self.reader.SetLevel(1)
        self.reader.Update()
        image = self.reader.GetOutputDataObject(0)
        self.assertEqual(image.GetDimensions(), self.archive.size(1))
        self.assertEqual(image.GetPointData().GetNumberOfArrays(), 1)
        self.assertAlmostEqual(image.GetSpacing()[2], 2 * (self.archive.coordinates()[2][1] - self.archive.coordinates()[2][0]), 12)


if __name__ == "__main__":
    unittest.main(verbosity=2)
