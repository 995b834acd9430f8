// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/se3.h>
#include <pointplane/evaluation/ate.h>
#include <pointplane/evaluation/nees.h>
#include <pointplane/evaluation/rpe.h>

#include <cmath>

#include <benchmark/benchmark.h>

namespace
{
using namespace pointplane;

/** n poses at 30 Hz along a curve, off by `error` metres. */
Trajectory curve(std::size_t n, double error)
{
    Trajectory out;
    out.name = "curve";
    for (std::size_t k = 0; k < n; ++k)
    {
        const double t = static_cast<double>(k) / 30;
        Vector6d xi;
        xi << std::sin(t), std::cos(0.7 * t), 0.3 * std::sin(0.3 * t), 0.2 * std::sin(t),
            0.3 * std::cos(0.5 * t), 0.1 * t;
        xi.head<3>().array() += error * std::sin(31.4 * t);
        out.stamps.push_back(t);
        out.poses.push_back(se3Exp(xi));
        out.covs.push_back(1e-6 * static_cast<double>(k + 1) * Matrix6d::Identity());
    }
    return out;
}

void rpeAllPairs(benchmark::State& state)
{
    const auto n = static_cast<std::size_t>(state.range(0));
    const Trajectory truth = curve(n, 0);
    const Trajectory estimate = curve(n, 0.01);
    RpeResult result;
    for (auto _ : state)
    {
        result = relativePoseError(truth, estimate, {});
    }
    state.counters["pairs"] = static_cast<double>(result.translation.count);
    state.counters["rmse"] = result.translation.rmse;
}
BENCHMARK(rpeAllPairs)->Arg(1000)->Arg(10000)->Unit(benchmark::kMillisecond);

void rpeFixedDelta(benchmark::State& state)
{
    const auto n = static_cast<std::size_t>(state.range(0));
    const Trajectory truth = curve(n, 0);
    const Trajectory estimate = curve(n, 0.01);
    RpeOptions options;
    options.fixedDelta = true;
    for (auto _ : state)
    {
        benchmark::DoNotOptimize(relativePoseError(truth, estimate, options));
    }
}
BENCHMARK(rpeFixedDelta)->Arg(100000)->Unit(benchmark::kMillisecond);

void ate(benchmark::State& state)
{
    const auto n = static_cast<std::size_t>(state.range(0));
    const Trajectory truth = curve(n, 0);
    const Trajectory estimate = curve(n, 0.01);
    for (auto _ : state)
    {
        benchmark::DoNotOptimize(absoluteTrajectoryError(truth, estimate, {}));
    }
}
BENCHMARK(ate)->Arg(100000)->Unit(benchmark::kMillisecond);

void nees(benchmark::State& state)
{
    const auto n = static_cast<std::size_t>(state.range(0));
    const Trajectory truth = curve(n, 0);
    const Trajectory estimate = curve(n, 0.001);
    for (auto _ : state)
    {
        benchmark::DoNotOptimize(neesIncrements(truth, estimate, {}, {}));
    }
}
BENCHMARK(nees)->Arg(100000)->Unit(benchmark::kMillisecond);
}  // namespace
