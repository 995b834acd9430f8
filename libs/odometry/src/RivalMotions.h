// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/pose/PoseSolver.h>

#include <optional>
#include <vector>

#include "Reference.h"

namespace pointplane
{
/** With which of two motions a pair of features agrees. */
enum class Side
{
    Both,
    First,   //!< and contradicts the second
    Second,  //!< and contradicts the first
    Neither
};

/** Two motions that explain different features of one frame. */
struct Rivalry
{
    Motion first, second;
    std::vector<Side> points, planes;    //!< of the problem's pairs
    double areaFirst{0}, areaSecond{0};  //!< that only one of them explains [m^2]

    [[nodiscard]] bool firstWins() const { return areaFirst >= areaSecond; }
    [[nodiscard]] const Motion& winner() const { return firstWins() ? first : second; }

    /** Whether the winner explains at least half as much again. */
    [[nodiscard]] bool isClear() const;
};

/** Looks for a second motion in what disagrees with an estimate.
 *
 * What moves is a motion of its own, and may have more corners than the still world. So corners do
 * not decide which of two motions is the camera's, but the surface that they stand for: what is
 * large stands still. Each point stands for a cell of the view at its depth.
 * \param estimate that the solver made of the problem
 * \param usual variance of the residuals so far, over the propagated one
 * \return nothing if too little disagrees, or if it does not agree about a motion */
[[nodiscard]] std::optional<Rivalry> findRivalry(
    const PoseSolver& solver,
    const PoseProblem& problem,
    const PoseEstimate& estimate,
    const NoiseFactors& usual);

/** Moves what does not go with the winner to what moves: the loser's planes and points, and points
 * of neither. \param associations that the problem was built from */
void leaveLoserOut(const Rivalry& rivalry, std::vector<Association>& associations);
}  // namespace pointplane
