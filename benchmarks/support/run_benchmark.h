// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/errors.h>

#include <iostream>
#include <string>

#include "methods.h"
#include <CLI/CLI.hpp>

namespace pointplane
{
/** main() of a benchmark that adds its options to the command line, then runs. \return exit code */
template <class Benchmark>
int runBenchmark(int argc, char** argv, const std::string& name, const std::string& description)
{
    CLI::App app{description};
    const Benchmark benchmark(app);
    const auto failed = [&name](const std::exception& e, int code)
    {
        std::cerr << name << ": " << oneLine(e) << "\n";
        return code;
    };
    try
    {
        app.parse(argc, argv);
        benchmark.run(std::cout, std::cerr);
        return kExitOk;
    }
    catch (const CLI::ParseError& e)
    {
        return app.exit(e) == 0 ? kExitOk : kExitBadInput;
    }
    catch (const IncompleteError& e)
    {
        return failed(e, kExitIncomplete);
    }
    catch (const EnvironmentError& e)
    {
        return failed(e, kExitEnvironment);
    }
    catch (const std::exception& e)
    {
        return failed(e, kExitBadInput);
    }
}
}  // namespace pointplane
