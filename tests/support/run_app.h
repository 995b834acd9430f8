// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sstream>
#include <string>
#include <vector>

namespace pointplane::test
{
/** What an application wrote and returned. */
struct AppRun
{
    int code{0};
    std::string out, err;
};

/** Runs `int app(arguments, out, err)` in this process. */
template <class App>
[[nodiscard]] AppRun runApp(App app, const std::vector<std::string>& args)
{
    std::ostringstream out;
    std::ostringstream err;
    const int code = app(args, out, err);
    return {code, out.str(), err.str()};
}
}  // namespace pointplane::test
