// SPDX-License-Identifier: BSD-3-Clause
#include "EnvelopeBenchmark.h"
#include "run_benchmark.h"

int main(int argc, char** argv)
{
    return pointplane::runBenchmark<pointplane::EnvelopeBenchmark>(
        argc,
        argv,
        "benchmark_envelope",
        "Slow, interrupted and poor recordings: what pointplane makes of them, and the odometries "
        "in OpenCV and MRPT");
}
