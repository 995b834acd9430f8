// SPDX-License-Identifier: BSD-3-Clause
// Any bytes as a log of ElasticFusion.
#include <pointplane/mrpt_io/errors.h>

#include <cstring>
#include <memory>

#include "KlgRecording.h"
#include "fuzzing.h"

namespace
{
using namespace pointplane;

/** Calibration of images of 8 x 6 pixels. */
const fuzzing::MemoryFile& camera()
{
    static const char text[] = "8 8 3.5 2.5 0 0 0 0 0 8 6 1000\n";
    static const auto file = []
    {
        auto out = std::make_unique<fuzzing::MemoryFile>();
        out->assign(reinterpret_cast<const std::uint8_t*>(text), std::strlen(text));
        return out;
    }();
    return *file;
}

/** \return whether there may be more */
bool readFrame(Recording& recording)
{
    try
    {
        const auto frame = recording.next();
        if (frame)
        {
            const cv::Size size(frame->scan.camera.width, frame->scan.camera.height);
            fuzzing::require(frame->scan.depth.size() == size, "depth of the camera's size");
            fuzzing::require(frame->scan.colour.size() == size, "colour of the camera's size");
        }
        return frame.has_value();
    }
    catch (const BadFrame& error)
    {
        fuzzing::requireOneLine(oneLine(error));
        return true;
    }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const fuzzing::MemoryFile file;
    file.assign(data, size);
    try
    {
        KlgOptions options;
        options.file = file.path();
        options.camera = camera().path();
        KlgRecording recording(options);
        // A log may claim two thousand million frames, all of them bad.
        for (int i = 0; i < 1000 && readFrame(recording); ++i)
        {
            fuzzing::require(recording.progress() <= 1, "no more than all is read");
        }
    }
    catch (const InputError& error)
    {
        fuzzing::requireOneLine(oneLine(error));
    }
    return 0;
}
