// SPDX-License-Identifier: BSD-3-Clause
// Any bytes as a .simplemap: every key frame in it, up to its end or the damage.
#include <pointplane/mrpt_io/SimplemapReader.h>
#include <pointplane/mrpt_io/errors.h>

#include "fuzzing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace pointplane;
    static const fuzzing::MemoryFile file;
    file.assign(data, size);
    try
    {
        SimplemapReader reader(file.path(), RawlogClasses::Known);
        while (const auto keyFrame = reader.next())
        {
            fuzzing::require(keyFrame->pose && keyFrame->observations, "key frames are whole");
        }
    }
    catch (const InputError& error)
    {
        fuzzing::requireOneLine(error.what());
    }
    return 0;
}
