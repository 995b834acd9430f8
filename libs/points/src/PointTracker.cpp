// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/quantile.h>
#include <pointplane/core/range.h>
#include <pointplane/points/PointTracker.h>

#include <opencv2/core/utility.hpp>
#include <opencv2/video/tracking.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include "local_surface.h"
#include "reference_patches.h"
#include "reference_points.h"

namespace pointplane
{
namespace
{
/** Relative change of brightness from one pixel to another, per vignetting: it grows with the
 * square of the distance from the centre. */
double vignettingBetween(
    const cv::Mat& image, const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px)
{
    const Eigen::Vector2d centre(0.5 * (image.cols - 1), 0.5 * (image.rows - 1));
    return ((from_px - centre).squaredNorm() - (to_px - centre).squaredNorm()) /
           centre.squaredNorm();
}

/** Where a wide search ends, from the point's place: patches are only shifted there, so a turn of
 * six degrees costs this much. */
constexpr double kUnrefined_px = 0.5;
}  // namespace

struct PointTracker::Search
{
    PatchSearch ofPatch;
    double radius_px;
    bool isWide;
    bool hasDepth{true};  //!< the frame in which points are searched for
    size_t step{1};       //!< every step-th point
};

struct PointTracker::Sought
{
    size_t ref;
    cv::Point2f predicted, position;
    bool found{false};
};

struct PointTracker::Found
{
    PointTrack track;
    Eigen::Matrix<double, 3, 2> ofPixel;  //!< change with its pixel [m/px]
    double variance_px2;                  //!< of its position, as its patch fits
};

void PointTracker::TParams::check() const
{
    checkRange("maxPoints", maxPoints, 1, 100000);
    checkRange("minPoints", minPoints, 0, 100000);
    checkRange("minSpacingFraction", minSpacingFraction, 1e-4, 0.99);
    checkRange("cornerQuality", cornerQuality, 1e-9, 0.99);
    checkRange("maxNoisePx", maxNoisePx, 0.001, 100);
    checkRange("windowPx", windowPx, 5, 63);
    checkRange("numLevels", numLevels, 1, 8);
    checkRange("searchRadiusFraction", searchRadiusFraction, 0.001, 1);
    checkRange("minZncc", minZncc, 0, 0.999);
    checkRange("sigmaPx", sigmaPx, 0.001, 10);
    checkRange("depthVarianceFactor", depthVarianceFactor, 0.01, 100);
}

PointTracker::PointTracker(
    const TParams& params, const PointLifter::TParams& lifter, const DepthNoise& noise)
    : params_(params), lifter_(lifter, cornerNoise(noise))
{
    params_.check();
}

void PointTracker::setNoise(const DepthNoise& noise) { lifter_.setNoise(cornerNoise(noise)); }

/** Noise of depth at a corner, and of a corner's position. */
DepthNoise PointTracker::cornerNoise(const DepthNoise& noise) const
{
    DepthNoise out = noise.scaled(std::sqrt(params_.depthVarianceFactor));
    out.sigmaPixelPx = params_.sigmaPx;
    return out;
}

std::vector<cv::Mat> PointTracker::pyramid(const cv::Mat& gray) const
{
    std::vector<cv::Mat> out;
    if (!gray.empty())
    {
        cv::buildOpticalFlowPyramid(
            gray, out, {params_.windowPx, params_.windowPx}, params_.numLevels - 1, false);
    }
    return out;
}

PointReference PointTracker::makeReference(const RgbdFrame& frame) const
{
    return frame.gray.empty() ? PointReference{} : referencePoints(frame, params_, lifter_);
}

/** Lucas-Kanade surely finds what lies within a quarter of the window at the coarsest level: no
 * more levels than the radius needs. A wide search is for a first guess, which a few points give.
 */
PointTracker::Search PointTracker::searchFor(double radius_px, bool isWide, size_t numPoints) const
{
    constexpr size_t kWidePoints = 60;
    Search out{{}, radius_px, isWide};
    int& numLevels = out.ofPatch.numLevels;
    while (numLevels < params_.numLevels &&
           (params_.windowPx / 4.0) * (1 << (numLevels - 1)) < radius_px)
    {
        ++numLevels;
    }
    if (isWide)
    {
        out.step = std::max<size_t>(1, numPoints / kWidePoints);
        out.ofPatch.epsilon_px = 0.1;
    }
    return out;
}

/** Points of the reference that are due and should be seen, where the motion puts them. */
std::vector<PointTracker::Sought> PointTracker::inView(
    const PointReference& reference,
    const RgbdFrame& frame,
    const Eigen::Isometry3d& T_cur_ref,
    const Search& search)
{
    std::vector<Sought> out;
    out.reserve(reference.points.size() / search.step + 1);
    for (size_t i = 0; i < reference.points.size(); i += search.step)
    {
        const Eigen::Vector3d p_cur = T_cur_ref * reference.points[i].p_cam.mean;
        if (!(p_cur.z() > 0) || !(search.isWide || reference.isDue(i)))
        {
            continue;
        }
        const Eigen::Vector2d uv_px = frame.camera.project(p_cur);
        const cv::Point2f predicted = cv::Point2d(uv_px.x(), uv_px.y());
        if (isWellInside(predicted, frame.gray))
        {
            out.push_back({i, predicted, predicted});
        }
    }
    return out;
}

/** The search ended nearby, on what looks like the point. */
bool PointTracker::isFound(
    const Sought& point,
    const PointReference& reference,
    const cv::Mat& gray,
    const Search& search) const
{
    if (!point.found || cv::norm(point.position - point.predicted) > search.radius_px ||
        !isWellInside(point.position, gray))
    {
        return false;
    }
    constexpr double kMostBrighter = 30;  // [grey]; exposure does not change it by so much
    const Likeness likeness = reference.patches->refined.compare(point.ref, gray, point.position);
    return std::abs(likeness.brighter) < kMostBrighter && likeness.zncc >= params_.minZncc;
}

/** Exactly where it is, and in space, with what is not known of it. */
std::optional<PointTracker::Found> PointTracker::trackOf(
    const Sought& point,
    const PointReference& reference,
    const RgbdFrame& frame,
    const Eigen::Isometry3d& T_cur_ref,
    const Search& search) const
{
    const PointFeature& ref = reference.points[point.ref];
    cv::Point2f position = point.position;
    std::optional<double> variance = kUnrefined_px * kUnrefined_px;
    if (!search.isWide)
    {
        variance = reference.patches->refined.refine(
            point.ref, frame.gray, surfaceWarp(frame.camera, ref, T_cur_ref), position);
        if (!variance)
        {
            return {};
        }
    }
    const Eigen::Vector2d uv_px = Eigen::Vector2f(position.x, position.y).cast<double>();
    auto feature = search.hasDepth ? lifter_.lift(frame, uv_px)
                                   : lifter_.onRay(frame, uv_px, (T_cur_ref * ref.p_cam.mean).z());
    if (!feature || !feature->p_cam.mean.allFinite())
    {
        return {};  // no depth, or no ray reaches the pixel
    }
    feature->directions = reference.directions[point.ref];
    // Along an edge, a track slides on the surface.
    const Eigen::Matrix<double, 3, 2> J = T_cur_ref.linear() * surfaceJacobian(frame.camera, ref);
    feature->p_cam.cov += propagate(J, reference.cov_px[point.ref]);
    feature->ofVignetting_m = J * (vignettingBetween(frame.gray, ref.uv_px, feature->uv_px) *
                                   reference.ofBrightness_px[point.ref]);
    return Found{{static_cast<int>(point.ref), *feature}, J, *variance};
}

/** With the noise of their positions: the median of what patches tell. A patch alone may fit well
 * by chance, or because it is a mark on the image. */
std::vector<PointTrack> PointTracker::withNoise(const std::vector<Found>& found)
{
    std::vector<double> variances;
    for (const Found& f : found)
    {
        variances.push_back(f.variance_px2);
    }
    const double variance_px2 = found.empty() ? 0 : median(std::move(variances));
    std::vector<PointTrack> out;
    for (const Found& f : found)
    {
        out.push_back(f.track);
        out.back().cur.p_cam.cov += variance_px2 * f.ofPixel * f.ofPixel.transpose();
    }
    return out;
}

std::vector<PointTrack> PointTracker::track(
    const PointReference& reference,
    const RgbdFrame& frame,
    const std::vector<cv::Mat>& pyramid,
    const Eigen::Isometry3d& T_cur_ref,
    double radiusFactor) const
{
    if (!reference.patches || pyramid.empty())
    {
        return {};
    }
    Search search = searchFor(
        radiusFactor * searchRadius_px(frame.gray), radiusFactor > 1, reference.points.size());
    search.hasDepth = hasDepth(frame);
    std::vector<Sought> sought = inView(reference, frame, T_cur_ref, search);
    cv::parallel_for_(
        cv::Range(0, static_cast<int>(sought.size())),
        [&](const cv::Range& range)
        {
            for (int k = range.start; k < range.end; ++k)
            {
                Sought& point = sought[static_cast<size_t>(k)];
                point.found = reference.patches->searched.find(
                    point.ref, pyramid, search.ofPatch, point.position);
            }
        });
    std::vector<Found> found;
    for (const Sought& point : sought)
    {
        if (isFound(point, reference, frame.gray, search))
        {
            if (auto track = trackOf(point, reference, frame, T_cur_ref, search))
            {
                found.push_back(*track);
            }
        }
    }
    return withNoise(found);
}
}  // namespace pointplane
