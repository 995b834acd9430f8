// SPDX-License-Identifier: BSD-3-Clause
// Preloaded: time in the thread that plays a recorded session passes only while the player waits
// for its next image. So a busy machine cannot make the player slower than the camera was.
#include <dlfcn.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

namespace
{
constexpr long kMicrosPerSecond = 1'000'000;
thread_local bool plays = false;
thread_local long long now_us = 0;  //!< on the monotonic clock

int realTime(clockid_t clock, timespec* time)
{
    using Function = int (*)(clockid_t, timespec*);
    static const auto function = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "clock_gettime"));
    return function(clock, time);
}
}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept
{
    if (!plays || clock != CLOCK_MONOTONIC)
    {
        return realTime(clock, time);
    }
    time->tv_sec = now_us / kMicrosPerSecond;
    time->tv_nsec = 1000 * (now_us % kMicrosPerSecond);
    return 0;
}

/** Only the player asks for the time in this way. */
extern "C" int gettimeofday(timeval* time, void* /*zone*/) noexcept
{
    if (!plays)
    {
        timespec start{};
        realTime(CLOCK_MONOTONIC, &start);
        now_us = start.tv_sec * kMicrosPerSecond + start.tv_nsec / 1000;
        plays = true;
    }
    time->tv_sec = now_us / kMicrosPerSecond;
    time->tv_usec = now_us % kMicrosPerSecond;
    return 0;
}

/** And only the player waits in this way. */
extern "C" int usleep(useconds_t time_us)
{
    now_us += time_us;
    return 0;
}
