// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/Odometry.h>
#include <pointplane/odometry/PairBuilder.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <optional>
#include <string>
#include <utility>

#include "PoseHistory.h"
#include "PoseStage.h"
#include "Stopwatch.h"
#include "frame_checks.h"

namespace pointplane
{
namespace
{
/** First frame's covariance: strictly positive definite, yet nothing. */
constexpr double kFirstSigma = 1e-6;

/** Elapsed between two frames whose stamps do not tell. */
constexpr double kUnknownStep = 1.0 / 30;  // [s]

/** Search radius when too little is found again around the prediction, over the usual one. */
constexpr double kWideSearch = 5;
}  // namespace

struct Odometry::Impl
{
    explicit Impl(const OdometryParams& p);

    OdometryResult process(const RgbdFrame& frame);
    [[nodiscard]] OdometryResult estimate(const RgbdFrame& frame);

    void extract(const RgbdFrame& frame, FrameDiagnostics& diagnostics);
    [[nodiscard]] OdometryResult start(
        const RgbdFrame& frame, const std::string& reason, OdometryResult result);
    [[nodiscard]] bool isLate(double stamp);
    [[nodiscard]] bool track(const RgbdFrame& frame, OdometryResult& result);
    void keepUnmatched(const RgbdFrame& frame);
    void restartAtUnmatched();
    [[nodiscard]] OdometryResult coast(
        double stamp, const std::string& reason, OdometryResult result);
    [[nodiscard]] std::vector<Association> associate(
        const RgbdFrame& frame, const Eigen::Isometry3d& T_prev_cur, double radiusFactor) const;
    [[nodiscard]] double overlapWithNewest(const std::vector<Association>& associations) const;
    void advance(const RgbdFrame& frame, const std::vector<Association>& associations);
    void forgetOthers();

    OdometryParams params;
    PlaneExtractor planeExtractor;
    PlaneMatcher planeMatcher;
    PointStage pointStage;
    PoseStage poseStage;
    ReferenceWindow window;

