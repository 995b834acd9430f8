// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/errors.h>

#include <iostream>

#include "SpeedBenchmark.h"

int main(int argc, char** argv)
{
    CLI::App app{
        "Time per frame of pointplane's configurations and of the odometries in OpenCV and MRPT"};
    const pointplane::SpeedBenchmark benchmark(app);
    try
    {
        app.parse(argc, argv);
        benchmark.run(std::cout, std::cerr);
        return pointplane::kExitOk;
    }
    catch (const CLI::ParseError& e)
    {
        return app.exit(e) == 0 ? pointplane::kExitOk : pointplane::kExitBadInput;
    }
    catch (const pointplane::EnvironmentError& e)
    {
        std::cerr << "benchmark_speed: " << pointplane::oneLine(e) << "\n";
        return pointplane::kExitEnvironment;
    }
    catch (const std::exception& e)
    {
        std::cerr << "benchmark_speed: " << pointplane::oneLine(e) << "\n";
        return pointplane::kExitBadInput;
    }
}
