// SPDX-License-Identifier: BSD-3-Clause
#include "FrameMarks.h"

#include <pointplane/core/number_text.h>

#include <algorithm>
#include <sstream>

#include "text_line.h"

namespace pointplane
{
void FrameMarks::read(
    const std::string& text, const std::string& path, std::size_t line, double latest)
{
    static const std::string kKey = "# pointplane-status";
    if (text.compare(0, kKey.size(), kKey) != 0)
    {
        return;
    }
    any = true;
    if (text.compare(kKey.size(), 1, " ") != 0)
    {
        return;  // the line that explains the others
    }
    std::istringstream words(text.substr(kKey.size()));
    std::string stampText;
    std::string status;
    words >> stampText >> status;
    status = status.substr(0, status.find(':'));
    const auto stamp = parseNumber<double>(stampText);
    if (!stamp || (status != "lost" && status != "predicted"))
    {
        failAt(path, line, "not a status: expected # pointplane-status STAMP lost or predicted");
    }
    if (status == "predicted")
    {
        predicted.insert(*stamp);
    }
    else if (*stamp > std::max(latest, lost.empty() ? 0 : lost.back()))
    {
        lost.push_back(*stamp);
    }
    else  // a stamp that is not after the others may be why the frame is lost
    {
        ++lostWithoutTime;
    }
}
}  // namespace pointplane
