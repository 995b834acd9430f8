// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "Attempt.h"

namespace pointplane::adversary
{
using Args = std::vector<std::string>;

/** A run that is good, to which one option is added, or in which its value is exchanged. Files are
 * in the folder where it is started. */
struct Case
{
    App app;  //!< or none: the grabber
    Args args;

    [[nodiscard]] Attempt run(const Args& withArgs, const Surroundings& surroundings) const;
};

/** One run of every program and command. */
[[nodiscard]] std::vector<Case> casesOfPrograms();

/** What they read. */
void writeInputs(const std::string& folder);

struct Option
{
    std::string name;
    std::string description;
    bool isNumber{false}, isWhole{false}, isSigned{true};
};

/** The options of a case's program that take a value, as its --help has them. */
[[nodiscard]] std::vector<Option> optionsOf(const Case& c, const Surroundings& surroundings);

/** With the option's value in the place of an earlier one. */
[[nodiscard]] Args with(Args args, const std::string& option, const std::string& value);
}  // namespace pointplane::adversary
