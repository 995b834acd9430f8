// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/pose/PoseAnalysis.h>

#include "Solution.h"

namespace pointplane
{
/** Sets all that is about the camera's errors. */
void addCamera(const Solution& at, PoseAnalysis& out);
}  // namespace pointplane
