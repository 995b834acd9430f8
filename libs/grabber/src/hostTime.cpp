// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>

#include "drivers.h"

namespace pointplane
{
double hostTime()
{
    using std::chrono::duration;
    struct Anchor
    {
        std::chrono::system_clock::time_point utc{std::chrono::system_clock::now()};
        std::chrono::steady_clock::time_point steady{std::chrono::steady_clock::now()};
    };
    static const Anchor anchor;
    return duration<double>(anchor.utc.time_since_epoch()).count() +
           duration<double>(std::chrono::steady_clock::now() - anchor.steady).count();
}
}  // namespace pointplane
