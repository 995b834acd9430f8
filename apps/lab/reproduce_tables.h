// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "Reproduction.h"

namespace pointplane
{
/** A table of text. */
struct ReproductionTable
{
    std::string caption;
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;
};

/** The paper's Tables 1 and 2 beside the published figures, Fig. 3 as a table, and the ablations;
 * those whose variants were run. */
[[nodiscard]] std::vector<ReproductionTable> reproductionTables(const Reproduction& result);
}  // namespace pointplane
