// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "methods.h"
#include "sequences.h"

namespace pointplane
{
/** How one method did on one sequence. */
struct MethodScore
{
    std::string method;
    bool isPeer{false};
    std::string failure;  //!< why it gave up, or empty
    int numFrames{0}, numLost{0}, numPredicted{0};
    double rpeTranslation{0}, rpeRotation{0};  //!< RMSE over 1 s, TUM protocol [m, rad]
    double ate{0};                             //!< RMSE [m]
    double msMedian{0}, msP99{0};              //!< of a frame
    /** NEES per degree of freedom over 1 frame, 10 frames and 1 s; none without covariances. */
    std::array<std::optional<double>, 3> nees;
};

/** One method on one sequence. */
class MethodRun
{
 public:
    explicit MethodRun(const NamedMethod& method);

    /** Does nothing any more after the method has thrown. */
    void process(const RgbdFrame& frame);

    [[nodiscard]] MethodScore score(const BenchmarkSequence& sequence) const;

 private:
    std::unique_ptr<Method> method_;
    MethodScore score_;
    Trajectory estimate_;
    Eigen::Isometry3d pose_{Eigen::Isometry3d::Identity()};
    std::vector<double> ms_;
};
}  // namespace pointplane
