// SPDX-License-Identifier: BSD-3-Clause
#include "FrontEnd.h"

#include <algorithm>
#include <functional>
#include <future>

#include "Judge.h"
#include "Stopwatch.h"
#include "frame_checks.h"
#include "no_reading.h"
#include "surface_comparison.h"

namespace pointplane
{
namespace
{
/** Whether most readings tell no distance. */
bool isNoise(const cv::Mat& depth, const DepthNoise& noise)
{
    const PixelGrid grid = PixelGrid::coarse(depth.size());
    int numReadings = 0, numNoise = 0;
    for (int row = 0; row < grid.size.height; ++row)
    {
        for (int column = 0; column < grid.size.width; ++column)
        {
            const auto z = static_cast<double>(depth.at<float>(grid.pixel(column, row)));
            numReadings += z > 0 ? 1 : 0;
            numNoise += z > 0 && !noise.tellsDistance(z) ? 1 : 0;
        }
    }
    return 2 * numNoise > numReadings;
}
}  // namespace

FrontEnd::FrontEnd(const OdometryParams& params)
    : params_(params.pipeline),
      findsMarks_(params.pipeline.fuses() && !params.reference.isAdjacent()),
      depthNoise_(params.depthNoise),
      marks_(params.pointTracker.windowPx),
      planeExtractor_(params.planeExtractor, params.depthNoise),
      planeMatcher_(params.planeMatcher),
      pointStage_(
          params.points,
          params.pointTracker,
          params.pointDetector,
          params.pointMatcher,
          params.pointLifter,
          params.depthNoise),
      imageAligner_(params.pointLifter, params.depthNoise),
      planeAligner_(params.planeMatcher)
{
}

Features FrontEnd::extract(const RgbdFrame& frame, FrameDiagnostics& diagnostics)
{
    Features out;
    out.frame = frame;
    forgetOtherCamera(frame.camera);
    learnNoise(frame.depth);
    diagnostics.depthNoise = depthNoise_.noise();
    out.bend = depthNoise_.noise().sigmaRelative;
    out.depthIsNoise = isNoise(frame.depth, depthNoise_.noise());
    if (out.depthIsNoise)
    {
        out.frame.depth = cv::Mat(frame.depth.size(), frame.depth.type(), kNoReading);
    }
    leaveOutAttached(out.frame, diagnostics);
    out.hasDepth = hasDepth(out.frame);
    findFeatures(out, diagnostics);
    return out;
}

void FrontEnd::forgetOtherCamera(const PinholeCamera& camera)
{
    if (camera_ && !sameCamera(*camera_, camera))
    {
        depthNoise_.reset();
        attached_ = {};
        marks_.forget();
    }
    camera_ = camera;
}

void FrontEnd::learnNoise(const cv::Mat& depth)
{
    depthNoise_.update(depth);
    planeExtractor_.setNoise(depthNoise_.noise());
    pointStage_.setNoise(depthNoise_.noise());
    imageAligner_.setNoise(depthNoise_.noise());
}

void FrontEnd::findFeatures(Features& features, FrameDiagnostics& diagnostics)
{
    const auto points = [&]
    {
        const Stopwatch watch;
        if (params_.usePoints)
        {
            features.points = pointStage_.prepare(features.frame);
        }
        return watch.ms();
    };
    std::future<double> pointsMs =
        std::async(params_.numThreads > 1 ? std::launch::async : std::launch::deferred, points);
    const Stopwatch watch;
    if (params_.usePlanes)
    {
        features.planes = planeExtractor_.extract(features.frame.depth, features.frame.camera);
    }
    diagnostics.msPlanes = watch.ms();
    diagnostics.msPoints = pointsMs.get();
    diagnostics.numPlanes = static_cast<int>(features.planes.planes.size());
}

void FrontEnd::leaveOutAttached(RgbdFrame& frame, FrameDiagnostics& diagnostics)
{
    if (!params_.findRobot)
    {
        return;
    }
    attached_.update(frame, depthNoise_.noise());
    diagnostics.attachedShare = attached_.share();
    if (diagnostics.attachedShare > 0)
    {
        frame.depth = frame.depth.clone();
        frame.depth.setTo(kNoReading, attached_.mask());
    }
}

PointReference FrontEnd::pointReference(const Features& features, const RgbdFrame& part) const
{
    if (!params_.usePoints)
    {
        return {};
    }
    return pointStage_.makeReference(withoutMarks(part), features.points);
}

RgbdFrame FrontEnd::withoutMarks(const RgbdFrame& frame) const
{
    RgbdFrame out = frame;
    if (!marks_.mask().empty())
    {
        out.depth = frame.depth.clone();
        out.depth.setTo(kNoReading, marks_.mask());
    }
    return out;
}

std::string FrontEnd::whyNoPoint(const RgbdFrame& frame) const
{
    if (!params_.usePoints)
    {
        return "";
    }
    return frame.gray.empty()              ? "it has no colour image"
           : pointStage_.findsPoint(frame) ? ""
                                           : pointplane::whyNoPoint(frame.gray);
}

std::shared_ptr<KeyframeImages> FrontEnd::keyframeImages(const Features& features) const
{
    if (params_.leastAgreement == 0 && !params_.searchImages)
    {
        return {};  // nobody will ask
    }
    auto out = std::make_shared<KeyframeImages>();
    out->frame = features.frame;
    out->surface = SurfaceSamples(out->frame, depthNoise_.noise());
    out->described = features.described;
    return out;
}

Agreement FrontEnd::compare(
    const SurfaceSamples& reference,
    const RgbdFrame& current,
    const Eigen::Isometry3d& T_cur_ref,
    double slack_m) const
{
    return compareSurfaces(reference, T_cur_ref, current, depthNoise_.noise(), slack_m);
}

Agreement FrontEnd::compare(
    const Reference& reference, const Features& current, const Eigen::Isometry3d& T_cur_ref) const
{
    return reference.images ? compare(reference.images->surface, current.frame, T_cur_ref, 0)
                            : Agreement();
}

MatchedPoints FrontEnd::matchImages(const Reference& reference, const Features& current) const
{
    if (!params_.usePoints || !reference.images)
    {
        return {};
    }
    const auto described = [&](std::optional<DescribedPoints>& points, const RgbdFrame& frame)
    {
        if (!points)
        {
            points = imageAligner_.describe(withoutMarks(frame));
        }
        return std::cref(*points);
    };
    return imageAligner_.match(
        described(reference.images->described, reference.images->frame),
        described(current.described, current.frame));
}

std::optional<Eigen::Isometry3d> FrontEnd::alignImages(
    const Reference& reference, const Features& current) const
{
    return imageAligner_.align(matchImages(reference, current), current.frame.camera);
}

std::vector<Eigen::Isometry3d> FrontEnd::alignPlanes(
    const Reference& reference, const Features& current) const
{
    if (!params_.usePlanes || !reference.images)
    {
        return {};
    }
    std::vector<Eigen::Isometry3d> out =
        planeAligner_.motions(reference.planes, current.planes, matchImages(reference, current));
    const auto isContradicted = [&](const Eigen::Isometry3d& T_cur_ref)
    { return !Judge::areConvincing(compare(reference, current, T_cur_ref)); };
    out.erase(std::remove_if(out.begin(), out.end(), isContradicted), out.end());
    return out;
}

Association FrontEnd::associate(
    const Reference& reference,
    const Features& current,
    const Eigen::Isometry3d& T_cur_ref,
    double radiusFactor) const
{
    Association out;
    out.reference = &reference;
    if (params_.usePlanes)
    {
        out.planes =
            planeMatcher_.match(reference.planes, current.planes, current.frame.camera, T_cur_ref);
    }
    if (params_.usePoints && !reference.points.points.empty())
    {
        out.points = pointStage_.correspond(
            reference.points, current.frame, current.points, T_cur_ref, radiusFactor);
        if (findsMarks_)
        {
            marks_.split(out, current.frame.camera);
        }
    }
    return out;
}
}  // namespace pointplane
