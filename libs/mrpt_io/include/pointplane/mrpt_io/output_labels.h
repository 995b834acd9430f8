// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace pointplane
{
/** @name How the output rawlog names what it says about a camera, by the camera's label.
 * @{ */
inline const std::string kPoseEnding = "_pose";
inline const std::string kSinceEnding = "_since_";  //!< the number of frames follows
inline const std::string kStatusBegins = "pointplane-status label=";
inline const std::string kStatusFrame = " frame=";  //!< behind the label; number and status follow

/** Of the CObservationRobotPose with the pose since the first frame. */
[[nodiscard]] inline std::string poseLabelOf(const std::string& camera)
{
    return camera + kPoseEnding;
}
/** Of those with motions since earlier frames; the number of frames follows. */
[[nodiscard]] inline std::string sinceLabelOf(const std::string& camera)
{
    return camera + kSinceEnding;
}
/** Beginning of the text of a CObservationComment on a frame that was not tracked. */
[[nodiscard]] inline std::string statusCommentOf(const std::string& camera)
{
    return kStatusBegins + camera + kStatusFrame;
}
/** The whole text. \param frame its number, from 0 \param status "predicted" or "lost" */
[[nodiscard]] inline std::string statusCommentOf(
    const std::string& camera,
    std::size_t frame,
    const std::string& status,
    const std::string& reason)
{
    return statusCommentOf(camera) + std::to_string(frame) + " " + status +
           (reason.empty() ? "" : ": " + reason);
}
inline const std::string kSkippedBegins = "pointplane-skipped label=";  //!< the label follows
/** Text of a CObservationComment: there were frames without a pose and a status comment. */
[[nodiscard]] inline std::string skippedCommentOf(const std::string& camera)
{
    return kSkippedBegins + camera;
}
/** @} */
}  // namespace pointplane
