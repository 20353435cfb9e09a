# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
import copy
import json
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

import limen
import numpy as np


class Registered(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.case = limen.simulate("room", points_indoor=60_000, stations=2)
        cls.result = limen.register(*cls.case.scans)

    def test_the_true_pose_is_found(self):
        self.assertTrue(self.result.registered, self.result.reason)
        error = self.result.target_from_source @ np.linalg.inv(self.case.target_from_source(0, 1))
        self.assertLess(np.linalg.norm(error[:3, 3]), 0.005)
        self.assertLess(np.abs(error[:3, :3] - np.eye(3)).max(), 0.001)
        self.assertGreater(self.result.best.matched_planes, 5)
        self.assertTrue((self.result.sigma.translation_m < 0.01).all())
        self.assertEqual(self.result.stages[-1][0], "judgement")

    def test_points_are_moved(self):
        source, target = self.case.scans
        moved = self.result.apply(source.world_points)
        expected = limen.transform(source.world_points, self.result.target_from_source)
        np.testing.assert_allclose(moved, expected)

    def test_files_are_those_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            self.result.save(Path(folder) / "result")
            written = json.loads((Path(folder) / "result" / "result.json").read_text())
            self.assertEqual(written, self.result.to_dict())
            self.assertEqual(written["outcome"], "registered")
            np.testing.assert_array_equal(written["target_from_source"], self.result.target_from_source)
            self.assertIn("<html", (Path(folder) / "result" / "report.html").read_text(encoding="utf-8"))
            self.result.save(Path(folder) / "result", report=False)
            names = sorted(path.name for path in (Path(folder) / "result").iterdir())
            self.assertEqual(names, ["result.json", "transform.txt"])
            text = np.loadtxt(Path(folder) / "result" / "transform.txt")
            np.testing.assert_array_equal(text, self.result.target_from_source)

    def test_what_was_found_of_the_inputs_is_stated(self):
        sides = self.result.to_dict()["inputs"]
        self.assertTrue(sides["source"]["scanner"]["confirmed"] and sides["target"]["scanner"]["confirmed"])
        source, target = self.case.scans
        self.assertIn("same", limen.register(source, source).to_dict()["notes"][0])
        far = (source.world_points + (652_000, 6_840_000, 0)).astype(np.float32)
        self.assertIn("rounded to 0.5 m", limen.register(far, target).to_dict()["notes"][0])

    def test_a_centre_is_of_arrays_and_of_files(self):
        source, target = self.case.scans
        with tempfile.TemporaryDirectory() as folder:
            source.save(Path(folder) / "a.ply")
            result = limen.register(Path(folder) / "a.ply", target, source_centre=(0.0, 0.01, 0.0))
        scanner = result.to_dict()["inputs"]["source"]["scanner"]
        self.assertEqual((scanner["source"], scanner["place"]), ("user", [0.0, 0.01, 0.0]))
        for given in ({"source_centre": (0, 0, 0)}, {"centre": (0, 0, 0)}, {"seed": -1}):
            with self.assertRaises(ValueError):
                limen.register(source, target, **given)
        for given in ({"seed": 1.5}, {"options": {"method": "auto"}}):
            with self.assertRaises(TypeError):
                limen.register(source, target, **given)
        with self.assertRaisesRegex(limen.Error, "rigid"):
            limen.evaluate(self.result, 2 * np.eye(4))

    def test_copies_of_options_and_results_have_all(self):
        options = limen.ExtractOptions()
        options.grow.min_inliers = 77
        for again in (copy.deepcopy(options), pickle.loads(pickle.dumps(options))):
            self.assertEqual(again.grow.min_inliers, 77)
        with tempfile.TemporaryDirectory() as folder:
            copy.copy(self.result).save(folder)
            self.assertTrue((Path(folder) / "report.html").exists())

    def test_an_interrupt_while_progress_is_shown_by_other_work(self):
        source, target = self.case.scans
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "a.ply"
            source.save(path)

            def tell(stage, done, total):
                limen.read_scan(path)
                signal.raise_signal(signal.SIGINT)

            with self.assertRaises(KeyboardInterrupt):
                limen.register(source, target, progress=tell)
        self.assertTrue(limen.register(source, target).registered)

    def test_the_same_input_gives_the_same_pose(self):
        limen.set_threads(1)
        try:
            again = limen.register(*self.case.scans)
        finally:
            limen.set_threads(0)
        np.testing.assert_array_equal(again.target_from_source, self.result.target_from_source)

    def test_files_and_groups_are_taken(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "source.ply"
            self.case.scans[0].save(path)
            result = limen.register(path, [(self.case.scans[1], np.eye(4))])
        np.testing.assert_allclose(result.target_from_source, self.result.target_from_source, atol=1e-9)

    def test_options_reach_the_work(self):
        result = limen.register(*self.case.scans, method="polygons", seed=3)
        self.assertEqual(result.to_dict()["options"]["method"], "polygons")
        self.assertEqual(result.to_dict()["seed"], 3)
        self.assertEqual(result.best.matched_openings, 0)
        chosen = limen.RegisterOptions(method="polygons", seed=4)
        mixed = limen.register(*self.case.scans, options=chosen, seed=3).to_dict()
        self.assertEqual((mixed["options"]["method"], mixed["seed"]), ("polygons", 3))
        self.assertEqual(chosen.seed, 4, "what the caller gave stays as it is")
        few = limen.register(*self.case.scans, options=limen.RegisterOptions(refined_poses=1, alternatives=0))
        self.assertEqual(few.alternatives, [])
        with self.assertRaises(limen.Error):
            limen.register(*self.case.scans, options=limen.RegisterOptions(refined_poses=0))
        with self.assertRaises(limen.Error):
            limen.register(*self.case.scans, method="guess")

    def test_nothing_in_common(self):
        grain = np.random.default_rng(1).uniform(-1, 1, (2000, 3))
        result = limen.register(limen.Scan(points=grain, centres=(0, 0, 0)), self.case.scans[1])
        self.assertEqual(result.outcome, "no_match")
        self.assertIsNone(result.target_from_source)
        with self.assertRaises(ValueError):
            result.apply(grain)
        self.assertIn("no_match", result._repr_html_())

    def test_in_a_notebook(self):
        page = self.result._repr_html_()
        for part in ("<b>registered</b>", "<svg", "shift of the centre", "far end", "matched"):
            self.assertIn(part, page)
        self.assertLess(len(page), 1_000_000)
        self.assertIn("registered", repr(self.result))


    def test_every_pose_can_be_applied(self):
        points = self.case.scans[0].world_points[:100]
        np.testing.assert_allclose(self.result.best.apply(points), self.result.apply(points))
        other = self.result.alternatives[0]
        np.testing.assert_allclose(other.apply(points), limen.transform(points, other.target_from_source))
        self.assertFalse(other.tie)
        self.assertEqual(other.sigma.covariance.shape, (6, 6))
        self.assertGreater(self.result.probability, 0.9)
        np.testing.assert_allclose(
            np.sqrt(np.diag(self.result.sigma.covariance)[3:]), self.result.sigma.translation_m
        )

    def test_names_are_those_of_the_file(self):
        written = self.result.to_dict()
        match, of_match = self.result.matches[0], written["matches"][0]
        for name in ("source_plane", "target_plane", "distance_m", "overlap_m2"):
            self.assertEqual(getattr(match, name), of_match[name])
        self.assertEqual(len(self.result.matched_openings), len(written["matched_openings"]))
        self.assertEqual(len(self.result.wall_thickness), len(written["wall_thickness"]))
        self.assertEqual(self.result.precision, written["precision"])
        self.assertEqual(self.result.motion, written["motion"])
        self.assertTrue(self.result.next_steps)

    def test_arrays_are_taken_as_they_are(self):
        source, target = (scan.world_points for scan in self.case.scans)
        result = limen.register(source, target, centre=(0, 0, 0))
        np.testing.assert_allclose(result.target_from_source, self.result.target_from_source, atol=1e-3)

    def test_evaluate_is_that_of_the_program(self):
        truth = self.case.target_from_source(0, 1)
        error = limen.evaluate(self.result, truth)
        self.assertLess(error.translation_error_m, 0.005)
        self.assertLess(error.rotation_error_deg, 0.05)
        self.assertLess(error.largest_error_in_sigmas, 4.0)
        with tempfile.TemporaryDirectory() as folder:
            self.result.save(folder, report=False)
            np.savetxt(Path(folder) / "truth.txt", truth, fmt="%.17g")
            words = [sys.executable, "-m", "limen", "evaluate", folder + "/result.json", folder + "/truth.txt", "--json"]
            written = json.loads(subprocess.run(words, capture_output=True, text=True, check=True).stdout)
        self.assertAlmostEqual(written["translation_error_m"], error.translation_error_m, places=9)
        self.assertAlmostEqual(written["rotation_error_deg"], error.rotation_error_deg, places=7)
        half_turn = np.diag([-1.0, 1.0, -1.0, 1.0])
        self.assertAlmostEqual(
            limen.evaluate(self.result, half_turn @ self.result.target_from_source).rotation_error_deg, 180.0
        )

    def test_pickles(self):
        scan = self.case.scans[0]
        again = pickle.loads(pickle.dumps(scan))
        np.testing.assert_array_equal(again.points, scan.points)
        np.testing.assert_array_equal(again.local_origin, scan.local_origin)
        np.testing.assert_array_equal(again.centres, scan.centres)
        self.assertEqual((again.name, again.level), (scan.name, scan.level))
        kept = pickle.loads(pickle.dumps(self.result))
        self.assertEqual(kept.to_dict(), self.result.to_dict())
        np.testing.assert_array_equal(kept.target_from_source, self.result.target_from_source)
        self.assertEqual(repr(kept), repr(self.result))
        with tempfile.TemporaryDirectory() as folder:
            kept.save(folder, report=False)
            self.assertEqual(json.loads((Path(folder) / "result.json").read_text()), self.result.to_dict())
            np.testing.assert_array_equal(
                np.loadtxt(Path(folder) / "transform.txt"), self.result.target_from_source
            )
            with self.assertRaises(ValueError):
                kept.save(folder)


class Found(unittest.TestCase):
    def test_planes_openings_and_segments(self):
        case = limen.simulate("room", points_indoor=100_000, stations=1, curtain_share=0.0)
        scan = case.scans[0]
        features = limen.extract_features(scan)
        self.assertGreater(len(features.planes), 6)
        self.assertGreater(len(features.openings), 0)
        self.assertEqual(features.segments.shape[1:], (2, 3))
        self.assertEqual(features.labels.shape, (len(scan),))
        plane = features.planes[0]
        on_it = scan.world_points[features.labels == 0]
        self.assertEqual(len(on_it), plane.inliers)
        self.assertLess(np.abs(on_it @ plane.normal - plane.offset).mean(), 0.01)
        self.assertLess(np.abs(plane.outline @ plane.normal - plane.offset).max(), 1e-9)
        opening = features.openings[0]
        self.assertAlmostEqual(opening.width_m, np.linalg.norm(np.diff(opening.corners[:2], axis=0)))
        self.assertIn("<svg", features._repr_html_())
        bare = limen.extract_features(scan, openings=False, segments=False)
        self.assertEqual((len(bare.openings), len(bare.segments)), (0, 0))

    def test_options_are_those_of_cpp(self):
        options = limen.ExtractOptions()
        options.grow.min_inliers = 5000
        case = limen.simulate("room", points_indoor=60_000, stations=1)
        few = limen.extract_features(case.scans[0], options, openings=False, segments=False)
        self.assertTrue(all(plane.inliers >= 4000 for plane in few.planes))
        self.assertLess(len(few.planes), 8)
        with self.assertRaises(TypeError):
            limen.ExtractOptions(min_inliers=3)
        self.assertIn("min_inliers=5000", repr(options))


class AgainstAModel(unittest.TestCase):
    def test_deviation(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "wall.obj"
            path.write_text("o wall\nv 0 2 0\nv 4 2 0\nv 4 2 3\nv 0 2 3\nf 1 2 3 4\n")
            axes = np.meshgrid(np.linspace(0.1, 3.9, 200), [2.01], np.linspace(0.1, 2.9, 150))
            grid = np.stack(axes, -1).reshape(-1, 3)
            scan = limen.Scan(points=grid, centres=(2, -3, 1.5))
            result = limen.deviation(scan, path)
            self.assertEqual(result.elements[0].presence, "found")
            self.assertAlmostEqual(abs(result.elements[0].median_m), 0.01, places=6)
            self.assertEqual(result.distance_m.shape, (len(grid),))
            self.assertIn("1 elements found", repr(result))
            self.assertIn("wall", result._repr_html_())
            result.save(Path(folder) / "out")
            self.assertEqual(sorted(p.name for p in (Path(folder) / "out").iterdir()),
                             ["deviation.csv", "deviation.json", "deviation.ply", "deviation.xlsx"])


class LongWork(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.case = limen.simulate("room", points_indoor=300_000, stations=2)

    def test_progress_is_told(self):
        steps = []
        limen.register(*self.case.scans, progress=lambda *step: steps.append(step))
        self.assertTrue({"hypotheses", "scoring", "refinement"} <= {stage for stage, _, _ in steps})
        self.assertTrue(all(0 <= done <= total or total == 0 for _, done, total in steps))

    def test_what_progress_throws_stops_the_work(self):
        def stop(stage, done, total):
            raise LookupError(stage)

        with self.assertRaises(LookupError):
            limen.register(*self.case.scans, progress=stop)
        limen.extract_features(self.case.scans[0], openings=False, segments=False)

    def test_other_threads_run_meanwhile(self):
        ticks = []
        done = threading.Event()

        def tick():
            while not done.is_set():
                ticks.append(time.monotonic())
                time.sleep(0.01)

        thread = threading.Thread(target=tick)
        thread.start()
        begun = time.monotonic()
        limen.register(*self.case.scans)
        taken = time.monotonic() - begun
        done.set()
        thread.join()
        self.assertGreater(len(ticks), 0.2 * taken / 0.01)

    def test_an_interrupt_is_keyboard_interrupt(self):
        script = (
            "import limen, sys\n"
            "def tell(*what):\n    print('working', flush=True)\n"
            "try:\n    limen.simulate('museum', points_indoor=5_000_000, progress=tell)\n"
            "except KeyboardInterrupt:\n    print('stopped'); sys.exit(7)\n"
        )
        process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
        self.assertEqual(process.stdout.readline(), "working\n")
        time.sleep(0.3)
        pressed = time.monotonic()
        process.send_signal(signal.SIGINT)
        rest = process.communicate(timeout=60)[0]
        self.assertLess(time.monotonic() - pressed, 2.0)
        self.assertTrue(rest.endswith("stopped\n"), rest)
        self.assertEqual(process.returncode, 7)


if __name__ == "__main__":
    unittest.main()
