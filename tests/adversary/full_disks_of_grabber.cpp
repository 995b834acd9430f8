// SPDX-License-Identifier: BSD-3-Clause
#include "Attempt.h"
#include "VirtualCamera.h"
#include "rawlog_samples.h"

namespace pointplane::adversary
{
namespace
{
namespace fs = std::filesystem;
constexpr int kCopied = 8192;  // kilobytes of a disk on which all is well

/** What was recorded, copied from the disk before it is gone. */
[[nodiscard]] std::string wrongRecording(const std::string& rawlog, const Attempt& a)
{
    if (!fs::exists(rawlog) || fs::file_size(rawlog) == 0)
    {
        return "";
    }
    const auto contents = test::readAll(rawlog);
    std::size_t frames = 0;
    for (const auto& object : contents.objects)
    {
        frames += std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(object) ? 1 : 0;
    }
    const bool told =
        a.err.find("recorded " + std::to_string(frames) + " frames") != std::string::npos;
    return unless(told, std::to_string(frames) + " frames are in the file") +
           unless(  // where images are beside it, there may be room for the end mark
               contents.ending.kind == RawlogEnd::Clean ||
                   (a.code == 3 && contents.ending.kind == RawlogEnd::Truncated),
               "ending: " + contents.ending.message);
}
}  // namespace

Tally fullDisksOfGrabber(double share)
{
    Tally tally("the same of `grabber`, with a virtual camera");
    const test::TempDir dir;
    const test::VirtualCamera camera("", test::patternFrames(30, 64, 48), 52.5);
    const std::string disk = dir / "disk", copy = dir / "copy";
    struct Case
    {
        std::string name;
        std::vector<std::string> args;
    };
    const std::vector<Case> cases{
        {"rawlog", {"-o", disk + "/out.rawlog"}},
        {"external", {"-o", disk + "/out.rawlog", "--images", "external"}},
        {"oni", {"-o", disk + "/out.oni"}},
        {"preview", {"--preview", disk + "/out.png"}},
        {"live", {"--live", "--live-output", disk + "/out.rawlog"}}};
    for (const Case& c : cases)
    {
        for (const int kilobytes : {4, 8, 16, 40, 100, 200, kCopied})
        {
            if (share < 1 && kilobytes != 40 && kilobytes != kCopied)
            {
                continue;
            }
            Surroundings surroundings{disk, kilobytes};
            surroundings.environment = camera.environment();
            surroundings.leaves = copy;
            fs::remove_all(copy);
            std::vector<std::string> args = recorder(20, {"--min-free-mb", "0"});
            args.insert(args.end(), c.args.begin(), c.args.end());
            const Attempt a = attemptOf("grabber", args, surroundings);
            if (a.code < 0)
            {
                continue;  // this user may not mount a disk
            }
            std::string wrong =
                wrongWithOwnLines(a) + unless(a.code == 0 || a.code == 3, "exit code " + a.err) +
                unless(kilobytes != kCopied || a.code == 0, a.err) +
                unless(
                    kilobytes >= 40 || a.code == 3 || c.name == "preview" || c.name == "live",
                    "nothing said");
            if (c.name == "rawlog" || c.name == "external")
            {
                wrong += wrongRecording(copy + "/out.rawlog", a);
            }
            tally.add(a, wrong, c.name + ", " + std::to_string(kilobytes) + " kB");
        }
    }
    return tally;
}
}  // namespace pointplane::adversary
