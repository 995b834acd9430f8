// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/HtmlReport.h>

#include <string>

namespace pointplane
{
struct CommandContext;
class OutputGuard;

/** Tells the guard of the report in `directory`; empty: there is none. */
void guardReport(OutputGuard& guard, const std::string& directory);

/** Writes `report` to `directory`/index.html, which is created, and says so. Ends it with version,
 * time and command line; each chart is also an SVG file. \throws EnvironmentError */
void writeReportFile(HtmlReport report, const std::string& directory, CommandContext& context);
}  // namespace pointplane
