// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/odometry/Odometry.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "Aligner.h"
#include "FrontEnd.h"
#include "LatestImages.h"
#include "Stopwatch.h"
#include "Track.h"
#include "align_somewhere.h"
#include "depth_motion.h"
#include "frame_checks.h"
#include "shown_features.h"
#include "surfaces.h"
#include "uncertainty/ErrorModel.h"

namespace pointplane
{
struct Odometry::Impl
{
    explicit Impl(const OdometryParams& p)
        : params(p),
          frontEnd(p),
          aligner(p),
          errors(p),
          track(p),
          images(p.pointLifter.minDepth, p.pointLifter.maxDepth)
    {
    }

    OdometryResult process(const RgbdFrame& frame);
    void locate(const RgbdFrame& frame, OdometryResult& result);
    void compare(const RgbdFrame& frame, const Features& current, OdometryResult& result);
    [[nodiscard]] std::string whyUnusable(const RgbdFrame& frame);
    [[nodiscard]] std::string whyNoDepth(const RgbdFrame& frame, const Features& current) const;
    [[nodiscard]] Reference newReference(const Features& current, PointReference points);
    void restart(const RgbdFrame& frame, const Features& current, OdometryResult& result);
    void measure(const Features& current, Alignment& alignment, OdometryResult& result);
    [[nodiscard]] PoseAnalysis analyse(const Features& current, Alignment& alignment) const;
    [[nodiscard]] JointCovariance::Measurement learnErrors(
        const Features& current, const Alignment& alignment, const PoseAnalysis& analysis);
    [[nodiscard]] std::optional<PointReference> keyframePoints(
        const Features& current, const Alignment& alignment, const PoseAnalysis& analysis) const;
    void predict(const Features& current, const Alignment& alignment, OdometryResult& result);
    void extrapolate(TrackingStatus status, double stamp, OdometryResult& result);

