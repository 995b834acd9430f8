// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Trajectory.h>

#include <string>

namespace pointplane
{
/** \param offset added to the estimate's stamps [s]
 * \throws std::runtime_error if the two do not overlap in time (it names both ranges), or if one
 * has fewer than two poses \throws std::invalid_argument if one is not as Trajectory says: its
 * stamps are not in order, or its lists differ in length */
void checkOverlap(const Trajectory& groundTruth, const Trajectory& estimate, double offset);

/** ", estimate's stamps +0.5 s and translations times 2": a score of it is that of another
 * estimate. Empty where neither is changed. */
[[nodiscard]] std::string describeChanges(double offset, double scale);

/** Whether positions are where double resolves them to a micrometre; beyond, errors lose
 * their digits, and those of a run that is stuck out there would be 0. \param scale of the
 * positions \throws std::runtime_error naming file and stamp */
void checkPositions(const Trajectory& trajectory, double scale = 1);
}  // namespace pointplane
