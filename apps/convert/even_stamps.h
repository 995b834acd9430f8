// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace pointplane
{
/** Stamps as a camera with a steady rate would have them, where a host's jitter or rounding moved
 * them: each is that of a line through the stamps of half a second before and after. Missing frames
 * stay missing, and a rate that changes slowly is followed. Stamps that repeat are rounded: then
 * the line is as long as ten steps of the rounding, and a frame is missing only if a step is.
 * \param stamps of images in their order, none before the one before [s]
 * \return as many, ascending [s]
 * \throws InputError if the stamps are not those of a steady rate */
[[nodiscard]] std::vector<double> evenStamps(const std::vector<double>& stamps);

struct EvenedStamps
{
    std::vector<double> stamps;  //!< [s]
    std::string note;            //!< how far they were moved, one line for people
};

/** evenStamps() of the images of a recording.
 * \param stamps as of evenStamps() \param name of the images, which begins the message of an error
 * \throws InputError as evenStamps() */
[[nodiscard]] EvenedStamps evenOut(const std::vector<double>& stamps, const std::string& name);
}  // namespace pointplane
