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
/** RGB-D odometry for MRPT programs. It takes the scans of a camera, and returns the poses of the
 * robot with covariances.
 *
 *     pointplane::VisualOdometry vo;
 *     vo.loadFromConfigFileName("config.ini");
 *     for (const auto& observation : observations)  // of a rawlog, in order of time
 *     {
 *         if (auto comment = std::dynamic_pointer_cast<CObservationComment>(observation))
 *         {
 *             vo.converter().readComment(*comment);  // shutter, and whether it is calibrated
 *         }
 *         if (auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(observation))
 *         {
 *             const auto result = vo.process(*scan);
 *             std::cout << toString(result.status) << " " << result.pose << "\n";
 *         }
 *     }
 *
 * Give the comments too: pointplane's programs write into them what a scan has no place for.
 * readComment() throws InputError if one is damaged.
 *
 * Each camera needs an object of its own. The first scan's sensorLabel says which camera it is;
 * scans with another label are Lost. Scans must come in order of time. A scan that cannot be used
 * is Lost, and RobotMotion::reason says why; process() throws only if memory is short. Do not use
 * one object from two threads at once. One that was moved from may only be destroyed or assigned
 * to.
 *
 * It logs each frame at LVL_DEBUG, and frames that are Predicted or Lost at LVL_WARN. */
class VisualOdometry : public mrpt::system::COutputLogger
{
 public:
    using TParams = OdometryParams;

    /** \throws std::invalid_argument naming the key when a parameter is out of range */
    explicit VisualOdometry(const TParams& params = {});

    /** Replaces all parameters and starts anew, as reset(). \throws InputError naming file, line
     * and key */
    void loadFromConfigFileName(const std::string& path);

    /** Estimates the motion since the previous observation.
     * \return increment and pose of the robot, MRPT axes, by sensorPose */
    [[nodiscard]] RobotMotion process(const mrpt::obs::CObservation3DRangeScan& scan);

    /** The same for a frame that an ObservationConverter has made. One in another thread must not
     * be converter(), and needs the comments and the folder of external images itself. A frame with
     * a problem (ConvertedFrame::problem), or whose T_robot_cam is no pose, is Lost for that
     * reason. */
    [[nodiscard]] RobotMotion process(const ConvertedFrame& converted);

    /** Points and planes of the latest frame, in the camera's optical frame. Copy it to keep it:
     * process(), reset() and loadFromConfigFileName() change it or end it. */
    [[nodiscard]] const FrameFeatures& features() const { return odometry_.features(); }
    [[nodiscard]] const TParams& params() const { return odometry_.params(); }

    /** Odometry::setMask(). Stays when parameters are loaded. */
    void setMask(const cv::Mat& mask) { odometry_.setMask(mask); }

    /** To tell where external images are (setExternalsDirectory()), and to give it comments
     * (readComment()). */
    [[nodiscard]] ObservationConverter& converter() { return converter_; }

    /** Starts anew with the same parameters, mask and folder of external images. It forgets the
     * cameras, too (ObservationConverter::reset()): give it their comments again. */
    void reset();

 private:
    Odometry odometry_;
    ObservationConverter converter_;
    RobotTrajectory trajectory_;
    std::optional<std::string> label_;  //!< of the first observation
};
}  // namespace pointplane
