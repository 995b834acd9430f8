// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace pointplane
{
/** @name Checks of options that are numbers. CLI11's own let nan pass, and name their limits in 300
 * digits.
 * @{ */
[[nodiscard]] CLI::Validator isFinite();
[[nodiscard]] CLI::Validator isPositive();                          //!< and finite
[[nodiscard]] CLI::Validator isNotNegative();                       //!< and finite
[[nodiscard]] CLI::Validator isBetween(double least, double most);  //!< or one of them
/** In decimal digits, and one that 64 bits hold. CLI11's own conversion takes -1 for 2^64 - 1, the
 * nearest number for one that is too large, and 010 for 8. For transform(). */
[[nodiscard]] CLI::Validator isWhole(bool isSigned);
/** @} */
}  // namespace pointplane
