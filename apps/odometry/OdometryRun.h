// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/OdometryParams.h>

#include <iosfwd>

#include "OdometryOptions.h"
#include "RunSummary.h"

namespace pointplane
{
/** Reads, estimates and writes, each in its own thread (jobs > 1) or in turns; the bytes written
 * are the same. \param err progress and problems of single frames \throws InputError,
 * EnvironmentError; what was written before stays readable */
[[nodiscard]] RunSummary runOdometry(
    const OdometryOptions& options, const OdometryParams& params, std::ostream& err);
}  // namespace pointplane
