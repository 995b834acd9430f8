// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/range.h>
#include <pointplane/points/PointTracker.h>

#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include "local_surface.h"
#include "lucas_kanade.h"
#include "patch_uncertainty.h"
#include "warped_patches.h"

namespace pointplane
{
namespace
{
constexpr int kBorderPx = 8;
constexpr int kZnccPx = 9;  //!< side of the patches that are compared

/** An edge's noise across it, of the noise that a corner may have. */
constexpr double kEdgeOfCorner = 0.5;

bool isInside(const cv::Point2f& p, const cv::Mat& image)
{
    return p.x >= kBorderPx && p.y >= kBorderPx &&
           p.x <= static_cast<float>(image.cols - 1 - kBorderPx) &&
           p.y <= static_cast<float>(image.rows - 1 - kBorderPx);
}

/** Samples a patch bilinearly. \pre isInside(centre, image) */
void samplePatch(const cv::Mat& image, const cv::Point2f& centre, float* out)
{
    const float left = centre.x - kZnccPx / 2, top = centre.y - kZnccPx / 2;
    const int u = static_cast<int>(left), v = static_cast<int>(top);
    const float a = left - static_cast<float>(u), b = top - static_cast<float>(v);
    for (int y = 0; y < kZnccPx; ++y)
    {
        const uchar* row = image.ptr<uchar>(v + y) + u;
        const uchar* next = image.ptr<uchar>(v + y + 1) + u;
        for (int x = 0; x < kZnccPx; ++x)
        {
            const float upper =
                static_cast<float>(row[x]) * (1 - a) + static_cast<float>(row[x + 1]) * a;
            const float lower =
                static_cast<float>(next[x]) * (1 - a) + static_cast<float>(next[x + 1]) * a;
            *out++ = upper * (1 - b) + lower * b;
        }
    }
}

/** The square around a point, to be compared with others. \pre isInside(centre, image) */
struct ComparedPatch
{
    static constexpr int kSize = kZnccPx * kZnccPx;

    ComparedPatch(const cv::Mat& image, const cv::Point2f& centre)
    {
        samplePatch(image, centre, samples.data());
        for (const float sample : samples)
        {
            const auto x = static_cast<double>(sample);
            sum += x;
            sumOfSquares += x * x;
        }
    }

    [[nodiscard]] double variation() const { return sumOfSquares - sum * sum / kSize; }

    std::array<float, kSize> samples;
    double sum{0}, sumOfSquares{0};
};

/** Zero-mean normalised cross-correlation, blind to gain and bias; 0 for flat patches. */
double zncc(const ComparedPatch& a, const ComparedPatch& b)
{
    double product = 0;
    for (size_t i = 0; i < a.samples.size(); ++i)
    {
        product += static_cast<double>(a.samples[i]) * static_cast<double>(b.samples[i]);
    }
    const double va = a.variation(), vb = b.variation();
    return va > 1 && vb > 1 ? (product - a.sum * b.sum / ComparedPatch::kSize) / std::sqrt(va * vb)
                            : 0;
}

/** Exposure changes brightness, but not by this much. */
bool isAsBright(const ComparedPatch& a, const ComparedPatch& b)
{
    constexpr double kMostShift = 30;  // [grey]
    return std::abs(a.sum - b.sum) < kMostShift * ComparedPatch::kSize;
}

/** Relative change of brightness from one pixel to another, per vignetting: it grows with the
 * square of the distance from the centre. */
double vignettingBetween(
    const cv::Mat& image, const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px)
{
    const Eigen::Vector2d centre(0.5 * (image.cols - 1), 0.5 * (image.rows - 1));
    return ((from_px - centre).squaredNorm() - (to_px - centre).squaredNorm()) /
           centre.squaredNorm();
}
}  // namespace

/** What the points of a reference look like. */
struct ReferencePatches
{
    PatchTemplates searched;
    WarpedPatches refined;
    std::vector<ComparedPatch> compared;

