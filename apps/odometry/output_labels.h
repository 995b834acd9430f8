// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace pointplane
{
/** @name How the output rawlog names what it says about a camera, by the camera's label.
 * @{ */
/** Of the CObservationRobotPose with the pose since the first frame. */
[[nodiscard]] inline std::string poseLabelOf(const std::string& camera) { return camera + "_pose"; }
/** Of those with motions since earlier frames; the number of frames follows. */
[[nodiscard]] inline std::string sinceLabelOf(const std::string& camera)
{
    return camera + "_since_";
}
/** Beginning of the text of a CObservationComment on a frame that was not tracked. */
[[nodiscard]] inline std::string statusCommentOf(const std::string& camera)
{
    return "pointplane-status label=" + camera + " frame=";
}
/** @} */
}  // namespace pointplane
