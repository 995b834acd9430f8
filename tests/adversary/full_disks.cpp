// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>

#include "Attempt.h"
#include "ConvertApp.h"
#include "EvalApp.h"
#include "OdometryApp.h"
#include "SimulateApp.h"
#include "TempDir.h"
#include "rawlog_samples.h"

namespace pointplane::adversary
{
Tally fullDisks(double share)
{
    Tally tally(
        "disks (tmpfs) that fill up: outputs of `odometry`, `simulate`, `convert` and `eval`");
    const test::TempDir dir;
    const std::string disk = dir / "disk", in = dir / "in.rawlog", folder = dir / "tum";
    test::writeObservations(in, 40);
    writeTumFolder(folder);
    const std::string trajectory = dir / "t.txt";
    const std::string truth = dir / "truth.txt";
    (void)attempt(runOdometry, {in, "--trajectory", trajectory, "--quiet"});
    std::filesystem::copy(trajectory, truth);
    struct Case
    {
        App app;
        std::vector<std::string> args;
    };
    const std::string out = disk + "/out";
    const std::vector<std::string> simulate{
        "corner", "-o", out, "--size", "64x48", "--duration", "1", "--quiet"};
    std::vector<Case> cases;
    for (const char* option :
         {"-o", "--trajectory", "--diagnostics", "--simplemap", "--graph", "--overlay"})
    {
        cases.push_back({runOdometry, {in, option, out, "--quiet"}});
    }
    cases.push_back({runSimulate, simulate});
    cases.push_back({runSimulate, simulate});
    cases.back().args.emplace_back("--external");
    for (const char* external : {"--embedded", "--external"})
    {
        cases.push_back({runConvert, {"tum", folder, "-o", out, external, "--quiet"}});
    }
    cases.push_back({runEval, {"rpe", truth, trajectory, "--json", out}});
    cases.push_back({runEval, {"rpe", truth, trajectory, "--report", out}});
    cases.push_back({runEval, {"ate", truth, trajectory, "--csv", out}});
    cases.push_back({runEval, {"ate", truth, trajectory, "--save", out}});
    for (const Case& c : cases)
    {
        for (const int kilobytes : {4, 8, 12, 16, 24, 40, 64, 128, 8192})
        {
            if (share < 1 && kilobytes != 4 && kilobytes != 8192)
            {
                continue;
            }
            const Attempt a = attempt(c.app, c.args, {disk, kilobytes});
            if (a.code < 0)
            {
                continue;  // this user may not mount a disk
            }
            std::string wrong = wrongWith(a) + unless(a.code == 0 || a.code == 3, "exit code");
            wrong += unless(kilobytes < 8192 || a.code == 0, "fails on a large disk: " + a.err);
            tally.add(
                a, wrong, c.args[0] + " " + c.args[1] + ", " + std::to_string(kilobytes) + " kB");
        }
    }
    return tally;
}
}  // namespace pointplane::adversary
