// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/se3.h>
#include <pointplane/odometry/Reference.h>

#include <cmath>
#include <utility>

namespace pointplane
{
void ReferenceWindow::TParams::check() const
{
    POINTPLANE_CHECK(
        reference == "keyframes" || reference == "previous",
        "reference = " << reference << " is neither keyframes nor previous");
    POINTPLANE_CHECK(
        maxKeyframes >= 1 && maxKeyframes <= 50,
        "maxKeyframes = " << maxKeyframes << " is not in 1..50");
    POINTPLANE_CHECK(
        keyframeDistance > 0, "keyframeDistance = " << keyframeDistance << " is not positive");
    POINTPLANE_CHECK(
        keyframeAngleDeg > 0, "keyframeAngleDeg = " << keyframeAngleDeg << " is not positive");
    POINTPLANE_CHECK(
        keyframeMinOverlap >= 0 && keyframeMinOverlap < 1,
        "keyframeMinOverlap = " << keyframeMinOverlap << " is not in [0, 1)");
}

ReferenceWindow::ReferenceWindow(const TParams& params) : params_(params) { params_.check(); }

std::vector<const Reference*> ReferenceWindow::active() const
{
    std::vector<const Reference*> out;
    if (!hasPrevious_)
    {
        return out;
    }
    out.push_back(&previous_);
    for (auto it = keyframes_.rbegin(); it != keyframes_.rend(); ++it)
    {
        if (it->id != previous_.id)
        {
            out.push_back(&*it);
        }
    }
    return out;
}

bool ReferenceWindow::isNewest(const Reference& reference) const
{
    return reference.id == (keyframes_.empty() ? previous_.id : keyframes_.back().id);
}

bool ReferenceWindow::needsKeyframe(const Eigen::Isometry3d& T_world_cam, double overlap) const
{
    if (params_.reference == "previous" || keyframes_.empty())
    {
        return true;
    }
    const Eigen::Isometry3d T_key_cam = keyframes_.back().T_world_cam.inverse() * T_world_cam;
    return T_key_cam.translation().norm() > params_.keyframeDistance ||
           so3Log(T_key_cam.linear()).norm() > params_.keyframeAngleDeg * M_PI / 180 ||
           overlap < params_.keyframeMinOverlap;
}

void ReferenceWindow::refinePreviousVelocity(const Vector6d& velocity)
{
    previous_.velocity = velocity;
    if (!keyframes_.empty() && keyframes_.back().id == previous_.id)
    {
        keyframes_.back().velocity = velocity;
    }
}

void ReferenceWindow::notePoints(int id, const std::vector<PointTrack>& tracks)
{
    for (Reference& keyframe : keyframes_)
    {
        if (keyframe.id == id)
        {
            keyframe.points.note(tracks);
        }
    }
}

void ReferenceWindow::add(Reference frame, bool isKeyframe)
{
    hasPrevious_ = true;
    previous_ = std::move(frame);
    if (isKeyframe && params_.reference == "keyframes")
    {
        keyframes_.push_back(previous_);
        while (keyframes_.size() > static_cast<size_t>(params_.maxKeyframes))
        {
            keyframes_.pop_front();
        }
    }
}

void ReferenceWindow::clear()
{
    hasPrevious_ = false;
    previous_ = {};
    keyframes_.clear();
}
}  // namespace pointplane
