// SPDX-License-Identifier: BSD-3-Clause
#include "ReferenceWindow.h"

#include <pointplane/core/check.h>
#include <pointplane/core/se3.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pointplane
{
ReferenceWindow::ReferenceWindow(const ReferenceParams& params)
    : params_(params), isFrameToFrame_(params.isFrameToFrame())
{
    params_.check();
}

std::vector<const Reference*> ReferenceWindow::active() const
{
    std::vector<const Reference*> out;
    if (!previous_)
    {
        return out;
    }
    out.push_back(&*previous_);
    for (auto it = keyframes_.rbegin(); it != keyframes_.rend(); ++it)
    {
        if (it->id != previous_->id)
        {
            out.push_back(&*it);
        }
    }
    return out;
}

bool ReferenceWindow::isNewest(const Reference& reference) const
{
    return reference.id == (keyframes_.empty() ? previous_->id : keyframes_.back().id);
}

double ReferenceWindow::overlap(
    const std::vector<Association>& associations, const Findable& findable) const
{
    const auto fraction = [](size_t found, size_t all)
    { return all > 0 ? static_cast<double>(found) / static_cast<double>(all) : 1.0; };
    double out = associations.empty() ? 0 : 1;
    for (const Association& a : associations)
    {
        if (isNewest(*a.reference))
        {
            const size_t planesFound = a.planes.size() + a.movingPlanes.size();
            const double points = fraction(a.numPointsFound(), a.reference->points.points.size());
            const double planes = fraction(planesFound, a.reference->planes.planes.size());
            out = std::min(findable.points ? points : 1, findable.planes ? planes : 1);
        }
    }
    return out;
}

bool ReferenceWindow::needsKeyframe(const Eigen::Isometry3d& T_world_cam, double overlap) const
{
    if (isFrameToFrame_ || keyframes_.empty())
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
    previous_->velocity = velocity;
    for (Reference& keyframe : keyframes_)
    {
        if (keyframe.id == previous_->id)
        {
            keyframe.velocity = velocity;
        }
    }
}

void ReferenceWindow::changeStamps(double by)
{
    if (previous_)
    {
        previous_->stamp += by;
    }
    for (std::deque<Reference>* frames : {&keyframes_, &places_})
    {
        for (Reference& frame : *frames)
        {
            frame.stamp += by;
        }
    }
}

void ReferenceWindow::notePoints(const Association& association)
{
    for (Reference& keyframe : keyframes_)
    {
        if (keyframe.id == association.reference->id && keyframe.points.patches)
        {
            keyframe.points.note(
                {&association.points, &association.movingPoints, &association.doubtedPoints});
        }
    }
}

void ReferenceWindow::add(Reference frame, bool isKeyframe)
{
    previous_ = std::move(frame);
    if (isKeyframe && !isFrameToFrame_)
    {
        addKeyframe(*previous_);
    }
}

void ReferenceWindow::addKeyframe(Reference frame)
{
    keyframes_.push_back(std::move(frame));
    while (keyframes_.size() > static_cast<size_t>(params_.maxKeyframes))
    {
        addPlace(std::move(keyframes_.front()));
        keyframes_.pop_front();
    }
}

/** In place of those that show the same. */
void ReferenceWindow::addPlace(Reference frame)
{
    const auto isSame = [&](const Reference& other)
    {
        const Eigen::Isometry3d T = other.T_world_cam.inverse() * frame.T_world_cam;
        return T.translation().norm() < params_.keyframeDistance &&
               so3Log(T.linear()).norm() < params_.keyframeAngleDeg * M_PI / 180;
    };
    places_.erase(std::remove_if(places_.begin(), places_.end(), isSame), places_.end());
    places_.push_back(std::move(frame));
    while (places_.size() > static_cast<size_t>(params_.maxPlaces))
    {
        places_.pop_front();
    }
}

void ReferenceWindow::recall(int id)
{
    const auto it = std::find_if(
        places_.begin(), places_.end(), [id](const Reference& r) { return r.id == id; });
    POINTPLANE_CHECK(it != places_.end(), "frame " << id << " is not a place");
    Reference place = std::move(*it);
    places_.erase(it);
    addKeyframe(std::move(place));
}

void ReferenceWindow::leave()
{
    for (Reference& keyframe : keyframes_)
    {
        addPlace(std::move(keyframe));
    }
    keyframes_.clear();
    previous_.reset();
}

void ReferenceWindow::clear()
{
    previous_.reset();
    keyframes_.clear();
    places_.clear();
}
}  // namespace pointplane
