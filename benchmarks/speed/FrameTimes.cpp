// SPDX-License-Identifier: BSD-3-Clause
#include "FrameTimes.h"

#include <pointplane/core/quantile.h>

#include <ctime>
#include <numeric>

namespace pointplane
{
namespace
{
[[nodiscard]] double cpuMs()
{
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}
}  // namespace

void FrameTimes::addCpu(const std::function<void()>& work)
{
    const double start = cpuMs();
    work();
    add(cpuMs() - start);
}

void FrameTimes::addWall(const std::function<void()>& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    add(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
            .count());
}

double FrameTimes::mean() const
{
    return std::accumulate(ms_.begin(), ms_.end(), 0.0) / static_cast<double>(ms_.size());
}

double FrameTimes::median() const { return pointplane::median(ms_); }

double FrameTimes::p99() const { return quantile(ms_, 0.99); }
}  // namespace pointplane
