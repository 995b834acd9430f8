// SPDX-License-Identifier: BSD-3-Clause
#include "Aligner.h"

#include <pointplane/core/PoseGaussian.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "Stopwatch.h"
#include "by_chance.h"
#include "depth_motion.h"
#include "image_motions.h"
#include "points_in_view.h"
#include "surfaces.h"

namespace pointplane
{
namespace
{
/** When too little is found again around the prediction: radius in which points are searched for,
 * and residual up to which they count at the start, over the usual ones. */
constexpr double kWideSearch = 5;

/** Of two motions, as a covariance of the pose (left perturbation). */
Matrix6d squareOfDistance(const Motion& a, const Motion& b)
{
    const Vector6d apart = leftError(a.T_prev_cur, b.T_prev_cur);
    return apart * apart.transpose();
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
      windowPx_(params.pointTracker.windowPx),
      memory_(params.noiseScale.timeConstant),
      solver_(params.poseSolver),
      judge_(params)
{
}

Alignment Aligner::align(
    const FrontEnd& frontEnd,
    const Features& current,
    const Track& track,
    const ErrorModel& errors,
    FrameDiagnostics& diagnostics) const
{
    const Stopwatch watch;
    const Prediction predicted = track.prediction(current.frame.stamp);
    const Scene scene{
        frontEnd,
        current,
        track,
        errors,
        predicted,
        PairBuilder(track.previous(), current, errors.camera())};
    Alignment out = findMotion(scene);
    settle(scene, out);
    tell(out, diagnostics);
    diagnostics.msMatching = watch.ms() - diagnostics.msPose;
    return out;
}

/** Searches close to the prediction, then farther away, then in the whole images: until a motion is
 * convincing. */
Alignment Aligner::findMotion(const Scene& scene) const
{
    // [P17, section Matching] capitalises on small motion.
    const Eigen::Isometry3d expected =
        searchesAhead_ ? scene.predicted.pose.mean : Eigen::Isometry3d::Identity();
    const Motion start{expected, scene.predicted.motion.mean.velocity};
    const NoiseFactors usual = scene.errors.usual();
    const bool verifies = params_.leastAgreement > 0;
    Alignment out = attempt(scene, start, Search::Close);
    if (scene.track.overlap(out.associations, scene.current) >= minOverlap_ &&
        (!verifies || Judge::needsNoOther(out, usual)))
    {
        return out;
    }
    Alignment wide = attempt(scene, start, Search::Wide);
    if (verifies)
    {
        Judge::keepBetter(out, std::move(wide), usual);
    }
    else
    {
        wide.marks.insert(wide.marks.end(), out.marks.begin(), out.marks.end());
        out = std::move(wide);
    }
    if (params_.searchImages && !Judge::needsNoOther(out, usual))
    {
        searchImages(scene, out);
    }
    return out;
}

/** Whether the motion is believed, and without which points. */
void Aligner::settle(const Scene& scene, Alignment& alignment) const
{
    if (alignment.unsettled.empty() && !scene.frontEnd.marks().areKnown() &&
        !alignment.marks.empty())
    {
        alignment.unsettled =
            "points stand in the image while the depth behind them changes: either they are fixed "
            "to the image, or its depth is wrong";
    }
    const NoiseFactors usual = scene.errors.usual();
    judge_.contradict(alignment, usual);
    if (restsOnChance(alignment))
    {
        distrustPoints(scene, alignment);
        if (!alignment.doubt)
        {
            verify(scene, alignment);
            judge_.contradict(alignment, usual);
        }
    }
}

/** Lays the frame over its references near a motion. */
Alignment Aligner::attempt(const Scene& scene, const Motion& start, Search search) const
{
    Alignment out;
    out.predicted = scene.predicted;
    Motion sought = start;                       // where features are searched for
    Motion first = scene.predicted.motion.mean;  // where the solver starts
    const double reach = search == Search::Wide ? kWideSearch : 1;
    if (search == Search::Wide)
    {
        out.associations = associate(scene, start.T_prev_cur, reach);
        estimate(scene, start, out, reach);
        sought = first = out.estimate.motion.mean;
    }
    out.associations = associate(scene, sought.T_prev_cur, 1);
    estimate(scene, first, out, reach);
    searchAgain(scene, sought.T_prev_cur, first, out);
    judge_.judge(out);
    settleRivals(scene, out);
    verify(scene, out);
    out.marks = marksIn(out.associations);
    return out;
}

/** Points beyond the search radius are not found, and those within it pull the motion to where they
 * were searched for. So they are searched for again around the estimate, while more of them agree.
 * \param T_prev_cur where they were searched for
 * \param first where the solver starts */
void Aligner::searchAgain(
    const Scene& scene,
    Eigen::Isometry3d T_prev_cur,
    const Motion& first,
    Alignment& alignment) const
{
    const RgbdFrame& frame = scene.current.frame;
    const double radius_px = scene.frontEnd.searchRadius_px(frame);
    while (fuses_ &&
           areNearEdge(
               alignment.associations, frame.camera, scene.track.fromWorld(T_prev_cur), radius_px))
    {
        T_prev_cur = alignment.estimate.motion.mean.T_prev_cur;
        Alignment again;
        again.predicted = alignment.predicted;
        again.estimate.iterations = alignment.estimate.iterations;
        again.msPose = alignment.msPose;
        again.associations = associate(scene, T_prev_cur, 1);
        estimate(scene, first, again);
        if (again.estimate.numPointInliers <= alignment.estimate.numPointInliers)
        {
            return;
        }
        alignment = std::move(again);
    }
}

/** Takes another motion than the estimated one if that explains more surface. */
void Aligner::settleRivals(const Scene& scene, Alignment& alignment) const
{
    if (!fuses_ || !alignment.holds)
    {
        return;
    }
    const auto rivalry =
        findRivalry(solver_, alignment.problem, alignment.estimate, scene.errors.usual());
    if (!rivalry || (rivalry->firstWins() && rivalry->isClear()))
    {
        return;  // what moves has no weight
    }
    leaveLoserOut(*rivalry, alignment.associations);
    estimate(scene, rivalry->winner(), alignment);
    judge_.judge(alignment);
    alignment.unsettled = Judge::whyUnsettled(*rivalry);
    if (!rivalry->firstWins() && scene.predicted.followsMeasured)
    {
        alignment.turn = squareOfDistance(rivalry->first, alignment.estimate.motion.mean);
    }
}

/** Whether points that may agree by chance decide a direction. */
bool Aligner::restsOnChance(const Alignment& alignment) const
{
    return fuses_ && alignment.holds && Judge::mayBeChance(alignment) &&
           solver_.pointSupport(alignment.problem, alignment.estimate) < kFewPoints;
}

/** Planes and prediction tell the motion without the points. If the prediction does not confirm it,
 * these points are the best guess: the motion stays. It may be the other one as well, so their
 * distance adds to the covariance that it has without them. */
void Aligner::distrustPoints(const Scene& scene, Alignment& alignment) const
{
    const Motion motion = alignment.estimate.motion.mean;
    const std::string fewAgree = Judge::fewPointsAgree(alignment);
    for (Association& association : alignment.associations)
    {
        association.doubtedPoints.insert(
            association.doubtedPoints.end(), association.points.begin(), association.points.end());
        association.points.clear();
    }
    estimate(scene, motion, alignment);
    if (!Judge::isConfirmed(alignment))
    {
        alignment.doubt = squareOfDistance(motion, alignment.estimate.motion.mean);
        alignment.estimate.motion.mean = motion;
    }
    judge_.judge(alignment);
    if (!alignment.holds)
    {
        alignment.reason = fewAgree;
    }
}

/** Motions that the images alone tell, until one is convincing, or leads to the motion that was
 * found already: by their points, and where these tell none, by their planes. */
void Aligner::searchImages(const Scene& scene, Alignment& best) const
{
    for (const bool byPoints : {true, false})
    {
        bool isFound = false;
        for (const Reference* reference : scene.track.references())
        {
            const auto T_prev_cur =
                byPoints ? motionOfPoints(scene.frontEnd, scene.current, scene.track, *reference)
                         : motionOfPlanes(
                               scene.frontEnd,
                               scene.current,
                               scene.track,
                               *reference,
                               scene.predicted.pose);
            if (!T_prev_cur)
            {
                continue;
            }
            isFound = true;
            const Motion start{*T_prev_cur, scene.predicted.motion.mean.velocity};
            Alignment other = attempt(scene, start, Search::Wide);
            const bool isKnown = Judge::areSame(best, other);
            Judge::keepBetter(best, std::move(other), scene.errors.usual());
            if (isKnown || Judge::needsNoOther(best, scene.errors.usual()))
            {
                return;
            }
        }
        if (isFound)
        {
            return;
        }
    }
}

std::vector<Association> Aligner::associate(
    const Scene& scene, const Eigen::Isometry3d& T_prev_cur, double radiusFactor)
{
    std::vector<Association> out;
    const Eigen::Isometry3d T_cur_world = scene.track.fromWorld(T_prev_cur);
    for (const Reference* reference : scene.track.references())
    {
        out.push_back(scene.frontEnd.associate(
            *reference, scene.current, T_cur_world * reference->T_world_cam, radiusFactor));
    }
    return out;
}

/** From the associations; the prediction where there is too little to estimate from. */
void Aligner::estimate(
    const Scene& scene, const Motion& start, Alignment& alignment, double startWidening) const
{
    const Stopwatch watch;
    PoseProblem& problem = alignment.problem;
    scene.pairs.build(alignment.associations, windowPx_, problem);
    problem.prior = scene.predicted.prior;
    problem.noise = scene.errors.noise();
    if (fuses_)
    {
        problem.surfaces = rememberedInliers(alignment.associations, scene.current, memory_);
    }
    PoseEstimate out;
    out.motion = scene.predicted.motion;
    if (static_cast<int>(alignment.numMatches()) >= judge_.minMatches())
    {
        out = solver_.solve(problem, start, startWidening);
    }
    out.iterations += alignment.estimate.iterations;
    alignment.estimate = out;
    alignment.msPose += watch.ms();
}

/** Asks the depth image without what has moved, and counts the points that should be in view of the
 * colour image. */
void Aligner::verify(const Scene& scene, Alignment& alignment)
{
    const Motion& motion = alignment.estimate.motion.mean;
    const Eigen::Isometry3d T_cur_world = scene.track.fromWorld(motion.T_prev_cur);
    const std::vector<InlierRatio>& surfaces = alignment.problem.surfaces;
    const RgbdFrame still = withoutMoved(scene.current, surfaces);
    alignment.agreement = {};
    alignment.numSought = 0;
    for (const Association& association : alignment.associations)
    {
        const Reference& reference = *association.reference;
        if (!still.gray.empty())
        {
            alignment.numSought +=
                numInView(reference, still.camera, T_cur_world * reference.T_world_cam);
        }
        const auto samples = stillSamples(association, surfaces);
        if (samples && scene.current.hasDepth &&
            alignment.agreement.seen() < Judge::kEnoughSurfaces)
        {
            const DepthMotion depth =
                depthMotion(scene.track, reference, still, motion, scene.errors.camera());
            alignment.agreement +=
                scene.frontEnd.compare(*samples, still, depth.T_cur_ref, depth.slack_m);
        }
    }
    for (const Association& association : alignment.associations)
    {
        // Those that ImageMarks left out cannot confirm a motion, nor contradict it.
        const size_t leftOut = association.fixedPoints.size() + association.doubtedPoints.size();
        alignment.numSought = std::max(0, alignment.numSought - static_cast<int>(leftOut));
    }
}
}  // namespace pointplane
