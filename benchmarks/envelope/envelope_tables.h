// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "EnvelopeScore.h"

namespace pointplane
{
/** What counts over all sequences, a line per method and per condition, and the cells in which our
 * first method is behind a peer. Markdown. */
[[nodiscard]] std::string envelopeSummary(const std::vector<EnvelopeScore>& scores);

/** A heading and a table per sequence: our first method, then what the others make of it. Markdown.
 * \param scores method by method within a condition, condition by condition within a sequence */
[[nodiscard]] std::string envelopeTables(const std::vector<EnvelopeScore>& scores);

/** \throws IncompleteError naming the first cell in which one of our methods gave up */
void requireNoFailures(const std::vector<EnvelopeScore>& scores);

/** A line per sequence, condition and method. */
[[nodiscard]] std::string envelopeCsv(const std::vector<EnvelopeScore>& scores);

/** What envelopeCsv() has written, without the single steps. \throws InputError naming the line */
[[nodiscard]] std::vector<EnvelopeScore> scoresFromCsv(const std::string& path);

/** The scores with those that others have of other methods in the same cells, in the order of the
 * first. */
[[nodiscard]] std::vector<EnvelopeScore> withMethodsOf(
    const std::vector<EnvelopeScore>& scores, const std::vector<EnvelopeScore>& others);

/** A line per tracked step that is beyond five standard deviations, or off by more than 50 mm or
 * 5 deg: where to look. */
[[nodiscard]] std::string failuresCsv(const std::vector<EnvelopeScore>& scores);
}  // namespace pointplane
