// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/MovingRegions.h>
#include <pointplane/odometry/OdometryParams.h>
#include <pointplane/odometry/OdometryResult.h>
#include <pointplane/sensor/AttachedParts.h>
#include <pointplane/sensor/DepthNoiseLearner.h>

#include <optional>
#include <string>
#include <vector>

#include "Features.h"
#include "ImageMarks.h"
#include "PlaneAligner.h"
#include "Reference.h"

namespace pointplane
{
/** Takes points and planes from images, and finds what two frames have in common. Of the past it
 * knows the camera's noise, which it learns from the depth images, and what moves with the camera.
 */
class FrontEnd
{
 public:
    explicit FrontEnd(const OdometryParams& params);

    [[nodiscard]] Features extract(const RgbdFrame& frame, FrameDiagnostics& diagnostics);

    /** The points by which later frames are compared with this one. Takes time.
     * \param part of the frame: corners are taken where it has depth, key points that are matched
     * everywhere */
    [[nodiscard]] PointReference pointReference(
        const Features& features, const RgbdFrame& part) const;

    /** Why the image has no point, or empty. Takes time. */
    [[nodiscard]] std::string whyNoPoint(const RgbdFrame& frame) const;

    /** What is kept of the frame's images when it becomes a key frame. */
    [[nodiscard]] std::shared_ptr<KeyframeImages> keyframeImages(const Features& features) const;

    /** How well the depth images agree about a motion; see compareSurfaces(). */
    [[nodiscard]] Agreement compare(
        const SurfaceSamples& reference,
        const RgbdFrame& current,
        const Eigen::Isometry3d& T_cur_ref,
        double slack_m) const;
    [[nodiscard]] Agreement compare(
        const Reference& reference,
        const Features& current,
        const Eigen::Isometry3d& T_cur_ref) const;

    /** What has moved since earlier frames; see findMovingRegions(). */
    [[nodiscard]] MovingRegions findMoving(
        const Features& current, const std::vector<EarlierView>& earlier) const
    {
        return findMovingRegions(current.frame, earlier, depthNoise_.noise());
    }

    /** Motion T_cur_ref without a prediction (ImageAligner); nothing if too few points tell one. */
    [[nodiscard]] std::optional<Eigen::Isometry3d> alignImages(
        const Reference& reference, const Features& current) const;

    /** Motions T_cur_ref without a prediction (PlaneAligner) with which the surfaces agree. Where
     * surfaces look alike there are several, of which one is right at most. */
    [[nodiscard]] std::vector<Eigen::Isometry3d> alignPlanes(
        const Reference& reference, const Features& current) const;

    /** Finds points and planes of a reference again.
     * \param T_cur_ref where to look \param radiusFactor above 1 looks farther, less thoroughly */
    [[nodiscard]] Association associate(
        const Reference& reference,
        const Features& current,
        const Eigen::Isometry3d& T_cur_ref,
        double radiusFactor) const;

    /** What is fixed to the image. */
    [[nodiscard]] const ImageMarks& marks() const { return marks_; }
    [[nodiscard]] ImageMarks& marks() { return marks_; }

    /** PointStage::searchRadius_px(). */
    [[nodiscard]] double searchRadius_px(const RgbdFrame& frame) const
    {
        return pointStage_.searchRadius_px(frame);
    }

 private:
    /** What is learnt of one camera is not of another. */
    void forgetOtherCamera(const PinholeCamera& camera);

    void learnNoise(const cv::Mat& depth);

    /** Planes, and images that are ready for points. */
    void findFeatures(Features& features, FrameDiagnostics& diagnostics);

    /** A frame without depth where marks are: no point is taken there. */
    [[nodiscard]] RgbdFrame withoutMarks(const RgbdFrame& frame) const;

    /** Parts of the view that move with the camera tell nothing of its motion. */
    void leaveOutAttached(RgbdFrame& frame, FrameDiagnostics& diagnostics);

    [[nodiscard]] MatchedPoints matchImages(
        const Reference& reference, const Features& current) const;

    PipelineParams params_;
    bool findsMarks_;  //!< that takes two frames which are compared with the same one
    std::optional<PinholeCamera> camera_;  //!< of the frame before
    DepthNoiseLearner depthNoise_;
    AttachedParts attached_;
    ImageMarks marks_;
    PlaneExtractor planeExtractor_;
    PlaneMatcher planeMatcher_;
    PointStage pointStage_;
    ImageAligner imageAligner_;
    PlaneAligner planeAligner_;
};
}  // namespace pointplane
