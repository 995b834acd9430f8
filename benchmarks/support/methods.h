// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/PoseGaussian.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace pointplane
{
enum class Outcome
{
    Measured,
    Predicted,
    Lost
};

struct MethodStep
{
    Outcome outcome{Outcome::Measured};
    Eigen::Isometry3d T_prev_cur{Eigen::Isometry3d::Identity()};  //!< optical frames
    std::optional<Matrix6d> incrementCov{};  //!< of T_prev_cur (left perturbation), if told
    std::optional<PoseGaussian> pose{};      //!< T_first_cur, of methods with covariances
    std::vector<PoseGaussian> since{};       //!< of these, as OdometryResult::since
};

/** An odometry under test, for one sequence. Frames come in order of time. */
class Method
{
 public:
    virtual ~Method() = default;
    /** \param frame images are not modified */
    [[nodiscard]] virtual MethodStep process(const RgbdFrame& frame) = 0;
};

struct NamedMethod
{
    std::string name;
    bool isPeer{false};
    std::function<std::unique_ptr<Method>()> create;
};

/** One of our methods gave up; all else is done. */
class IncompleteError : public std::runtime_error
{
 public:
    using std::runtime_error::runtime_error;
};

/** One of ours: a configuration file with settings as "Section.key=value".
 * \param hideShutter takes what the source knows of the shutter away from the frames
 * \throws InputError */
[[nodiscard]] NamedMethod ourMethod(
    const std::string& name,
    const std::string& configFile,
    const std::vector<std::string>& settings,
    bool hideShutter = false);

/** The three configurations and their ablations.
 * \param configDirectory holds config.ini, config-fast.ini and config-paper.ini
 * \throws InputError */
[[nodiscard]] std::vector<NamedMethod> ourMethods(const std::string& configDirectory);

/** \param type of cv::rgbd::Odometry: RgbdOdometry, ICPOdometry or RgbdICPOdometry */
[[nodiscard]] NamedMethod openCvMethod(const std::string& type);

/** MRPT's DIFODO. \param width 160 or 320 [px] */
[[nodiscard]] NamedMethod difodoMethod(int width);

/** OpenCV's three and DIFODO at two sizes. A frame that fails keeps the previous motion. */
[[nodiscard]] std::vector<NamedMethod> peerMethods();

/** The frame with its rows turned round when the image's y axis points up (negative fy), which no
 * peer knows: the same scene, poses and depth. Otherwise the frame itself. */
[[nodiscard]] RgbdFrame withYDown(const RgbdFrame& frame);
}  // namespace pointplane
