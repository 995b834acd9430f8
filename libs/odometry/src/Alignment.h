// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/pose/PoseSolver.h>

#include <optional>
#include <string>
#include <vector>

#include "ImageMarks.h"
#include "PairBuilder.h"
#include "Track.h"
#include "surface_agreement.h"

namespace pointplane
{
/** A frame compared with its references: matches, motion, and whether it is to be believed. */
struct Alignment
{
    Prediction predicted;
    std::vector<Association> associations;
    PoseProblem problem;  //!< the pairs that they make
    PoseEstimate estimate;
    int observableDirections{0};   //!< of 6, measured better than predicted
    bool isPredictionWeak{false};  //!< the prediction does not tell which feature is which
    Agreement agreement;           //!< of the surfaces seen before with this frame's depth image
    int numSought{0};              //!< points of the references that should be in view
    /** Of a motion by points that neither `problem` nor the covariance contains: how far they may
     * be wrong, by the motion that is estimated without them; a covariance of the pose (left
     * perturbation, m, rad). The motion is no minimum of `problem` then. */
    std::optional<Matrix6d> doubt;
    /** Of a motion that is not the one that most features follow: how far apart the two are, as a
     * covariance like `doubt`. The frames before may have followed the other one. */
    std::optional<Matrix6d> turn;
    std::vector<Mark> marks;  //!< of this and of other attempts at the frame
    std::string unsettled;    //!< why another motion may be the camera's (RivalMotions), or empty
    bool holds{false};        //!< the estimate is to be believed
    double msPose{0};         //!< time that solving took [ms]
    std::string reason;       //!< why it does not hold, or how much of it is predicted

    [[nodiscard]] size_t numMatches() const
    {
        return problem.points.size() + problem.planes.size();
    }
};
}  // namespace pointplane
