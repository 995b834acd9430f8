// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/RgbdFrame.h>

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>

#include <memory>
#include <optional>
#include <set>
#include <string>

namespace pointplane
{
/** An observation in the form that the odometry takes, or what is wrong with it. */
struct ConvertedFrame
{
    RgbdFrame frame;      //!< only the stamp is set when there is a problem
    std::string problem;  //!< one clause without full stop; empty when usable
    std::string sensorLabel;
    /** The camera on the robot: T_robot_cam with optical axes, from sensorPose and, if it is the
     * intensity camera, relativePoseIntensityWRTDepth. */
    Eigen::Isometry3d T_robot_cam{Eigen::Isometry3d::Identity()};
};

/** CObservation3DRangeScan -> RgbdFrame.
 *
 * It takes any rangeUnits and image size, range_is_depth off, external images and ranges, lens
 * distortion, negative fy. Intensity may be in colour, monochrome or missing; if it is missing, the
 * frame's `gray` is empty. Its camera is that of the label's latest intensity image, or the depth
 * camera if there was none. Of 16 bit intensity, the bits count that the camera has used so far.
 * Depth that is not registered to the intensity image (other intrinsics, size, or
 * relativePoseIntensityWRTDepth) is rendered into the intensity camera. maxRange is ignored:
 * writers leave it at its default while measuring farther.
 *
 * Registered depth lies in the raw image if cameraParams has the distortion of
 * cameraParamsIntensity, and at undistorted pixels if it has none. Not thread-safe: convert() keeps
 * what it knows of the latest cameras. An object that was moved from may only be destroyed or
 * assigned to. Docs: docs/rawlogs.md. */
class ObservationConverter
{
 public:
    ObservationConverter();
    ~ObservationConverter();
    ObservationConverter(ObservationConverter&&) noexcept;
    ObservationConverter& operator=(ObservationConverter&&) noexcept;

    /** Where external images and ranges are (RawlogReader::externalsDirectory()). Without it, or
     * with an empty one, MRPT's folder: mrpt::img::CImage::getImagesPathBase(). */
    void setExternalsDirectory(const std::string& directory);

    /** Reads the shutter model of a comment of the form
     *     pointplane-camera label=L readoutColour=0.02 readoutDepth=0.02 depthDelay=-0.01
     * (seconds; see ShutterModel; absent = not known; a blank in the label is %20). Other comments
     * are ignored. \return whose it is, L; empty: it is another comment
     * \throws InputError naming the key if a value cannot be understood */
    std::string readComment(const mrpt::obs::CObservationComment& comment);

    /** Keys of such comments that were ignored: a newer version may know them. */
    [[nodiscard]] const std::set<std::string>& unknownKeys() const;

    /** \param scan not changed; external data that were read are not kept in it
     * \return the frame or, whatever is wrong with the observation, the problem; never throws for
     * it, but std::bad_alloc or OpenCV's own where memory is short */
    [[nodiscard]] ConvertedFrame convert(const mrpt::obs::CObservation3DRangeScan& scan) const;

    /** For another recording: forgets the cameras, with comments and latest images. The folder of
     * external images stays. */
    void reset();

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/** A frame as the odometry of one camera takes it. One of another camera has a problem, and no
 * stamp, because it says nothing of this camera. \param label of the camera: the first frame's */
[[nodiscard]] ConvertedFrame ofOneCamera(
    const ConvertedFrame& converted, std::optional<std::string>& label);

/** The comment that readComment() understands; unknown values are left out. */
[[nodiscard]] std::string cameraComment(
    const std::string& label, const ShutterModel& shutter, bool isNominal = false);
}  // namespace pointplane
