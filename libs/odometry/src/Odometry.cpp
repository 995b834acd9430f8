// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/odometry/Odometry.h>
#include <pointplane/odometry/PairBuilder.h>

#include <Eigen/Eigenvalues>
#include <opencv2/core.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <optional>
#include <sstream>
#include <utility>

namespace pointplane
{
namespace
{
/** First frame's covariance: strictly positive definite, yet nothing. */
constexpr double kFirstSigma = 1e-6;

/** Fewer matches than this in total cannot fix a pose [P17, section Pose estimation]. */
constexpr int kMinMatches = 3;

/** Elapsed between two frames whose stamps do not tell. */
constexpr double kUnknownStep = 1.0 / 30;  // [s]

/** Search radius when too little is found again around the prediction, over the usual one. */
constexpr double kWideSearch = 5;

/** Rounds of estimation: the velocity that undoes the rolling shutter is the estimate's own. */
constexpr int kShutterRounds = 2;

class Stopwatch
{
 public:
    [[nodiscard]] double ms() const
    {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_)
            .count();
    }

 private:
    std::chrono::steady_clock::time_point start_{std::chrono::steady_clock::now()};
};

bool sameCamera(const PinholeCamera& a, const PinholeCamera& b)
{
    return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy &&
           a.cx == b.cx && a.cy == b.cy && a.distortion == b.distortion &&
           (!a.isDistorted() || a.depthAtUndistortedPixel == b.depthAtUndistortedPixel);
}

/** Why a frame cannot be used, or empty. */
std::string problemOf(const RgbdFrame& frame)
{
    if (std::string problem = frame.camera.problem(); !problem.empty())
    {
        return problem;
    }
    const cv::Size size(frame.camera.width, frame.camera.height);
    std::ostringstream out;
    if (!std::isfinite(frame.stamp))
    {
        out << "the time stamp is not finite";
    }
    else if (frame.depth.type() != CV_32FC1 || frame.depth.size() != size)
    {
        out << "the depth image (" << frame.depth.cols << "x" << frame.depth.rows
            << ") does not fit the camera (" << size.width << "x" << size.height << ")";
    }
    else if (!frame.gray.empty() && (frame.gray.type() != CV_8UC1 || frame.gray.size() != size))
    {
        out << "the intensity image (" << frame.gray.cols << "x" << frame.gray.rows
            << ") does not fit the camera (" << size.width << "x" << size.height << ")";
    }
    return out.str();
}

/** How many directions the measurements know better than the motion model does. */
int observableDirections(const Matrix6d& information, const Matrix6d& priorCovariance)
{
    const Matrix6d L = priorCovariance.llt().matrixL();
    const Eigen::SelfAdjointEigenSolver<Matrix6d> es(L.transpose() * information * L);
    return static_cast<int>((es.eigenvalues().array() > 1).count());
}

double maxSigma(const Matrix6d& cov)
{
    const Eigen::SelfAdjointEigenSolver<Matrix6d> es(cov);
    return std::sqrt(std::max(0.0, es.eigenvalues().maxCoeff()));
}

/** Where a reference frame is, and what has been predicted since. */
struct Anchor
{
    PoseGaussian pose;     //!< T_first_ref
    PoseGaussian coasted;  //!< T_ref_latest by the motion model alone; zero covariance when none

    void coast(const PoseGaussian& increment) { coasted = compose(coasted, increment); }
};

/** A frame that has features, but none that the window knows. */
struct Unmatched
{
    Reference frame;
    Anchor anchor;
};
}  // namespace

struct Odometry::Impl
{
    explicit Impl(const OdometryParams& p);

    OdometryResult process(const RgbdFrame& frame);

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
    [[nodiscard]] FrameVelocities velocities(const Eigen::Isometry3d& T_prev_cur, double dt) const;
    [[nodiscard]] PoseEstimate estimate(
        const RgbdFrame& frame,
        const std::vector<Association>& associations,
        const PoseGaussian& predicted,
        double dt,
        FrameDiagnostics& diagnostics);
    void judge(
        const PoseEstimate& estimate, const PoseGaussian& predicted, OdometryResult& result) const;
    void advance(const RgbdFrame& frame, const std::vector<Association>& associations);
    void finish(const PoseGaussian& T_prev_cur, OdometryResult& result);

