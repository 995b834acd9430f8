// SPDX-License-Identifier: BSD-3-Clause
// What each way to store a recording costs: 640x480 at 30 frames a second in real time, rendered
// with a Kinect's noise. Prints the table of docs/grabber.md.
//
//     benchmark_grabber FOLDER [SECONDS]     writes into FOLDER, which should be on the disk in
//     question
#include <pointplane/grabber/RecordingWriter.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <sys/resource.h>

namespace
{
using namespace pointplane;
using Clock = std::chrono::steady_clock;
constexpr double kFps = 30.0;
constexpr int kNumFrames = 30;  // played forth and back

std::vector<ImagePair> render()
{
    SimulationParams params;
    params.duration = (kNumFrames + 1) / params.fps;
    const SimulatedSequence sequence("desk", params, 1);
    std::vector<ImagePair> pairs;
    for (int k = 0; k < kNumFrames; ++k)
    {
        ImagePair pair;
        cv::Mat bgr;
        cv::Mat depth = sequence.frame(k, &bgr).depth.clone();
        cv::patchNaNs(depth, 0.0);
        depth.convertTo(pair.depth.pixels, CV_16U, 1000.0);
        pair.colour.stream = StreamKind::Colour;
        pair.colour.layout = PixelLayout::Rgb8;
        cv::cvtColor(bgr, pair.colour.pixels, cv::COLOR_BGR2RGB);
        pairs.push_back(pair);
    }
    return pairs;
}

double processorSeconds()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t)
    { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Choice
{
    const char* options;
    EncodingOptions encoding;
};

void measure(
    const Choice& choice,
    const std::vector<ImagePair>& pairs,
    const std::string& folder,
    double duration)
{
    CameraFacts facts;
    facts.registered = true;
    const ObservationBuilder builder(nominalCalibration(facts));
    RecordingOptions options;
    options.path = folder + "/out.rawlog";
    options.encoding = choice.encoding;
    const int count = static_cast<int>(duration * kFps);
    int lost = 0;
    std::size_t maxQueued = 0;
    const double processorBefore = processorSeconds();
    RecordingWriter writer(options, builder);
    const auto begin = Clock::now();
    for (int k = 0; k < count; ++k)
    {
        std::this_thread::sleep_until(begin + std::chrono::duration<double>(k / kFps));
        const int phase = k % (2 * kNumFrames - 2);
        ImagePair pair =
            pairs[static_cast<std::size_t>(std::min(phase, 2 * kNumFrames - 2 - phase))];
        pair.stamp = 1.7e9 + k / kFps;
        lost += writer.tryPush(pair) ? 0 : 1;
        maxQueued = std::max(maxQueued, writer.stats().framesQueued);
    }
    writer.finish();
    const double megabytes = 1e-6 * static_cast<double>(writer.stats().bytesWritten);
    const double processor = processorSeconds() - processorBefore;
    std::printf(
        "| `%s` | %.1f | %.2f | %.1f | %d | %zu |\n",
        choice.options,
        megabytes / duration,
        megabytes / count,
        1e3 * processor / count,
        lost,
        maxQueued);
    std::fflush(stdout);
    std::filesystem::remove_all(folder + "/out_Images");
    std::filesystem::remove(options.path);
}
}  // namespace

int main(int argc, char** argv)
{
    if (argc < 2)
    {
        std::fprintf(stderr, "usage: benchmark_grabber FOLDER [SECONDS]\n");
        return 2;
    }
    const std::string folder = argv[1];
    const double duration = argc > 2 ? std::atof(argv[2]) : 10.0;
    constexpr auto kEmbedded = ImageStorage::Embedded, kExternal = ImageStorage::External;
    // JPEG last: MRPT's switch for it holds for the whole process.
    const std::vector<Choice> choices{
        {"--compression 0", {kEmbedded, 0, 0}},
        {"--compression 1 (default)", {kEmbedded, 1, 0}},
        {"--compression 6", {kEmbedded, 6, 0}},
        {"--images external", {kExternal, 1, 0}},
        {"--images external --jpeg 95", {kExternal, 1, 95}},
        {"--jpeg 95", {kEmbedded, 1, 95}}};
    const auto pairs = render();
    std::printf(
        "| options | MB/s | MB/frame | processor ms/frame | frames lost | longest queue |\n");
    std::printf("|---|---|---|---|---|---|\n");
    for (const auto& choice : choices)
    {
        measure(choice, pairs, folder, duration);
    }
    return 0;
}
