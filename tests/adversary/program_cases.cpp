// SPDX-License-Identifier: BSD-3-Clause
#include "program_cases.h"

#include <cctype>
#include <filesystem>
#include <set>
#include <sstream>

#include "ConvertApp.h"
#include "EvalApp.h"
#include "LabApp.h"
#include "OdometryApp.h"
#include "SimulateApp.h"
#include "TempDir.h"
#include "rawlog_samples.h"

namespace pointplane::adversary
{
namespace
{
namespace fs = std::filesystem;

/** A log of ElasticFusion with two frames, not compressed. */
[[nodiscard]] std::string klgOfTwoFrames()
{
    constexpr std::int32_t kPixels = 32 * 24, kDepthBytes = 2 * kPixels, kColourBytes = 3 * kPixels;
    std::string out;
    const auto add = [&out](const auto& value)
    { out.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
    add(std::int32_t{2});
    for (const std::int64_t microseconds : {0, 33333})
    {
        add(microseconds);
        add(kDepthBytes);
        add(kColourBytes);
        out += std::string(kDepthBytes, '\5') + std::string(kColourBytes, '\7');
    }
    return out;
}
}  // namespace

Attempt Case::run(const Args& withArgs, const Surroundings& surroundings) const
{
    return app != nullptr ? attempt(app, withArgs, surroundings)
                          : attemptOf("grabber", withArgs, surroundings);
}

void writeInputs(const std::string& folder)
{
    fs::remove_all(folder);
    fs::create_directory(folder);
    test::writeObservations(folder + "/in.rawlog", 40);
    writeTumFolder(folder + "/tum");
    fs::create_directory(folder + "/images");
    for (const char* name : {"rgb", "depth"})
    {
        fs::rename(folder + "/tum/" + name, folder + "/images/" + name);
        fs::copy(folder + "/images/" + name, folder + "/tum/" + name);
    }
    fs::copy(folder + "/tum/camera.txt", folder + "/images/camera.txt");
    test::writeBytes(folder + "/in.klg", klgOfTwoFrames());
    test::writeBytes(folder + "/c.ini", "[Covariance]\n");
    Surroundings there;
    there.folder = folder;
    (void)attempt(
        runOdometry,
        {"in.rawlog", "-o", "est.rawlog", "--trajectory", "t.txt", "--since", "1", "--quiet"},
        there);
    // One file as ground truth and estimate is warned of.
    fs::copy(folder + "/t.txt", folder + "/truth.txt");
    fs::copy(folder + "/est.rawlog", folder + "/truth.rawlog");
}

std::vector<Case> casesOfPrograms()
{
    const std::string programs = std::string(PROGRAMS) + "/pointplane-";
    const Args recorded = recorder(3, {"--live", "-o", "out.rawlog"});
    return {
        {runOdometry,
         {"in.rawlog",
          "-o",
          "out.rawlog",
          "--trajectory",
          "o.txt",
          "--simplemap",
          "o.simplemap",
          "--overlay",
          "o",
          "--overlay-every",
          "20",
          "--quiet"}},
        {runSimulate,
         {"corner", "-o", "out.rawlog", "--size", "32x24", "--duration", "0.1", "--quiet"}},
        {runConvert, {"tum", "tum", "-o", "out.rawlog", "--quiet"}},
        {runConvert, {"folder", "images", "-o", "out.rawlog", "--quiet"}},
        {runConvert,
         {"klg", "in.klg", "--camera", "tum/camera.txt", "-o", "out.rawlog", "--quiet"}},
        {runConvert, {"bag", "in.rawlog", "-o", "out.rawlog", "--quiet"}},
        {runEval, {"rpe", "truth.txt", "t.txt", "--report", "o"}},
        {runEval, {"ate", "truth.txt", "t.txt", "--report", "o"}},
        {runEval, {"nees", "truth.rawlog", "est.rawlog", "--interval", "1f", "--report", "o"}},
        {runEval, {"compare", "truth.txt", "t.txt", "t.txt", "--report", "o"}},
        {runLab,
         {"sweep",
          "PoseSolver.alpha",
          "in.rawlog",
          "--values",
          "1",
          "--gt",
          "t.txt",
          "--odometry",
          programs + "odometry"}},
        {runLab,
         {"reproduce",
          "tum",
          "--only",
          "alpha",
          "--alphas",
          "1",
          "--paper-config",
          "c.ini",
          "--odometry",
          programs + "odometry",
          "--convert",
          programs + "convert",
          "--simulate",
          programs + "simulate"}},
        {nullptr, recorded}};
}
std::vector<Option> optionsOf(const Case& c, const Surroundings& surroundings)
{
    const bool hasCommands = c.app == runConvert || c.app == runEval || c.app == runLab;
    const Args args = hasCommands ? Args{c.args[0], "--help"} : Args{"--help"};
    std::istringstream help(c.run(args, surroundings).out);
    std::vector<Option> out;
    bool takesValue = false;
    for (std::string line; std::getline(help, line);)
    {
        std::istringstream words(line);
        std::string name, type;
        if (line.rfind("  -", 0) == 0)  // `  -o,--output FILE  ...`
        {
            words >> name >> type;
            const std::string word = type.substr(0, type.find_first_of(":="));
            const std::set<std::string> numbers{"FLOAT", "INT", "UINT"};
            takesValue = type.size() > 1 && std::isupper(type[0]) && std::isupper(type[1]);
            if (takesValue)
            {
                out.push_back(
                    {name.substr(name.find("--")),
                     "",
                     numbers.count(word) > 0,
                     word == "INT" || word == "UINT",
                     word != "UINT"});
            }
        }
        constexpr std::size_t kColumn = 30;  // of descriptions, also where they have a line alone
        if (takesValue && line.size() > kColumn)
        {
            out.back().description += line.substr(line.find_first_not_of(' ', kColumn));
        }
    }
    return out;
}

Args with(Args args, const std::string& option, const std::string& value)
{
    const std::string shortName = option == "--output"   ? "-o"
                                  : option == "--config" ? "-c"
                                                         : option;
    for (std::size_t i = 0; i + 1 < args.size(); ++i)
    {
        if (args[i] == option || args[i] == shortName)
        {
            args[i + 1] = value;
            return args;
        }
    }
    args.push_back(option + "=" + value);
    return args;
}

}  // namespace pointplane::adversary
