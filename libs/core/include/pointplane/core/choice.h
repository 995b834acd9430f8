// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <stdexcept>
#include <string>
#include <utility>

namespace pointplane
{
/** Turns the word of a parameter into its enumerator.
 * \param key name of the parameter, for the message
 * \throws std::invalid_argument naming the key and the words that it may have */
template <class Enum>
[[nodiscard]] Enum chosen(
    const std::string& key,
    const std::string& word,
    std::initializer_list<std::pair<const char*, Enum>> choices)
{
    std::string words;
    for (const auto& [name, value] : choices)
    {
        if (word == name)
        {
            return value;
        }
        words += (words.empty() ? "" : ", ") + std::string(name);
    }
    throw std::invalid_argument(key + " = " + word + " is not one of " + words);
}
}  // namespace pointplane
