// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/PairBuilder.h>
#include <pointplane/odometry/surface_agreement.h>
#include <pointplane/pose/PoseSolver.h>

#include <string>
#include <vector>

#include "ImageMarks.h"
#include "Track.h"

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
    /** The motion was estimated with points that neither `problem` nor the covariance contains. So
     * it is no minimum of `problem`. */
    bool isOfDoubtedPoints{false};
    /** How far they may be wrong: squared distance from the motion that is estimated without them.
     */
    Matrix6d doubt{Matrix6d::Zero()};
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
