// SPDX-License-Identifier: BSD-3-Clause
#include <set>
#include <sstream>

#include "Attempt.h"
#include "ConvertApp.h"
#include "EvalApp.h"
#include "LabApp.h"
#include "OdometryApp.h"
#include "SimulateApp.h"
#include "VirtualCamera.h"
#include "rawlog_samples.h"

namespace pointplane::adversary
{
namespace
{
namespace fs = std::filesystem;
using Args = std::vector<std::string>;

/** A run that is good, to which one option is added, or in which its value is exchanged. Files are
 * in the folder where it is started. */
struct Case
{
    App app;  //!< or none: the grabber
    Args args;
};

struct Option
{
    std::string name;
    bool isNumber{false}, isWhole{false}, isSigned{true};
};

/** Options with a value, as --help has them: `  -o,--output TEXT  ...`. */
[[nodiscard]] std::vector<Option> optionsIn(const std::string& help)
{
    std::vector<Option> out;
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);)
    {
        std::istringstream words(line);
        std::string name, type;
        if (line.rfind("  -", 0) != 0 || !(words >> name >> type))
        {
            continue;
        }
        const std::string word = type.substr(0, type.find_first_of(":="));
        const std::set<std::string> numbers{"FLOAT", "INT", "UINT"};
        const std::set<std::string> texts{"TEXT", "FILE", "DIR", "NAME", "PROGRAM"};
        if (numbers.count(word) + texts.count(word) > 0)
        {
            out.push_back(
                {name.substr(name.find("--")),
                 numbers.count(word) > 0,
                 word == "INT" || word == "UINT",
                 word != "UINT"});
        }
    }
    return out;
}

/** The values that this option may not take for a number. */
[[nodiscard]] bool mustRefuse(const Option& option, const std::string& value)
{
    const std::set<std::string> noNumbers{"nan", "inf", "-inf", "abc", "", "0,5", "1e999"};
    const std::set<std::string> notWhole{
        "1e300", "-1e300", "1e-300", "0.5", "99999999999999999999"};
    return (option.isNumber && noNumbers.count(value) > 0) ||
           (option.isWhole && notWhole.count(value) > 0) || (!option.isSigned && value == "-1");
}

/** With the option's value in the place of an earlier one. */
[[nodiscard]] Args with(Args args, const std::string& option, const std::string& value)
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
    Surroundings there;
    there.folder = folder;
    (void)attempt(
        runOdometry,
        {"in.rawlog", "-o", "est.rawlog", "--trajectory", "t.txt", "--since", "1", "--quiet"},
        there);
}

[[nodiscard]] std::vector<Case> casesOfPrograms()
{
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
        {runConvert, {"klg", "in.rawlog", "-o", "out.rawlog", "--quiet"}},
        {runConvert, {"bag", "in.rawlog", "-o", "out.rawlog", "--quiet"}},
        {runEval, {"rpe", "t.txt", "t.txt", "--report", "o"}},
        {runEval, {"ate", "t.txt", "t.txt", "--report", "o"}},
        {runEval, {"nees", "est.rawlog", "est.rawlog", "--interval", "1f", "--report", "o"}},
        {runEval, {"compare", "t.txt", "t.txt", "t.txt", "--report", "o"}},
        {runLab,
         {"sweep",
          "PoseSolver.alpha",
          "in.rawlog",
          "--values",
          "1",
          "--gt",
          "t.txt",
          "--odometry",
          std::string(PROGRAMS) + "/pointplane-odometry"}},
        {nullptr, recorded}};
}
}  // namespace

Tally optionValues(double share)
{
    Tally tally("values of options of all programs: every option, from nan to text and nothing");
    const test::TempDir dir;
    const test::VirtualCamera camera("", test::patternFrames(30, 64, 48), 52.5);
    const std::string whole = dir / "whole", folder = dir / "folder";
    writeInputs(whole);
    Surroundings there;
    there.folder = folder;
    std::mt19937 rng(24);
    const auto run = [&](const Case& c, const Args& args)
    {
        Surroundings surroundings = there;
        surroundings.environment = camera.environment();
        return c.app != nullptr ? attempt(c.app, args, there)
                                : attemptOf("grabber", args, surroundings);
    };
    for (const Case& c : casesOfPrograms())
    {
        fs::remove_all(folder);
        fs::copy(whole, folder, fs::copy_options::recursive);
        const bool hasCommands = c.app == runConvert || c.app == runEval || c.app == runLab;
        const Args help = hasCommands ? Args{c.args[0], "--help"} : Args{"--help"};
        for (const Option& option : optionsIn(run(c, help).out))
        {
            for (const char* value :
                 {"nan",
                  "inf",
                  "-inf",
                  "1e300",
                  "-1e300",
                  "1e-300",
                  "1e999",
                  "0",
                  "-1",
                  "0.5",
                  "",
                  "abc",
                  "0,5",
                  "99999999999999999999",
                  "-0"})
            {
                if (static_cast<double>(rng() % 1000) >= 1000 * share)
                {
                    continue;
                }
                fs::remove_all(folder);
                fs::copy(whole, folder, fs::copy_options::recursive);
                const Args args = with(c.args, option.name, value);
                const Attempt a = run(c, args);
                // Besides what is wrong, eval says where its report is, and the lab how far it is.
                const bool mayTellMore = c.app == nullptr || a.code != 2;
                std::string wrong = mayTellMore ? wrongWithOwnLines(a) : wrongWith(a);
                wrong += unless(
                    !mustRefuse(option, value) || a.code == 2,
                    "taken for a number, exit code " + std::to_string(a.code));
                for (const auto& entry : fs::recursive_directory_iterator(whole))
                {
                    const auto copy = folder / fs::relative(entry.path(), whole);
                    wrong += unless(
                        !entry.is_regular_file() ||
                            test::readBytes(entry.path()) == test::readBytes(copy),
                        "changed: " + copy.string());
                }
                tally.add(a, wrong, c.args[0] + " " + option.name + "=" + value);
            }
        }
    }
    return tally;
}
}  // namespace pointplane::adversary
