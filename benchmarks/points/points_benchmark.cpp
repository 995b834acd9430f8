// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/points/PatchAligner.h>
#include <pointplane/points/PointDetector.h>
#include <pointplane/points/PointLifter.h>
#include <pointplane/points/PointMatcher.h>

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

void lift(benchmark::State& state)
{
    RgbdFrame frame;
    frame.camera.distortion = {{0.262383, -0.953104, -0.005358, 0.002628, 1.163314}};
    frame.depth = cv::Mat(480, 640, CV_32FC1, cv::Scalar(2));
    const std::vector<Vector2d> points = detectorOf("fast").detect(first()).uv_px;
    const PointLifter lifter{DepthNoise{}};
    for (auto _ : state)
    {
        benchmark::DoNotOptimize(lifter.liftAll(frame, points));
    }
    state.counters["points"] = static_cast<double>(points.size());
}
BENCHMARK(lift)->Unit(benchmark::kMicrosecond);

void pyramid(benchmark::State& state)
{
    const cv::Mat& gray = first();
    ImagePyramid out;
    for (auto _ : state)
    {
        out.build(gray, 4);
    }
}
BENCHMARK(pyramid)->Unit(benchmark::kMicrosecond);

/** One patch: template, then search. */
void patch(benchmark::State& state)
{
    PatchAligner::TParams params;
    params.patchSizePx = static_cast<int>(state.range(0));
    const PatchAligner aligner(params);
    const ImagePyramid a(first(), params.numLevels), b(second(), params.numLevels);
    const std::vector<Vector2d> points = detectorOf("fast").detect(first()).uv_px;
    const Eigen::Matrix2d slant = (Eigen::Matrix2d() << 1.02, 0.01, -0.02, 0.99).finished();
    PatchReference reference;
    size_t i = 0, converged = 0;
    for (auto _ : state)
    {
        const Vector2d& uv = points[i++ % points.size()];
        aligner.makeReference(a, uv, slant, reference);
        converged += aligner.align(reference, b, uv).isConverged() ? 1 : 0;
    }
    state.counters["converged"] =
        static_cast<double>(converged) / static_cast<double>(state.iterations());
}
BENCHMARK(patch)->Arg(8)->Arg(12)->Arg(16)->Unit(benchmark::kMicrosecond);
}  // namespace
