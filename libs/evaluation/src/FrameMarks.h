// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace pointplane
{
/** What `# pointplane-status` lines say about frames; docs/rawlogs.md describes them. */
struct FrameMarks
{
    bool any{false};
    std::set<double> predicted;  //!< stamps of frames with a pose
    std::vector<double> lost;    //!< of frames without one, in order
    std::size_t lostWithoutTime{0};

    /** \param latest stamp in the lines before */
    void read(const std::string& text, const std::string& path, std::size_t line, double latest);
};
}  // namespace pointplane
