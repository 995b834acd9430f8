// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/params_ini.h>

#include <cmath>
#include <sstream>

#include "Attempt.h"
#include "OdometryApp.h"
#include "TempDir.h"
#include "rawlog_samples.h"

namespace pointplane::adversary
{
namespace
{
/** Every pose of the trajectory is a number, and none is farther than the scene is large. */
[[nodiscard]] std::string wrongTrajectory(const std::string& path)
{
    std::istringstream lines(test::readBytes(path));
    for (std::string line; std::getline(lines, line);)
    {
        std::istringstream words(line);
        double stamp = 0, x = 0;
        if (line.empty() || line[0] == '#' || !(words >> stamp))
        {
            continue;
        }
        for (int i = 0; i < 7; ++i)
        {
            if (!(words >> x) || !std::isfinite(x) || std::abs(x) > 100)
            {
                return "trajectory: " + line;
            }
        }
    }
    return "";
}
}  // namespace

Tally iniValues(double share)
{
    Tally tally("values of every key, from 1e-300 to nan and text");
    const test::TempDir dir;
    const std::string in = dir / "in.rawlog", out = dir / "out.txt";
    {
        RawlogWriter writer(in);
        for (int i = 0; i < 4; ++i)
        {
            writer.write(*test::sampleScan(i, 64, 48));
        }
        writer.close();
    }
    OdometryParams params;
    std::mt19937 rng(23);
    for (const auto& entry : parametersOf(params))
    {
        for (const char* value :
             {"0",    "-1",         "1",           "2",     "1e-10", "1e-300", "1e6",
              "1e10", "1e300",      "nan",         "inf",   "-inf",  "abc",    "",
              "0,5",  "2147483647", "99999999999", "-1e-9", "0.5",   "true"})
        {
            if (static_cast<double>(rng() % 1000) >= 1000 * share)
            {
                continue;
            }
            const std::string setting = entry.section + "." + entry.key + "=" + value;
            const Attempt a =
                attempt(runOdometry, {in, "--trajectory", out, "--quiet", "--set", setting});
            // Without planes, for example, nothing is measured in these images.
            const bool isRun =
                a.code == 0 ||
                (a.code == 1 &&
                 (a.err.find("most of the motion is predicted") != std::string::npos ||
                  a.err.find("a path cannot begin without depth") != std::string::npos));
            std::string wrong = wrongWith(a) + unless(isRun || a.code == 2, "exit code");
            wrong += unless(
                a.code != 2 || a.err.find(entry.key) != std::string::npos,
                "key not named: " + a.err);
            wrong += isRun ? wrongTrajectory(out) : "";
            tally.add(a, wrong, setting);
        }
    }
    return tally;
}
}  // namespace pointplane::adversary
