// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "image_names.h"

namespace pointplane
{
/** @name Poses from the numbers of a file
 * Nothing if they are none, as files have them where tracking was lost.
 * @{ */

/** Of a 4x4 matrix, row by row: a rotation and a translation [m]. */
[[nodiscard]] std::optional<Eigen::Isometry3d> poseFromMatrix(const std::vector<double>& numbers);

/** \param xyzw quaternion */
[[nodiscard]] std::optional<Eigen::Isometry3d> poseFromQuaternion(
    const Eigen::Vector3d& position, const Eigen::Vector4d& xyzw);
/** @} */

/** Poses of frames, T_world_camera, by their numbers. */
using NumberedPoses = std::map<long, Eigen::Isometry3d>;

/** FolderLayout::poseOf of images whose numbers are those of the poses. */
[[nodiscard]] std::function<std::optional<Eigen::Isometry3d>(const ImageRef&)> poseByNumber(
    NumberedPoses poses);
}  // namespace pointplane
