// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/planes/PlaneExtractor.h>
#include <pointplane/simulation/SimulatedSequence.h>
#include <pointplane/simulation/scenes.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

#include "segmentation_score.h"

/** Quality and time of the plane extraction on simulated scenes, as a Markdown table. A true plane
 * counts from 1 % of the image on; regions agree when each covers 80 % of the other. */
namespace
{
void printRow(const std::string& scene, const pointplane::SimulationParams& params, int numFrames)
{
    const pointplane::SimulatedSequence sequence(scene, params, 1);
    pointplane::PlaneExtractor extractor({}, {});
    pointplane::test::SegmentationScore score;
    std::vector<double> ms;
    for (int k = 0; k < numFrames; ++k)
    {
        const int i = k * (sequence.numFrames() - 1) / numFrames;
        const pointplane::RgbdFrame frame = sequence.frame(i);
        const std::clock_t start = std::clock();
        const pointplane::PlaneSet set = extractor.extract(frame.depth, frame.camera);
        ms.push_back(1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
        const cv::Mat valid = frame.depth > 0;
        score += pointplane::test::scoreSegmentation(
            sequence.truePlanes(i).labels,
            set.labels,
            valid,
            0.8,
            static_cast<int>(frame.depth.total() / 100));
    }
    std::sort(ms.begin(), ms.end());
    const double n = std::max(1, score.numTrue);
    std::printf(
        "| %-14s | %5d | %5.1f | %4.1f | %5.1f | %6.1f | %8d | %5.1f | %5.1f |\n",
        scene.c_str(),
        score.numTrue,
        100 * score.correct / n,
        100 * score.over / n,
        100 * score.under / n,
        100 * score.missed / n,
        score.spurious,
        ms[ms.size() / 2],
        ms[ms.size() * 99 / 100]);
}
}  // namespace

int main(int argc, char** argv)
{
    try
    {
        const int numFrames = argc > 1 ? std::max(1, std::atoi(argv[1])) : 40;
        pointplane::SimulationParams params;
        params.exposure = 0;  // colour does not matter here
        std::printf(
            "| scene          | truth | found | over | under | missed | spurious |    ms |   p99 "
            "|\n");
        std::printf(
            "|----------------|-------|-------|------|-------|--------|----------|-------|-------|"
            "\n");
        for (const pointplane::SceneInfo& scene : pointplane::sceneList())
        {
            printRow(scene.name, params, numFrames);
        }
        std::printf(
            "\ntruth: true planes over %d frames; found, over, missed in %% of them; under: joint "
            "regions, likewise; ms: CPU time, median and 99th percentile\n",
            numFrames);
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "benchmark_planes: %s\n", error.what());
        return 1;
    }
    return 0;
}
