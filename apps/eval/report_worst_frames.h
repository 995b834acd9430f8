// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/FrameTable.h>
#include <pointplane/evaluation/HtmlReport.h>

#include <string>

#include "ReportedRun.h"

namespace pointplane
{
/** Adds pictures, of those that there are, of the frames whose motion from the previous frame is
 * the most wrong.
 * \param table tells the frames' numbers; without rows, poses are counted
 * \param folder of pointplane-odometry --overlay \throws InputError if none of them is there */
void addWorstFrames(
    HtmlReport& report, const ReportedRun& run, const FrameTable& table, const std::string& folder);
}  // namespace pointplane
