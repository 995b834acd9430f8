// SPDX-License-Identifier: BSD-3-Clause
#include "AccuracyBenchmark.h"
#include "run_benchmark.h"

int main(int argc, char** argv)
{
    return pointplane::runBenchmark<pointplane::AccuracyBenchmark>(
        argc,
        argv,
        "benchmark_accuracy",
        "Accuracy of pointplane's configurations and of the odometries in OpenCV and MRPT");
}
