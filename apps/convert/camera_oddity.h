// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/PinholeCamera.h>

#include <string>

namespace pointplane
{
/** What cameras hardly ever have and a mixed-up calibration has: unequal focal lengths, a principal
 * point far from the middle, a lens that folds within the image. Empty if there is nothing.
 * \param camera whose problem() is empty */
[[nodiscard]] std::string oddityOf(const PinholeCamera& camera);
}  // namespace pointplane
