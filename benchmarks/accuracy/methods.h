// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/PoseGaussian.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <functional>
#include <memory>
#include <optional>
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
    std::optional<PoseGaussian> pose;  //!< T_first_cur, of methods with covariances
};

/** An odometry under test, for one sequence. */
class Method
{
 public:
    virtual ~Method() = default;
    [[nodiscard]] virtual MethodStep process(const RgbdFrame& frame) = 0;
};

struct NamedMethod
{
    std::string name;
    std::function<std::unique_ptr<Method>()> create;
};

/** Both configurations and their ablations. \param configDirectory holds config.ini and
 * config-paper.ini \throws InputError */
[[nodiscard]] std::vector<NamedMethod> ourMethods(const std::string& configDirectory);

/** OpenCV's three and DIFODO at two sizes. A frame that fails keeps the previous motion. */
[[nodiscard]] std::vector<NamedMethod> peerMethods();
}  // namespace pointplane
