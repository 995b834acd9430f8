// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/se3.h>

#include <Eigen/Core>

#include <gmock/gmock.h>

namespace pointplane::test
{
/** Element-wise |a - b| <= tolerance, sizes equal; prints the worst element. */
MATCHER_P2(IsMatrixNear, expected, tolerance, "")
{
    if (arg.rows() != expected.rows() || arg.cols() != expected.cols())
    {
        *result_listener << "size " << arg.rows() << "x" << arg.cols();
        return false;
    }
    const double worst = (arg - expected).cwiseAbs().maxCoeff();
    *result_listener << "largest difference " << worst << "\nactual:\n"
                     << arg << "\nexpected:\n"
                     << expected;
    return arg.allFinite() && worst <= tolerance;
}

/** Rotation within `rad` and translation within `m` of the expected Eigen::Isometry3d. */
MATCHER_P3(IsNearPose, expected, rad, m, "")
{
    const double angle = so3Log(expected.linear().transpose() * arg.linear()).norm();
    const double distance = (arg.translation() - expected.translation()).norm();
    *result_listener << "rotation off by " << angle << " rad, translation by " << distance << " m";
    return angle <= rad && distance <= m;
}
}  // namespace pointplane::test