    ReferencePatches(int windowPx, size_t numPoints, size_t numLevels) : searched(windowPx)
    {
        searched.reserve(numPoints, numLevels);
        refined.reserve(numPoints, windowPx / 2);
        compared.reserve(numPoints);
    }

    /** \param pyramid with derivatives \param halfPx half of the window \param brightness constant
     * for edges, along which it may be all that tells anything */
    void add(
        const std::vector<cv::Mat>& pyramid,
        const cv::Point2f& centre,
        int halfPx,
        Brightness brightness,
        const Directions& measured)
    {
        // Corners have structure enough nearer to their centre, where the surface is flatter.
        const int refinedPx = brightness == Brightness::Shifted ? 3 * halfPx / 4 : halfPx;
        searched.add(pyramid, centre, brightness);
        refined.add(pyramid[0], pyramid[1], centre, refinedPx, brightness, measured);
        compared.emplace_back(pyramid[0], centre);
    }
};

struct PointTracker::Search
{
    PatchSearch ofPatch;
    double radius_px;
    bool isWide;
    size_t step{1};  //!< every step-th point
};

struct PointTracker::Sought
{
    size_t ref;
    cv::Point2f predicted, position;
    bool found{false};
};

void PointReference::note(const std::vector<PointTrack>& tracks)
{
    misses.resize(points.size(), 0);
    for (int& count : misses)
    {
        ++count;
    }
    for (const PointTrack& track : tracks)
    {
        misses[static_cast<size_t>(track.ref)] = 0;
    }
}

bool PointReference::isDue(size_t point) const
{
    constexpr int kPatience = 3, kTurns = 8;
    return point >= misses.size() || misses[point] < kPatience ||
           (misses[point] + static_cast<int>(point)) % kTurns == 0;
}

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

/** \param pyramid with derivatives. Corners are looked for in the halved image, four times as fast:
 * a patch that is searched for needs structure in it, its centre may be anywhere. */
std::vector<cv::Point2f> PointTracker::candidates(const std::vector<cv::Mat>& pyramid) const
{
    constexpr size_t kHalved = 2;  // images and derivatives take turns
    const bool isHalved = pyramid.size() > kHalved;
    const float scale = isHalved ? 2.0F : 1.0F;
    std::vector<cv::Point2f> out;
    cv::goodFeaturesToTrack(
        pyramid[isHalved ? kHalved : 0],
        out,
        2 * params_.maxPoints,
        params_.cornerQuality,
        params_.minSpacingFraction * pyramid[0].cols / static_cast<double>(scale));
    for (cv::Point2f& corner : out)
    {
        corner *= scale;
    }
    return out;
}

PointReference PointTracker::makeReference(const RgbdFrame& frame) const
{
    PointReference out;
    if (frame.gray.empty())
    {
        return out;
    }
    std::vector<cv::Mat> pyramid;
    cv::buildOpticalFlowPyramid(
        frame.gray, pyramid, {params_.windowPx, params_.windowPx}, params_.numLevels - 1, true);
    struct Edge
    {
        PointFeature point;
        PatchUncertainty uncertainty;
    };
    std::vector<Edge> edges;
    const std::vector<cv::Point2f> corners = candidates(pyramid);
    const auto patches = std::make_shared<ReferencePatches>(
        params_.windowPx,
        std::min(corners.size(), static_cast<size_t>(params_.maxPoints)),
        pyramid.size() / 2);
    const auto add =
        [&](const PointFeature& point, const PatchUncertainty& uncertainty, Brightness brightness)
    {
        const cv::Point2f centre = cv::Point2d(point.uv_px.x(), point.uv_px.y());
        const Directions measured = uncertainty.measured(params_.maxNoisePx);
        patches->add(pyramid, centre, params_.windowPx / 2, brightness, measured);
        out.points.push_back(point);
        out.cov_px.push_back(uncertainty.covariance(params_.maxNoisePx));
        out.ofBrightness_px.push_back(uncertainty.displacement(params_.maxNoisePx));
    };
    const double noise = imageNoise(frame.gray);
    for (const cv::Point2f& pixel : corners)
    {
        if (out.points.size() >= static_cast<size_t>(params_.maxPoints))
        {
            break;
        }
        const auto uncertaintyWith = [&](Brightness brightness) {
            return patchUncertainty(
                frame.gray, pyramid[1], pixel, params_.windowPx, noise, brightness);
        };
        PatchUncertainty uncertainty = uncertaintyWith(Brightness::Shifted);
        const bool isCorner = uncertainty.worst() <= params_.maxNoisePx;
        if (!isCorner)
        {
            uncertainty = uncertaintyWith(Brightness::Constant);
        }
        const bool isEdge = !isCorner && uncertainty.best() <= kEdgeOfCorner * params_.maxNoisePx;
        if (!isInside(pixel, frame.gray) || !(isCorner || isEdge))
        {
            continue;
        }
        const auto feature = lifter_.lift(frame, Eigen::Vector2f(pixel.x, pixel.y).cast<double>());
        if (feature && isCorner)
        {
            add(*feature, uncertainty, Brightness::Shifted);
        }
        else if (feature && !isNearDepthJump(frame, *feature))
        {
            edges.push_back({*feature, uncertainty});
        }
    }
    for (size_t i = 0;
         i < edges.size() && out.points.size() < static_cast<size_t>(params_.minPoints);
         ++i)
    {
        add(edges[i].point, edges[i].uncertainty, Brightness::Constant);
    }
    out.patches = patches;
    return out;
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
        if (isInside(predicted, frame.gray))
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
        !isInside(point.position, gray))
    {
        return false;
    }
    const ComparedPatch& looked = reference.patches->compared[point.ref];
    const ComparedPatch found(gray, point.position);
    return isAsBright(looked, found) && zncc(looked, found) >= params_.minZncc;
}

