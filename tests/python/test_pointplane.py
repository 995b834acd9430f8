#!/usr/bin/env python3
"""The Python module, on a rawlog: test_pointplane.py RAWLOG"""
import contextlib
import copy
import gc
import gzip
import io
import os
import pathlib
import pickle
import re
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np

import pointplane

RAWLOG = os.path.abspath(sys.argv.pop())


def write_comment(path, text):
    """A rawlog of one CObservationComment: class and its version, text, stamp, end mark."""
    name = b"CObservationComment"
    with gzip.open(path, "wb") as file:
        file.write(struct.pack("<B", 0x80 | len(name)) + name + b"\0")
        file.write(struct.pack("<I", len(text)) + text + struct.pack("<Q", 0) + b"\x88")


class Rawlogs(unittest.TestCase):
    def test_frames_are_arrays_in_metres(self):
        frames = list(pointplane.read_rawlog(RAWLOG))
        self.assertGreaterEqual(len(frames), 10)
        frame = frames[3]
        self.assertEqual(frame.problem, "")
        self.assertEqual(frame.depth.dtype, np.float32)
        self.assertEqual(frame.gray.dtype, np.uint8)
        self.assertEqual(frame.depth.shape, (frame.camera.height, frame.camera.width))
        self.assertTrue(0.1 < np.nanmedian(frame.depth) < 10)
        self.assertGreater(frame.stamp, frames[2].stamp)

    def test_arrays_share_the_frames_memory_and_keep_it(self):
        frame = next(iter(pointplane.read_rawlog(RAWLOG)))
        depth = frame.depth
        self.assertFalse(depth.flags.owndata)
        before = depth.copy()
        self.assertTrue(np.shares_memory(depth, frame.depth))
        del frame
        gc.collect()
        np.testing.assert_array_equal(depth, before)

    def test_a_missing_file_is_named(self):
        with self.assertRaisesRegex(pointplane.InputError, "none.rawlog"):
            pointplane.read_rawlog("none.rawlog")

    def test_names_that_are_not_utf_8_are_shown(self):
        with self.assertRaisesRegex(pointplane.InputError, r"cannot open caf\\xe9.rawlog: "):
            pointplane.read_rawlog(b"caf\xe9.rawlog")
        with tempfile.TemporaryDirectory() as folder:
            with open(folder + "/latin.ini", "wb") as file:
                file.write(b"[Lens]\nnominal = v\xe9rit\xe9\n")
            with self.assertRaisesRegex(pointplane.InputError, r"nominal = 'v\\xe9rit\\xe9' is not"):
                pointplane.VisualOdometry(folder + "/latin.ini")

    def test_files_may_be_paths_of_pathlib(self):
        frames = list(pointplane.read_rawlog(pathlib.Path(RAWLOG)))
        self.assertEqual(len(frames), len(list(pointplane.read_rawlog(RAWLOG))))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "config.ini"
            path.write_text("[PoseSolver]\nalpha = 3\n")
            self.assertEqual(pointplane.VisualOdometry(path).process(frames[0]).status, "first")

    def test_an_unknown_label_is_told_with_those_there_are(self):
        self.assertGreaterEqual(len(list(pointplane.read_rawlog(RAWLOG, "RGBD"))), 10)
        with self.assertRaisesRegex(
            pointplane.InputError, r"corner.rawlog: no frames of camera 'typo'.*\d+ of 'RGBD'"
        ):
            list(pointplane.read_rawlog(RAWLOG, "typo"))

    def test_a_camera_without_a_label_is_not_mixed_with_another(self):
        label = struct.pack("<I", 4) + b"RGBD"
        with gzip.open(RAWLOG) as file:
            parts = file.read().split(label)
        with tempfile.TemporaryDirectory() as folder:
            with gzip.open(folder + "/two.rawlog", "wb") as file:
                file.write(parts[0])
                for number, part in enumerate(parts[1:]):
                    file.write((struct.pack("<I", 0) if number % 2 == 0 else label) + part)
            every = [frame.stamp for frame in pointplane.read_rawlog(RAWLOG)]
            frames = list(pointplane.read_rawlog(folder + "/two.rawlog"))
            self.assertEqual([frame.stamp for frame in frames], every[::2])

    def test_other_threads_run_while_a_frame_is_read(self):
        counts = {"now": 0}

        def read():
            counts["before"] = counts["now"]
            counts["frames"] = len(list(frames))
            counts["after"] = counts["now"]

        frames = pointplane.read_rawlog(RAWLOG)
        thread = threading.Thread(target=read)
        interval = sys.getswitchinterval()
        sys.setswitchinterval(60)  # threads take turns only where one lets the other run
        try:
            thread.start()
            while thread.is_alive():
                counts["now"] += 1
                time.sleep(1e-4)
        finally:
            sys.setswitchinterval(interval)
        self.assertGreaterEqual(counts["frames"], 10)
        self.assertGreater(counts["after"] - counts["before"], 2)

    def test_threads_may_share_a_rawlog(self):
        every = [frame.stamp for frame in pointplane.read_rawlog(RAWLOG)]
        shared, stamps = pointplane.read_rawlog(RAWLOG), []
        threads = [
            threading.Thread(target=lambda: stamps.extend(frame.stamp for frame in shared))
            for _ in range(3)
        ]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(sorted(stamps), every)

    def test_a_frame_that_cannot_be_used_has_no_camera(self):
        with gzip.open(RAWLOG) as file:
            content = file.read()
        label = struct.pack("<I", 4) + b"RGBD"
        end = content.index(label)
        with tempfile.TemporaryDirectory() as folder:
            with gzip.open(folder + "/unstamped.rawlog", "wb") as file:
                file.write(content[: end - 8] + bytes(8) + content[end:])
            frame = next(iter(pointplane.read_rawlog(folder + "/unstamped.rawlog")))
        self.assertRegex(frame.problem, "time stamp")
        self.assertIsNone(frame.depth)
        self.assertIsNone(frame.camera)

    def test_a_rawlog_without_a_camera_is_no_recording_of_zero_frames(self):
        with tempfile.TemporaryDirectory() as folder:
            path = folder + "/comment.rawlog"
            write_comment(path, b"nothing else is in this recording")
            for label in ("", "RGBD"):
                with self.assertRaisesRegex(
                    pointplane.InputError, "comment.rawlog: no CObservation3DRangeScan in it"
                ):
                    list(pointplane.read_rawlog(path, label))

    def test_a_comment_that_cannot_be_understood_is_told_with_its_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = folder + "/comment.rawlog"
            write_comment(path, b"pointplane-camera label=RGBD depthDelay=late")
            with self.assertRaisesRegex(pointplane.InputError, "comment.rawlog: .*key depthDelay"):
                list(pointplane.read_rawlog(path))

    def test_help_names_types_as_python_does(self):
        for thing in vars(pointplane).values():
            for member in [thing, *vars(thing).values()] if isinstance(thing, type) else [thing]:
                self.assertNotIn("::", str(getattr(member, "__doc__", "")), member)


