// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace pointplane
{
/** The calling thread yields to capture and compression. */
inline void lowerThreadPriority()
{
    constexpr int kNice = 15;
    // On Linux the priority belongs to the thread.
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(::syscall(SYS_gettid)), kNice);
}
}  // namespace pointplane
