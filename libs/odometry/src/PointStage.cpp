// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/choice.h>
#include <pointplane/odometry/PointStage.h>

#include <algorithm>
#include <limits>

namespace pointplane
{
bool PointStage::TParams::tracks() const
{
    return chosen<bool>("method", method, {{"track", true}, {"match", false}});
}

void PointStage::TParams::check() const { (void)tracks(); }

PointStage::PointStage(
    const TParams& params,
    const PointTracker::TParams& tracker,
    const PointDetector::TParams& detector,
    const PointMatcher::TParams& matcher,
    const PointLifter::TParams& lifter,
    const DepthNoise& noise)
    : tracks_(params.tracks()),
      tracker_(tracker, lifter, noise),
      detector_(detector),
      matcher_(matcher),
      lifter_(lifter, noise),
      wallDepth_m_(std::clamp(1.0, lifter.minDepth, lifter.maxDepth))
{
}

PreparedPoints PointStage::prepare(const RgbdFrame& frame) const
{
    PreparedPoints out;
    if (tracks_)
    {
        out.pyramid = tracker_.pyramid(frame.gray);
    }
    else
    {
        out.described = describe(frame, detector_, lifter_);
    }
    return out;
}

void PointStage::setNoise(const DepthNoise& noise)
{
    tracker_.setNoise(noise);
    lifter_.setNoise(noise);
}

PointReference PointStage::makeReference(
    const RgbdFrame& frame, const PreparedPoints& prepared) const
{
    if (tracks_)
    {
        return tracker_.makeReference(frame);
    }
    PointReference out;
    out.points = prepared.described.points;
    out.descriptors = prepared.described.descriptors;
    return out;
}

bool PointStage::findsPoint(const RgbdFrame& frame) const
{
    if (!tracks_)
    {
        return !detector_.detect(frame.gray).uv_px.empty();
    }
    RgbdFrame wall = frame;
    wall.depth = cv::Mat(frame.depth.size(), frame.depth.type(), wallDepth_m_);
    return !tracker_.makeReference(wall).points.empty();
}

double PointStage::searchRadius_px(const RgbdFrame& frame) const
{
    return tracks_ ? tracker_.searchRadius_px(frame.gray) : matcher_.searchRadius_px();
}

std::vector<PointTrack> PointStage::correspond(
    const PointReference& reference,
    const RgbdFrame& frame,
    const PreparedPoints& prepared,
    const Eigen::Isometry3d& T_cur_ref,
    double radiusFactor) const
{
    if (tracks_)
    {
        return tracker_.track(reference, frame, prepared.pyramid, T_cur_ref, radiusFactor);
    }
    const DescribedPoints& described = prepared.described;
    std::vector<Eigen::Vector2d> predicted, current;
    for (const PointFeature& point : reference.points)
    {
        const Eigen::Vector3d p_cur = T_cur_ref * point.p_cam.mean;
        predicted.push_back(
            p_cur.z() > 0 ? frame.camera.project(p_cur)
                          : Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
    }
    for (const PointFeature& point : described.points)
    {
        current.push_back(point.uv_px);
    }
    std::vector<PointTrack> out;
    if (predicted.empty() || current.empty())
    {
        return out;
    }
    for (const PointMatch& match :
         matcher_.match(predicted, reference.descriptors, current, described.descriptors))
    {
        out.push_back({match.ref, described.points[static_cast<size_t>(match.cur)]});
    }
    return out;
}
}  // namespace pointplane
