// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <string>

#include <gmock/gmock.h>

namespace pointplane::test
{
/** What the matchers below compare, compiled once. */
[[nodiscard]] bool areNear(
    const Eigen::MatrixXd& actual,
    const Eigen::MatrixXd& expected,
    double tolerance,
    std::string& explanation);
[[nodiscard]] bool areNear(
    const Eigen::Isometry3d& actual,
    const Eigen::Isometry3d& expected,
    double rad,
    double m,
    std::string& explanation);

/** Element-wise |a - b| <= tolerance, sizes equal; prints the worst element. */
MATCHER_P2(IsMatrixNear, expected, tolerance, "")
{
    std::string explanation;
    const bool isNear = areNear(arg, expected, tolerance, explanation);
    *result_listener << explanation;
    return isNear;
}

/** Rotation within `rad` and translation within `m` of the expected Eigen::Isometry3d. */
MATCHER_P3(IsNearPose, expected, rad, m, "")
{
    std::string explanation;
    const bool isNear =
        areNear(Eigen::Isometry3d(arg), Eigen::Isometry3d(expected), rad, m, explanation);
    *result_listener << explanation;
    return isNear;
}
}  // namespace pointplane::test
