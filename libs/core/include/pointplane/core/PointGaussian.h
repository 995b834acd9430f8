// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>

namespace pointplane
{
/** A 3-D point with uncertainty, both in the same frame [m, m^2]. */
struct PointGaussian
{
    Eigen::Vector3d mean{Eigen::Vector3d::Zero()};
    Eigen::Matrix3d cov{Eigen::Matrix3d::Zero()};
};
}  // namespace pointplane
