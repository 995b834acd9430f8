// SPDX-License-Identifier: BSD-3-Clause
#include "GroundTruthBenchmark.h"
#include "run_benchmark.h"

int main(int argc, char** argv)
{
    return pointplane::runBenchmark<pointplane::GroundTruthBenchmark>(
        argc,
        argv,
        "benchmark_ground_truth",
        "Rotational noise of ground truth, measured by the images alone");
}
