// SPDX-License-Identifier: BSD-3-Clause
#include "number_checks.h"

#include <pointplane/core/number_text.h>

#include <algorithm>
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
            const auto value = parseFinite(text);
            return value && isGood(*value) ? std::string() : "'" + text + "' is not " + what;
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

CLI::Validator isWhole(bool isSigned)
{
    return {
        [isSigned](std::string& text)
        {
            if (text.empty())
            {
                return std::string();  // isNotEmpty() of runCommand() says so
            }
            const bool isNegative = text[0] == '-';
            std::string digits = text.substr(isNegative || text[0] == '+' ? 1 : 0);
            const std::string what = "'" + text + "' is ";
            if (digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos)
            {
                return what + "not a whole number";
            }
            digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size() - 1));
            if (isNegative && !isSigned && digits != "0")
            {
                return what + "not zero or a positive number";
            }
            text = (isNegative && isSigned ? "-" : "") + digits;
            const bool fits = isSigned ? parseNumber<long long>(text).has_value()
                                       : parseNumber<unsigned long long>(text).has_value();
            return fits ? std::string() : what + "too large a number";
        },
        ""};
}
}  // namespace pointplane
