// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/HtmlReport.h>

#include "ReportedRun.h"

namespace pointplane
{
/** Adds scores and charts of the run without its lost frames: errors relative and absolute, paths
 * and poses. Says of each part that cannot be made why. */
void addPathSections(HtmlReport& report, const ReportedRun& run);
}  // namespace pointplane
