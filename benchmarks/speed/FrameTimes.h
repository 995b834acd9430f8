// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace pointplane
{
/** Milliseconds of many frames. */
class FrameTimes
{
 public:
    void add(double ms) { ms_.push_back(ms); }

    /** Runs the work and adds the CPU time that the process spends on it: on one thread the wall
     * time of an idle machine, whatever else runs on this one. */
    void addCpu(const std::function<void()>& work);

    /** Likewise, wall time. */
    void addWall(const std::function<void()>& work);

    [[nodiscard]] bool empty() const { return ms_.empty(); }

    /** @name \pre not empty
     * @{ */
    [[nodiscard]] double mean() const;
    [[nodiscard]] double median() const;
    [[nodiscard]] double p99() const;
    /** @} */

 private:
    std::vector<double> ms_;
};
}  // namespace pointplane
