// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/RgbdFrame.h>

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>

#include <map>
#include <memory>
#include <string>

namespace pointplane
{
/** An observation as the odometry takes it, or why it cannot be taken. */
struct ConvertedFrame
{
    RgbdFrame frame;      //!< only the stamp is set when there is a problem
    std::string problem;  //!< one clause without full stop; empty when usable
    /** The camera on the robot: T_robot_cam with optical axes, from sensorPose and, where there is
     * an intensity image, relativePoseIntensityWRTDepth. */
    Eigen::Isometry3d T_robot_cam{Eigen::Isometry3d::Identity()};
};

/** CObservation3DRangeScan -> RgbdFrame.
 *
 * Understands any rangeUnits and size, range_is_depth off, colour, monochrome and missing intensity
 * (the frame's `gray` is then empty and its camera the depth camera), external images and ranges,
 * lens distortion, negative fy. Depth that is not registered to the intensity image (different
 * intrinsics, size, or relativePoseIntensityWRTDepth) is rendered into the intensity camera.
 * maxRange is not applied: writers leave it at its default while measuring farther.
 *
 * Whether registered depth lies at distorted or ideal pixels follows from cameraParams: with the
 * distortion of cameraParamsIntensity it lies in the raw image, without at undistorted pixels. */
class ObservationConverter
{
 public:
    ObservationConverter();
    ~ObservationConverter();
    ObservationConverter(ObservationConverter&&) noexcept;
    ObservationConverter& operator=(ObservationConverter&&) noexcept;

    /** Where external images and ranges are (RawlogReader::externalsDirectory()). */
    void setExternalsDirectory(const std::string& directory);

    /** Takes note of a shutter model in a comment of the form
     *     pointplane-camera label=L readoutColour=0.02 readoutDepth=0.02 depthDelay=-0.01
     * (seconds; see ShutterModel; absent = not known). Other comments are ignored.
     * \throws InputError naming the key if such a comment cannot be understood */
    void readComment(const mrpt::obs::CObservationComment& comment);

    /** Never throws for what is in the observation. The observation stays as it is; external data
     * are not kept in it. */
    [[nodiscard]] ConvertedFrame convert(const mrpt::obs::CObservation3DRangeScan& scan) const;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/** The comment that readComment() understands; unknown values are left out. */
[[nodiscard]] std::string cameraComment(
    const std::string& label, const ShutterModel& shutter, bool isNominal = false);
}  // namespace pointplane
