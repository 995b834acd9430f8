// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/MovingRegions.h>
#include <pointplane/odometry/OdometryParams.h>
#include <pointplane/pose/PoseSolver.h>

#include <string>

#include "Alignment.h"
#include "RivalMotions.h"
#include "surface_comparison.h"

namespace pointplane
{
/** Is an alignment to be believed (docs/theory.md, section Verdict)? */
class Judge
{
 public:
    explicit Judge(const OdometryParams& params);

    /** Fewest matches to estimate a motion from. */
    [[nodiscard]] int minMatches() const;

    /** By what the estimate says of itself: sets `holds`, `observableDirections`,
     * `isPredictionWeak`, `reason`. */
    void judge(Alignment& alignment) const;

    /** The last word: surfaces that should be in view and are not; matches that might be any.
     * \param usual variance of the residuals so far, over the propagated one */
    void contradict(Alignment& alignment, const NoiseFactors& usual) const;

    /** Of two alignments of a frame, keeps the one that more speaks for. From here on, points that
     * either put into view count as sought: the few that are left in view of a motion that looks
     * away from the others do not confirm it.
     * \param usual variance of the residuals so far, over the propagated one */
    static void keepBetter(Alignment& best, Alignment other, const NoiseFactors& usual);

    /** Whether two alignments of a frame hold, and each is within the other's standard deviation.
     */
    [[nodiscard]] static bool areSame(const Alignment& a, const Alignment& b);

    /** Whether it is believed even far from the prediction. */
    [[nodiscard]] static bool isConvincing(const Alignment& alignment, const NoiseFactors& usual);

    /** Whether it is convincing and needs no comparison with others: points in view agree, too. */
    [[nodiscard]] static bool needsNoOther(const Alignment& alignment, const NoiseFactors& usual);

    /** Whether enough surfaces are compared, and agree as they do with a right motion. */
    [[nodiscard]] static bool areConvincing(const Agreement& surfaces);

    /** Whether a motion from the previous frame is too far from the predicted one to be believed
     * for its own sake. */
    [[nodiscard]] static bool isSurprising(
        const Eigen::Isometry3d& T_prev_cur, const PoseGaussian& predicted);

    /** Likewise of an estimate, in the directions that are measured. */
    [[nodiscard]] static bool isSurprising(const Alignment& alignment);

    /** Why the winner of two motions is not believed to be the camera's, or empty: its surface is
     * not clearly larger. */
    [[nodiscard]] static std::string whyUnsettled(const Rivalry& rivalry);

    /** Whether so much has moved in front of the camera that only a new key frame can tell a right
     * motion from a wrong one. */
    [[nodiscard]] static bool needsNewView(const Alignment& alignment, const MovingRegions& moving);

    /** Whether the prediction tells that a motion is right, as far as surfaces can contradict it,
     * or most points in view. */
    [[nodiscard]] static bool isConfirmed(const Alignment& alignment);

    /** Whether a direction that few points decide may be wrong: the motion is not confirmed, or
     * hardly any of the points in view agrees with it. */
    [[nodiscard]] static bool mayBeChance(const Alignment& alignment);

    /** The reason of a frame that is not believed because of that. */
    [[nodiscard]] static std::string fewPointsAgree(const Alignment& alignment);

    /** Of the surfaces in view, nine tenths agree with a right motion and a third with one that is
     * wrong by 5 cm or 5 deg (docs/theory.md, "Verdict"): so much is between. */
    static constexpr double kConvincingSurfaces = 0.75;

    /** So many surfaces are enough to compare: a tenth of a view of 4:3. */
    static constexpr int kEnoughSurfaces = static_cast<int>(
        MovingRegions::kSureShare * PixelGrid::kSamples * PixelGrid::kSamples * 3 / 4);
    static_assert(kEnoughSurfaces == 480);

 private:
    /** Whether a predicted pose does not tell which feature is which. */
    [[nodiscard]] bool isUncertain(const PoseGaussian& predicted) const;

    PipelineParams params_;
    bool fuses_;
    double sameDistance_, sameAngle_;  //!< planes that near and that parallel may be mixed up
};
}  // namespace pointplane
