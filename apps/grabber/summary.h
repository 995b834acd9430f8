// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/LiveOdometry.h>
#include <pointplane/grabber/RgbdCalibration.h>

#include <iosfwd>
#include <string>
#include <vector>

#include "StatusLine.h"

namespace pointplane
{
/** What a run did, for the user. */
struct RunSummary
{
    RunState state;
    CameraFacts camera;
    std::string calibration;           //!< where it comes from
    std::vector<std::string> outputs;  //!< files written
    std::vector<std::string> notes;
    bool hasLive{false};
    LiveStats live;
};

void print(const RunSummary& summary, std::ostream& out);

/** "virtual://0 Maker Name, serial 1 (openni2), 640x480@30, depth registered to colour". */
[[nodiscard]] std::string describe(const CameraFacts& facts);
}  // namespace pointplane
