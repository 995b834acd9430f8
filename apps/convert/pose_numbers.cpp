// SPDX-License-Identifier: BSD-3-Clause
#include "pose_numbers.h"

#include <cmath>
#include <utility>

namespace pointplane
{
std::optional<Eigen::Isometry3d> poseFromMatrix(const std::vector<double>& numbers)
{
    constexpr double kRounding = 1e-3;  // of what a file holds
    if (numbers.size() != 16)
    {
        return {};
    }
    Eigen::Isometry3d out;
    out.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
    const Eigen::Matrix3d R = out.linear();
    if (!out.matrix().allFinite() || out.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1) ||
        !(R.transpose() * R).isIdentity(kRounding) || R.determinant() < 0)
    {
        return {};
    }
    out.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
    return out;
}

std::optional<Eigen::Isometry3d> poseFromQuaternion(
    const Eigen::Vector3d& position, const Eigen::Vector4d& xyzw)
{
    constexpr double kRounding = 0.01;  // files have four digits and more
    if (!position.allFinite() || !(std::abs(xyzw.norm() - 1) < kRounding))
    {
        return {};
    }
    Eigen::Isometry3d out(Eigen::Quaterniond(xyzw).normalized());
    out.translation() = position;
    return out;
}

std::function<std::optional<Eigen::Isometry3d>(const ImageRef&)> poseByNumber(NumberedPoses poses)
{
    return [poses = std::move(poses)](const ImageRef& image) -> std::optional<Eigen::Isometry3d>
    {
        const auto found = poses.find(image.key);
        return image.isNumbered && found != poses.end() ? std::optional(found->second)
                                                        : std::nullopt;
    };
}
}  // namespace pointplane