/** Exactly where it is, and in space, with what is not known of it. */
std::optional<PointTrack> PointTracker::trackOf(
    const Sought& point,
    const PointReference& reference,
    const RgbdFrame& frame,
    const Eigen::Isometry3d& T_cur_ref,
    const Search& search) const
{
    const PointFeature& ref = reference.points[point.ref];
    cv::Point2f position = point.position;
    if (!search.isWide &&
        !reference.patches->refined.refine(
            point.ref, frame.gray, surfaceWarp(frame.camera, ref, T_cur_ref), position))
    {
        return {};
    }
    auto feature = lifter_.lift(frame, Eigen::Vector2f(position.x, position.y).cast<double>());
    if (!feature)
    {
        return {};
    }
    // Along an edge, a track slides on the surface.
    const Eigen::Matrix<double, 3, 2> J = T_cur_ref.linear() * surfaceJacobian(frame.camera, ref);
    feature->p_cam.cov += propagate(J, reference.cov_px[point.ref]);
    feature->ofVignetting_m = J * (vignettingBetween(frame.gray, ref.uv_px, feature->uv_px) *
                                   reference.ofBrightness_px[point.ref]);
    return PointTrack{static_cast<int>(point.ref), *feature};
}

std::vector<PointTrack> PointTracker::track(
    const PointReference& reference,
    const RgbdFrame& frame,
    const std::vector<cv::Mat>& pyramid,
    const Eigen::Isometry3d& T_cur_ref,
    double radiusFactor) const
{
    std::vector<PointTrack> tracks;
    if (!reference.patches || pyramid.empty())
    {
        return tracks;
    }
    const Search search = searchFor(
        radiusFactor * params_.searchRadiusFraction * frame.gray.cols,
        radiusFactor > 1,
        reference.points.size());
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
    for (const Sought& point : sought)
    {
        if (isFound(point, reference, frame.gray, search))
        {
            if (auto track = trackOf(point, reference, frame, T_cur_ref, search))
            {
                tracks.push_back(*track);
            }
        }
    }
    return tracks;
}
}  // namespace pointplane
