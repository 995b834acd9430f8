// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/RobotTrajectory.h>
#include <pointplane/odometry/Odometry.h>

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/system/COutputLogger.h>

#include <optional>
#include <string>

namespace pointplane
{
/** RGB-D odometry for MRPT programs: observations in, pose PDFs of the robot out.
 *
 *     pointplane::VisualOdometry vo;
 *     vo.loadFromConfigFileName("config.ini");
 *     const auto r = vo.process(*observation);
 *     std::cout << r.pose << pointplane::toString(r.status);
 *
 * One object per camera, observations in order of time: those of another sensorLabel than the first
 * one's are Lost. A frame that cannot be used is Lost with a reason, never an exception. Not
 * thread-safe. Logs at LVL_DEBUG per frame, LVL_WARN when not tracked. */
class VisualOdometry : public mrpt::system::COutputLogger
{
 public:
    using TParams = OdometryParams;

    /** \throws std::invalid_argument naming the key when a parameter is out of range */
    explicit VisualOdometry(const TParams& params = {});

    /** Replaces all parameters and starts anew. \throws InputError naming file, line and key */
    void loadFromConfigFileName(const std::string& path);

    /** Estimates the motion since the previous observation.
     * \return increment and pose of the robot, MRPT axes, by sensorPose */
    [[nodiscard]] RobotMotion process(const mrpt::obs::CObservation3DRangeScan& scan);

    /** The same for a frame that an ObservationConverter has made, in another thread for instance.
     * A frame with a problem (ConvertedFrame::problem) is Lost for that reason. */
    [[nodiscard]] RobotMotion process(const ConvertedFrame& converted);

    /** Points and planes of the latest frame, camera's optical frame. */
    [[nodiscard]] const FrameFeatures& features() const { return odometry_.features(); }
    [[nodiscard]] const TParams& params() const { return odometry_.params(); }

    /** Odometry::setMask(). Stays when parameters are loaded. */
    void setMask(const cv::Mat& mask) { odometry_.setMask(mask); }

    /** For external images and shutter comments. */
    [[nodiscard]] ObservationConverter& converter() { return converter_; }

    /** Starts anew with the same parameters. */
    void reset();

 private:
    Odometry odometry_;
    ObservationConverter converter_;
    RobotTrajectory trajectory_;
    std::optional<std::string> label_;  //!< of the first observation
};
}  // namespace pointplane
