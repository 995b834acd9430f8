// SPDX-License-Identifier: BSD-3-Clause
#include "word_check.h"

#include <algorithm>

namespace pointplane
{
CLI::Validator isOneOf(const std::vector<std::string>& words)
{
    return {
        [words](const std::string& text)
        {
            const bool isThere = std::find(words.begin(), words.end(), text) != words.end();
            return isThere ? std::string()
                           : "'" + text + "' is not one of " + CLI::detail::join(words, ", ");
        },
        "{" + CLI::detail::join(words, ",") + "}"};
}
}  // namespace pointplane
