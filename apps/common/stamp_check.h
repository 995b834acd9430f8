// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace pointplane
{
/** What a velocity should not be told from such stamps for: one clause for people, or empty.
 *
 * Knows stamps that go back or repeat, that are in another unit than seconds, that are rounded to a
 * coarse step (of the interval between frames), and that jitter as a host's do, where a camera's
 * frames are evenly spaced. \param stamps of frames, in the order of recording [s] */
[[nodiscard]] std::string problemOfStamps(const std::vector<double>& stamps);

/** \param name of what the stamps are of, for the message
 * \throws InputError if there are several, and all are the same: no frame would have a motion */
void requireTimes(const std::vector<double>& stamps, const std::string& name);
}  // namespace pointplane