    OdometryParams params;
    FrontEnd frontEnd;
    Aligner aligner;
    ErrorModel errors;
    Track track;
    LatestImages images;
    FrameFeatures shown;  //!< of the latest frame, for pictures
};

namespace
{
void addReason(const std::string& reason, OdometryResult& result)
{
    result.reason += (result.reason.empty() || reason.empty() ? "" : "; ") + reason;
}
}  // namespace

OdometryResult Odometry::Impl::process(const RgbdFrame& frame)
{
    const Stopwatch total;
    OdometryResult result;
    result.stamp = frame.stamp;
    shown = {};
    locate(frame, result);
    // Before the path begins, there is no pose in the track.
    result.pose = track.isEmpty() ? result.increment : track.pose();
    result.since = track.since();
    if (result.status == TrackingStatus::Tracked)
    {
        // From the frame before, which may be a predicted one, by the joint covariance.
        result.increment = result.since.front();
    }
    if (result.status != TrackingStatus::First)
    {
        const Vector6d sigma = result.increment.cov.diagonal().cwiseSqrt();
        result.diagnostics.maxSigmaTranslation = sigma.head<3>().maxCoeff();
        result.diagnostics.maxSigmaRotation = sigma.tail<3>().maxCoeff();
    }
    showEachOnce(0.5 * params.pointTracker.windowPx, shown);  // patches share half a side
    countShown(shown, result.diagnostics);
    result.diagnostics.lens = errors.camera().lens();
    result.diagnostics.msTotal = total.ms();
    return result;
}

/** The paper's Fig. 1: extraction, then, in compare(), matching, pose estimation, validation. */
void Odometry::Impl::locate(const RgbdFrame& frame, OdometryResult& result)
{
    result.reason = whyUnusable(frame);
    if (!result.reason.empty())
    {
        constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();
        return extrapolate(
            TrackingStatus::Lost, isTime(frame.stamp) ? frame.stamp : kNoTime, result);
    }
    RgbdFrame own = frame;
    own.camera.isNominal = own.camera.isNominal || params.lens.nominal;
    const bool isFirst = track.isEmpty();
    if (isFirst)
    {
        images.forget();  // no frame has been used yet
    }
    result.reason = images.renew(own);
    if (!result.reason.empty() && own.gray.empty() && !hasDepth(own))
    {
        // Nothing was measured: the camera, or what carries its images, has stopped.
        addReason(pointplane::whyNoDepth(frame.depth, params.pointLifter), result);
        return extrapolate(TrackingStatus::Predicted, frame.stamp, result);
    }
    const Features current = frontEnd.extract(own, result.diagnostics);
    addReason(current.depthIsNoise ? "its depth image is noise" : "", result);
    shown = shownPlanes(current);
    if (isFirst && !current.hasDepth)
    {
        addReason(whyNoDepth(frame, current), result);
        addReason(
            result.reason.empty() ? "nearly all of its depth is of the robot itself" : "", result);
        addReason("a path cannot begin without depth", result);
        return extrapolate(TrackingStatus::Lost, frame.stamp, result);
    }
    const bool isOtherCamera = !isFirst && !track.isOf(frame.camera);
    if (!isFirst && track.followClock(frame.stamp))
    {
        addReason(
            "two stamps in a row are not after an earlier one: the clock was set back, or frames "
            "are out of order",
            result);
    }
    addReason(isOtherCamera ? "the camera's size or calibration has changed" : "", result);
    if (isFirst || isOtherCamera)
    {
        return restart(frame, current, result);
    }
    compare(frame, current, result);
}

/** A frame that is compared with those before. \param frame as it came, for the reasons */
void Odometry::Impl::compare(
    const RgbdFrame& frame, const Features& current, OdometryResult& result)
{
    track.noteGap(current.frame.stamp);
    Alignment alignment =
        alignSomewhere(aligner, frontEnd, current, errors, track, result.diagnostics);
    if (frontEnd.marks().learn(alignment.associations, alignment.marks, frame.camera))
    {
        addReason(
            "points are fixed to the image, like text; frames before may have followed them, so it "
            "is not compared with these",
            result);
        track.forgetVelocity();
        return restart(frame, current, result);
    }
    addReason(alignment.reason, result);
    if (alignment.holds)
    {
        measure(current, alignment, result);
    }
    else
    {
        showPairs(alignment.associations, nullptr, shown);
        predict(current, alignment, result);
    }
    if (alignment.problem.points.empty())
    {
        addReason(frontEnd.whyNoPoint(frame), result);
        addReason(frontEnd.marks().whyNoPoint(alignment.associations), result);
    }
    addReason(whyNoDepth(frame, current), result);
}

std::string Odometry::Impl::whyUnusable(const RgbdFrame& frame)
{
    const std::string problem = problemOf(frame, images.mask().size());
    return !problem.empty() ? problem
           : !track.isEmpty() && track.noteLate(frame.stamp)
               ? "its time stamp is not after the previous frame's"
               : "";
}

/** Why the frame as it came has no depth. Other parts that were left out of it have been told
 * already, but for the robot. */
std::string Odometry::Impl::whyNoDepth(const RgbdFrame& frame, const Features& current) const
{
    return current.hasDepth ? "" : pointplane::whyNoDepth(frame.depth, params.pointLifter);
}

namespace
{
/** Without points, and without what the track adds. */
Reference referenceOf(const Features& current)
{
    Reference out;
    out.stamp = current.frame.stamp;
    out.shutter = current.frame.shutter;
    out.planes = current.planes;
    return out;
}
}  // namespace

/** With all that later frames are compared by, but for what the track adds. */
Reference Odometry::Impl::newReference(const Features& current, PointReference points)
{
    Reference out = referenceOf(current);
    out.points = std::move(points);
    out.images = frontEnd.keyframeImages(current);
    showNewPoints(out.points, shown);
    return out;
}

/** The first frame, or one that cannot be compared with those before. \param frame as it came */
void Odometry::Impl::restart(
    const RgbdFrame& frame, const Features& current, OdometryResult& result)
{
    result.status = track.isEmpty() ? TrackingStatus::First : TrackingStatus::Predicted;
    Reference reference = newReference(current, frontEnd.pointReference(current, current.frame));
    if (reference.points.points.empty())
    {
        addReason(frontEnd.whyNoPoint(frame), result);
    }
    shown.isKeyframe = true;
    const PinholeCamera& camera = current.frame.camera;
    if (!track.isOf(camera))
    {
        track.changeCamera(camera, errors.changeCamera(camera));
    }
    result.increment = track.restart(std::move(reference));
}

/** Learns from the frame and makes it a reference. */
void Odometry::Impl::measure(const Features& current, Alignment& alignment, OdometryResult& result)
{
    result.status = TrackingStatus::Tracked;
    const MotionGaussian& motion = alignment.estimate.motion;
    if (alignment.observableDirections == 6 && !alignment.doubt)
    {
        frontEnd.marks().learn(
            alignment.associations,
            current.frame.camera,
            {track.fromWorld(motion.mean.T_prev_cur), inverse(motion.pose()).cov});
    }
    const PoseAnalysis analysis = analyse(current, alignment);
    Track::Measured measured;
    measured.motion = motion;
    measured.dt = alignment.predicted.dt;
    measured.isJump = Judge::isSurprising(alignment);
    measured.errors = learnErrors(current, alignment, analysis);
    showPairs(alignment.associations, &analysis, shown);
    shown.moving = frontEnd.findMoving(
        current, earlierViews(track, current.frame, motion.mean, errors.camera()));
    std::optional<PointReference> points = keyframePoints(current, alignment, analysis);
    measured.isKeyframe = shown.isKeyframe = points.has_value();
    measured.frame = points ? newReference(current, std::move(*points)) : referenceOf(current);
    measured.frame.surfaces = analysis.surfaces;
    track.measure(std::move(measured), alignment.associations);
}

PoseAnalysis Odometry::Impl::analyse(const Features& current, Alignment& alignment) const
{
    PairBuilder(track.previous(), current, errors.camera())
        .addCameraErrors(alignment.associations, alignment.estimate.motion.mean, alignment.problem);
    PoseAnalysis out = aligner.analyse(alignment);
    countMoving(alignment.associations, current, out.surfaces);
    return out;
}

JointCovariance::Measurement Odometry::Impl::learnErrors(
    const Features& current, const Alignment& alignment, const PoseAnalysis& analysis)
{
    ErrorModel::Measured frame;
    frame.references = track.references();
    frame.estimate = alignment.estimate;
    frame.analysis = analysis;
    frame.dt = alignment.predicted.dt;
    frame.shutter = current.frame.shutter;
    frame.bend = current.bend;
    frame.motionNoise =
        track.motionNoise(frame.dt, analysis.sensitivity.prior.topLeftCorner<6, 6>());
    frame.acceleration2 = track.acceleration2();
    frame.velocities = track.velocityCovs();
    frame.doubt = alignment.doubt ? alignment.doubt : alignment.turn;
    return errors.learn(frame);
}

/** Those of a measured frame that becomes a key frame. */
std::optional<PointReference> Odometry::Impl::keyframePoints(
    const Features& current, const Alignment& alignment, const PoseAnalysis& analysis) const
{
    constexpr int kPointsOfPose = 3;
    if (!current.hasDepth)
    {
        return {};  // it shows nothing that others could be compared with
    }
    const bool isNew = track.needsKeyframe(
                           alignment.estimate.motion.mean.T_prev_cur,
                           track.overlap(alignment.associations, current)) ||
                       Judge::needsNewView(alignment, shown.moving);
    // Those before may have been dark, blurred or without colour.
    const bool mayHaveMore = params.pipeline.usePoints && !current.frame.gray.empty() &&
                             alignment.numSought < params.pointTracker.minPoints;
    if (!isNew && !mayHaveMore)
    {
        return {};
    }
    PointReference out =
        frontEnd.pointReference(current, stillPart(current, shown.moving, analysis.surfaces));
    const auto known = static_cast<std::size_t>(std::max(kPointsOfPose, alignment.numSought));
    const bool hasMore = out.points.size() >= 2 * known;
    return isNew || hasMore ? std::optional(std::move(out)) : std::nullopt;
}

/** A usable frame that could not be measured. */
void Odometry::Impl::predict(
    const Features& current, const Alignment& alignment, OdometryResult& result)
{
    result.status = TrackingStatus::Predicted;
    std::optional<Reference> unmatched =
        newReference(current, frontEnd.pointReference(current, current.frame));
    unmatched->surfaces = alignment.problem.surfaces;  // what moved before still does
    // [P17, section Matching]: consecutive frames, whatever became of the one before.
    const bool isAdjacent = params.reference.isAdjacent();
    if (!isAdjacent && unmatched->planes.planes.empty() && unmatched->points.points.empty())
    {
        unmatched.reset();
    }
    result.increment = track.predict(current.frame.stamp, std::move(unmatched));
    if (isAdjacent)
    {
        (void)track.restartAtUnmatched();
    }
}

/** A frame that measures nothing and leaves no reference. */
void Odometry::Impl::extrapolate(TrackingStatus status, double stamp, OdometryResult& result)
{
    result.status = status;
    result.increment = track.predict(stamp);
}

const char* toString(TrackingStatus status)
{
    constexpr const char* kWords[] = {"first", "tracked", "predicted", "lost"};
    return kWords[static_cast<size_t>(status)];
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
const FrameFeatures& Odometry::features() const { return impl_->shown; }
const OdometryParams& Odometry::params() const { return impl_->params; }
cv::Mat Odometry::mask() const { return impl_->images.mask().clone(); }

void Odometry::setMask(const cv::Mat& mask) { impl_->images.setMask(mask); }

void Odometry::reset()
{
    const cv::Mat mask = impl_->images.mask();
    impl_ = std::make_unique<Impl>(OdometryParams(impl_->params));
    impl_->images.setMask(mask);
}
}  // namespace pointplane
