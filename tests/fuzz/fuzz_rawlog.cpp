// SPDX-License-Identifier: BSD-3-Clause
// Any bytes as a rawlog: every object in it, and how it ends.
#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/errors.h>

#include "fuzzing.h"

namespace
{
using namespace pointplane;

/** Only what the bytes themselves hold: file names in them could point anywhere. */
void convert(const mrpt::serialization::CSerializable& object)
{
    const auto* scan = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&object);
    if (scan != nullptr && !scan->rangeImage_isExternallyStored() &&
        !scan->intensityImage.isExternallyStored())
    {
        const ConvertedFrame frame = ObservationConverter().convert(*scan);
        if (!frame.problem.empty())
        {
            fuzzing::requireOneLine(frame.problem);
        }
    }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const fuzzing::MemoryFile file;
    file.assign(data, size);
    try
    {
        RawlogReader reader(file.path(), RawlogClasses::Known);
        std::size_t numObjects = 0;
        while (const auto object = reader.next())
        {
            ++numObjects;
            convert(*object);
        }
        const RawlogEnding& ending = reader.ending();
        fuzzing::require(numObjects == reader.numObjects(), "objects are counted");
        fuzzing::require(ending.kind != RawlogEnd::Open, "the end is reached");
        fuzzing::require(ending.objectIndex == numObjects, "the end is after the last object");
        fuzzing::require(ending.byteOffset <= size, "the end is in the file");
        if (ending.kind != RawlogEnd::Clean)
        {
            fuzzing::requireOneLine(ending.message);
        }
    }
    catch (const InputError& error)
    {
        fuzzing::requireOneLine(error.what());
    }
    return 0;
}
