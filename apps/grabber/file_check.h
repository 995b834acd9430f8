// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "GrabberOptions.h"

namespace pointplane
{
/** Before there is a camera: a typo should not have to wait for one.
 * \throws InputError if files of a run are missing, would be overwritten or are the same */
void checkFilesOf(const GrabberOptions& options);
}  // namespace pointplane
