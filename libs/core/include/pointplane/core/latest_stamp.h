// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace pointplane
{
/** The latest stamp in seconds since 1970, the largest number of its number of digits. Larger
 * numbers are in another unit. */
constexpr std::int64_t kLatestStamp = 99'999'999'999;
}  // namespace pointplane
