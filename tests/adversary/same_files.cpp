// SPDX-License-Identifier: BSD-3-Clause
#include "Attempt.h"
#include "EvalApp.h"
#include "OdometryApp.h"
#include "TempDir.h"
#include "rawlog_samples.h"

namespace pointplane::adversary
{
namespace
{
namespace fs = std::filesystem;

/** Contents of all files in a folder. */
[[nodiscard]] std::map<std::string, std::string> contentsOf(const std::string& folder)
{
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
    {
        if (entry.is_regular_file())
        {
            out[entry.path()] = test::readBytes(entry.path());
        }
    }
    return out;
}
}  // namespace

Tally sameFiles(double)
{
    Tally tally(
        "outputs that are an input or another output, by the same name, another way, symbolic and "
        "hard links, partial names");
    const test::TempDir dir;
    fs::create_directory(dir / "d");
    const std::string in = dir / "d/a.rawlog", config = dir / "d/c.ini", text = dir / "d/t.txt";
    const std::string partial = dir / "d/q.rawlog.partial";
    test::writeObservations(in, 3);
    fs::copy(in, partial);
    test::writeBytes(config, "[Covariance]\n");
    (void)attempt(runOdometry, {in, "--trajectory", text, "--quiet"});
    fs::create_symlink(in, dir / "d/symbolic");
    fs::create_hard_link(in, dir / "d/hard");
    fs::create_directory_symlink(dir / "d", dir / "e");
    const auto before = contentsOf(dir / "d");
    const auto expectRefused = [&](App app, const std::vector<std::string>& args)
    {
        const Attempt a = attempt(app, args);
        std::string name;
        for (const std::string& arg : args)
        {
            name += arg + " ";
        }
        tally.add(
            a,
            wrongWith(a) + unless(a.code == 2, "not refused") +
                unless(contentsOf(dir / "d") == before, "files changed"),
            name);
    };
    const std::vector<std::string> options{
        "-o", "--trajectory", "--diagnostics", "--simplemap", "--graph"};
    const std::string out = dir / "d/out";
    for (const std::string& option : options)
    {
        for (const std::string& name :
             {in, dir / "d/symbolic", dir / "d/hard", dir / "e/a.rawlog", dir / "d/../d/a.rawlog"})
        {
            expectRefused(runOdometry, {in, option, name, "--quiet"});
            expectRefused(runOdometry, {name, option, in, "--quiet"});
        }
        expectRefused(runOdometry, {in, "-c", config, option, config, "--quiet"});
        expectRefused(runOdometry, {partial, option, dir / "d/q.rawlog", "--quiet"});
        for (const std::string& other : options)
        {
            if (other != option)
            {
                expectRefused(runOdometry, {in, option, out, other, out, "--quiet"});
                expectRefused(runOdometry, {in, option, out, other, out + ".partial", "--quiet"});
            }
        }
    }
    for (const char* option : {"--json", "--csv"})
    {
        for (const char* command : {"rpe", "ate"})
        {
            expectRefused(runEval, {command, text, text, option, text});
        }
    }
    return tally;
}
}  // namespace pointplane::adversary
