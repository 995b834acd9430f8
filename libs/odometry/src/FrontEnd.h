// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/Features.h>
#include <pointplane/odometry/MovingRegions.h>
#include <pointplane/odometry/OdometryParams.h>
#include <pointplane/odometry/OdometryResult.h>
#include <pointplane/odometry/Reference.h>
#include <pointplane/sensor/DepthNoiseLearner.h>

#include <optional>
#include <vector>

namespace pointplane
{
/** From images to points and planes, and to what two frames have in common. Knows no history but
 * what the depth images have told of the camera's noise. */
class FrontEnd
{
 public:
    explicit FrontEnd(const OdometryParams& params);

    [[nodiscard]] Features extract(const RgbdFrame& frame, FrameDiagnostics& diagnostics);

    /** The points by which later frames can be compared with this one. Takes time. */
    [[nodiscard]] PointReference pointReference(const Features& features) const;

    /** What the frame's images are needed for when it has become a key frame. */
    [[nodiscard]] std::shared_ptr<KeyframeImages> keyframeImages(const Features& features) const;

    /** How well the depth images agree about a motion; see compareSurfaces(). */
    [[nodiscard]] Agreement compare(
        const Reference& reference,
        const Features& current,
        const Eigen::Isometry3d& T_cur_ref,
        double slack_m) const;

    /** What has moved since earlier frames; see findMovingRegions(). */
    [[nodiscard]] MovingRegions findMoving(
        const Features& current, const std::vector<EarlierView>& earlier) const
    {
        return findMovingRegions(current.frame, earlier, depthNoise_.noise());
    }

    /** Motion by the images alone, where enough points tell one. */
    [[nodiscard]] std::optional<ImageMotion> alignImages(
        const Reference& reference, const Features& current) const;

    /** What of the reference is found again.
     * \param T_cur_ref where to look \param radiusFactor above 1 looks farther, less thoroughly */
    [[nodiscard]] Association associate(
        const Reference& reference,
        const Features& current,
        const Eigen::Isometry3d& T_cur_ref,
        double radiusFactor) const;

 private:
    PipelineParams params_;
    std::optional<PinholeCamera> camera_;  //!< of the frame before
    DepthNoiseLearner depthNoise_;
    PlaneExtractor planeExtractor_;
    PlaneMatcher planeMatcher_;
    PointStage pointStage_;
    ImageAligner imageAligner_;
};
}  // namespace pointplane