class Odometry(unittest.TestCase):
    def test_arrays_give_what_the_frames_of_the_rawlog_give(self):
        by_frame = pointplane.VisualOdometry()
        by_array = pointplane.VisualOdometry()
        for frame in pointplane.read_rawlog(RAWLOG):
            a = by_frame.process(frame)
            b = by_array.process(frame.depth, frame.gray, frame.camera, frame.stamp)
            self.assertEqual(b.status, a.status)
        self.assertEqual(a.status, "tracked")
        self.assertEqual(a.stamp, b.stamp)
        # The rawlog tells the shutter, the arrays do not.
        np.testing.assert_allclose(a.pose, b.pose, atol=0.02)

    def test_a_result_is_a_motion_with_its_covariance(self):
        odometry = pointplane.VisualOdometry()
        accumulated = np.eye(4)
        for frame in pointplane.read_rawlog(RAWLOG):
            result = odometry.process(frame)
            accumulated = accumulated @ result.increment
        np.testing.assert_allclose(result.pose, accumulated, atol=1e-9)
        np.testing.assert_allclose(result.pose[:3, :3] @ result.pose[:3, :3].T, np.eye(3), atol=1e-9)
        for covariance in (result.covariance, result.increment_covariance):
            self.assertEqual(covariance.shape, (6, 6))
            self.assertTrue((np.linalg.eigvalsh(covariance) > 0).all())
        self.assertIn("tracked", repr(result))

    def test_since_has_the_motions_from_several_frames_before(self):
        odometry = pointplane.VisualOdometry(settings=["Covariance.history=3"])
        results = [odometry.process(frame) for frame in pointplane.read_rawlog(RAWLOG)]
        self.assertEqual([len(result.since) for result in results[:5]], [0, 1, 2, 3, 3])
        last = results[-1]
        np.testing.assert_array_equal(last.since[0][0], last.increment)
        np.testing.assert_array_equal(last.since[0][1], last.increment_covariance)
        for steps, (pose, covariance) in enumerate(last.since, 1):
            before = results[-1 - steps].pose
            np.testing.assert_allclose(pose, np.linalg.inv(before) @ last.pose, atol=1e-9)
            self.assertTrue((np.linalg.eigvalsh(covariance) > 0).all())

    def test_a_frame_of_another_camera_is_lost_and_changes_no_pose(self):
        with gzip.open(RAWLOG) as file:
            content = file.read()
        with tempfile.TemporaryDirectory() as folder:
            with gzip.open(folder + "/rear.rawlog", "wb") as file:
                label = struct.pack("<I", 4)
                file.write(content.replace(label + b"RGBD", label + b"REAR"))
            rear = list(pointplane.read_rawlog(folder + "/rear.rawlog"))
        frames = list(pointplane.read_rawlog(RAWLOG))
        self.assertEqual((frames[0].sensor_label, rear[0].sensor_label), ("RGBD", "REAR"))
        odometry = pointplane.VisualOdometry()
        odometry.process(frames[0])
        before = odometry.process(frames[1])
        lost = odometry.process(rear[-1])
        self.assertEqual(lost.status, "lost")
        self.assertRegex(lost.reason, "^is of camera 'REAR', not of 'RGBD': each camera needs an")
        np.testing.assert_allclose(lost.pose, before.pose, atol=1e-9)
        self.assertEqual(odometry.process(frames[2]).status, "tracked")
        odometry.reset()
        self.assertEqual(odometry.process(rear[0]).status, "first")

    def test_results_and_cameras_can_be_pickled_and_copied(self):
        odometry = pointplane.VisualOdometry()
        for frame in pointplane.read_rawlog(RAWLOG):
            result = odometry.process(frame)
        dark = odometry.process(frame.depth, None, frame.camera, frame.stamp)
        self.assertEqual(dark.status, "lost")
        for change in (lambda thing: pickle.loads(pickle.dumps(thing)), copy.copy, copy.deepcopy):
            for given in (result, dark):
                other = change(given)
                for name in ("status", "reason", "stamp"):
                    self.assertEqual(getattr(other, name), getattr(given, name))
                for name in ("pose", "covariance", "increment", "increment_covariance"):
                    np.testing.assert_array_equal(getattr(other, name), getattr(given, name))
                self.assertEqual(len(other.since), 1)
                for one, same in zip(other.since[0], given.since[0]):
                    np.testing.assert_array_equal(one, same)
            camera = pointplane.Camera(500, 501, 320, 240, 640, 480, (0.1, 0, 0, 0, 0.2))
            self.assertIn("640x480, fx=500 fy=501 cx=320 cy=240, distorted", repr(camera))
            other = change(camera)
            for name in ("fx", "fy", "cx", "cy", "width", "height", "distortion"):
                self.assertEqual(getattr(other, name), getattr(camera, name))
        for status in (-1, 4):
            with self.assertRaisesRegex(ValueError, "no status of a frame"):
                type(dark).__new__(type(dark)).__setstate__((status, *dark.__getstate__()[1:]))

    def test_depth_in_integers_is_scaled_and_zero_is_no_reading(self):
        frame = next(iter(pointplane.read_rawlog(RAWLOG)))
        millimetres = np.nan_to_num(frame.depth * 1000).astype(np.uint16)
        for depth, unit in ((millimetres, 0.001), (millimetres * 5, 0.0002)):
            odometry = pointplane.VisualOdometry()
            result = odometry.process(depth, None, frame.camera, frame.stamp, depth_unit=unit)
            self.assertEqual(result.status, "first")

    def test_the_largest_integer_is_no_reading_as_in_rawlogs(self):
        frame = next(iter(pointplane.read_rawlog(RAWLOG)))
        for none in (0, 65535):
            depth = np.full(frame.depth.shape, none, np.uint16)
            result = pointplane.VisualOdometry().process(depth, None, frame.camera, 1.0)
            self.assertIn("its depth image has no reading", result.reason)

    def test_colour_is_converted_and_views_with_gaps_between_rows_are_taken(self):
        frame = next(iter(pointplane.read_rawlog(RAWLOG)))
        colour = np.repeat(frame.gray[:, :, None], 3, axis=2)
        wide = np.full((frame.depth.shape[0], frame.depth.shape[1] + 8), np.nan, np.float32)
        view = wide[:, 4:-4]
        view[:] = frame.depth
        self.assertFalse(view.flags.c_contiguous)
        result = pointplane.VisualOdometry().process(view, colour, frame.camera, frame.stamp)
        self.assertEqual(result.status, "first")

    def test_arrays_are_not_copied_where_their_type_fits(self):
        """A copy would be in the program's memory: Linux tells the most that it had meanwhile."""

        def most():
            status = pathlib.Path("/proc/self/status").read_text()
            return int(re.search(r"VmHWM:\s+(\d+) kB", status).group(1)) / 1024

        def growth(depth, colour):
            pathlib.Path("/proc/self/clear_refs").write_text("5")  # what it had before
            before = most()
            result = odometry.process(depth, colour, camera, 1.0)
            self.assertIn("(8192x4096) does not fit the camera (640x480)", result.reason)
            return most() - before

        camera = pointplane.Camera(525, 525, 319.5, 239.5, 640, 480)
        odometry = pointplane.VisualOdometry()
        rows, columns = 4096, 8192  # 128 MB of depth; zeros take no memory until they are written
        depth = np.zeros((rows, columns + 8), np.float32)[:, 4:-4]
        gray = np.zeros((rows, columns), np.uint8)
        self.assertLess(growth(depth, gray), 16)
        # That a copy is seen: these are converted, as is documented.
        self.assertGreater(growth(np.zeros((rows, columns), np.uint16), None), 100)

    def test_arrays_belong_to_the_caller_before_and_after(self):
        """They are not written to, and may be written to after the call."""
        poses = []
        for overwritten in (False, True):
            odometry = pointplane.VisualOdometry()
            for frame in pointplane.read_rawlog(RAWLOG):
                depth, gray = frame.depth.copy(), frame.gray.copy()
                for array in (depth, gray):
                    array.flags.writeable = False
                result = odometry.process(depth, gray, frame.camera, frame.stamp)
                np.testing.assert_array_equal(depth, frame.depth)
                np.testing.assert_array_equal(gray, frame.gray)
                if overwritten:
                    for array in (depth, gray):
                        array.flags.writeable = True
                        array[:] = 1
            poses.append(result.pose)
        np.testing.assert_array_equal(poses[0], poses[1])

    def test_what_cannot_be_used_is_lost_with_a_reason(self):
        frame = next(iter(pointplane.read_rawlog(RAWLOG)))
        small = np.ones((10, 10), np.float32)
        result = pointplane.VisualOdometry().process(small, None, frame.camera, frame.stamp)
        self.assertEqual(result.status, "lost")
        self.assertIn("10x10", result.reason)

    def test_a_motion_that_is_measured_in_part_is_tracked_with_a_reason(self):
        camera = pointplane.Camera(260, 260, 159.5, 119.5, 320, 240)
        wall = np.full((240, 320), 2, np.float32)
        odometry = pointplane.VisualOdometry()
        for i in range(3):
            result = odometry.process(wall - 0.001 * np.float32(i), None, camera, 1 + i / 30)
        self.assertEqual(result.status, "tracked")
        self.assertIn("3 of 6 directions are measured", result.reason)
        self.assertIn("what limits a tracked one", pointplane.Result.reason.__doc__)

    def test_a_mask_leaves_out_a_part_of_the_images(self):
        odometry = pointplane.VisualOdometry()
        frames = list(pointplane.read_rawlog(RAWLOG))
        mask = np.full(frames[0].gray.shape, 255, np.uint8)
        mask[: mask.shape[0] // 2] = 0
        poses = []
        for given in (mask, None):
            odometry.set_mask(given)
            odometry.reset()
            poses.append([odometry.process(frame).pose for frame in frames][-1])
        self.assertGreater(np.abs(poses[0] - poses[1]).max(), 0)
        odometry.set_mask(mask[:, :8])
        self.assertIn("the mask", odometry.process(frames[0]).reason)
        with self.assertRaisesRegex(TypeError, "^mask: expected uint8, 0 where .*; it is bool$"):
            odometry.set_mask(mask > 0)
        for value, word in ((0, "black"), (1, "white"), (255, "white")):
            with self.assertRaisesRegex(ValueError, f"^the mask is {word} everywhere; it must be"):
                odometry.set_mask(np.full_like(mask, value))

    def test_a_mask_means_the_same_whatever_its_largest_value(self):
        frames = list(pointplane.read_rawlog(RAWLOG))
        poses = []
        for dark, bright in ((0, 255), (20, 255), (0, 1)):
            mask = np.full(frames[0].gray.shape, bright, np.uint8)
            mask[: mask.shape[0] // 2] = dark
            odometry = pointplane.VisualOdometry()
            odometry.set_mask(mask)
            poses.append([odometry.process(frame).pose for frame in frames][-1])
        np.testing.assert_array_equal(poses[0], poses[1])
        np.testing.assert_array_equal(poses[0], poses[2])

    def test_wrong_types_and_shapes_are_refused(self):
        frame = next(iter(pointplane.read_rawlog(RAWLOG)))
        odometry = pointplane.VisualOdometry()
        for kind in (np.float64, ">f4", np.int32, np.uint8):
            with self.assertRaisesRegex(
                TypeError,
                "^depth: expected float32 in metres, or uint16 in units of depth_unit; it is "
                f"{np.dtype(kind)}$",
            ):
                odometry.process(np.zeros((48, 64), kind), None, frame.camera, 1.0)
        with self.assertRaisesRegex(TypeError, "^colour: expected uint8, gray or RGB; it is int32$"):
            odometry.process(frame.depth, frame.gray.astype(np.int32), frame.camera, 1.0)
        # What NumPy would have to convert: nobody would keep what it made.
        converted = type("Image", (), {"__array__": lambda self: frame.gray.copy()})
        for thing, name in ((frame.gray.tolist(), "list"), (converted(), "Image")):
            with self.assertRaisesRegex(
                TypeError, f"^colour: expected uint8, gray or RGB; it is {name}$"
            ):
                odometry.process(frame.depth, thing, frame.camera, 1.0)
            with self.assertRaisesRegex(TypeError, f"^mask: expected uint8, 0 where .*is {name}$"):
                odometry.set_mask(thing)
        rgb = np.zeros((*frame.gray.shape, 3), np.uint8)
        for view in (frame.gray[:, ::2], frame.gray.T, rgb[:, :, ::-1], rgb[:, ::2]):
            with self.assertRaisesRegex(
                ValueError, r"^colour: rows are not contiguous; give numpy.ascontiguousarray\(colour\)$"
            ):
                odometry.process(frame.depth, view, frame.camera, 1.0)
        for view in (frame.depth[:, ::2], frame.depth[::-1], frame.depth.T):
            with self.assertRaisesRegex(
                ValueError, r"^depth: rows are not contiguous; give numpy.ascontiguousarray\(depth\)$"
            ):
                odometry.process(view, None, frame.camera, 1.0)
        # Rows that overlap, as of a sliding window, or that lie odd bytes apart.
        row = frame.depth.shape[1] * 4
        for step in (4, row + 1):
            memory = np.zeros(frame.depth.shape[0] * (row + 4), np.uint8)
            view = np.ndarray(frame.depth.shape, np.float32, memory, 0, (step, 4))
            with self.assertRaisesRegex(ValueError, "^depth: rows are not contiguous"):
                odometry.process(view, None, frame.camera, 1.0)
        with self.assertRaisesRegex(ValueError, "^depth: is empty$"):
            odometry.process(frame.depth[:0], None, frame.camera, 1.0)
        with self.assertRaisesRegex(
            ValueError, r"^colour: has the shape \(1, 2, 4\), not \(height, width, 3\)$"
        ):
            odometry.process(frame.depth, np.zeros((1, 2, 4), np.uint8), frame.camera, 1.0)
        with self.assertRaisesRegex(ValueError, "focal"):
            pointplane.Camera(0, 500, 320, 240, 640, 480)
        for cx, cy in ((0, 0), (-1, 240), (5000, 240), (320, 480)):
            with self.assertRaisesRegex(ValueError, "principal point is outside of the image"):
                pointplane.Camera(500, 500, cx, cy, 640, 480)

    def test_distortion_is_as_opencv_gives_it(self):
        def distortion(given):
            return list(pointplane.Camera(500, 500, 320, 240, 640, 480, given).distortion)

        five = [0.1, -0.2, 0.001, 0.002, 0.3]
        for given in (five, tuple(five), np.array(five), np.array([five]), np.array(five)[:, None]):
            self.assertEqual(distortion(given), five)
        self.assertEqual(distortion(five[:4]), five[:4] + [0])
        self.assertEqual(distortion([]), 5 * [0])
        self.assertEqual(distortion(None), 5 * [0])
        for wrong in ("0.1", ["k1"], 0.1):
            with self.assertRaisesRegex(TypeError, "^distortion: expected numbers k1 k2 p1 p2 k3"):
                distortion(wrong)
        self.assertEqual(distortion(five + [0, 0, 0]), five)
        with self.assertRaisesRegex(ValueError, "^distortion has 8 values, but only k1 k2 p1 p2 k3"):
            distortion(five + [0, 0, 1e-3])

    def test_arrays_of_another_process_are_taken(self):
        frame = next(iter(pointplane.read_rawlog(RAWLOG)))
        millimetres = np.nan_to_num(frame.depth * 1000).astype(np.uint16)
        for depth in (frame.depth, millimetres):
            for change in (
                lambda array: pickle.loads(pickle.dumps(array)),
                lambda array: array.astype(np.dtype(array.dtype, metadata={"unit": "m"})),
            ):
                odometry = pointplane.VisualOdometry()
                odometry.set_mask(change((frame.gray > 99).astype(np.uint8)))
                result = odometry.process(change(depth), change(frame.gray), frame.camera, 1.0)
                self.assertEqual(result.status, "first")
        with self.assertRaisesRegex(TypeError, "^depth: expected float32"):
            odometry.process(frame.depth.astype(">f4"), None, frame.camera, 1.0)

    def test_objects_that_were_not_initialised_are_refused(self):
        new = {
            name: getattr(pointplane, name).__new__(getattr(pointplane, name))
            for name in ("VisualOdometry", "Camera", "Frame", "Result", "RawlogFrames")
        }
        camera = pointplane.Camera(fx=9, fy=9, cx=2, cy=2, width=4, height=4)
        depth = np.ones((4, 4), np.float32)
        for name, use in (
            ("VisualOdometry", lambda: new["VisualOdometry"].process(depth, None, camera, 1.0)),
            ("VisualOdometry", lambda: new["VisualOdometry"].reset()),
            ("Camera", lambda: new["Camera"].fx),
            ("Camera", lambda: pointplane.VisualOdometry().process(depth, None, new["Camera"], 1.0)),
            ("Frame", lambda: new["Frame"].depth),
            ("Frame", lambda: pointplane.VisualOdometry().process(new["Frame"])),
            ("Result", lambda: new["Result"].pose),
            ("RawlogFrames", lambda: next(new["RawlogFrames"])),
        ):
            with self.assertRaisesRegex(TypeError, name + r": its __init__\(\) was not called"):
                use()

    def test_masked_arrays_are_refused_because_their_mask_would_be_lost(self):
        frame = next(iter(pointplane.read_rawlog(RAWLOG)))
        odometry = pointplane.VisualOdometry()
        far = np.ma.masked_greater(frame.depth, 2)
        dark = np.ma.masked_less(frame.gray, 9)
        with self.assertRaisesRegex(TypeError, r"^depth: is a masked.*depth.filled\(numpy.nan\)"):
            odometry.process(far, frame.gray, frame.camera, 1.0)
        with self.assertRaisesRegex(TypeError, r"^colour: is a masked.*give colour.filled\(0\)$"):
            odometry.process(frame.depth, dark, frame.camera, 1.0)
        with self.assertRaisesRegex(TypeError, "^mask: is a masked array"):
            odometry.set_mask(dark)
        result = odometry.process(far.filled(np.nan), dark.filled(0), frame.camera, 1.0)
        self.assertEqual(result.status, "first")

    def test_units_of_depth_that_no_camera_has_are_refused(self):
        frame = next(iter(pointplane.read_rawlog(RAWLOG)))
        millimetres = np.nan_to_num(frame.depth * 1000).astype(np.uint16)
        odometry = pointplane.VisualOdometry()
        for unit in (0, -0.001, float("nan"), float("inf"), 1e-300, 1e300, 1000):
            with self.assertRaisesRegex(
                ValueError, r"^depth_unit: is \S+ m, not from 1e-06 to 1 m; 0.001 means millimetres$"
            ):
                odometry.process(millimetres, None, frame.camera, 1.0, depth_unit=unit)
        with self.assertRaisesRegex(ValueError, "^depth_unit: is of uint16, .*depth is in metres$"):
            odometry.process(frame.depth * 1000, None, frame.camera, 1.0, depth_unit=0.001)

    def test_stamps_in_other_units_than_seconds_are_lost_with_a_reason(self):
        frame = next(iter(pointplane.read_rawlog(RAWLOG)))
        odometry = pointplane.VisualOdometry()
        for stamp in (1305031102175304000, 1305031102175304, 1305031102175):
            result = odometry.process(frame.depth, None, frame.camera, stamp)
            self.assertEqual(result.status, "lost")
            self.assertRegex(result.reason, r"^its time stamp, \S+, is too large for seconds; divide")
        result = odometry.process(frame.depth, None, frame.camera, 1305031102.175)
        self.assertEqual(result.status, "first")

    def test_threads_may_share_one_object(self):
        frames = list(pointplane.read_rawlog(RAWLOG))
        odometry = pointplane.VisualOdometry()
        statuses, errors = [], []

        def work():
            try:
                for frame in frames * 2:
                    statuses.append(odometry.process(frame).status)
                odometry.reset()
            except Exception as error:
                errors.append(error)

        threads = [threading.Thread(target=work) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(errors, [])
        self.assertEqual(len(statuses), 6 * len(frames))
        self.assertLessEqual(set(statuses), {"first", "tracked", "predicted", "lost"})
        # What the threads left behind does no harm.
        odometry.reset()
        self.assertEqual(odometry.process(frames[0]).status, "first")
        self.assertEqual(odometry.process(frames[1]).status, "tracked")

    def test_first_arrays_may_be_of_several_threads(self):
        script = """
import sys, threading
import pointplane
frame = next(pointplane.read_rawlog(sys.argv[1]))
start = threading.Barrier(4)
def work():
    start.wait()
    frame.depth
threads = [threading.Thread(target=work, daemon=True) for _ in range(4)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
"""
        subprocess.run([sys.executable, "-c", script, RAWLOG], check=True, timeout=60)

    def test_a_daemon_thread_does_not_disturb_the_end(self):
        script = """
import sys, threading, time
import pointplane
odometry, frames = pointplane.VisualOdometry(), list(pointplane.read_rawlog(sys.argv[1]))
def work():
    while True:
        for frame in frames:
            odometry.process(frame)
threading.Thread(target=work, daemon=True).start()
time.sleep(0.2)
"""
        for _ in range(3):
            done = subprocess.run([sys.executable, "-c", script, RAWLOG], timeout=60)
            self.assertEqual(done.returncode, 0)

    def test_configuration(self):
        pointplane.VisualOdometry(settings=["PoseSolver.alpha=7"])
        with self.assertRaisesRegex(pointplane.InputError, "PoseSolver"):
            pointplane.VisualOdometry(settings=["PoseSolver.alpa=7"])
        for wrong in ("PoseSolver.alpha=7", b"PoseSolver.alpha=7", ["PoseSolver.alpha=7", 1]):
            with self.assertRaisesRegex(
                TypeError, r"^settings: expected a list like \['Lens.nominal=true'\]$"
            ):
                pointplane.VisualOdometry("", wrong)


class Documents(unittest.TestCase):
    def test_their_lines_run_as_they_are_written(self):
        root = pathlib.Path(__file__).parents[2]
        pages = [(root / page).read_text() for page in ("docs/python.md", "README.md")]
        images, rawlog = (re.search(r"```python\n(.*?)```", page, re.S).group(1) for page in pages)
        rows, columns = np.mgrid[0:480, 0:640]
        names = {
            "depth": (2 + 0.001 * columns).astype(np.float32),
            "colour": ((rows // 20 + columns // 20) % 2 * 255).astype(np.uint8),
            "stamp": 1.0,
        }
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(root / "config.ini", folder + "/config.ini")
            os.symlink(RAWLOG, folder + "/in.rawlog")
            before = os.getcwd()
            os.chdir(folder)
            try:
                exec(images, names)
                self.assertEqual(names["result"].status, "first")
                with contextlib.redirect_stdout(io.StringIO()):
                    exec(rawlog, names)
            finally:
                os.chdir(before)
        self.assertEqual(names["result"].status, "tracked")


if __name__ == "__main__":
    unittest.main()
