// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace pointplane
{
/** Exchanges the names of two folders on disks that cannot do it at once, such as those of a
 * network. Where a step fails, both have their names again.
 * \return false, with errno, after a failure */
[[nodiscard]] bool exchangeInSteps(const std::string& a, const std::string& b);
}  // namespace pointplane
