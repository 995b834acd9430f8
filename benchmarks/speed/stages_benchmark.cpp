// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/planes/PlaneExtractor.h>
#include <pointplane/planes/PlaneMatcher.h>
#include <pointplane/points/PointTracker.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <opencv2/core/utility.hpp>

#include "benchmark/benchmark.h"

// The stages of config.ini on two neighbouring frames of the simulated desk, on one thread.
namespace
{
using namespace pointplane;

struct Frames
{
    Frames()
    {
        cv::setNumThreads(1);
        SimulationParams params;
        params.duration = 1;
        const SimulatedSequence sequence("desk", params, 1);
        constexpr int kReference = 10, kCurrent = 14;
        reference = sequence.frame(kReference);
        current = sequence.frame(kCurrent);
        T_cur_ref = sequence.trueMotion(kReference, kCurrent).inverse();
    }
    RgbdFrame reference, current;
    Eigen::Isometry3d T_cur_ref;
};

const Frames& frames()
{
    static const Frames out;
    return out;
}

PlaneExtractor& extractor()
{
    static PlaneExtractor out({}, {});
    return out;
}

const PointTracker& tracker()
{
    static const PointTracker out({}, {}, {});
    return out;
}

void planes(benchmark::State& state)
{
    const RgbdFrame& frame = frames().current;
    for (auto _ : state)
    {
        benchmark::DoNotOptimize(extractor().extract(frame.depth, frame.camera));
    }
}
BENCHMARK(planes)->Unit(benchmark::kMillisecond);

void planeMatching(benchmark::State& state)
{
    const Frames& f = frames();
    const PlaneSet a = extractor().extract(f.reference.depth, f.reference.camera);
    const PlaneSet b = extractor().extract(f.current.depth, f.current.camera);
    const PlaneMatcher matcher(PlaneMatcher::TParams{});
    for (auto _ : state)
    {
        benchmark::DoNotOptimize(matcher.match(a, b, f.current.camera, f.T_cur_ref));
    }
}
BENCHMARK(planeMatching)->Unit(benchmark::kMillisecond);

void pointPyramid(benchmark::State& state)
{
    const RgbdFrame& frame = frames().current;
    for (auto _ : state)
    {
        benchmark::DoNotOptimize(tracker().pyramid(frame.gray));
    }
}
BENCHMARK(pointPyramid)->Unit(benchmark::kMillisecond);

void pointReference(benchmark::State& state)
{
    const RgbdFrame& frame = frames().current;
    for (auto _ : state)
    {
        benchmark::DoNotOptimize(tracker().makeReference(frame));
    }
}
BENCHMARK(pointReference)->Unit(benchmark::kMillisecond);

/** Argument: widening of the search. */
void pointTracking(benchmark::State& state)
{
    const Frames& f = frames();
    const PointReference reference = tracker().makeReference(f.reference);
    const std::vector<cv::Mat> pyramid = tracker().pyramid(f.current.gray);
    size_t found = 0;
    for (auto _ : state)
    {
        found =
            tracker()
                .track(
                    reference, f.current, pyramid, f.T_cur_ref, static_cast<double>(state.range(0)))
                .size();
    }
    state.counters["found"] = static_cast<double>(found);
    state.counters["of"] = static_cast<double>(reference.points.size());
}
BENCHMARK(pointTracking)->Arg(1)->Arg(5)->Unit(benchmark::kMillisecond);
}  // namespace
