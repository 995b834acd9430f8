// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "Attempt.h"
#include "OdometryApp.h"
#include "TempDir.h"
#include "VirtualCamera.h"
#include "program_cases.h"
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

[[nodiscard]] std::string textOf(const Args& args)
{
    std::string out;
    for (const std::string& arg : args)
    {
        out += arg + " ";
    }
    return out;
}

/** Whether the help says that something is written to what this option names. */
[[nodiscard]] bool isSaidToWrite(const Option& option)
{
    const std::string text = " " + option.description;
    return !option.isNumber && (text.rfind(" Keep ", 0) == 0 || text.rfind(" Draw ", 0) == 0 ||
                                text.rfind(" Renew ", 0) == 0 || text.rfind(" Write ", 0) == 0 ||
                                text.find(" write") != std::string::npos);
}

/** The outputs of one run: every option of the program that makes what it names. */
class OutputsOf
{
 public:
    OutputsOf(const Case& c, const std::string& whole, const Surroundings& there, Tally& tally)
        : case_(c), whole_(whole), there_(there), tally_(tally)
    {
        find();
        for (const std::string& arg : c.args)
        {
            const fs::path path = fs::path(whole) / arg;
            if (fs::path(arg).is_absolute())
            {
                continue;  // another program
            }
            if (fs::is_regular_file(path))
            {
                inputs_.push_back(arg);
            }
            else if (fs::is_directory(path))
            {
                for (const auto& entry : fs::directory_iterator(path))
                {
                    insideInputs_.push_back(fs::path(arg) / entry.path().filename());
                }
                insideInputs_.push_back(arg + "/rgb/0.png");
            }
        }
    }

    void tryAll()
    {
        for (const Output& output : outputs_)
        {
            const auto& [option, extension, isFolder] = output;
            for (const std::string& input : inputs_)
            {
                tryInput(option, input, {"", "symbolic", "hard", "linked/name"});
            }
            for (const std::string& input : insideInputs_)
            {
                tryInput(option, input, {"", "linked/name"});
            }
            for (const Output& other : outputs_)
            {
                if (other.option != option && !(isFolder && other.isFolder))
                {
                    refresh();
                    const std::string name = "same" + extension;
                    expectRefused(with(with(case_.args, option, name), other.option, name), {2});
                }
            }
            refresh();
            expectRefused(with(case_.args, option, "t.txt/new" + extension), {2, 3});
            if (!isFolder)
            {
                refresh();
                fs::create_directory(there_.folder + "/is" + extension);
                expectRefused(with(case_.args, option, "is" + extension), {2});
                expectWrittenThrough(option, extension);
            }
        }
    }

 private:
    void refresh()
    {
        fs::remove_all(there_.folder);
        fs::copy(whole_, there_.folder, fs::copy_options::recursive);
    }

    void find()
    {
        for (const Option& option : optionsOf(case_, there_))
        {
            refresh();
            // The grabber knows what it is to write by the name.
            const std::string extension = case_.app != nullptr         ? ""
                                          : option.name == "--preview" ? ".png"
                                                                       : ".rawlog";
            const Args args = with(case_.args, option.name, "fresh" + extension);
            const Attempt a = option.isNumber ? Attempt{0, 0, "", ""} : case_.run(args, there_);
            const fs::path made = fs::path(there_.folder) / ("fresh" + extension);
            const bool isMade = fs::exists(made);
            if (isMade)
            {
                outputs_.push_back({option.name, extension, fs::is_directory(made)});
            }
            if (isMade != isSaidToWrite(option))
            {
                tally_.add(a, "--help and file differ: " + a.err, textOf(args));
            }
        }
    }

    void tryInput(
        const std::string& option, const std::string& input, const std::vector<std::string>& names)
    {
        const std::string folder = there_.folder + "/";
        for (std::string other : names)
        {
            refresh();
            if (other.empty())
            {
                other = input;
            }
            else if (other == "symbolic")
            {
                fs::create_symlink(input, folder + other);
            }
            else if (other == "hard")
            {
                fs::create_hard_link(folder + input, folder + other);
            }
            else
            {
                fs::create_directory_symlink(".", folder + "linked");
                other = "linked/" + input;
            }
            expectRefused(with(case_.args, option, other), {2});
        }
    }

    void expectRefused(const Args& args, const std::vector<int>& codes)
    {
        const auto files = contentsOf(there_.folder);
        const Attempt a = case_.run(args, there_);
        const bool isRefused = std::count(codes.begin(), codes.end(), a.code) > 0;
        tally_.add(
            a,
            wrongWith(a) + unless(isRefused, "not refused") +
                unless(contentsOf(there_.folder) == files, "files changed"),
            textOf(args));
    }

    void expectWrittenThrough(const std::string& option, const std::string& extension)
    {
        const fs::path folder = there_.folder;
        const fs::path link = folder / ("link" + extension);
        const std::string target = "is" + extension + "/target" + extension;
        fs::create_symlink(target, link);
        const Args args = with(case_.args, option, link.filename());
        const Attempt a = case_.run(args, there_);
        if (a.err.find("recordings never overwrite") == std::string::npos)
        {
            tally_.add(
                a,
                unless(
                    a.code == 0 || a.code == 1,
                    "exit code " + std::to_string(a.code) + ": " + a.err) +
                    unless(fs::is_symlink(link), "the link is gone") +
                    unless(fs::is_regular_file(folder / target), "not written through"),
                textOf(args));
        }
    }

    const Case& case_;
    std::string whole_;
    Surroundings there_;
    Tally& tally_;
    struct Output
    {
        std::string option, extension;
        bool isFolder{false};
    };
    std::vector<Output> outputs_;
    std::vector<std::string> inputs_, insideInputs_;  //!< named, or in a folder that is named
};

void tryOutputsOfAllPrograms(Tally& tally)
{
    const test::TempDir dir;
    const test::VirtualCamera camera("", test::patternFrames(30, 64, 48), 52.5);
    writeInputs(dir / "whole");
    Surroundings there;
    there.folder = dir / "folder";
    there.environment = camera.environment();
    for (const Case& c : casesOfPrograms())
    {
        if (c.args[0] == "bag")
        {
            continue;  // only ROS makes one; what is written is as for klg
        }
        fs::remove_all(there.folder);
        fs::create_directory(there.folder);
        OutputsOf(c, dir / "whole", there, tally).tryAll();
    }
}
}  // namespace

Tally sameFiles(double)
{
    Tally tally("outputs that are an input, another output or a folder, also by links");
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
        tally.add(
            a,
            wrongWith(a) + unless(a.code == 2, "not refused") +
                unless(contentsOf(dir / "d") == before, "files changed"),
            textOf(args));
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
    tryOutputsOfAllPrograms(tally);
    return tally;
}
}  // namespace pointplane::adversary
