// SPDX-License-Identifier: BSD-3-Clause
#include "SpeedBenchmark.h"
#include "run_benchmark.h"

int main(int argc, char** argv)
{
    return pointplane::runBenchmark<pointplane::SpeedBenchmark>(
        argc,
        argv,
        "benchmark_speed",
        "Time per frame of pointplane's configurations and of the odometries in OpenCV and MRPT");
}
