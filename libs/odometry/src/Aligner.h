// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/Features.h>
#include <pointplane/odometry/MovingRegions.h>
#include <pointplane/odometry/OdometryParams.h>
#include <pointplane/odometry/OdometryResult.h>
#include <pointplane/odometry/PairBuilder.h>
#include <pointplane/odometry/Verdict.h>
#include <pointplane/pose/PoseSolver.h>

#include <optional>
#include <string>
#include <vector>

#include "FrontEnd.h"
#include "Track.h"
#include "uncertainty/ErrorModel.h"

namespace pointplane
{
/** A frame laid over its references. */
struct Alignment
{
    Prediction predicted;
    std::vector<Association> associations;
    PoseProblem problem;  //!< the pairs that they make
    PoseEstimate estimate;
    int observableDirections{0};  //!< of 6, measured better than predicted
    Agreement agreement;          //!< of the surfaces seen before with this frame's depth image
    int numSought{0};             //!< points of the references that should be in view
    bool holds{false};            //!< the estimate is to be believed
    double msPose{0};             //!< time that solving took [ms]
    std::string reason;           //!< why not, or what of it is predicted

    [[nodiscard]] size_t numMatches() const
    {
        return problem.points.size() + problem.planes.size();
    }

    /** Part of the points in view that agrees with the estimate; of a handful, less. */
    [[nodiscard]] double pointShare() const;
};

/** Matching and pose estimation with its validation [P17, section Pose estimation]. Points and
 * planes are looked for where the predicted motion puts them; where that leads nowhere, farther
 * off, and then where the images alone put them. The depth image, which took no part, has the last
 * word. */
class Aligner
{
 public:
    explicit Aligner(const OdometryParams& params);

    /** \param track where references and prediction come from */
    [[nodiscard]] Alignment align(
        const FrontEnd& frontEnd,
        const Features& current,
        Track& track,
        const ErrorModel& errors,
        FrameDiagnostics& diagnostics) const;

    /** The place in which the camera is again, or nothing. */
    [[nodiscard]] std::optional<int> recognise(
        const FrontEnd& frontEnd, const Features& current, const Track& track) const;

    /** What has moved in front of the camera since its references. \pre the alignment holds */
    [[nodiscard]] static MovingRegions findMoving(
        const FrontEnd& frontEnd,
        const Features& current,
        const Track& track,
        const ErrorModel& errors,
        const Alignment& alignment);

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
        Wide    //!< farther, for a first guess, and then closely
    };

    [[nodiscard]] Alignment attempt(const Scene& scene, const Motion& start, Search search) const;
    void searchImages(const Scene& scene, Alignment& best) const;
    [[nodiscard]] static std::vector<Association> associate(
        const Scene& scene, const Eigen::Isometry3d& T_prev_cur, double radiusFactor);
    void estimate(const Scene& scene, const Motion& start, Alignment& alignment) const;
    void judge(Alignment& alignment) const;
    static void verify(const Scene& scene, Alignment& alignment);
    [[nodiscard]] bool isConvincing(const Scene& scene, const Alignment& alignment) const;
    void contradict(const Scene& scene, Alignment& alignment) const;
    [[nodiscard]] int minMatches() const;

    PipelineParams params_;
    bool fuses_, searchesAhead_;
    double minOverlap_;
    PoseSolver solver_;
};
}  // namespace pointplane
