// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/OdometryResult.h>

#include "Aligner.h"
#include "Alignment.h"
#include "FrontEnd.h"
#include "Track.h"
#include "uncertainty/ErrorModel.h"

namespace pointplane
{
/** Compares a frame with the references, else with an older key frame that it recognises, else with
 * the latest frame that matched none.
 * \param track changes if the motion holds with another reference */
[[nodiscard]] Alignment alignSomewhere(
    const Aligner& aligner,
    const FrontEnd& frontEnd,
    const Features& current,
    const ErrorModel& errors,
    Track& track,
    FrameDiagnostics& diagnostics);
}  // namespace pointplane
