// SPDX-License-Identifier: BSD-3-Clause
#include <set>

#include "Attempt.h"
#include "TempDir.h"
#include "VirtualCamera.h"
#include "program_cases.h"

namespace pointplane::adversary
{
namespace
{
namespace fs = std::filesystem;

/** The values that this option may not take for a number. */
[[nodiscard]] bool mustRefuse(const Option& option, const std::string& value)
{
    const std::set<std::string> noNumbers{"nan", "inf", "-inf", "abc", "", "0,5", "1e999"};
    const std::set<std::string> notWhole{
        "1e300", "-1e300", "1e-300", "0.5", "99999999999999999999"};
    return (option.isNumber && noNumbers.count(value) > 0) ||
           (option.isWhole && notWhole.count(value) > 0) || (!option.isSigned && value == "-1");
}
}  // namespace

Tally optionValues(double share)
{
    Tally tally("values of every option, from nan to text and nothing");
    const test::TempDir dir;
    const test::VirtualCamera camera("", test::patternFrames(30, 64, 48), 52.5);
    const std::string whole = dir / "whole", folder = dir / "folder";
    writeInputs(whole);
    Surroundings there;
    there.folder = folder;
    there.environment = camera.environment();
    std::mt19937 rng(24);
    for (const Case& c : casesOfPrograms())
    {
        fs::remove_all(folder);
        fs::copy(whole, folder, fs::copy_options::recursive);
        for (const Option& option : optionsOf(c, there))
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
                const Attempt a = c.run(args, there);
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
