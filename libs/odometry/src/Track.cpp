// SPDX-License-Identifier: BSD-3-Clause
#include "Track.h"

#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <utility>

#include "frame_checks.h"

namespace pointplane
{
namespace
{
/** Limit of the input: two exposures are not sooner after each other [s], whatever their stamps
 * say. */
constexpr double kShortestStep = 1e-3;

/** Between frames whose stamps do not tell [s]. */
constexpr double kUsualStep = 1.0 / 30;

/** From one stamp to another [s]. Those of a damaged file may be any numbers. */
double stepBetween(double earlier, double later)
{
    return std::clamp(later - earlier, kShortestStep, MotionModel::kLongestStep);
}
}  // namespace

Track::Track(const OdometryParams& params)
    : maxGap_(params.pipeline.maxGap),
      fuses_(params.pipeline.fuses()),
      isFrameToFrame_(params.reference.isFrameToFrame()),
      motion_(params.motionModel),
      history_(params.covariance.history),
      window_(params.reference)
{
}

bool Track::needsKeyframe(const Eigen::Isometry3d& T_prev_cur, double overlap) const
{
    return window_.needsKeyframe(previous().T_world_cam * T_prev_cur, overlap);
}

bool Track::isOf(const PinholeCamera& camera) const
{
    return !isEmpty() && sameCamera(camera_, camera);
}

bool Track::noteLate(double stamp)
{
    if (stamp > latestStamp_)
    {
        lateStamp_.reset();
        return false;
    }
    const bool clockWasSet = lateStamp_ && stamp > *lateStamp_;
    lateStamp_ = stamp;
    return !clockWasSet;
}

bool Track::followClock(double stamp)
{
    if (!(stamp <= latestStamp_))
    {
        return false;
    }
    const double change = stamp - MotionModel::kLongestStep - latestStamp_;
    latestStamp_ += change;
    window_.changeStamps(change);
    if (unmatched_)
    {
        unmatched_->stamp += change;
    }
    lateStamp_.reset();
    return true;
}

void Track::noteGap(double stamp)
{
    if (stepBetween(previous().stamp, stamp) > maxGap_)
    {
        forgetVelocity();
    }
}

Prediction Track::prediction(double stamp) const
{
    Prediction out;
    out.dt = stepBetween(previous().stamp, stamp);
    out.followsMeasured = isPreviousMeasured_ && previous().id == history_.latestFrame();
    out.motion = motion_.predictFromEstimate(out.dt);
    out.pose = out.motion.pose();
    out.pose.cov += motion_.bySuddenAcceleration(out.dt);
    out.prior = priorFrom(out.motion, out.pose);
    return out;
}

/** The velocity follows the pose as motions do, but the pose is hardly pulled to the predicted one:
 * a jerk must not be smoothed away. The paper's gate wants to know what the frame alone says. */
MotionPrior Track::priorFrom(const MotionGaussian& motion, const PoseGaussian& pose) const
{
    if (!fuses_)
    {
        return MotionPrior::fixedVelocity(motion.mean);
    }
    MotionPrior prior = MotionPrior::from(motion);
    prior.pose = pose.cov.ldlt().solve(Matrix6d::Identity());
    return prior;
}

/** Only once in a gap. From then on, the uncertainty of the velocity grows from frame to frame. */
void Track::forgetVelocity()
{
    if (isVelocityKnown_)
    {
        motion_.reset();
        history_.endCoasting();
        isVelocityKnown_ = false;
    }
}

void Track::changeCamera(const PinholeCamera& camera, const CameraMatrix& cov)
{
    history_.changeCamera(cov);
    camera_ = camera;
}

PoseGaussian Track::restart(Reference frame)
{
    PoseGaussian none;
    none.cov = Matrix6d::Identity() * (kExactSigma * kExactSigma);
    const PoseGaussian increment = !isEmpty() || wasLost_ ? coast(frame.stamp) : none;
    if (isEmpty())
    {
        history_.predict(none);  // the world begins here
    }
    history_.restart(history_.latestFrame());
    window_.clear();
    motion_.startAtReference();
    unmatched_.reset();
    isPreviousMeasured_ = false;
    latestStamp_ = frame.stamp;
    lateStamp_.reset();
    add(std::move(frame), true);
    return increment;
}

void Track::measure(Measured measured, const std::vector<Association>& associations)
{
    const DecayedVelocities decayed = motion_.after(measured.dt);
    std::optional<MotionModel::Smoothed> previousVelocity;
    isPreviousMeasured_ = true;
    isVelocityKnown_ = !measured.isJump;
    if (measured.isJump)
    {
        motion_.reset();
    }
    else
    {
        previousVelocity = updateMotion(measured.motion, measured.dt);
        measured.frame.velocity = motion_.velocity();
        window_.refinePreviousVelocity(
            previousVelocity ? previousVelocity->velocity : motion_.velocity());
    }
    noteWhichPointsAreFound(associations);
    history_.measure(
        previous().T_world_cam,
        measured.motion.mean.T_prev_cur,
        decayed,
        measured.errors,
        previousVelocity);
    unmatched_.reset();
    latestStamp_ = measured.frame.stamp;
    add(std::move(measured.frame), measured.isKeyframe);
}

/** A frame that shows none, as in the dark or without colour, tells nothing of single ones. */
void Track::noteWhichPointsAreFound(const std::vector<Association>& associations)
{
    const bool isAnyFound = std::any_of(
        associations.begin(),
        associations.end(),
        [](const Association& association) { return association.numPointsFound() > 0; });
    for (const Association& association : associations)
    {
        if (isAnyFound)
        {
            window_.notePoints(association);
        }
    }
}

std::optional<MotionModel::Smoothed> Track::updateMotion(const MotionGaussian& motion, double dt)
{
    if (!fuses_)
    {
        motion_.follow(motion.mean.T_prev_cur, dt);
        return {};
    }
    const MotionModel::Smoothed previousVelocity = motion_.update(motion, dt);
    if (isFrameToFrame_)
    {
        motion_.followIncrements();
    }
    return previousVelocity;
}

PoseGaussian Track::predict(double stamp, std::optional<Reference> unmatched)
{
    const bool goesOn = isEmpty() || (std::isfinite(stamp) && stamp >= latestStamp_);
    const PoseGaussian increment = goesOn ? coast(stamp) : stay(stamp);
    if (unmatched)
    {
        unmatched_ = std::move(unmatched);
        unmatched_->id = history_.latestFrame();
        unmatched_->T_world_cam = history_.latest();
    }
    if (!isEmpty())
    {
        forgetOthers();
    }
    return increment;
}

PoseGaussian Track::stay(double stamp)
{
    // If the clock was set, any time may have passed. Without a stamp, frames follow in order.
    const bool tells = latestStamp_ - stamp <= maxGap_;
    const double dt = tells                  ? stepBetween(stamp, latestStamp_)
                      : std::isfinite(stamp) ? MotionModel::kLongestStep
                                             : kUsualStep;
    const PoseGaussian way = motion_.predict(dt).pose();
    const Vector6d mean = se3Log(way.mean);
    PoseGaussian increment;
    increment.cov = strictlyPositive(
        Matrix6d(way.cov + motion_.bySuddenAcceleration(dt) + mean * mean.transpose()));
    JointCovariance::Prediction errors;
    errors.noise.topLeftCorner<6, 6>() = increment.cov;
    errors.velocity = motion_.velocityCov();
    errors.after = motion_.after(0);
    history_.predict(increment.mean, errors);
    return increment;
}

PoseGaussian Track::coast(double stamp)
{
    const bool known = stamp >= latestStamp_ && std::isfinite(stamp);
    const double dt = known ? stepBetween(latestStamp_, stamp) : kUsualStep;
    JointCovariance::Prediction errors;
    if (dt > maxGap_ || (!isEmpty() && stepBetween(previous().stamp, stamp) > maxGap_))
    {
        forgetVelocity();
    }
    PoseGaussian increment = motion_.predict(dt).pose();
    errors.noise = motion_.unforeseen(dt);
    errors.velocity = motion_.velocityCov();
    increment.cov = strictlyPositive(Matrix6d(increment.cov + motion_.bySuddenAcceleration(dt)));
    errors.after = motion_.after(dt);
    motion_.coast(dt);
    if (std::isfinite(stamp))
    {
        latestStamp_ = std::fmax(latestStamp_, stamp);
    }
    if (!isEmpty())
    {
        history_.predict(increment.mean, errors);
    }
    wasLost_ = wasLost_ || isEmpty();
    return increment;
}

bool Track::restartAtUnmatched()
{
    if (!unmatched_)
    {
        return false;
    }
    window_.leave();
    motion_.startAtReference();
    isPreviousMeasured_ = false;
    history_.restart(unmatched_->id, placeIds());
    window_.add(std::move(*unmatched_), true);
    unmatched_.reset();
    return true;
}

/** The latest frame becomes the previous one. */
void Track::add(Reference frame, bool isKeyframe)
{
    frame.id = history_.latestFrame();
    frame.T_world_cam = history_.latest();
    window_.add(std::move(frame), isKeyframe);
    forgetOthers();
}

std::map<int, Matrix6d> Track::velocityCovs() const
{
    std::map<int, Matrix6d> out;
    for (const Reference* reference : references())
    {
        out[reference->id] = history_.velocityCov(reference->id);
    }
    return out;
}

std::vector<int> Track::placeIds() const
{
    std::vector<int> out;
    for (const Reference& place : window_.places())
    {
        out.push_back(place.id);
    }
    return out;
}

/** Keeps what the next frame will be compared with, and the history. */
void Track::forgetOthers()
{
    std::vector<int> active, poses = placeIds();
    for (const Reference* reference : window_.active())
    {
        active.push_back(reference->id);
    }
    if (unmatched_)
    {
        poses.push_back(unmatched_->id);
    }
    history_.keep(active, poses);
}
}  // namespace pointplane
