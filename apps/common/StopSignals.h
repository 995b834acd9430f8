// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pointplane
{
/** Makes Ctrl-C, SIGTERM and SIGHUP ask for a clean end; the same one again ends the process at
 * once (what is on the disk stays readable). A SIGHUP that is ignored, as by nohup, stays so.
 * Closed pipes and full file systems become errors of the write instead of killing the process. */
void installStopSignals();

[[nodiscard]] bool stopRequested();
}  // namespace pointplane
