// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "reproduce_tables.h"

namespace pointplane
{
/** The paper's figures of a sequence; empty if it has none. */
[[nodiscard]] PublishedFigures publishedOf(const std::string& sequence);

/** Tables 1 and 2 of the paper, beside its figures: first its own sequences, then others. */
[[nodiscard]] std::vector<ReproductionTable> paperTables(const Reproduction& result);

/** Whether weights and planes change the error by more than chance. */
[[nodiscard]] ReproductionTable chanceTable(const Reproduction& result);
}  // namespace pointplane
