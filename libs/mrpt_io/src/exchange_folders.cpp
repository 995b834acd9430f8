// SPDX-License-Identifier: BSD-3-Clause
#include "exchange_folders.h"

#include <cerrno>
#include <cstdio>

namespace pointplane
{
bool exchangeInSteps(const std::string& a, const std::string& b)
{
    const auto rename = [](const std::string& from, const std::string& to)
    { return std::rename(from.c_str(), to.c_str()) == 0; };
    const std::string aside = a + ".earlier";
    if (!rename(a, aside))
    {
        return false;
    }
    const bool isThere = rename(b, a);
    if (isThere && rename(aside, b))
    {
        return true;
    }
    const int why = errno;
    if (isThere)
    {
        (void)rename(a, b);
    }
    (void)rename(aside, a);
    errno = why;
    return false;
}
}  // namespace pointplane
