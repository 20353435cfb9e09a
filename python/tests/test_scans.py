# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
import contextlib
import gc
import io
import json
import tempfile
import unittest
from pathlib import Path

import limen
import numpy as np

#: A place on a national grid, whole metres and a fraction that a float cannot hold.
FAR = np.array([652_000.0, 6_861_000.0, 35.0])


def cube(count=1000):
    return np.random.default_rng(7).uniform(-4.0, 4.0, (count, 3))


class ScanFromArrays(unittest.TestCase):
    def test_points_are_shown_without_a_copy(self):
        scan = limen.Scan(points=cube())
        self.assertTrue(np.shares_memory(scan.points, scan.points))
        self.assertEqual((scan.points.dtype, scan.points.shape), (np.float64, (1000, 3)))
        self.assertFalse(scan.points.flags.writeable)

    def test_a_view_keeps_its_scan(self):
        given = cube()
        points = limen.Scan(points=given).points
        gc.collect()
        cube(500_000)  # would take the memory, were it free
        np.testing.assert_array_equal(points, given)

    def test_a_national_grid_loses_nothing(self):
        near = np.round(cube() * 1024) / 1024  # sums with FAR are exact
        scan = limen.Scan(points=near + FAR, centres=FAR)
        self.assertLess(np.abs(scan.points).max(), 1000.0)
        np.testing.assert_array_equal(scan.world_points, near + FAR)
        np.testing.assert_array_equal(scan.centres[0] + scan.local_origin, FAR)

    def test_points_about_a_local_origin(self):
        given = cube()
        scan = limen.Scan(points=given, local_origin=FAR)
        np.testing.assert_array_equal(scan.points, given)
        np.testing.assert_array_equal(scan.local_origin, FAR)

    def test_values_that_cannot_be_kept_are_refused(self):
        points = cube(10)
        named = np.zeros(10, dtype=[("x", "f8"), ("y", "f8"), ("z", "f8")])
        for given, said in (
            ({"colours": np.full((10, 3), 0.5)}, "0.5"),
            ({"colours": np.full((10, 3), 300)}, "300"),
            ({"colours": np.zeros((3, 10))}, "shape"),
            ({"times": np.zeros((5, 2))}, "shape"),
            ({"lines": np.full(10, 2**40), "indices": np.zeros(10)}, "lines"),
            ({"local_origin": (np.nan, 2.0, 3.0)}, "local_origin"),
            ({"local_origin": (1.0, 2.0)}, "local_origin"),
            ({"points": named}, "structured"),
        ):
            with self.assertRaisesRegex(limen.Error, said):
                limen.Scan(**{"points": points, **given})

    def test_a_stated_scanner_position_is_the_users(self):
        scan = limen.Scan(points=cube(), centres=(0.0, 0.0, 0.5))
        with tempfile.TemporaryDirectory() as folder:
            scan.save(Path(folder) / "cube.ply")
            read = limen.read_scan(Path(folder) / "cube.ply", origin=(0.0, 0.0, 0.5))
            self.assertEqual(scan._centre_source, read._centre_source)
            with self.assertRaisesRegex(limen.Error, "PLY"):
                scan.save(Path(folder) / "cube.las")

    def test_all_values_come_back(self):
        n = 1000
        parts = {
            "times": np.arange(n) * 0.5,
            "intensities": np.linspace(0, 1, n, dtype=np.float32),
            "colours": np.arange(3 * n, dtype=np.uint8).reshape(n, 3),
            "lines": np.arange(n, dtype=np.int32) // 10,
            "indices": np.arange(n, dtype=np.int32) % 10,
            "centres": cube() + 1.0,
        }
        scan = limen.Scan(points=cube(), name="mobile", level=False, **parts)
        for name, values in parts.items():
            np.testing.assert_array_equal(getattr(scan, name), values, err_msg=name)
        self.assertTrue(scan.mobile)
        self.assertEqual((scan.name, scan.level, len(scan)), ("mobile", False, n))
        self.assertIsNone(limen.Scan(points=cube()).times)
        self.assertIsNone(limen.Scan(points=cube()).centres)

    def test_any_number_type_and_order_is_taken(self):
        given = np.asfortranarray(cube().astype(np.float32))
        np.testing.assert_array_equal(limen.Scan(points=given).points, given.astype(np.float64))
        self.assertEqual(len(limen.Scan(points=[[0, 0, 0], [1, 2, 3]])), 2)

    def test_wrong_arrays_are_named(self):
        for arguments, message in (
            ({"points": np.zeros((5, 2))}, "points"),
            ({"points": np.zeros((0, 3))}, "no points"),
            ({"points": np.array([[0.0, np.nan, 0.0]])}, "points[0]"),
            ({"points": cube(5), "times": np.zeros(4)}, "times"),
            ({"points": cube(5), "centres": np.zeros((2, 3))}, "centres"),
            ({"points": cube(5), "lines": np.zeros(5, int)}, "lines"),
        ):
            with self.assertRaises(limen.Error, msg=message) as caught:
                limen.Scan(**arguments)
            self.assertIn(message, str(caught.exception))


