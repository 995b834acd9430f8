// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace pointplane
{
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;
using Matrix126d = Eigen::Matrix<double, 12, 6>;
using Matrix36d = Eigen::Matrix<double, 3, 6>;
using Matrix43d = Eigen::Matrix<double, 4, 3>;

/** Of a tangent vector whose axes are alike: (t, t, t, r, r, r). */
[[nodiscard]] inline Vector6d perAxis(double translation, double rotation)
{
    Vector6d out;
    out << Eigen::Vector3d::Constant(translation), Eigen::Vector3d::Constant(rotation);
    return out;
}
}  // namespace pointplane
