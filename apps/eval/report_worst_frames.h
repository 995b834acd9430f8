// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/FrameTable.h>
#include <pointplane/evaluation/HtmlReport.h>

#include <cstddef>
#include <map>
#include <string>

#include "ReportedRun.h"

namespace pointplane
{
/** A picture of pointplane-odometry --overlay. */
struct FramePicture
{
    std::size_t frame{0};  //!< counted as there, lost and skipped ones too
    std::string path;
};

/** By stamp of the estimate's pose. */
using FramePictures = std::map<double, FramePicture>;

/** Pictures, of those that there are, of frames that are not lost.
 * \param table tells the frames' numbers by their stamps \param tablePath its file
 * \param folder of pointplane-odometry --overlay
 * \throws InputError if there are none, or if table or folder are not of the estimate */
[[nodiscard]] FramePictures picturesOf(
    const Trajectory& estimate,
    const FrameTable& table,
    const std::string& tablePath,
    const std::string& folder);

/** Adds pictures of the frames whose motion from the frame before that was not lost is the most
 * wrong. \throws std::runtime_error if there is none that can be scored */
void addWorstFrames(HtmlReport& report, const ReportedRun& run, const FramePictures& pictures);
}  // namespace pointplane
