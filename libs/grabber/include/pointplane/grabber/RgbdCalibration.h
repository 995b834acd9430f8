// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/Camera.h>

#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>

#include <string>

namespace pointplane
{
/** Everything that goes into an observation besides its images. */
struct RgbdCalibration
{
    mrpt::img::TCamera depth, colour;     //!< equal but for distortion when depth is registered
    mrpt::poses::CPose3D colourWrtDepth;  //!< CObservation3DRangeScan's convention
    mrpt::poses::CPose3D sensorPose;      //!< of the depth camera on the robot
    std::string sensorLabel{"OPENNI2"};
    bool isNominal{false};  //!< nobody calibrated this camera: intrinsics are those of its model
    std::string source;     //!< where the intrinsics come from, one clause for the summary
};

/** From what the driver says: square pixels, principal point in the centre, no distortion. */
[[nodiscard]] RgbdCalibration nominalCalibration(const CameraFacts& facts);

/** From a file of a calibration program:
 *
 * - ini of rawlog-grabber or kinect-stereo-calib: sections `<section>_RIGHT` (colour camera),
 *   `<section>_LEFT` (depth camera) and `<section>_LEFT2RIGHT_POSE`; from `<section>` itself, if
 *   there is one, `sensorLabel` and `pose_x` ... `pose_roll` (metres, degrees). For registered
 * depth only the colour camera is read;
 * - yml of camera-calib: the colour camera. Depth must be registered to it.
 *
 * \throws InputError that names file, section and key */
[[nodiscard]] RgbdCalibration calibrationFromFile(
    const std::string& path, const std::string& section, const CameraFacts& facts);
}  // namespace pointplane