    OdometryParams params;
    PlaneExtractor planeExtractor;
    PlaneMatcher planeMatcher;
    PointStage pointStage;
    PoseSolver solver;
    MotionModel motion;
    ShutterCalibrator shutter;
    ReferenceWindow window;

    FrameFeatures features;
    Reference current;
    PinholeCamera camera;
    Anchor anchor;      //!< of the window's previous frame
    PoseGaussian pose;  //!< of the latest frame, measured or predicted
    std::optional<Unmatched> unmatched;
    double latestStamp{0};
    std::optional<double> lateStamp;  //!< of the latest frame, when it was not after latestStamp
    bool started{false};
    int numFrames{0};
};

Odometry::Impl::Impl(const OdometryParams& p)
    : params(p),
      planeExtractor(p.planeExtractor, p.depthNoise),
      planeMatcher(p.planeMatcher),
      pointStage(
          p.points, p.pointTracker, p.pointDetector, p.pointMatcher, p.pointLifter, p.depthNoise),
      solver(p.poseSolver),
      motion(p.motionModel),
      shutter(p.shutter),
      window(p.reference)
{
    pose.cov = Matrix6d::Identity() * (kFirstSigma * kFirstSigma);
}

/** The paper's Fig. 1: extraction, matching, pose estimation, validation. */
OdometryResult Odometry::Impl::process(const RgbdFrame& frame)
{
    const Stopwatch total;
    OdometryResult result;
    result.stamp = frame.stamp;
    ++numFrames;
    features = {};

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
        result = start(
            frame,
            frame.stamp <= latestStamp ? "the clock has been set back"
                                       : "the camera's size or calibration has changed",
            result);
        result.diagnostics.msTotal = total.ms();
        return result;
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
    result.diagnostics.msTotal = total.ms();
    return result;
}

bool Odometry::Impl::track(const RgbdFrame& frame, OdometryResult& result)
{
    // 2. Predicted motion since the latest measured frame, and matches with the references.
    const double dt = frame.stamp - window.previous().stamp;
    if (dt > params.pipeline.maxGap)
    {
        motion.reset();
    }
    const PoseGaussian predicted = motion.predict(dt);
    const Stopwatch matching;
    std::vector<Association> associations = associate(frame, predicted.mean, 1);
    if (overlapWithNewest(associations) < params.reference.keyframeMinOverlap)
    {
        // A jerk that the motion model did not foresee: look farther, then closely again.
        associations = associate(frame, predicted.mean, kWideSearch);
        const PoseEstimate coarse =
            estimate(frame, associations, predicted, dt, result.diagnostics);
        associations = associate(frame, coarse.T_base_cur.mean, 1);
    }
    result.diagnostics.msMatching = matching.ms();

    // 3. Pose from both, each weighted by its uncertainty, and its validation.
    const PoseEstimate estimated = estimate(frame, associations, predicted, dt, result.diagnostics);
    judge(estimated, predicted, result);
    if (result.status != TrackingStatus::Tracked)
    {
        return false;
    }

    // 4. The frame becomes a reference.
    const FrameVelocities v = velocities(estimated.T_base_cur.mean, dt);
    window.refinePreviousVelocity(v.previous);
    current.velocity = v.current;
    shutter.update(
        PairBuilder(window.previous(), current, frame.camera.height),
        associations,
        v,
        estimated.T_base_cur.mean);
    finish(estimated.T_base_cur, result);
    motion.update(estimated.T_base_cur.mean, dt);
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
    current.T_world_cam = pose.mean;
    unmatched = Unmatched{std::move(current), {pose, {}}};
}

void Odometry::Impl::restartAtUnmatched()
{
    window.clear();
    window.add(std::move(unmatched->frame), true);
    anchor = unmatched->anchor;
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
    current.id = numFrames;
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
        result.pose = pose;
    }
    started = true;
    camera = frame.camera;
    window.clear();
    anchor = {pose, {}};
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
    if (dt > params.pipeline.maxGap)
    {
        motion.reset();
    }
    result.increment = motion.predict(dt);
    motion.coast(dt);
    pose = compose(pose, result.increment);
    result.pose = pose;
    anchor.coast(result.increment);
    if (unmatched)
    {
        unmatched->anchor.coast(result.increment);
    }
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

/** The mean velocity over an increment is that of its middle: extrapolated to the current frame,
 * interpolated at the previous one. */
