// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "EnvelopeScore.h"

namespace pointplane
{
/** What our first method makes of each sequence, a line per sequence: the median of its conditions
 * beside that of the best peers; more if there is one condition. Markdown.
 * \param scores as of envelopeTables() */
[[nodiscard]] std::string envelopeOverview(const std::vector<EnvelopeScore>& scores);
}  // namespace pointplane
