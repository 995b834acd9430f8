// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/Features.h>
#include <pointplane/odometry/OdometryParams.h>
#include <pointplane/odometry/OdometryResult.h>
#include <pointplane/pose/PoseSolver.h>

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
    bool holds{false};   //!< the estimate is to be believed
    std::string reason;  //!< why not, or what of it is predicted
};

/** Matching and pose estimation with its validation [P17, section Pose estimation]. */
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

    [[nodiscard]] PoseAnalysis analyse(const Alignment& alignment) const
    {
        return solver_.analyse(alignment.problem, alignment.estimate);
    }

 private:
    [[nodiscard]] static std::vector<Association> associate(
        const FrontEnd& frontEnd,
        const Features& current,
        const Track& track,
        const Eigen::Isometry3d& T_prev_cur,
        double radiusFactor);
    void estimate(
        Alignment& alignment,
        const PairBuilder& pairs,
        const ErrorModel& errors,
        FrameDiagnostics& diagnostics) const;
    void judge(Alignment& alignment, FrameDiagnostics& diagnostics) const;
    [[nodiscard]] int minMatches() const;

    PipelineParams params_;
    bool fuses_, searchesAhead_;
    double minOverlap_;
    PoseSolver solver_;
};
}  // namespace pointplane
