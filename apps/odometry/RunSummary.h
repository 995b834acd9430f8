// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "FrameRecord.h"

namespace pointplane
{
/** What a run amounted to. */
struct RunSummary
{
    std::string label;
    std::size_t numFrames{0}, numTracked{0}, numPredicted{0}, numLost{0};
    std::size_t numUnusable{0};         //!< of the lost: the observation was at fault
    double pathLength{0};               //!< of the robot [m]
    double seconds{0};                  //!< wall time
    FrameDiagnostics sum;               //!< of the times per stage
    std::vector<std::string> problems;  //!< one line each, the first few
    std::string damage;                 //!< where the input ended early, or empty
    std::vector<std::string> outputs;   //!< descriptions

    void add(const OutputItem& item);

    /** \param profile also the mean times per stage */
    void print(std::ostream& out, bool profile) const;

    /** One of mrpt_io/errors.h. */
    [[nodiscard]] int exitCode() const;
};
}  // namespace pointplane
