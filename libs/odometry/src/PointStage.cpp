// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/odometry/PointStage.h>

#include <limits>

namespace pointplane
{
void PointStage::TParams::check() const
{
    POINTPLANE_CHECK(
        method == "track" || method == "match",
        "method = " << method << " is neither track nor match");
}

PointStage::PointStage(
    const TParams& params,
    const PointTracker::TParams& tracker,
    const PointDetector::TParams& detector,
    const PointMatcher::TParams& matcher,
    const PointLifter::TParams& lifter,
    const DepthNoise& noise)
    : params_(params),
      tracker_(tracker, lifter, noise),
      detector_(detector),
      matcher_(matcher),
      lifter_(lifter, noise)
{
    params_.check();
}

void PointStage::prepare(const RgbdFrame& frame)
{
    if (tracks())
    {
        pyramid_ = tracker_.pyramid(frame.gray);
        return;
    }
    const DetectedPoints detected = detector_.detect(frame.gray);
    LiftedPoints lifted = lifter_.liftAll(frame, detected.uv_px);
    described_.points = std::move(lifted.points);
    described_.descriptors.release();
    for (const int i : lifted.index)
    {
        described_.descriptors.push_back(detected.descriptors.row(i));
    }
}

PointReference PointStage::makeReference(const RgbdFrame& frame) const
{
    return tracks() ? tracker_.makeReference(frame) : described_;
}

std::vector<PointTrack> PointStage::correspond(
    const PointReference& reference,
    const RgbdFrame& frame,
    const Eigen::Isometry3d& T_cur_ref,
    double radiusFactor) const
{
    if (tracks())
    {
        return tracker_.track(reference, frame, pyramid_, T_cur_ref, radiusFactor);
    }
    std::vector<Eigen::Vector2d> predicted, current;
    for (const PointFeature& point : reference.points)
    {
        const Eigen::Vector3d p_cur = T_cur_ref * point.p_cam.mean;
        predicted.push_back(
            p_cur.z() > 0.1 ? frame.camera.project(p_cur)
                            : Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
    }
    for (const PointFeature& point : described_.points)
    {
        current.push_back(point.uv_px);
    }
    std::vector<PointTrack> out;
    if (predicted.empty() || current.empty())
    {
        return out;
    }
    for (const PointMatch& match :
         matcher_.match(predicted, reference.descriptors, current, described_.descriptors))
    {
        out.push_back({match.ref, described_.points[static_cast<size_t>(match.cur)]});
    }
    return out;
}
}  // namespace pointplane
