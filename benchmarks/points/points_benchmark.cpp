// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/points/PointDetector.h>
#include <pointplane/points/PointLifter.h>
#include <pointplane/points/PointMatcher.h>
#include <pointplane/points/PointTracker.h>

#include <opencv2/core.hpp>

#include <string>

#include "benchmark/benchmark.h"
#include "texture.h"

// All stages on one synthetic 640x480 image with noise and the same moved by a few pixels.
namespace
{
using namespace pointplane;
using Vector2d = Eigen::Vector2d;

const Vector2d kShift(2.3, -1.6);

cv::Mat image(const Vector2d& shift)
{
    static const test::Texture texture(1, 8, 80);
    test::GaussianSampler random(2);
    const auto grey = [&](double u, double v) { return texture(u - shift.x(), v - shift.y()); };
    return test::renderImage(640, 480, grey, 2, &random);
}

const cv::Mat& first()
{
    static const cv::Mat out = image({0, 0});
    return out;
}

const cv::Mat& second()
{
    static const cv::Mat out = image(kShift);
    return out;
}

PointDetector detectorOf(const std::string& name)
{
    PointDetector::TParams params;
    params.detector = name;
    return PointDetector(params);
}

void detect(benchmark::State& state, const std::string& name)
{
    const PointDetector detector = detectorOf(name);
    const cv::Mat& gray = first();
    size_t count = 0;
    for (auto _ : state)
    {
        count = detector.detect(gray).uv_px.size();
    }
    state.counters["points"] = static_cast<double>(count);
}
BENCHMARK_CAPTURE(detect, surf, "surf")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(detect, fast, "fast")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(detect, orb, "orb")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(detect, akaze, "akaze")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(detect, sift, "sift")->Unit(benchmark::kMillisecond);

void match(benchmark::State& state, const std::string& name)
{
    const PointDetector detector = detectorOf(name);
    const DetectedPoints a = detector.detect(first()), b = detector.detect(second());
    const PointMatcher matcher;
    size_t count = 0;
    for (auto _ : state)
    {
        count = matcher.match(a.uv_px, a.descriptors, b.uv_px, b.descriptors).size();
    }
    state.counters["matches"] = static_cast<double>(count);
}
BENCHMARK_CAPTURE(match, surf, "surf")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(match, fast, "fast")->Unit(benchmark::kMicrosecond);

RgbdFrame frameOf(const cv::Mat& gray)
{
    RgbdFrame out;
    out.gray = gray;
    out.camera.distortion = {{0.262383, -0.953104, -0.005358, 0.002628, 1.163314}};
    out.depth = cv::Mat(480, 640, CV_32FC1, cv::Scalar(2));
    return out;
}

void lift(benchmark::State& state)
{
    const RgbdFrame frame = frameOf(first());
    const std::vector<Vector2d> points = detectorOf("fast").detect(first()).uv_px;
    const PointLifter lifter{DepthNoise{}};
    for (auto _ : state)
    {
        benchmark::DoNotOptimize(lifter.liftAll(frame, points));
    }
    state.counters["points"] = static_cast<double>(points.size());
}
BENCHMARK(lift)->Unit(benchmark::kMicrosecond);

void makeReference(benchmark::State& state)
{
    const RgbdFrame frame = frameOf(first());
    const PointTracker tracker({}, PointLifter::TParams{}, DepthNoise{});
    for (auto _ : state)
    {
        benchmark::DoNotOptimize(tracker.makeReference(frame));
    }
}
BENCHMARK(makeReference)->Unit(benchmark::kMillisecond);

/** Pyramid of the current image, and all points of one reference. */
void track(benchmark::State& state)
{
    const RgbdFrame frame = frameOf(second());
    const PointTracker tracker({}, PointLifter::TParams{}, DepthNoise{});
    const PointReference reference = tracker.makeReference(frameOf(first()));
    size_t found = 0;
    for (auto _ : state)
    {
        found =
            tracker
                .track(reference, frame, tracker.pyramid(frame.gray), Eigen::Isometry3d::Identity())
                .size();
    }
    state.counters["points"] = static_cast<double>(reference.points.size());
    state.counters["found"] = static_cast<double>(found);
}
BENCHMARK(track)->Unit(benchmark::kMillisecond);
}  // namespace
