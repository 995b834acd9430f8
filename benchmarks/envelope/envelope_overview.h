// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "EnvelopeScore.h"

namespace pointplane
{
/** What our first method makes of each sequence under each condition, beside the best peer. A line
 * per condition, a column per sequence. Markdown.
 * \param scores as of envelopeTables() */
[[nodiscard]] std::string envelopeOverview(const std::vector<EnvelopeScore>& scores);
}  // namespace pointplane
