// SPDX-License-Identifier: BSD-3-Clause
#include "label_check.h"

#include <algorithm>
#include <string>

namespace pointplane
{
CLI::Validator isLabel()
{
    return {
        [](const std::string& text)
        {
            const bool isPrintable = std::none_of(
                text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
            return std::string(isPrintable ? "" : "holds a new line or another control character");
        },
        ""};
}
}  // namespace pointplane
