// SPDX-License-Identifier: BSD-3-Clause
// Long runs of the real programs: what they hold on to must not grow. POINTPLANE_SOAK_FRAMES sets
// the length; an hour at 30 Hz is 108000 (tools/soak.sh).
#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "RenderedMotion.h"
#include "VirtualCamera.h"
#include <gtest/gtest.h>

namespace
{
using namespace pointplane;
using namespace pointplane::test;
namespace fs = std::filesystem;

constexpr int kWidth = 96, kHeight = 72;

int numFrames()
{
    const char* text = std::getenv("POINTPLANE_SOAK_FRAMES");
    return text != nullptr ? std::atoi(text) : 3000;
}

/** Resident memory and open files of a running program. */
struct Usage
{
    double megabytes{0};
    long files{0};
};

Usage usageOf(pid_t pid)
{
    const std::string folder = "/proc/" + std::to_string(pid);
    Usage usage;
    long whole = 0, resident = 0;
    std::ifstream(folder + "/statm") >> whole >> resident;
    usage.megabytes = static_cast<double>(resident * ::sysconf(_SC_PAGESIZE)) / 1e6;
    std::error_code error;
    const fs::directory_iterator end;
    for (fs::directory_iterator it(folder + "/fd", error); !error && it != end; it.increment(error))
    {
        ++usage.files;
    }
    return usage;
}

/** The usage of a program from start to end, sampled ten times a second. */
class Samples
{
 public:
    /** Until the program ends. \return its exit code */
    int follow(ChildProcess& process)
    {
        while (true)
        {
            const Usage usage = usageOf(process.pid());
            const int code = process.wait(std::chrono::milliseconds(100));
            if (code != -1)
            {
                return code;
            }
            samples_.push_back(usage);
        }
    }

    /** The end against the second quarter, when every buffer has been filled once, and the queues
     * of a busy computer, too. The last samples are left out: a program that ends writes what it
     * has collected. */
    void expectNoGrowth(const char* program, double megabytes) const
    {
        ASSERT_GT(samples_.size(), 20U) << "too short to tell";
        const Usage early = largest(samples_.size() / 4, samples_.size() / 2);
        const Usage late = largest(samples_.size() * 7 / 8, samples_.size() - 2);
        std::cout << program << ": " << numFrames() << " frames, " << early.megabytes << " MB and "
                  << early.files << " files in the second quarter, " << late.megabytes << " MB and "
                  << late.files << " files at the end\n";
        EXPECT_LT(late.megabytes - early.megabytes, megabytes) << program;
        EXPECT_LE(late.files, early.files + 1) << program;
    }

 private:
    [[nodiscard]] Usage largest(std::size_t begin, std::size_t end) const
    {
        Usage out;
        for (std::size_t i = begin; i < end; ++i)
        {
            out.megabytes = std::max(out.megabytes, samples_[i].megabytes);
            out.files = std::max(out.files, samples_[i].files);
        }
        return out;
    }
    std::vector<Usage> samples_;
};

/** Records with the grabber, its live odometry beside, and runs the odometry on the recording. */
TEST(Soak, memoryAndFilesDoNotGrow)
{
    const TempDir dir;
    const RenderedMotion motion(60, kWidth, kHeight);
    // Ten times as fast as a Kinect.
    const VirtualCamera camera(
        "forthAndBack 1\nperiodUs 3333", motion.frames(), RenderedMotion::kFocal_px * kWidth / 640);
    const std::string recording = dir / "recording.rawlog";
    ChildProcess grabber(
        GRABBER,
        {"--driver",
         "openni2",
         "-o",
         recording,
         "--mode",
         "96x72@30",
         "--warm-up",
         "0.2",
         "--frames",
         std::to_string(numFrames()),
         "--live",
         "--live-output",
         dir / "live.rawlog"},
        camera.environment());
    Samples recordingSamples;
    ASSERT_EQ(recordingSamples.follow(grabber), 0) << grabber.err();
    recordingSamples.expectNoGrowth("pointplane-grabber", 8);

    ChildProcess odometry(
        ODOMETRY,
        {recording, "-o", dir / "poses.rawlog", "--trajectory", dir / "poses.txt", "--quiet"},
        {});
    Samples odometrySamples;
    // So small images show little of a camera as fast as this: about half of the frames are
    // predicted, and if it is more than half, the code is 1.
    const int code = odometrySamples.follow(odometry);
    ASSERT_TRUE(code == 0 || code == 1) << code << odometry.err();
    odometrySamples.expectNoGrowth("pointplane-odometry", 8);
}
}  // namespace
