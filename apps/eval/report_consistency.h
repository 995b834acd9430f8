// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/HtmlReport.h>

#include "ReportedRun.h"

namespace pointplane
{
/** Adds the table of NEES and its charts; charts of single errors for the first interval only.
 * \throws std::runtime_error where there is no NEES */
void addConsistency(HtmlReport& report, const ReportedRun& run);
}  // namespace pointplane