class Files(unittest.TestCase):
    def test_a_saved_scan_is_read_again(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "scan.ply"
            scan = limen.Scan(points=cube() + FAR, centres=FAR, intensities=np.ones(1000))
            scan.save(path)
            again = limen.read_scan(path)
            np.testing.assert_array_equal(again.world_points, scan.world_points)
            np.testing.assert_array_equal(again.centres[0] + again.local_origin, FAR)
            np.testing.assert_array_equal(again.intensities, scan.intensities)
            moved = limen.read_scan(path, origin=FAR + 1.0)
            np.testing.assert_array_equal(moved.centres[0] + moved.local_origin, FAR + 1.0)

    def test_an_error_says_what_where_and_what_to_do(self):
        with self.assertRaises(limen.Error) as caught:
            limen.read_scan("/no/such/file.ply")
        error = caught.exception
        self.assertIsInstance(error, ValueError)
        self.assertEqual((error.where, error.fault), ("/no/such/file.ply", "input"))
        self.assertTrue(error.what and error.remedy)

    def test_a_model_is_read(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "box.obj"
            path.write_text("o wall\nv 0 0 0\nv 4 0 0\nv 4 0 3\nv 0 0 3\nf 1 2 3 4\n")
            model = limen.read_model(path)
            wall = model.elements[0]
            self.assertEqual((model.schema, model.faces, wall.name or wall.type), ("OBJ", 1, "wall"))
            self.assertIn("OBJ", repr(model))


class Units(unittest.TestCase):
    def test_a_file_in_millimetres_is_read_in_metres(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "a.xyz"
            np.savetxt(path, 1000.0 * cube(200), fmt="%.3f")
            scan = limen.read_scan(path, units="mm")
            np.testing.assert_allclose(scan.world_points, cube(200), atol=1e-6)
            with self.assertRaises(limen.Error):
                limen.read_scan(path, units="furlong")

    def test_thin_keeps_one_in_a_cube(self):
        with tempfile.TemporaryDirectory() as folder:
            path, out = Path(folder) / "a.xyz", Path(folder) / "b.xyz"
            np.savetxt(path, cube(5000), fmt="%.6f")
            kept = limen.thin(path, out, spacing_m=1.0)
            self.assertEqual(len(limen.read_scan(out)), kept)
            self.assertLessEqual(kept, 9**3)
            self.assertGreater(kept, 300)
            with self.assertRaises(ValueError):
                limen.thin(path, out)


class Progress(unittest.TestCase):
    def test_true_tells_stages(self):
        output = io.StringIO()
        with contextlib.redirect_stderr(output):
            limen.simulate("room", points_indoor=2_000, stations=1, progress=True)
        self.assertTrue(output.getvalue())


class Projects(unittest.TestCase):
    def test_read_project_tells_poses_by_file(self):
        document = {
            "outcome": "registered",
            "reason": "all scans stand",
            "scans": [
                {"file": "a/one.ply", "state": "registered", "frame_from_scan": np.eye(4).tolist(), "reason": ""},
                {"file": "a/two.ply", "state": "floating", "frame_from_scan": None, "reason": "alone"},
            ],
            "questions": [{"text": "is it here?"}],
        }
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "project.json").write_text(json.dumps(document))
            found = limen.read_project(folder)
        np.testing.assert_array_equal(found.pose_of("one.ply"), np.eye(4))
        self.assertEqual(found.questions, ["is it here?"])
        with self.assertRaises(KeyError):
            found.pose_of("two.ply")


class Moving(unittest.TestCase):
    POSE = np.array([[0.0, -1, 0, 10], [1, 0, 0, 20], [0, 0, 1, 30], [0, 0, 0, 1]])

    def test_scans_and_arrays_move_alike(self):
        points = cube()
        expected = points @ self.POSE[:3, :3].T + self.POSE[:3, 3]
        np.testing.assert_allclose(limen.transform(points, self.POSE), expected, atol=1e-12)
        moved = limen.transform(limen.Scan(points=points), self.POSE)
        np.testing.assert_allclose(moved.world_points, expected, atol=1e-12)

    def test_a_file_is_moved(self):
        with tempfile.TemporaryDirectory() as folder:
            limen.Scan(points=cube()).save(Path(folder) / "a.ply")
            count = limen.transform_file(Path(folder) / "a.ply", self.POSE, Path(folder) / "b.ply")
            self.assertEqual(count, 1000)
            moved = limen.read_scan(Path(folder) / "b.ply").world_points
            np.testing.assert_allclose(moved, limen.transform(cube(), self.POSE), atol=1e-12)

    def test_what_is_no_pose_is_refused(self):
        with self.assertRaises(ValueError):
            limen.transform(cube(), np.eye(3))
        with self.assertRaises(limen.Error):
            limen.transform(cube(), 2 * np.eye(4))


class Showing(unittest.TestCase):
    def test_a_scan_in_a_notebook(self):
        scan = limen.Scan(points=cube(), name="<room>")
        self.assertIn("1,000 points", repr(scan))
        page = scan._repr_html_()
        self.assertIn("&lt;room&gt;", page)
        self.assertIn("<svg", page)
        self.assertNotIn("http://", page.replace("http://www.w3.org/2000/svg", ""))


if __name__ == "__main__":
    unittest.main()
