// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace pointplane
{
/** Those whose name contains one of the parts; all when there are no parts.
 * \param option named by the error \throws InputError when none is left */
template <class Named>
[[nodiscard]] std::vector<Named> wantedOf(
    std::vector<Named> all, const std::vector<std::string>& parts, const std::string& option)
{
    std::vector<Named> out;
    std::string known;
    for (Named& item : all)
    {
        known += (known.empty() ? "" : ", ") + item.name;
        const auto isPart = [&item](const std::string& part)
        { return item.name.find(part) != std::string::npos; };
        if (parts.empty() || std::any_of(parts.begin(), parts.end(), isPart))
        {
            out.push_back(std::move(item));
        }
    }
    if (out.empty())
    {
        throw InputError(option + ": nothing has that in its name; known are: " + known);
    }
    return out;
}
}  // namespace pointplane
