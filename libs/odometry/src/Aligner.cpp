// SPDX-License-Identifier: BSD-3-Clause
#include "Aligner.h"

#include <pointplane/core/se3.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "Stopwatch.h"

namespace pointplane
{
namespace
{
/** Search radius when too little is found again around the prediction, over the usual one. */
constexpr double kWideSearch = 5;

/** Fewer matches than this in total cannot fix a pose [P17, section Pose estimation]. */
constexpr int kMinMatches = 3;

/** So few points cannot contradict each other when they are wrong; a plane is worth three. */
constexpr int kFewPoints = 6;

/** Points that should be in view: of fewer, a share says little. */
constexpr int kHandful = 20;

/** Standard deviations from the predicted motion beyond which an estimate has to be convincing by
 * itself. Cameras in hands stay below three, at any frame rate: the prediction knows how little it
 * knows. Of estimates beyond five, hardly one is right (docs/theory.md, "Verdict"). */
constexpr double kMostSurprise = 5;

/** An estimate is convincing when all of the following holds. No alternative is looked for then,
 * and it is believed even far from the predicted motion.
 *
 * Of the surfaces in view, nine tenths agree with a right motion and a third with one that is wrong
 * by 5 cm or 5 deg (docs/theory.md, "Verdict"): so much is between. */
constexpr double kConvincingSurfaces = 0.75;

/** Surfaces and the share of points found again: along a wall, surfaces agree with any motion. With
 * the least surfaces, a seventh of the points must be found; with all of them, none. */
constexpr double kConvincingTogether = 0.9;

/** Residuals up to twice as large as in the frames before, squared: a wrong motion disagrees more.
 */
constexpr double kConvincingRise = 4;

/** A prediction that is less certain than this says nothing of which plane is which: other planes
 * are as near, and as parallel (PlaneMatcher). */
constexpr double kUncertainRotation = 10 * M_PI / 180, kUncertainTranslation = 0.1;  // [rad], [m]

/** Surfaces of a place that agree when it is recognised. By key points alone the motion is
 * centimetres off: less is asked than of an estimate, and twice what a wrong motion shows. What is
 * recalled is then aligned and judged like any reference. */
constexpr double kRecognised = 0.6;

/** About half of the time between two frames at 30 Hz, by which the stamp of a depth image may be
 * off where a source gives both images one stamp [s]. */
constexpr double kTimeSigma = 0.015;

/** Surfaces that are compared: of the newest reference, and of older ones until there are as many.
 */
constexpr int kEnoughSurfaces = 500;

/** How many directions the measurements know better than the motion model does. */
int observableDirections(const Matrix6d& information, const Matrix6d& priorCovariance)
{
    const Matrix6d L = priorCovariance.llt().matrixL();
    const Eigen::SelfAdjointEigenSolver<Matrix6d> es(L.transpose() * information * L);
    return static_cast<int>((es.eigenvalues().array() > 1).count());
}

/** Root mean square deviation from the predicted pose, in its standard deviations. */
double surprise(const PoseEstimate& estimate, const PoseGaussian& predicted)
{
    const Vector6d e = leftError(estimate.motion.mean.T_prev_cur, predicted.mean);
    return std::sqrt(e.dot(predicted.cov.ldlt().solve(e)) / 6);
}

double maxSigma(const Matrix6d& cov)
{
    const Eigen::SelfAdjointEigenSolver<Matrix6d> es(cov);
    return std::sqrt(std::max(0.0, es.eigenvalues().maxCoeff()));
}

/** Of a predicted pose. */
bool isUncertain(const Matrix6d& cov)
{
    const Vector6d variances = cov.diagonal();
    return variances.head<3>().maxCoeff() > kUncertainTranslation * kUncertainTranslation ||
           variances.tail<3>().maxCoeff() > kUncertainRotation * kUncertainRotation;
}

/** How much speaks for an alignment. */
double evidence(const Alignment& alignment)
{
    const double surfaces = alignment.agreement.fraction() *
                            std::min(1.0, 1.0 * alignment.agreement.seen() / kEnoughSurfaces);
    return (alignment.holds ? 1 : 0) + surfaces + alignment.pointShare();
}

/** Points of a reference that are due and in view of a camera. */
int numInView(
    const Reference& reference, const RgbdFrame& frame, const Eigen::Isometry3d& T_cur_ref)
{
    int out = 0;
    for (size_t i = 0; i < reference.points.points.size(); ++i)
    {
        const Eigen::Vector3d p_cur = T_cur_ref * reference.points.points[i].p_cam.mean;
        if (reference.points.isDue(i) && p_cur.z() > 0)
        {
            const Eigen::Vector2d uv_px = frame.camera.project(p_cur);
            out += uv_px.x() >= 0 && uv_px.y() >= 0 && uv_px.x() < frame.camera.width &&
                   uv_px.y() < frame.camera.height;
        }
    }
    return out;
}

/** The camera's motion while it waited for the depth image. */
Eigen::Isometry3d untilDepth(const Vector6d& velocity, double delay)
{
    return se3Exp(std::isfinite(delay) ? Vector6d(delay * velocity) : Vector6d::Zero());
}

/** How the depth image of a reference lies to the current one's. */
struct DepthMotion
{
    Eigen::Isometry3d T_cur_ref;  //!< between the cameras when their depth images were exposed
    double slack_m;               //!< by stamps that are off, of surfaces across the view
    double slackShare;            //!< and of surfaces aslant, in proportion to depth
};

DepthMotion depthMotion(
    const Track& track,
    const Reference& reference,
    const RgbdFrame& current,
    const Motion& motion,
    const ShutterCalibrator& shutter)
{
    const Eigen::Isometry3d T_cur_ref = motion.T_prev_cur.inverse() *
                                        track.previous().T_world_cam.inverse() *
                                        reference.T_world_cam;
    const Eigen::Isometry3d T_depth_cur =
        untilDepth(motion.velocity, shutter.complete(current.shutter).depthDelay).inverse();
    const Eigen::Isometry3d T_ref_depth =
        untilDepth(reference.velocity, shutter.complete(reference.shutter).depthDelay);
    const double speed = motion.velocity.head<3>().norm() + reference.velocity.head<3>().norm();
    const double rate = motion.velocity.tail<3>().norm() + reference.velocity.tail<3>().norm();
    return {T_depth_cur * T_cur_ref * T_ref_depth, kTimeSigma * speed, kTimeSigma * rate};
}

void tell(const Alignment& alignment, FrameDiagnostics& diagnostics)
{
    const PoseEstimate& estimate = alignment.estimate;
    diagnostics.iterations = estimate.iterations;
    diagnostics.numPointPairs = static_cast<int>(alignment.problem.points.size());
    diagnostics.numPlanePairs = static_cast<int>(alignment.problem.planes.size());
    diagnostics.numPointInliers = estimate.numPointInliers;
    diagnostics.pointChi2PerDof = estimate.pointChi2PerDof;
    diagnostics.planeChi2PerDof = estimate.planeChi2PerDof;
    diagnostics.numReferences = static_cast<int>(alignment.associations.size());
    diagnostics.observableDirections = alignment.observableDirections;
    diagnostics.msPose = alignment.msPose;
    diagnostics.surfaceAgreement = alignment.agreement.fraction();
}
}  // namespace

double Alignment::pointShare() const
{
    return static_cast<double>(estimate.numPointInliers) / std::max(numSought, kHandful);
}

struct Aligner::Scene
{
    const FrontEnd& frontEnd;
    const Features& current;
    const Track& track;
    const ErrorModel& errors;
    Prediction predicted;
    PairBuilder pairs;
};

Aligner::Aligner(const OdometryParams& params)
    : params_(params.pipeline),
      fuses_(params.pipeline.fuses()),
      searchesAhead_(params.pipeline.searchesAhead()),
      minOverlap_(params.reference.keyframeMinOverlap),
      solver_(params.poseSolver)
{
}

Alignment Aligner::align(
    const FrontEnd& frontEnd,
    const Features& current,
    Track& track,
    const ErrorModel& errors,
    FrameDiagnostics& diagnostics) const
{
    const Stopwatch watch;
    const Prediction predicted = track.prediction(current.frame.stamp);
    const Scene scene{
        frontEnd, current, track, errors, predicted, PairBuilder(track.previous(), current)};
    // [P17, section Matching] capitalises on small motion.
    const Eigen::Isometry3d expected =
        searchesAhead_ ? predicted.pose.mean : Eigen::Isometry3d::Identity();
    const Motion start{expected, predicted.motion.mean.velocity};
    const bool verifies = params_.leastAgreement > 0;
    Alignment out = attempt(scene, start, Search::Close);
    if (track.overlap(out.associations) < minOverlap_ || (verifies && !isConvincing(scene, out)))
    {
        Alignment wide = attempt(scene, start, Search::Wide);
        if (!verifies || evidence(wide) > evidence(out))
        {
            out = std::move(wide);
        }
        if (params_.searchImages && !isConvincing(scene, out))
        {
            searchImages(scene, out);
        }
    }
    contradict(scene, out);
    tell(out, diagnostics);
    diagnostics.msMatching = watch.ms() - diagnostics.msPose;
    return out;
}

/** Lays the frame over its references near a motion. */
Alignment Aligner::attempt(const Scene& scene, const Motion& start, Search search) const
{
    Alignment out;
    out.predicted = scene.predicted;
    if (search == Search::Close)
    {
        out.associations = associate(scene, start.T_prev_cur, 1);
        estimate(scene, scene.predicted.motion.mean, out);
    }
    else
    {
        out.associations = associate(scene, start.T_prev_cur, kWideSearch);
        estimate(scene, start, out);
        const Motion coarse = out.estimate.motion.mean;
        out.associations = associate(scene, coarse.T_prev_cur, 1);
        estimate(scene, coarse, out);
    }
    judge(out);
    verify(scene, out);
    return out;
}

/** Motions that the images alone tell, until one is convincing. */
void Aligner::searchImages(const Scene& scene, Alignment& best) const
{
    const Eigen::Isometry3d T_prev_world = scene.track.previous().T_world_cam.inverse();
    for (const Reference* reference : scene.track.references())
    {
        const auto motion = scene.frontEnd.alignImages(*reference, scene.current);
        if (!motion)
        {
            continue;
        }
        const Eigen::Isometry3d T_prev_cur =
            T_prev_world * reference->T_world_cam * motion->T_cur_ref.inverse();
        Alignment other =
            attempt(scene, {T_prev_cur, scene.predicted.motion.mean.velocity}, Search::Wide);
        if (evidence(other) > evidence(best))
        {
            best = std::move(other);
        }
        if (isConvincing(scene, best))
        {
            return;
        }
    }
}

std::optional<int> Aligner::recognise(
    const FrontEnd& frontEnd, const Features& current, const Track& track) const
{
    if (!params_.searchImages)
    {
        return {};
    }
    for (auto place = track.places().rbegin(); place != track.places().rend(); ++place)
    {
        const auto motion = frontEnd.alignImages(*place, current);
        if (motion &&
            frontEnd.compare(*place, current, motion->T_cur_ref, 0).fraction() > kRecognised)
        {
            return place->id;
        }
    }
    return {};
}

std::vector<Association> Aligner::associate(
    const Scene& scene, const Eigen::Isometry3d& T_prev_cur, double radiusFactor)
{
    std::vector<Association> out;
    const Eigen::Isometry3d T_cur_world =
        T_prev_cur.inverse() * scene.track.previous().T_world_cam.inverse();
    for (const Reference* reference : scene.track.references())
    {
        out.push_back(scene.frontEnd.associate(
            *reference, scene.current, T_cur_world * reference->T_world_cam, radiusFactor));
    }
    return out;
}

/** The paper counts points and planes; with a prediction to fuse with, any of them helps. */
int Aligner::minMatches() const { return fuses_ ? 1 : kMinMatches; }

/** From the associations; the prediction where there is too little to estimate from. */
void Aligner::estimate(const Scene& scene, const Motion& start, Alignment& alignment) const
{
    const Stopwatch watch;
    PoseProblem& problem = alignment.problem;
    scene.pairs.build(
        alignment.associations, scene.errors.shutter(), problem.points, problem.planes);
    problem.prior = scene.predicted.prior;
    problem.noise = scene.errors.noise();
    PoseEstimate out;
    out.motion = scene.predicted.motion;
    if (static_cast<int>(alignment.numMatches()) >= minMatches())
    {
        out = solver_.solve(problem, start);
    }
    out.iterations += alignment.estimate.iterations;
    alignment.estimate = out;
    alignment.msPose += watch.ms();
}

/** Is the estimate to be believed? */
void Aligner::judge(Alignment& alignment) const
{
    const PoseEstimate& estimate = alignment.estimate;
    const PoseGaussian& predicted = alignment.predicted.pose;
    alignment.observableDirections =
        observableDirections(estimate.infoPoints + estimate.infoPlanes, predicted.cov);
    const auto matches = static_cast<int>(alignment.numMatches());
    const double sigma = maxSigma(estimate.pose().cov);
    std::ostringstream reason;
    if (matches < minMatches())
    {
        reason << "too few points and planes are found again: " << matches;
    }
    else if (!fuses_)
    {
        // [P17, section Pose estimation]: the largest eigenvalue, and nothing else.
        alignment.holds = sigma <= params_.gateSigma;
        if (!alignment.holds)
        {
            reason << "the pose is too uncertain: its largest standard deviation " << sigma
                   << " is above gateSigma";
        }
    }
    else if (alignment.observableDirections == 0)
    {
        reason << "points and planes tell no direction better than the prediction does";
    }
    else
    {
        alignment.holds = true;
        if (alignment.observableDirections < 6)
        {
            reason << "only " << alignment.observableDirections
                   << " of 6 directions are measured, the others are predicted";
        }
    }
    alignment.reason = reason.str();
}

/** Asks the depth image, and counts the points that should be in view. */
void Aligner::verify(const Scene& scene, Alignment& alignment)
{
    const Motion& motion = alignment.estimate.motion.mean;
    const Eigen::Isometry3d T_cur_world =
        motion.T_prev_cur.inverse() * scene.track.previous().T_world_cam.inverse();
    for (const Reference* reference : scene.track.references())
    {
        alignment.numSought +=
            numInView(*reference, scene.current.frame, T_cur_world * reference->T_world_cam);
        if (alignment.agreement.seen() < kEnoughSurfaces)
        {
            const DepthMotion depth = depthMotion(
                scene.track, *reference, scene.current.frame, motion, scene.errors.shutter());
            alignment.agreement +=
                scene.frontEnd.compare(*reference, scene.current, depth.T_cur_ref, depth.slack_m);
        }
    }
}

MovingRegions Aligner::findMoving(
    const FrontEnd& frontEnd,
    const Features& current,
    const Track& track,
    const ErrorModel& errors,
    const Alignment& alignment)
{
    std::vector<EarlierView> earlier;
    for (const Reference* reference : track.references())
    {
        if (reference->images)
        {
            const DepthMotion depth = depthMotion(
                track, *reference, current.frame, alignment.estimate.motion.mean, errors.shutter());
            earlier.push_back(
                {&reference->images->frame,
                 depth.T_cur_ref.inverse(),
                 depth.slack_m,
                 depth.slackShare});
        }
    }
    return frontEnd.findMoving(current, earlier);
}

bool Aligner::isConvincing(const Scene& scene, const Alignment& a) const
{
    const NoiseFactors usual = scene.errors.usual();
    const int worth = a.estimate.numPointInliers + 3 * static_cast<int>(a.problem.planes.size());
    return a.holds && worth >= kFewPoints && a.agreement.fraction() > kConvincingSurfaces &&
           a.agreement.fraction() + a.pointShare() > kConvincingTogether &&
           a.estimate.pointChi2PerDof < kConvincingRise * usual.points &&
           a.estimate.planeChi2PerDof < kConvincingRise * usual.planes;
}

/** The last word: surfaces that should be in view and are not; matches that might be any. */
void Aligner::contradict(const Scene& scene, Alignment& alignment) const
{
    if (!alignment.holds || !fuses_)
    {
        return;
    }
    std::ostringstream reason;
    const double agreement = alignment.agreement.fraction();
    const double farOff = surprise(alignment.estimate, scene.predicted.pose);
    if (alignment.agreement.seen() > 0 && agreement < params_.leastAgreement)
    {
        reason << "the depth image shows only " << std::lround(100 * agreement)
               << " % of the surfaces where the motion of " << alignment.numMatches()
               << " points and planes puts them";
    }
    else if (farOff > kMostSurprise && !isConvincing(scene, alignment))
    {
        reason << "the motion is " << std::lround(farOff)
               << " standard deviations from the predicted one, and too little confirms it";
    }
    else if (
        isUncertain(scene.predicted.pose.cov) && alignment.numSought >= kHandful &&
        alignment.estimate.numPointInliers < kFewPoints && agreement <= kConvincingTogether)
    {
        reason << "only " << alignment.estimate.numPointInliers << " of " << alignment.numSought
               << " points in view agree with the motion of " << alignment.problem.planes.size()
               << " planes, " << scene.predicted.dt << " s after the previous measured frame";
    }
    if (!reason.str().empty())
    {
        alignment.reason = reason.str();
        alignment.holds = false;
    }
}
}  // namespace pointplane