FrameVelocities Odometry::Impl::velocities(const Eigen::Isometry3d& T_prev_cur, double dt) const
{
    const Vector6d mean = se3Log(T_prev_cur) / dt;
    if (!motion.hasVelocity())
    {
        return {mean, mean};
    }
    return {0.5 * (mean + motion.velocity()), 1.5 * mean - 0.5 * motion.velocity()};
}

PoseEstimate Odometry::Impl::estimate(
    const RgbdFrame& frame,
    const std::vector<Association>& associations,
    const PoseGaussian& predicted,
    double dt,
    FrameDiagnostics& diagnostics)
{
    const Stopwatch watch;
    const PairBuilder builder(window.previous(), current, frame.camera.height);
    const bool fuse = params.pipeline.degeneracy == "fuse";
    std::vector<PointPair> points;
    std::vector<PlanePair> planes;
    PoseEstimate out;
    out.T_base_cur = predicted;
    for (int round = 0; round < kShutterRounds; ++round)
    {
        const FrameVelocities v = velocities(out.T_base_cur.mean, dt);
        builder.build(associations, v, shutter, points, planes);
        if (static_cast<int>(points.size() + planes.size()) < (fuse ? 1 : kMinMatches))
        {
            break;
        }
        out = solver.solve(
            points,
            planes,
            out.T_base_cur.mean,
            fuse ? std::optional<PoseGaussian>(predicted) : std::nullopt);
        diagnostics.iterations += out.iterations;
    }
    diagnostics.numPointPairs = static_cast<int>(points.size());
    diagnostics.numPlanePairs = static_cast<int>(planes.size());
    diagnostics.numPointInliers = out.numPointInliers;
    diagnostics.pointChi2PerDof = out.pointChi2PerDof;
    diagnostics.planeChi2PerDof = out.planeChi2PerDof;
    diagnostics.numReferences = static_cast<int>(associations.size());
    diagnostics.msPose = watch.ms();
    return out;
}

void Odometry::Impl::judge(
    const PoseEstimate& estimate, const PoseGaussian& predicted, OdometryResult& result) const
{
    FrameDiagnostics& d = result.diagnostics;
    d.observableDirections =
        observableDirections(estimate.infoPoints + estimate.infoPlanes, predicted.cov);
    const bool fuse = params.pipeline.degeneracy == "fuse";
    const int matches = d.numPointPairs + d.numPlanePairs;
    std::ostringstream reason;
    if (matches < (fuse ? 1 : kMinMatches))
    {
        reason << matches << " point and plane matches";
    }
    else if (!fuse && maxSigma(estimate.T_base_cur.cov) > params.pipeline.gateSigma)
    {
        reason << "largest standard deviation " << maxSigma(estimate.T_base_cur.cov)
               << " is above the gate";
    }
    else if (
        params.poseSolver.weighting != "none" && d.pointChi2PerDof > params.pipeline.maxPointChi2)
    {
        reason << "the points contradict their covariances (chi-square per degree of freedom "
               << d.pointChi2PerDof << ")";
    }
    else if (d.observableDirections == 0)
    {
        reason << "no direction is measured better than it is predicted";
    }
    else
    {
        result.status = TrackingStatus::Tracked;
        if (d.observableDirections < 6)
        {
            reason << d.observableDirections << " of 6 directions measured, the others predicted";
        }
    }
    result.reason = reason.str();
}

/** Increment and pose of a measured frame. The pose continues from the latest measured frame; after
 * a gap the increment leads on from the predicted one, and is as uncertain as that. */
void Odometry::Impl::finish(const PoseGaussian& T_prev_cur, OdometryResult& result)
{
    pose = compose(anchor.pose, T_prev_cur);
    result.pose = pose;
    result.increment = compose(inverse(anchor.coasted), T_prev_cur);
    result.increment.cov = withEigenvalueFloor(result.increment.cov, 1e-14);
    const Vector6d sigma = result.increment.cov.diagonal().cwiseSqrt();
    result.diagnostics.maxSigmaTranslation = sigma.head<3>().maxCoeff();
    result.diagnostics.maxSigmaRotation = sigma.tail<3>().maxCoeff();
    anchor = {pose, {}};
    unmatched.reset();
    latestStamp = result.stamp;
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
    current.T_world_cam = pose.mean;
    const bool isKeyframe =
        window.empty() || window.needsKeyframe(pose.mean, overlapWithNewest(associations));
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
