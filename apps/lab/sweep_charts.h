// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/HtmlReport.h>

#include <string>
#include <vector>

#include "lab_runs.h"

namespace pointplane
{
/** How the values of a parameter stand on the horizontal axis. */
enum class ValueAxis
{
    Linear,
    Log,
    Names  //!< one beside the other, each named; words always
};

/** RPE RMSE over the values of a parameter, a curve per sequence: translation and rotation.
 * \param scores of sequence s and value v at [s * values.size() + v] */
[[nodiscard]] std::vector<Chart> sweepCharts(
    const std::string& parameter,
    const std::vector<std::string>& values,
    const std::vector<std::string>& sequences,
    const std::vector<LabScore>& scores,
    ValueAxis axis);
}  // namespace pointplane
