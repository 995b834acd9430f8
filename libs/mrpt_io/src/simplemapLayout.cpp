// SPDX-License-Identifier: BSD-3-Clause
// The layout of CSimpleMap around its poses and sensory frames, as MRPT serialises it.
#include "ObjectScanner.h"

namespace pointplane
{
using scanning::require;
using scanning::requireKnown;

namespace
{
constexpr int kNewestVersion = 2;
const char* const kMapClass = "CSimpleMap";
const char* const kMapClassBefore = "CSensFrameProbSequence";  // its name in MRPT 0.x
}  // namespace

/** The size of the name, of which the first byte has been copied, and the version have four bytes.
 */
ObjectScanner::Header ObjectScanner::copyOldHeader()
{
    Header header;
    const std::size_t size = bytes_->back();
    for (int k = 0; k < 3; ++k)
    {
        require(copyValue<std::uint8_t>() == 0, "not the start of an object");
    }
    header.className = copyClassName(size);
    header.version = copyValue<std::int32_t>();
    return header;
}

ObjectScanner::MapStart ObjectScanner::scanMapStart(std::vector<std::uint8_t>& bytes)
{
    begin(bytes);
    MapStart map;
    Header header;
    try
    {
        header = copyHeader();
    }
    catch (const OldFormat&)
    {
        map.isOld = true;
        header = copyOldHeader();
    }
    require(
        header.className == kMapClass || header.className == kMapClassBefore,
        "begins with class " + header.className + ", not " + kMapClass);
    requireKnown(
        header.version >= 0 && header.version <= kNewestVersion,
        std::string(kMapClass) + " of serialisation version " + std::to_string(header.version) +
            " (0 to 2 are supported)");
    map.version = header.version;
    map.numKeyFrames = copyValue<std::uint32_t>();
    return map;
}

void ObjectScanner::scanTwist(std::vector<std::uint8_t>& bytes)
{
    begin(bytes);
    copyString();  // "std::optional" and the name of its type
    copyString();
    if (copyBool())
    {
        copyArray(6, sizeof(double));
    }
}

void ObjectScanner::scanMapEnd(const MapStart& map, std::vector<std::uint8_t>& bytes)
{
    begin(bytes);
    if (!map.isOld)
    {
        copyEndFlag({kMapClass, map.version, 0});
    }
    // Reading on finds what is behind the map, or verifies the checksum of a compressed one.
    std::uint8_t more = 0;
    require(in_.read(&more, 1) == 0, "bytes after the end of the map");
    require(in_.end() == GzInput::End::Clean, in_.problem());
}
}  // namespace pointplane