    FrameFeatures features;
    Reference current;
    PinholeCamera camera;
    PoseHistory history;
    std::optional<Reference> unmatched;  //!< has features, but none that the window knows
    double latestStamp{0};
    std::optional<double> lateStamp;  //!< of the latest frame, when it was not after latestStamp
    bool started{false};
};

Odometry::Impl::Impl(const OdometryParams& p)
    : params(p),
      planeExtractor(p.planeExtractor, p.depthNoise),
      planeMatcher(p.planeMatcher),
      pointStage(
          p.points, p.pointTracker, p.pointDetector, p.pointMatcher, p.pointLifter, p.depthNoise),
      poseStage(p),
      window(p.reference),
      history(p.covariance)
{
}

OdometryResult Odometry::Impl::process(const RgbdFrame& frame)
{
    const Stopwatch total;
    features = {};
    OdometryResult result = estimate(frame);
    result.pose = history.pose();
    result.since = history.sinceAll();
    if (result.status == TrackingStatus::Tracked)
    {
        result.increment = result.since.front();
        const Vector6d sigma = result.increment.cov.diagonal().cwiseSqrt();
        result.diagnostics.maxSigmaTranslation = sigma.head<3>().maxCoeff();
        result.diagnostics.maxSigmaRotation = sigma.tail<3>().maxCoeff();
    }
    forgetOthers();
    result.diagnostics.msTotal = total.ms();
    return result;
}

/** The paper's Fig. 1: extraction, matching, pose estimation, validation. */
OdometryResult Odometry::Impl::estimate(const RgbdFrame& frame)
{
    OdometryResult result;
    result.stamp = frame.stamp;

    // A frame without images or without a time can only be predicted.
    if (const std::string problem = problemOf(frame); !problem.empty())
    {
        return coast(frame.stamp, problem, result);
    }
    if (started && isLate(frame.stamp))
    {
        return coast(frame.stamp, "its time stamp is not after the previous frame's", result);
    }

    // 1. Points and planes with their uncertainty.
    extract(frame, result.diagnostics);
    if (!started || !sameCamera(camera, frame.camera) || frame.stamp <= latestStamp)
    {
        // A different camera or clock: nothing of the past can be compared with this frame.
        return start(
            frame,
            frame.stamp <= latestStamp ? "the clock has been set back"
                                       : "the camera's size or calibration has changed",
            result);
    }

    // 2. and 3. against the references; when none of them is in view any more, against the latest
    // frame, which did not find them either.
    bool tracked = track(frame, result);
    if (!tracked && unmatched)
    {
        restartAtUnmatched();
        tracked = track(frame, result);
    }
    if (!tracked)
    {
        result = coast(frame.stamp, result.reason, result);
        result.status = TrackingStatus::Predicted;
        keepUnmatched(frame);
    }
    result.diagnostics.numPoints = static_cast<int>(features.points.size());
    return result;
}

bool Odometry::Impl::track(const RgbdFrame& frame, OdometryResult& result)
{
    // 2. Predicted motion since the latest measured frame, and matches with the references.
    const double dt = frame.stamp - window.previous().stamp;
    const PoseStage::Prediction predicted = poseStage.predict(dt);
    const PairBuilder pairs(window.previous(), current, frame.camera);
    const Stopwatch matching;
    std::vector<Association> associations = associate(frame, predicted.pose.mean, 1);
    if (overlapWithNewest(associations) < params.reference.keyframeMinOverlap)
    {
        // A jerk that the motion model did not foresee: look farther, then closely again.
        associations = associate(frame, predicted.pose.mean, kWideSearch);
        const PoseEstimate coarse =
            poseStage.estimate(pairs, associations, predicted, result.diagnostics);
        associations = associate(frame, coarse.motion.mean.T_base_cur, 1);
    }
    result.diagnostics.msMatching = matching.ms();

    // 3. Pose from both, each weighted by its uncertainty, and its validation.
    const PoseEstimate estimate =
        poseStage.estimate(pairs, associations, predicted, result.diagnostics);
    poseStage.judge(estimate, predicted, result);
    if (result.status != TrackingStatus::Tracked)
    {
        return false;
    }

    // 4. The frame becomes a reference.
    const PoseStage::Measured measured =
        poseStage.accept(estimate, predicted, pairs, associations, dt);
    window.refinePreviousVelocity(measured.previousVelocity);
    for (const Association& association : associations)
    {
        window.notePoints(association.reference->id, association.points);
    }
    current.velocity = measured.velocity;
    history.measure(window.previous().T_world_cam, measured.T_prev_cur, dt, measured.errors);
    unmatched.reset();
    latestStamp = result.stamp;
    advance(frame, associations);
    return true;
}

/** One frame may come late. A second one in order after it means that the clock has been set, or
 * that the stamps before were wrong; it is not late then. */
bool Odometry::Impl::isLate(double stamp)
{
    if (stamp > latestStamp)
    {
        lateStamp.reset();
        return false;
    }
    const bool clockWasSet = lateStamp && stamp > *lateStamp;
    lateStamp = stamp;
    return !clockWasSet;
}

void Odometry::Impl::keepUnmatched(const RgbdFrame& frame)
{
    if (params.pipeline.usePoints)
    {
        current.points = pointStage.makeReference(frame);
    }
    if (current.planes.planes.empty() && current.points.points.empty())
    {
        return;
    }
    current.T_world_cam = history.latest();
    unmatched = std::move(current);
}

void Odometry::Impl::restartAtUnmatched()
{
    window.clear();
    history.restart(unmatched->id);
    window.add(std::move(*unmatched), true);
    unmatched.reset();
}

void Odometry::Impl::extract(const RgbdFrame& frame, FrameDiagnostics& diagnostics)
{
    const auto points = [&]
    {
        const Stopwatch watch;
        if (params.pipeline.usePoints)
        {
            pointStage.prepare(frame);
        }
        return watch.ms();
    };
    std::future<double> pointsMs = std::async(
        params.pipeline.numThreads > 1 ? std::launch::async : std::launch::deferred, points);
    const Stopwatch watch;
    current = {};
    current.id = history.latestFrame() + 1;
    current.stamp = frame.stamp;
    current.shutter = frame.shutter;
    if (params.pipeline.usePlanes)
    {
        current.planes = planeExtractor.extract(frame.depth, frame.camera);
    }
    diagnostics.msPlanes = watch.ms();
    diagnostics.msPoints = pointsMs.get();
    diagnostics.numPlanes = static_cast<int>(current.planes.planes.size());
    features.planes = current.planes;
}

OdometryResult Odometry::Impl::start(
    const RgbdFrame& frame, const std::string& reason, OdometryResult result)
{
    if (started)
    {
        result = coast(frame.stamp, reason, result);
        result.status = TrackingStatus::Predicted;
    }
    else
    {
        result.status = TrackingStatus::First;
        result.increment.cov = Matrix6d::Identity() * (kFirstSigma * kFirstSigma);
        history.predict(result.increment);
    }
    history.restart(history.latestFrame());
    started = true;
    camera = frame.camera;
    window.clear();
    unmatched.reset();
    latestStamp = frame.stamp;
    lateStamp.reset();
    advance(frame, {});
    return result;
}

/** Moves on by the motion model alone. The window's previous frame stays: the next good frame is
 * aligned with it over the whole gap. */
OdometryResult Odometry::Impl::coast(double stamp, const std::string& reason, OdometryResult result)
{
    result.status = TrackingStatus::Lost;
    result.reason = reason;
    const double step = stamp - latestStamp;
    const bool known = started && step >= 0 && std::isfinite(step);
    const double dt = known ? std::max(step, 1e-3) : kUnknownStep;
    result.increment = poseStage.coast(dt);
    history.predict(result.increment);
    if (std::isfinite(stamp))
    {
        latestStamp = started ? std::max(latestStamp, stamp) : latestStamp;
    }
    return result;
}

std::vector<Association> Odometry::Impl::associate(
    const RgbdFrame& frame, const Eigen::Isometry3d& T_prev_cur, double radiusFactor) const
{
    std::vector<Association> out;
    const Eigen::Isometry3d T_cur_world =
        T_prev_cur.inverse() * window.previous().T_world_cam.inverse();
    for (const Reference* reference : window.active())
    {
        Association association;
        association.reference = reference;
        const Eigen::Isometry3d T_cur_ref = T_cur_world * reference->T_world_cam;
        if (params.pipeline.usePlanes)
        {
            association.planes =
                planeMatcher.match(reference->planes, current.planes, frame.camera, T_cur_ref);
        }
        if (params.pipeline.usePoints && !reference->points.points.empty())
        {
            association.points =
                pointStage.correspond(reference->points, frame, T_cur_ref, radiusFactor);
        }
        out.push_back(std::move(association));
    }
    return out;
}

/** Keeps what the next frame will be compared with, and the history. */
void Odometry::Impl::forgetOthers()
{
    std::vector<int> references;
    for (const Reference* reference : window.active())
    {
        references.push_back(reference->id);
    }
    history.keep(references, unmatched ? std::optional(unmatched->id) : std::nullopt);
}

/** The fraction of the newest key frame's points or planes that was found again, the smaller. */
double Odometry::Impl::overlapWithNewest(const std::vector<Association>& associations) const
{
    const auto fraction = [](size_t found, size_t all)
    { return all > 0 ? static_cast<double>(found) / static_cast<double>(all) : 1.0; };
    double overlap = associations.empty() ? 0 : 1;
    for (const Association& a : associations)
    {
        if (window.isNewest(*a.reference))
        {
            overlap = std::min(
                fraction(a.points.size(), a.reference->points.points.size()),
                fraction(a.planes.size(), a.reference->planes.planes.size()));
        }
    }
    return overlap;
}

void Odometry::Impl::advance(const RgbdFrame& frame, const std::vector<Association>& associations)
{
    features.points.clear();
    for (const Association& a : associations)
    {
        for (const PointTrack& track : a.points)
        {
            features.points.push_back(track.cur);
        }
    }
    current.T_world_cam = history.latest();
    const bool isKeyframe =
        window.empty() || window.needsKeyframe(history.latest(), overlapWithNewest(associations));
    if (isKeyframe && params.pipeline.usePoints)
    {
        current.points = pointStage.makeReference(frame);
        features.points = current.points.points;
    }
    window.add(std::move(current), isKeyframe);
}

const char* toString(TrackingStatus status)
{
    switch (status)
    {
        case TrackingStatus::First:
            return "first";
        case TrackingStatus::Tracked:
            return "tracked";
        case TrackingStatus::Predicted:
            return "predicted";
        case TrackingStatus::Lost:
            break;
    }
    return "lost";
}

Odometry::Odometry(const OdometryParams& params)
{
    params.check();
    impl_ = std::make_unique<Impl>(params);
}
Odometry::~Odometry() = default;
Odometry::Odometry(Odometry&&) noexcept = default;
Odometry& Odometry::operator=(Odometry&&) noexcept = default;
OdometryResult Odometry::process(const RgbdFrame& frame) { return impl_->process(frame); }
const FrameFeatures& Odometry::features() const { return impl_->features; }
const OdometryParams& Odometry::params() const { return impl_->params; }
void Odometry::reset() { impl_ = std::make_unique<Impl>(OdometryParams(impl_->params)); }
}  // namespace pointplane
