// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace pointplane
{
/** Stamps as a camera with a steady rate would have them, where a host's jitter or rounding moved
 * them: each is that of a line through the stamps of half a second before and after. Missing frames
 * stay missing, and a rate that changes slowly is followed.
 * \param stamps of images, ascending [s] \return as many, ascending [s]
 * \throws InputError if the stamps are not those of a steady rate */
[[nodiscard]] std::vector<double> evenStamps(const std::vector<double>& stamps);

/** How far stamps were moved, one line for people. */
[[nodiscard]] std::string describeEvening(
    const std::vector<double>& before, const std::vector<double>& after);
}  // namespace pointplane
