// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>

#include "Attempt.h"
#include "VirtualCamera.h"
#include "rawlog_samples.h"

namespace pointplane::adversary
{
namespace
{
struct LimitedProgram
{
    std::string program;
    std::vector<std::string> args;
    std::string output;  //!< a file that is there before
};

[[nodiscard]] std::vector<Surroundings> limits(double share)
{
    std::vector<Surroundings> out;
    for (std::uint64_t kilobytes : {64, 128, 1024})
    {
        out.emplace_back().stack = kilobytes << 10U;
    }
    for (std::uint64_t bytes : {0, 1 << 10, 1 << 13, 1 << 16, 1 << 30})
    {
        out.emplace_back().fileSize = bytes;
    }
    constexpr std::uint64_t kLeast = 220, kMost = 620;  // about what they ask for [MB]
    for (std::uint64_t megabytes = kLeast; megabytes <= kMost; megabytes += 20)
    {
        out.emplace_back().memory = megabytes << 20U;
    }
    const auto step = static_cast<std::size_t>(share < 1 ? 7 : 1);
    std::vector<Surroundings> some;
    for (std::size_t i = 0; i < out.size(); i += step)
    {
        some.push_back(out[i]);
    }
    return some;
}

[[nodiscard]] std::string nameOf(const Surroundings& s)
{
    return s.stack      ? "stack " + std::to_string(*s.stack)
           : s.fileSize ? "files " + std::to_string(*s.fileSize)
                        : "memory " + std::to_string(s.memory);
}
}  // namespace

Tally tightLimits(double share)
{
    Tally tally("limits: a stack of 64 kB, files of 0 bytes, 220 to 620 MB of memory, and more");
    const test::TempDir dir;
    const std::string in = dir / "in.rawlog", folder = dir / "tum", out = dir / "out";
    const std::string text = dir / "t.txt", truth = dir / "truth.txt";
    test::writeObservations(in, 40);
    writeTumFolder(folder);
    (void)attemptOf("odometry", {in, "--trajectory", text, "--quiet"});
    std::filesystem::copy(text, truth);
    const test::VirtualCamera camera("", test::patternFrames(30, 64, 48), 52.5);
    const std::vector<LimitedProgram> cases{
        {"odometry", {in, "-o", out, "--quiet"}, out},
        {"odometry", {in, "--trajectory", out, "--jobs", "1", "--quiet"}, out},
        {"odometry", {in, "--diagnostics", out, "--overlay", dir / "pictures", "--quiet"}, out},
        {"simulate",
         {"corner", "-o", out, "--size", "320x240", "--duration", "0.2", "--quiet"},
         out},
        {"convert", {"tum", folder, "-o", out, "--quiet"}, out},
        {"eval", {"rpe", truth, text, "--json", out}, out},
        {"eval", {"rpe", truth, text, "--report", dir / "report"}, ""},
        {"lab",
         {"sweep", "PoseSolver.alpha", in, "--values", "1", "--gt", text, "--json", out},
         out},
        {"grabber", recorder(5, {"--live", "-o", dir / "recording.rawlog"}), ""}};
    for (const LimitedProgram& c : cases)
    {
        for (Surroundings surroundings : limits(share))
        {
            if (c.program == "grabber")
            {
                std::filesystem::remove(dir / "recording.rawlog");
                surroundings.environment = camera.environment();
            }
            if (surroundings.memory < Surroundings{}.memory &&
                attemptOf(c.program, {"--version"}, surroundings).code != 0)
            {
                continue;  // the libraries fail before the program begins
            }
            test::writeBytes(out, "old");
            const Attempt a = attemptOf(c.program, c.args, surroundings);
            // The recorder and the lab say more than why they fail; so do libraries without memory.
            const bool saysMore = c.program == "grabber" || c.program == "lab" ||
                                  surroundings.memory < Surroundings{}.memory;
            const bool saidRunFailed = c.program == "lab" && a.code == 1;  // where runs are listed
            const bool ended = a.code == 0 || saidRunFailed;
            std::string wrong = saysMore ? wrongWithOwnLines(a) : wrongWith(a);
            wrong += unless(ended || a.code == 3, "exit code: " + a.err);
            wrong += unless(
                c.output.empty() || ended == (test::readBytes(out) != "old"), "earlier output");
            tally.add(a, wrong, c.program + " " + c.args[0] + ", " + nameOf(surroundings));
        }
    }
    return tally;
}
}  // namespace pointplane::adversary
