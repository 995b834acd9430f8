// SPDX-License-Identifier: BSD-3-Clause
#include "ImageMarks.h"

#include <pointplane/core/quantile.h>
#include <pointplane/core/se3.h>
#include <pointplane/core/significance.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "by_chance.h"

namespace pointplane
{
namespace
{
/** Places of standing points differ by their noise: less than this [px]. */
constexpr double kStill_px = 0.3;

/** More than that noise, surely [px]. */
constexpr double kMoved_px = kUnlikelySigmas * kStill_px;

/** Before a camera that stands, noise changes the depth of three points in a thousand, and what
 * moves covers the points behind it. */
constexpr double kLeastShare = 1.0 / 6;

const PointFeature& pointOf(const Association& association, const PointTrack& track)
{
    return association.reference->points.points[static_cast<size_t>(track.ref)];
}

cv::Point pixelAt(const Eigen::Vector2d& uv_px) { return {cvRound(uv_px.x()), cvRound(uv_px.y())}; }

bool stands(const PointFeature& ref, const PointFeature& cur)
{
    return (cur.uv_px - ref.uv_px).norm() < kStill_px;
}

/** A point that stands in the image, and the depth behind it. */
struct StandingPoint
{
    Eigen::Vector2d uv_px;
    double z;       //!< before [m]
    double change;  //!< of the depth [m]
    double sigma;   //!< of the change [m]
};

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

/** Of the place of a point, by the uncertainty of the pose, at most [px]. */
double sigma_px(const Eigen::Vector3d& p_cur, const Matrix6d& cov, const PinholeCamera& camera)
{
    Eigen::Matrix<double, 3, 6> dPoint_dPose;
    dPoint_dPose << Eigen::Matrix3d::Identity(), -hat(p_cur);
    const double variance = (dPoint_dPose * cov * dPoint_dPose.transpose()).trace();
    return std::max(camera.fx, camera.fy) / p_cur.z() * std::sqrt(std::max(0.0, variance));
}

/** Whether depth has changed at enough points, by other than factor z^power. */
bool hasChanged(const std::vector<StandingPoint>& points, double factor, int power)
{
    std::vector<Eigen::Vector2d> places_px;
    std::vector<double> changes;
    for (const StandingPoint& point : points)
    {
        const double change = point.change - factor * std::pow(point.z, power);
        if (std::abs(change) > kUnlikelySigmas * point.sigma)
        {
            places_px.push_back(point.uv_px);
            changes.push_back(std::abs(change) / point.z);
        }
    }
    return changes.size() >= kFewPoints &&
           static_cast<double>(changes.size()) >=
               kLeastShare * static_cast<double>(points.size()) &&
           expectedFlow_px(places_px, changes) > kMoved_px;
}

/** Depth that is measured before a resting camera can change all over the image: by an offset, as
 * time of flight does, in scale, or by an offset of the disparity.
 * \param power 0, 1 or 2 \return the median change, per z^power */
double commonFactor(const std::vector<StandingPoint>& points, int power)
{
    std::vector<double> factors(points.size());
    std::transform(
        points.begin(),
        points.end(),
        factors.begin(),
        [&](const StandingPoint& point) { return point.change / std::pow(point.z, power); });
    return median(std::move(factors));
}

/** What the points that stand in the image tell. */
enum class Still
{
    Nothing,  //!< they are few, or depth has changed all over the image
    Scene,    //!< the depth behind them stays
    Marks     //!< the depth behind many of them has changed otherwise
};

Still still(const Association& association)
{
    std::vector<StandingPoint> points;
    for (const PointTrack& track : association.points)
    {
        const PointFeature& ref = pointOf(association, track);
        const PointFeature& cur = track.cur;
        if (ref.hasDepth && cur.hasDepth && stands(ref, cur))
        {
            const double z = ref.p_cam.mean.z();
            points.push_back(
                {ref.uv_px,
                 z,
                 cur.p_cam.mean.z() - z,
                 std::sqrt(cur.p_cam.cov(2, 2) + ref.p_cam.cov(2, 2))});
        }
    }
    if (points.size() < kPointsOfAMotion)
    {
        return Still::Nothing;
    }
    if (!hasChanged(points, 0, 0))
    {
        return Still::Scene;
    }
    const std::array<int, 3> powers{0, 1, 2};
    const bool isOfSensor = std::any_of(
        powers.begin(),
        powers.end(),
        [&](int power) { return !hasChanged(points, commonFactor(points, power), power); });
    return isOfSensor ? Still::Nothing : Still::Marks;
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

void ImageMarks::split(Association& association, const PinholeCamera& camera) const
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
                                        : isStill || seesMark(camera.depthPixel(track.cur.uv_px))
                                            ? association.doubtedPoints
                                            : others;
        kind.push_back(track);
    }
    // Among many marks, one is easily taken for its neighbour, and seems to have moved.
    const size_t leftOut = association.fixedPoints.size() + association.doubtedPoints.size();
    if (areKnown_ && leftOut > others.size())
    {
        association.doubtedPoints.insert(
            association.doubtedPoints.end(), others.begin(), others.end());
        others.clear();
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
    const PoseGaussian& T_cur_world)
{
    for (const Association& association : associations)
    {
        const Eigen::Isometry3d T_cur_ref = T_cur_world.mean * association.reference->T_world_cam;
        for (const PointTrack& track : association.doubtedPoints)
        {
            const PointFeature& ref = pointOf(association, track);
            const Eigen::Vector3d p_cur = T_cur_ref * ref.p_cam.mean;
            if (areKnown_ && stands(ref, track.cur) && p_cur.z() > 0 &&
                (camera.project(p_cur) - ref.uv_px).norm() >
                    kMoved_px + kUnlikelySigmas * sigma_px(p_cur, T_cur_world.cov, camera))
            {
                add(track.cur.uv_px, camera);
            }
        }
    }
}

std::string ImageMarks::whyNoPoint(const std::vector<Association>& associations) const
{
    const bool leavesOut = std::any_of(
        associations.begin(),
        associations.end(),
        [](const Association& association) { return !association.doubtedPoints.empty(); });
    return areKnown_ && leavesOut ? "all points that it finds again may be fixed to the image" : "";
}

void ImageMarks::forget()
{
    areKnown_ = false;
    suspectedOf_ = kNone;
    mask_.release();
}

bool ImageMarks::seesMark(const Eigen::Vector2d& depthUv_px) const
{
    const cv::Point place = pixelAt(depthUv_px);
    return cv::Rect({}, mask_.size()).contains(place) && mask_.at<std::uint8_t>(place) > 0;
}

void ImageMarks::add(const Eigen::Vector2d& uv_px, const PinholeCamera& camera)
{
    if (mask_.empty())
    {
        mask_ = cv::Mat::zeros(camera.height, camera.width, CV_8UC1);
    }
    cv::circle(mask_, pixelAt(camera.depthPixel(uv_px)), radius_px_, 255, cv::FILLED);
}
}  // namespace pointplane
