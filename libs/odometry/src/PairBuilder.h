// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/pose/PoseSolver.h>

#include <vector>

#include "Features.h"
#include "Reference.h"

namespace pointplane
{
class CameraCalibrator;

/** Turns associations into pairs for the solver. References are moved into the camera of the
 * previous frame and freed from the rolling shutter. Of the current frame, pairs say how
 * they depend on its velocity. What was learnt of the camera is corrected. */
class PairBuilder
{
 public:
    /** \param previous, current, learnt must live as long as this */
    PairBuilder(const Reference& previous, const Features& current, const CameraCalibrator& learnt)
        : previous_(previous), current_(current), learnt_(learnt)
    {
    }

    /** Replaces the problem's pairs by those of all associations.
     * \param windowPx side of the patches that were searched for [px]. Corners of several
     * references whose patches share half a side see the same pixels: they count as one. */
    void build(
        const std::vector<Association>& associations, int windowPx, PoseProblem& problem) const;

    /** Adds how the pairs change with errors of the camera, once the motion is known. From
     * then on, dRef_dV is that of CameraCalibrator::rootMeanSquare().
     * \param problem that build() has made of the same associations */
    void addCameraErrors(
        const std::vector<Association>& associations,
        const Motion& motion,
        PoseProblem& problem) const;

 private:
    const Reference& previous_;
    const Features& current_;
    const CameraCalibrator& learnt_;
};
}  // namespace pointplane
