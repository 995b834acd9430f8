// SPDX-License-Identifier: BSD-3-Clause
#include "number_checks.h"

#include <cmath>
#include <sstream>
#include <string>

namespace pointplane
{
namespace
{
/** \param what it is not, where it is wrong \param name in the help */
template <class Good>
CLI::Validator numberThat(Good isGood, const std::string& what, const std::string& name)
{
    return {
        [isGood, what](const std::string& text)
        {
            double value = 0;
            const bool good =
                CLI::detail::lexical_cast(text, value) && std::isfinite(value) && isGood(value);
            return good ? std::string() : "'" + text + "' is not " + what;
        },
        name};
}
}  // namespace

CLI::Validator isFinite()
{
    return numberThat([](double) { return true; }, "a number", "");
}

CLI::Validator isPositive()
{
    return numberThat([](double value) { return value > 0; }, "a positive number", "POSITIVE");
}

CLI::Validator isNotNegative()
{
    return numberThat(
        [](double value) { return value >= 0; }, "zero or a positive number", "NONNEGATIVE");
}

CLI::Validator isBetween(double least, double most)
{
    std::ostringstream from, to;
    from << least;
    to << most;
    return numberThat(
        [least, most](double value) { return value >= least && value <= most; },
        "a number from " + from.str() + " to " + to.str(),
        "in [" + from.str() + " - " + to.str() + "]");
}
}  // namespace pointplane
