// SPDX-License-Identifier: BSD-3-Clause
#include "ImageMarks.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace pointplane
{
namespace
{
/** Places of standing points differ by their noise: less than this [px]. */
constexpr double kStill_px = 0.3;

/** More than that noise, surely [px]. */
constexpr double kMoved_px = 1;

/** Fewer points than this are wrong matches, and fewer that change lie at edges of depth. */
constexpr int kLeastPoints = 20;
constexpr size_t kLeastChanged = 10;

/** Depth has changed if it differs by more than three standard deviations. */
constexpr double kChanged2 = 9;

/** Before a camera that stands, noise changes the depth of three points in a thousand, and what
 * moves covers the points behind it. */
constexpr double kLeastShare = 1.0 / 6;

const PointFeature& pointOf(const Association& association, const PointTrack& track)
{
    return association.reference->points.points[static_cast<size_t>(track.ref)];
}

bool stands(const PointFeature& ref, const PointFeature& cur)
{
    return (cur.uv_px - ref.uv_px).norm() < kStill_px;
}

/** Of the depth, or 0 if that is not more than noise. */
double relativeChange(const PointFeature& ref, const PointFeature& cur)
{
    const double difference = cur.p_cam.mean.z() - ref.p_cam.mean.z();
    const double variance = cur.p_cam.cov(2, 2) + ref.p_cam.cov(2, 2);
    return difference * difference > kChanged2 * variance
               ? std::abs(difference) / ref.p_cam.mean.z()
               : 0;
}

/** How far points would have moved that stand where the camera goes to, or on the axis that it
 * circles: by as much of their distance from there as their depth has changed.
 * \return root mean square [px] */
double expectedFlow_px(
    const std::vector<Eigen::Vector2d>& places_px, const std::vector<double>& changes)
{
    Eigen::Vector2d sum(0, 0);
    double sum2 = 0, change = 0;
    for (size_t i = 0; i < places_px.size(); ++i)
    {
        sum += places_px[i];
        sum2 += places_px[i].squaredNorm();
        change += changes[i];
    }
    const auto n = static_cast<double>(places_px.size());
    return n > 0 ? std::sqrt(std::max(0.0, sum2 / n - (sum / n).squaredNorm())) * change / n : 0;
}

/** What the points that stand in the image tell. */
enum class Still
{
    Nothing,  //!< they are few
    Scene,    //!< the depth behind them stays
    Marks     //!< the depth behind many of them has changed
};

Still still(const Association& association)
{
    int numStill = 0;
    std::vector<Eigen::Vector2d> places_px;
    std::vector<double> changes;
    for (const PointTrack& track : association.points)
    {
        const PointFeature& ref = pointOf(association, track);
        if (!ref.hasDepth || !track.cur.hasDepth || !stands(ref, track.cur))
        {
            continue;
        }
        ++numStill;
        if (const double change = relativeChange(ref, track.cur); change > 0)
        {
            places_px.push_back(ref.uv_px);
            changes.push_back(change);
        }
    }
    const bool haveChanged = changes.size() >= kLeastChanged &&
                             static_cast<double>(changes.size()) >= kLeastShare * numStill &&
                             expectedFlow_px(places_px, changes) > kMoved_px;
    return numStill < kLeastPoints ? Still::Nothing : haveChanged ? Still::Marks : Still::Scene;
}
}  // namespace

std::vector<Mark> marksIn(const std::vector<Association>& associations)
{
    std::vector<Mark> out;
    for (const Association& association : associations)
    {
        for (const PointTrack& track : association.fixedPoints)
        {
            out.push_back({track.cur.uv_px, association.reference->id});
        }
    }
    return out;
}

void ImageMarks::split(Association& association) const
{
    const bool areShown = still(association) == Still::Marks;
    if (!areShown && !areKnown_)
    {
        return;
    }
    std::vector<PointTrack> others;
    for (const PointTrack& track : association.points)
    {
        const bool isStill = stands(pointOf(association, track), track.cur);
        std::vector<PointTrack>& kind = isStill && areShown ? association.fixedPoints
                                        : isStill || seesMark(track.cur.uv_px)
                                            ? association.doubtedPoints
                                            : others;
        kind.push_back(track);
    }
    association.points = std::move(others);
}

bool ImageMarks::learn(
    const std::vector<Association>& associations,
    const std::vector<Mark>& marks,
    const PinholeCamera& camera)
{
    bool isCompared = false, isContradicted = false;
    for (const Association& association : associations)
    {
        if (association.reference->id <= suspectedOf_)
        {
            isCompared = true;
            isContradicted = isContradicted || still(association) == Still::Scene;
        }
    }
    if (!isCompared || isContradicted)
    {
        suspectedOf_ = kNone;
    }
    const bool areFound = !areKnown_ && !marks.empty() && suspectedOf_ != kNone;
    areKnown_ = areKnown_ || areFound;
    for (const Mark& mark : marks)
    {
        suspectedOf_ = std::max(suspectedOf_, mark.reference);
        if (areKnown_)
        {
            add(mark.uv_px, camera);
        }
    }
    return areFound;
}

void ImageMarks::learn(
    const std::vector<Association>& associations,
    const PinholeCamera& camera,
    const Eigen::Isometry3d& T_cur_world)
{
    for (const Association& association : associations)
    {
        const Eigen::Isometry3d T_cur_ref = T_cur_world * association.reference->T_world_cam;
        for (const PointTrack& track : association.doubtedPoints)
        {
            const PointFeature& ref = pointOf(association, track);
            const Eigen::Vector3d p_cur = T_cur_ref * ref.p_cam.mean;
            if (areKnown_ && stands(ref, track.cur) && p_cur.z() > 0 &&
                (camera.project(p_cur) - ref.uv_px).norm() > kMoved_px)
            {
                add(track.cur.uv_px, camera);
            }
        }
    }
}

void ImageMarks::forget()
{
    areKnown_ = false;
    suspectedOf_ = kNone;
    mask_.release();
}

bool ImageMarks::seesMark(const Eigen::Vector2d& uv_px) const
{
    const cv::Point place(cvRound(uv_px.x()), cvRound(uv_px.y()));
    return cv::Rect({}, mask_.size()).contains(place) && mask_.at<std::uint8_t>(place) > 0;
}

void ImageMarks::add(const Eigen::Vector2d& uv_px, const PinholeCamera& camera)
{
    if (mask_.empty())
    {
        mask_ = cv::Mat::zeros(camera.height, camera.width, CV_8UC1);
    }
    cv::circle(mask_, cv::Point2d(uv_px.x(), uv_px.y()), radius_px_, 255, cv::FILLED);
}
}  // namespace pointplane
