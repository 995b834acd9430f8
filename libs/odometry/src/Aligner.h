// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/OdometryParams.h>
#include <pointplane/odometry/OdometryResult.h>
#include <pointplane/pose/PoseSolver.h>

#include <vector>

#include "Alignment.h"
#include "Features.h"
#include "FrontEnd.h"
#include "Judge.h"
#include "RivalMotions.h"
#include "Track.h"
#include "uncertainty/ErrorModel.h"

namespace pointplane
{
/** Matches a frame, estimates its pose and judges the estimate [P17, section Pose estimation].
 * Points and planes are searched for where the predicted motion puts them. If that fails, they are
 * searched for farther away, then where a motion puts them that the images alone tell. The rest
 * of the depth image, which took no part, has the last word. */
class Aligner
{
 public:
    explicit Aligner(const OdometryParams& params);

    /** \param track where references and prediction come from */
    [[nodiscard]] Alignment align(
        const FrontEnd& frontEnd,
        const Features& current,
        const Track& track,
        const ErrorModel& errors,
        FrameDiagnostics& diagnostics) const;

    /** Whether motions are searched for in the whole images. */
    [[nodiscard]] bool searchesImages() const { return params_.searchImages; }

    [[nodiscard]] PoseAnalysis analyse(const Alignment& alignment) const
    {
        return solver_.analyse(alignment.problem, alignment.estimate);
    }

 private:
    /** What all attempts at a frame share. */
    struct Scene;
    enum class Search
    {
        Close,  //!< around where a motion puts the features
        Wide    //!< farther away for a first guess, then closely around that
    };

    [[nodiscard]] Alignment findMotion(const Scene& scene) const;
    void settle(const Scene& scene, Alignment& alignment) const;
    [[nodiscard]] Alignment attempt(const Scene& scene, const Motion& start, Search search) const;
    void searchAgain(
        const Scene& scene,
        Eigen::Isometry3d T_prev_cur,
        const Motion& first,
        Alignment& alignment) const;
    void settleRivals(const Scene& scene, Alignment& alignment) const;
    [[nodiscard]] bool restsOnChance(const Alignment& alignment) const;
    void distrustPoints(const Scene& scene, Alignment& alignment) const;
    void searchImages(const Scene& scene, Alignment& best) const;
    [[nodiscard]] static std::vector<Association> associate(
        const Scene& scene, const Eigen::Isometry3d& T_prev_cur, double radiusFactor);
    void estimate(
        const Scene& scene,
        const Motion& start,
        Alignment& alignment,
        double startWidening = 1) const;
    static void verify(const Scene& scene, Alignment& alignment);

    PipelineParams params_;
    bool fuses_, searchesAhead_;
    double minOverlap_;
    int windowPx_;
    double memory_;
    PoseSolver solver_;
    Judge judge_;
};
}  // namespace pointplane
