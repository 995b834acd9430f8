// SPDX-License-Identifier: BSD-3-Clause
#include "Attempt.h"
#include "OdometryApp.h"
#include "TempDir.h"

namespace pointplane::adversary
{
Tally mrptSamples(double)
{
    namespace fs = std::filesystem;
    Tally tally("MRPT's sample rawlogs: read, or refused as not supported, never as damaged");
    const test::TempDir dir;
    std::error_code missing;
    for (const auto& entry : fs::directory_iterator("/usr/share/mrpt/datasets", missing))
    {
        if (entry.path().extension() != ".rawlog")
        {
            continue;
        }
        const Attempt a =
            attempt(runOdometry, {entry.path().string(), "--trajectory", dir / "t.txt", "--quiet"});
        const bool told = a.err.find("not supported") != std::string::npos ||
                          a.err.find("no CObservation3DRangeScan") != std::string::npos;
        tally.add(
            a,
            wrongWith(a) + unless(a.code == 0 || (a.code == 2 && told), "neither read nor told"),
            entry.path().filename().string());
    }
    return tally;
}
}  // namespace pointplane::adversary
