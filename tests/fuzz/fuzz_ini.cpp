// SPDX-License-Identifier: BSD-3-Clause
// Any bytes as a configuration: refused in one line, or read, written and read again.
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/params_ini.h>
#include <pointplane/odometry/Odometry.h>

#include "fuzzing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace pointplane;
    static const fuzzing::MemoryFile file;
    file.assign(data, size);
    try
    {
        OdometryParams params = loadOdometryParams(file.path());
        const std::string text = iniText(parametersOf(params));
        OdometryParams again;
        parseIni(text, "written", parametersOf(again));
        fuzzing::require(iniText(parametersOf(again)) == text, "what was written is read again");
        const Odometry odometry(params);
    }
    catch (const InputError& error)
    {
        fuzzing::requireOneLine(error.what());
    }
    return 0;
}
