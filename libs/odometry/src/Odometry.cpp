// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/odometry/Odometry.h>
#include <pointplane/odometry/ShutterCorrection.h>
#include <pointplane/pose/residuals.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <deque>

namespace pointplane
{
namespace
{
using Clock = std::chrono::steady_clock;
double msSince(Clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/** A past frame with its features. */
struct Reference
{
    double stamp{0};
    Eigen::Isometry3d T_world_cam{Eigen::Isometry3d::Identity()};
    Vector6d velocity{Vector6d::Zero()};  //!< body velocity at stamp
    PlaneSet planes;
    int id{0};
};
}  // namespace

struct Odometry::Impl
{
    explicit Impl(const OdometryParams& p)
        : params(p), extractor(p.planeExtractor, p.depthNoise), matcher(p.planeMatcher), solver(p.poseSolver),
          motion(p.motionModel)
    {
    }
    OdometryParams params;
    PlaneExtractor extractor;
    PlaneMatcher matcher;
    PoseSolver solver;
    MotionModel motion;

    FrameFeatures features;
    PoseGaussian pose;
    bool hasPrevious{false};
    Reference previous;
    std::deque<Reference> keyframes;
    int frameId{0};

    OdometryResult process(const RgbdFrame& frame);
};

OdometryResult Odometry::Impl::process(const RgbdFrame& frame)
{
    const auto start = Clock::now();
    OdometryResult out;
    out.stamp = frame.stamp;
    features.planes = extractor.extract(frame.depth, frame.camera);
    out.diagnostics.numPlanes = static_cast<int>(features.planes.planes.size());
    out.diagnostics.msPlanes = msSince(start);
    ShutterModel sm = frame.shutter;
    const auto fallback = [](double& v, double f) { if (!std::isfinite(v)) v = f; };
    fallback(sm.readoutColour, params.shutter.readoutColour);
    fallback(sm.readoutDepth, params.shutter.readoutDepth);
    fallback(sm.depthDelay, params.shutter.depthDelay);
    const ShutterCorrection shutter(sm, frame.camera.height);

    Reference current;
    current.stamp = frame.stamp;
    current.planes = features.planes;
    current.id = ++frameId;
    if (!hasPrevious)
    {
        out.status = TrackingStatus::First;
        out.increment.cov = Matrix6d::Identity() * 1e-10;
        hasPrevious = true;
        pose.cov = Matrix6d::Identity() * 1e-10;
        out.pose = pose;
        previous = current;
        keyframes.push_back(current);
        return out;
    }
    const double dt = frame.stamp - previous.stamp;
    const PoseGaussian prior = motion.predict(dt);
    std::vector<const Reference*> refs{&previous};
    if (params.reference.reference == "keyframes")
        for (const auto& k : keyframes)
            if (k.id != previous.id) refs.push_back(&k);
    Eigen::Isometry3d T = prior.mean;
    PoseEstimate est;
    std::vector<std::vector<PlaneMatch>> matches;
    double overlap = 1;
    for (int round = 0; round < 2; ++round)
    {
        const Vector6d mean = se3Log(T) / dt;
        Vector6d vCur = motion.velocity().isZero() ? mean : Vector6d(1.5 * mean - 0.5 * motion.velocity());
        const Vector6d vPrev = motion.velocity().isZero() ? mean : Vector6d(0.5 * (mean + motion.velocity()));
        current.velocity = vCur;
        previous.velocity = vPrev;
        std::vector<PlanePair> pairs;
        std::vector<PlaneGaussian> cur;
        for (const auto& p : current.planes.planes) cur.push_back(shutter.plane(p, vCur));
        for (const Reference* r : refs)
        {
            const Eigen::Isometry3d T_prev_ref = previous.T_world_cam.inverse() * r->T_world_cam;
            const auto ms = matcher.match(r->planes, current.planes, frame.camera, T.inverse() * T_prev_ref);
            const Vector6d vRef = r == &previous ? vPrev : (r->id == previous.id ? vPrev : r->velocity);
            for (const auto& m : ms)
            {
                pairs.push_back(
                    {transformed(T_prev_ref, shutter.plane(r->planes.planes[static_cast<size_t>(m.ref)], vRef)),
                     cur[static_cast<size_t>(m.cur)]});
            }
            if (!keyframes.empty() && r == &keyframes.back())
                overlap = static_cast<double>(ms.size()) / static_cast<double>(std::max<size_t>(1, r->planes.planes.size()));
        }
        out.diagnostics.numPlanePairs = static_cast<int>(pairs.size());
        est = solver.solve({}, pairs, T, prior);
        T = est.T_base_cur.mean;
        out.diagnostics.iterations += est.iterations;
    }
    for (auto& k : keyframes) if (k.id == previous.id) k.velocity = previous.velocity;
    out.diagnostics.planeChi2PerDof = est.planeChi2PerDof;
    out.status = TrackingStatus::Tracked;
    out.increment = est.T_base_cur;
    motion.update(T, dt);
    pose = compose(pose, out.increment);
    out.pose = pose;
    current.T_world_cam = pose.mean;
    const Eigen::Isometry3d d = keyframes.back().T_world_cam.inverse() * current.T_world_cam;
    previous = current;
    if (d.translation().norm() > params.reference.keyframeDistance ||
        so3Log(d.linear()).norm() > params.reference.keyframeAngleDeg * M_PI / 180 ||
        overlap < params.reference.keyframeMinOverlap)
    {
        keyframes.push_back(current);
        if (keyframes.size() > static_cast<size_t>(params.reference.maxKeyframes)) keyframes.pop_front();
    }
    out.diagnostics.msTotal = msSince(start);
    return out;
}

void ShutterParams::check() const {}
void ReferenceParams::check() const {}
void OdometryParams::check() const
{
    depthNoise.check();
    planeExtractor.check();
    planeMatcher.check();
    poseSolver.check();
    motionModel.check();
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
void Odometry::reset() { impl_ = std::make_unique<Impl>(impl_->params); }
}  // namespace pointplane
